use super::*;

fn mended(css: &str, before: &str, after: &str, kept: &[(usize, &str)]) -> String {
    let drawing = |body: &str| format!("<svg xmlns='http://www.w3.org/2000/svg'><style>{css}</style>{body}</svg>");
    let (before, after) = (drawing(before), drawing(after));
    let places: Vec<_> = kept.iter().map(|(e, tag)| (*e, after.find(tag).unwrap())).collect();
    let out = guarded(&before, &after, &places, &Budget::default()).unwrap().unwrap_or_else(|| after.clone());
    out.split_once("</style>").unwrap().1.strip_suffix("</svg>").unwrap().to_owned()
}

#[test]
fn rules_do_not_hit_what_is_new() {
    let new = "<g><path fill='red' style='opacity:.5'/></g>";
    assert_eq!(mended("rect{fill:blue}", "", new, &[]), new);
    let css = "path{fill:blue;opacity:1;stroke:red!important}*{transform:scale(2)}";
    assert_eq!(
        mended(css, "", "<g transform='translate(1 2)'/><path fill='red' style='opacity:.5'/>", &[]),
        "<g style=\"transform:matrix(1,0,0,1,1,2)\" transform='translate(1 2)'/>\
         <path fill='red' style='opacity:.5;fill:red;stroke:unset!important;transform:unset'/>"
    );
}

#[test]
fn renamed_elements_look_as_before() {
    let css = "circle{fill:teal;marker:none}path{fill:red;stroke:blue}";
    assert_eq!(
        mended(css, "<circle/>", "<path/>", &[(2, "<path")]),
        "<path style=\"fill:teal;marker-end:none;marker-mid:none;marker-start:none;stroke:unset\"/>"
    );
    // What the edit declares counts; what it leaves alone stays.
    assert_eq!(
        mended(css, "<circle style='fill:red'/>", "<path style='fill:gold'/>", &[(2, "<path")])
            .matches("fill:gold")
            .count(),
        1
    );
    assert_eq!(mended("g{fill:red}", "<g/>", "<g/>", &[(2, "<g/>")]), "<g/>");
}

#[test]
fn places_among_siblings() {
    let css = ".a:nth-child(3){fill:red}";
    let (before, after) = ("<g/><path class='a'/>", "<title/><g/><path class='a'/>");
    let kept = [(2, "<g/>"), (3, "<path")];
    assert_eq!(mended(css, before, after, &kept), after.replace("<path", "<path style=\"fill:red\""));
}
