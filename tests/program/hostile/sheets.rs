//! Style sheets and namespaces that could take time with the square of their length.

use super::bounded::{Folder, RECT, expect, is_not_read, svg};

/// A style sheet for a rectangle.
fn sheet(css: &str) -> String {
    format!("<style>{css}</style>{RECT}")
}

#[test]
fn long_sheets_are_read() {
    let expect =
        |body: &str, codes, words| Folder::with(&[("a.svg", &svg(body))]).ample().expect("a.svg", codes, words);
    expect(&sheet(&"rect{fill:red;a:1 2 #3}".repeat(8000)), [0, 0], "");
    expect(&sheet(&"rect{fill:red;a:1 2 #3}\n".repeat(20_000)), [0, 0], "");
    expect(&sheet(&"{}}{;:@\\".repeat(100_000)), [0, 0], "");
    expect(&format!("{}{RECT}", "<style>rect{fill:red}</style>".repeat(20_000)), [0, 0], "");
    // Rules of ordinary sheets.
    expect(&sheet(&"rect{fill:red;stroke-width:1.5;stroke:#00a0e9}\n".repeat(1000)), [0, 0], "");
}

#[test]
fn declarations_are_counted_for_each_selector() {
    let css = |tag: &str| format!("{}b{{{}}}", format!("{tag},").repeat(4000), "a:b;".repeat(4000));
    expect(&sheet(&css("a")), [0, 0], "");
    is_not_read(&sheet(&css("rect")), "work");
}

#[test]
fn values_of_attributes_are_counted() {
    let rules: String = (0..5000).map(|i| format!(".k{i}{{fill:blue}}\n")).collect();
    let rects = format!("<rect width='9' height='9' class='{}z'/>", "y ".repeat(1000)).repeat(300);
    // Rules for classes are looked up; rules for parts of a value are not.
    expect(&format!("<style>{rules}</style>{rects}"), [0, 0], "");
    let parts = rules.replace('.', "[class$=").replace('{', "]{");
    is_not_read(&format!("<style>{parts}</style>{rects}"), "work");
}

#[test]
fn values_are_counted_for_each_element() {
    let paths = "<path d='M0 0h9v9z'/>".repeat(20_000);
    let rule = |css: &str| format!("<style>{css}</style>{paths}");
    is_not_read(&rule(&format!("path{{transform:{}}}", "rotate(1deg)".repeat(38_000))), "work");
    // Texts inherit a value without which they are shown.
    let inherited = format!("<g style='text-shadow:{}'>{}</g>", "1px ".repeat(60_000), "<text>a</text>".repeat(300));
    expect(&inherited, [1, 1], "");
    // A short value may refer to a long one.
    let long = "1px ".repeat(4000);
    is_not_read(&rule(&format!("svg{{--a:{long}}}path{{stroke-dasharray:var(--a)}}")), "work");
}

#[test]
fn namespaces_are_counted() {
    let open: String = (0..12_000).map(|i| format!("<g xmlns:n{i}='u{i}'>")).collect();
    let deep = format!("{open}{RECT}{}", "</g>".repeat(12_000));
    Folder::with(&[("a.svg", &svg(&deep))]).is_not_read("a.svg", "work");
    // Some programs repeat one declaration on every element.
    let same = "<rect xmlns='http://www.w3.org/2000/svg' width='9' height='9'/>".repeat(9000);
    Folder::with(&[("a.svg", &svg(&same))]).whole().expect("a.svg", [0, 0], "");
}
