use super::*;

#[test]
fn the_root_declares_the_prefix() {
    let cases = [
        ("<svg/>", "<svg xmlns:cc=\"http://creativecommons.org/ns#\"/>"),
        ("<?xml version='1.0'?><!-- <a> --><!DOCTYPE svg [<!ENTITY a 'b'>]>\n<s:svg\n>", "<s:svg xmlns:cc=\"http://"),
    ];
    for (text, wanted) in cases {
        let found = declared(text, "cc").unwrap();
        assert!(found.contains(wanted), "{found}");
    }
    assert!(declared("<svg>", "figma").unwrap().contains("xmlns:figma=\"urn:undeclared:figma\""));
    assert_eq!(declared("<!-- ", "cc"), None);
}
