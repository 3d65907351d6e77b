use super::*;
use pathwarp::budget::Limits;

fn spent(text: &str, limit: Limit) -> f64 {
    let budget = Budget::new(Limits::none().with(limit, 1e300));
    count(text, &budget).unwrap();
    1e300_f64.min(budget.left(limit))
}

/// The expected sizes are counted by hand.
#[test]
fn expansions_are_counted_before_they_happen() {
    let within = |text: &str, bytes: f64| {
        let budget = Budget::new(Limits::default().with(Limit::Bytes, bytes));
        count(text, &budget).is_ok()
    };
    // 10 bytes in four references, less the references themselves.
    let flat = "<!DOCTYPE s [<!ENTITY a \"aaaaaaaaaa\">]><s>&a;&a;&a;&a;</s>";
    assert!(within(flat, 40.0) && !within(flat, 39.0));
    let mut nested = "<!DOCTYPE s [<!ENTITY a0 'ten bytes.'>".to_owned();
    for i in 1..10 {
        nested += &format!("<!ENTITY a{i} '{}'>", format!("&a{};", i - 1).repeat(10));
    }
    nested += "]><s>&a9;</s>";
    assert!(!within(&nested, 1e10) && within(&nested, 1e12));
    assert!(within("<s>a & b; &lt; &amp;</s>", 1.0));
    assert!(spent("<s/>", Limit::Bytes) >= 1e300);
}

#[test]
fn many_attributes_are_many_comparisons() {
    let tag = |n: usize| format!("<s {}/>", (0..n).map(|i| format!("a{i}=''")).collect::<Vec<_>>().join(" "));
    let within = |text: &str| count(text, &Budget::default()).is_ok();
    assert!(within(&tag(1000)) && !within(&tag(100_000)));
}
