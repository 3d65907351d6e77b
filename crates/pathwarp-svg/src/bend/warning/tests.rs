use super::Warning;

#[test]
fn notes_name_a_few_of_many() {
    let note = |n: usize| {
        let names = ["a", "b", "c", "d", "e", "f"][..n].iter().map(|s| (*s).to_owned()).collect();
        Warning::Note { text: "dropped", names }.to_string()
    };
    assert_eq!(
        [0, 1, 4, 6].map(note),
        ["dropped", "dropped: a", "dropped: a, b, c, d", "dropped: a, b, c, d and 2 more"]
    );
}
