use super::*;

#[test]
fn numbers_out_of_range_are_found_and_others_are_not() {
    let found = |t: &str| -> Vec<String> { far(t).into_iter().map(|r| t[r].to_owned()).collect() };
    assert_eq!(found("M0 0L1e308-3.4e38H1e+9 999999999 1e8z"), ["1e308", "3.4e38", "1e+9"]);
    assert_eq!(found("M.5.1234567890123 1e-20 12345678901.5"), ["12345678901.5"]);
    for t in ["M0 0L1e308 1", "0.5 12345678901", "1234567890"] {
        assert!(may_be_far(t), "{t}");
    }
    assert!(!may_be_far("M10 20.123456L-5 1234567 z"));
    assert_eq!(in_range("M0 0L1e308,1"), ("M0 0L9e8,1".into(), Some("1e308".into())));
}
