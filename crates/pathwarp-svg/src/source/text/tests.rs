use super::*;

#[test]
fn places_are_found() {
    let s = SourceText::parse(
        "<svg xmlns='http://www.w3.org/2000/svg'>\n <rect  x = '1' id='a'/><g a='>'>t</g></svg>".into(),
        "t",
    )
    .unwrap();
    let r = &s.elements[1];
    assert_eq!(&s.text[r.range.clone()], "<rect  x = '1' id='a'/>");
    assert_eq!(&s.text[r.find(&s.text, "x").unwrap().value_range.clone()], "1");
    assert!(r.close.is_none());
    let g = &s.elements[2];
    assert_eq!(&s.text[g.open_end..g.close.clone().unwrap().start], "t");
    assert_eq!(s.line_column(r.range.start), (2, 2));
}

#[test]
fn temporary_ids_leave_the_rest_alone() {
    let drawings = [
        "<svg xmlns='http://www.w3.org/2000/svg'><path/><g id='q'><path id=''/></g></svg>",
        "<?xml version='1.0'?>\n<!DOCTYPE svg>\n<!-- <path> --><s:svg xmlns:s='http://www.w3.org/2000/svg' a='>'\n><s:g\n/>\
         <s:path xml:id = \"a\" d='M0,0'/><s:style type='text/x'><![CDATA[ <g> .b{} ]]></s:style><s:title>t &amp; u</s:title></s:svg >",
        "<svg xmlns='http://www.w3.org/2000/svg' xmlns:i='http://www.inkscape.org/namespaces/inkscape'>\
         <g id='a' i:label='&lt;'><path id='a' d='M0,0\n1,1'/></g><rect id='longer than warp-5' x='1'/><rect \
         id='longer than warp-5' y='2'/><use href='#a'/><text><tspan id='c'>warp-</tspan></text><svg/></svg>",
    ];
    for d in drawings {
        let direct = SourceText::parse(d.to_owned(), "t").unwrap();
        let wanted = direct.instrumented().0;
        let (source, n) =
            SourceText::read(d.to_owned(), "t", &Budget::default(), |_, doc| Ok(doc.input_text().len())).unwrap();
        assert_eq!((n, &source.text), (wanted.len(), &direct.text));
        assert_eq!(format!("{:?}", source.elements), format!("{:?}", direct.elements));
        for e in &source.elements {
            assert!(d[e.range.start..].starts_with(&format!("<{}", &d[e.qname.clone()])));
            assert_eq!(&d[e.open_end - 1..e.open_end], ">");
            assert!(e.attrs.iter().all(|a| d[a.range.clone()].contains(&d[a.value_range.clone()])));
        }
    }
    let (text, ids) = {
        let (s, text) =
            SourceText::read(drawings[0].to_owned(), "t", &Budget::default(), |_, doc| Ok(doc.input_text().to_owned()))
                .unwrap();
        (text, s.by_tree_id().clone())
    };
    assert_eq!(
        text,
        "<svg id=\"warp-0\" xmlns='http://www.w3.org/2000/svg'><path id=\"warp-1\"/><g id='q'><path id='warp-3'/></g></svg>"
    );
    assert_eq!((&ids["q"], &ids["warp-3"]), (&vec![2], &vec![3]));
}
