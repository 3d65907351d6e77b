use super::*;

#[test]
fn properties_are_found() {
    assert!(PROPERTIES.windows(2).all(|w| w[0].name < w[1].name));
    assert!(PROPERTIES.iter().all(|p| std::ptr::eq(property(p.name).unwrap(), p)));
    assert!(STYLE_ONLY.iter().all(|n| property(n).is_some() && of_attribute(n).is_none()));
    assert!(property("class").is_none());
}
