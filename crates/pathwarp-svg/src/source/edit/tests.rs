use super::*;
use pathwarp::budget::Budget;

fn edited(shape: &str, edit: impl FnOnce(&mut Edits<'_>)) -> String {
    let head = "<svg xmlns='http://www.w3.org/2000/svg'>";
    let s = SourceText::read(format!("{head}{shape}</svg>"), "t", &Budget::default(), |_, _| Ok(())).unwrap().0;
    let mut e = Edits::new(&s);
    edit(&mut e);
    e.apply().0.strip_prefix(head).unwrap().strip_suffix("</svg>").unwrap().to_owned()
}

#[test]
fn a_rect_becomes_a_path_and_keeps_the_rest() {
    let out = edited("<rect  x='1'\n y='2' id='a' ><title>t</title></rect >", |e| {
        e.rename(1, "path");
        e.remove_attr(1, "x");
        e.remove_attr(1, "y");
        e.set_attr(1, "d", "M0,0".into());
    });
    assert_eq!(out, "<path id='a' d=\"M0,0\" ><title>t</title></path>");
}

#[test]
fn properties_go_where_they_win() {
    let set = |e: &mut Edits<'_>| e.set_property(1, "stroke-width", "2".into());
    assert_eq!(edited("<path stroke-width='1'/>", set), "<path stroke-width='2'/>");
    assert_eq!(edited("<path style='a:b; stroke-width : 1;'/>", set), "<path style='a:b;stroke-width:2'/>");
    assert_eq!(edited("<path/>", set), "<path stroke-width=\"2\"/>");
    let css = edited("<path/><style>path{stroke-width:3}</style>", set);
    assert!(css.starts_with("<path style=\"stroke-width:2\"/>"));
}

#[test]
fn content_of_an_empty_element_and_replacement() {
    let out = edited("<g/><g><path/></g>", |e| {
        e.set_content(1, "<x/>".into());
        e.set_attr(3, "d", "M0,0".into());
        e.replace(2, "<y/>".into());
        e.insert_after(2, "<z/>");
    });
    assert_eq!(out, "<g><x/></g><y/><z/>");
}
