use crate::source::check::*;
use pathwarp::budget::Limits;

fn count(body: &str) -> Result<(u64, usize), String> {
    let svg =
        format!("<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink'>{body}</svg>");
    let doc = roxmltree::Document::parse(&svg).unwrap();
    let budget = Budget::new(Limits::none().with(Limit::Elements, 1e6));
    let counted = Unfolding::new(&doc).count(&budget).map(|(size, depth)| (size.elements, depth));
    counted.map_err(|(node, _)| node.attribute("id").unwrap_or("").to_owned())
}

/// Expected counts worked out by hand.
#[test]
fn what_shows_again_counts_again() {
    let elements = |body: &str| count(body).unwrap().0;
    assert_eq!(elements("<g><rect/><x/></g><defs><rect/></defs>"), 5);
    // svg, defs, two copies of the group of two, each with its use.
    let group = "<defs><g id='g'><rect/></g></defs>";
    assert_eq!(elements(&format!("{group}<use xlink:href='#g'/><use href='#g'/>")), 2 + 2 * 3);
    // A pattern of two elements, by attribute, style, style sheet, from the group around and through a use.
    let pattern = "<pattern id='p'><rect/></pattern>";
    assert_eq!(elements(&format!("{pattern}<rect fill='url(#p) red'/>")), 3 + 2);
    assert_eq!(elements(&format!("{pattern}<rect style='fill:url( \"#p\" )' stroke='url(#p)'/>")), 3 + 4);
    assert_eq!(elements(&format!("{pattern}<g fill='url(#p)'><rect/><rect fill='red'/><rect/></g>")), 6 + 4);
    assert_eq!(elements(&format!("{pattern}{group}<use href='#g' fill='url(#p)'/>")), 4 + 2 + 2);
    let context = "<defs><g id='c' fill='context-fill'><rect/><rect/></g></defs>";
    assert_eq!(elements(&format!("{pattern}{context}<use href='#c' fill='url(#p)'/>")), 4 + 3 + 4);
    // The content of a pattern inherits from the pattern's position, not from the shape.
    assert_eq!(
        elements(&format!("<g stroke='url(#q)'>{pattern}</g><pattern id='q'/><rect fill='url(#p)'/>")),
        5 + 2 + 1
    );
    // A pattern without content uses another's; filters, masks and clip paths.
    assert_eq!(elements(&format!("{pattern}<pattern id='q' href='#p'/><rect fill='url(#q)'/>")), 4 + 1 + 2);
    let rest = "<clipPath id='c'><rect/></clipPath><mask id='m'><rect/><rect/></mask>\
                <filter id='f'><feImage href='#m'/></filter>";
    assert_eq!(
        elements(&format!("{rest}<g clip-path='url(#c)' mask='url(#m)' filter='url(#f) url(#f)'/>")),
        5 + 2 + 3 + 2 * 5
    );
    // A marker of two elements on at most nine vertices.
    let marker = "<marker id='m'><rect/></marker>";
    assert_eq!(elements(&format!("{marker}<path marker-mid='url(#m)' d='M1,2L3 4zl-5-6'/>")), 3 + 9 * 2);
    // Cycles terminate.
    assert_eq!(elements("<g id='g'><use href='#g'/></g>"), 3 + 3 - 1);
}

#[test]
fn nests_of_references_are_bounded() {
    let nest = |levels: usize, tag: &str, show: &dyn Fn(usize) -> String| -> String {
        let level = |i| format!("<{tag} id='n{i}'>{}</{tag}>", (0..10).map(|_| show(i + 1)).collect::<String>());
        (0..levels).map(level).chain([format!("<{tag} id='n{levels}'><rect/></{tag}>"), show(0)]).collect()
    };
    let fill = |i: usize| format!("<rect fill='url(#n{i})'/>");
    assert!(count(&nest(4, "pattern", &fill)).is_ok());
    assert_eq!(count(&nest(9, "pattern", &fill)), Err("n3".into()));
    assert_eq!(count(&nest(50, "mask", &|i| format!("<g style='mask:url(#n{i})'/>"))).map_err(|e| e.len()), Err(3));
    assert_eq!(count(&nest(50, "symbol", &|i| format!("<use href='#n{i}'/>"))).map_err(|e| e.len()), Err(3));
    // A long chain of single references.
    let chain: String =
        (0..9000).map(|i| format!("<pattern id='n{i}'><rect fill='url(#n{})'/></pattern>", i + 1)).collect();
    assert!(count(&format!("{chain}<rect fill='url(#n0)'/>")).is_err());
    assert!(count(&format!("{chain}<rect fill='url(#n8900)'/>")).is_ok());
}
