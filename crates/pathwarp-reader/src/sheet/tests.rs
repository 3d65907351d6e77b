use super::*;

fn names(css: &str) -> Vec<String> {
    let mut rules = Rules::default();
    rules.add(css);
    rules.blocks.iter().flat_map(|r| r.declarations.iter().map(|d| format!("{}={}", d.name, d.value))).collect()
}

#[test]
fn rules_that_count() {
    let css = "@media print{a{x:1}} @media screen{b{x:2}} @supports (x:y){c{x:3}} @font-face{x:4} ::before{x:5} e:foo{x:6} \
               f{X:7;Y:/* ; */ 8 ! important;z} @layer l{g{x:9}} @import 'x'; h{x:url(a;b)}";
    assert_eq!(names(css), ["x=2", "x=3", "x=5", "X=7".to_lowercase().as_str(), "y=8", "x=9", "x=url(a;b)"]);
}

#[test]
fn what_is_ignored_is_said() {
    let mut rules = Rules::default();
    rules.add("a:foo(1){x:1} {x:0} }{x:0} a..b{x:0} @media (min-width:3px){a{x:2}} a{x:3; b{x:4}} @import 'x';");
    let said: Vec<&str> = rules.unsupported.iter().map(String::as_str).collect();
    assert_eq!(
        said,
        [
            "rules for “a:foo(1)” are ignored",
            "rules inside of rules are ignored",
            "the rules of “@media (min-width:3px)” are ignored",
            "“@import 'x'” is ignored"
        ]
    );
}

#[test]
fn style_attributes() {
    let all = declarations("fill:red;--A:b;;stroke : url(x;y) !important");
    let all: Vec<_> = all.iter().map(|d| (&*d.name, &*d.value, d.important)).collect();
    assert_eq!(all, [("fill", "red", false), ("--A", "b", false), ("stroke", "url(x;y)", true)]);
}
