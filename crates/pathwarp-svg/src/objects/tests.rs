use super::*;
use pathwarp::budget::Limits;

const HEAD: &str = "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink'>";

fn file(body: &str) -> String {
    format!("{HEAD}{body}</svg>")
}

fn cage() -> Guides {
    let drawing = file("<g transform='scale(2)'><path id='cage' d='M0,0 1,1'/></g>");
    Guides::of(&drawing, &ids(&["cage"]), &Limits::default()).unwrap()
}

fn memory(id: &str) -> Memory {
    Memory { id: id.into(), recipe: "warp --bend '4 <0>'".into(), guides: cage(), nodes: "3 0,0".into() }
}

fn ids(list: &[&str]) -> Vec<String> {
    list.iter().map(ToString::to_string).collect()
}

#[test]
fn the_source_comes_back_to_the_byte() {
    let before = file("<g><path  id='a' d='M0,0'\n/></g><path id='b' d='M1,1'/>");
    let after = file("<g><path  id='a' d='M9,9'\n/></g><path id='b' d='M8,8'/>");
    let limits = Limits::default();
    let with = remember(&before, &after, &[memory("a"), memory("b")], &limits).unwrap();
    let listed = objects(&with, &limits).unwrap();
    let remembering: Vec<_> = listed.iter().filter(|o| o.recipe.is_some()).map(|o| o.id.as_str()).collect();
    assert_eq!(remembering, ["a", "b"]);
    let one = restore(&with, &ids(&["a"]), &limits).unwrap();
    assert!(one.svg.contains("<path  id='a' d='M0,0'\n/>") && one.svg.contains("d='M8,8'"), "{}", one.svg);
    assert_eq!(one.objects[0].recipe, "warp --bend '4 <0>'");
    assert_eq!((&one.objects[0].guides, one.objects[0].nodes.as_str()), (&cage(), "3 0,0"));
    let wanted = "<g transform=\"scale(2)\"><path id='cage' d='M0,0 1,1'/></g>";
    assert!(cage().file().contains(wanted), "{}", cage().file());
    let both = restore(&with, &ids(&["a", "b", "none"]), &limits).unwrap();
    assert_eq!(both.svg, before);
    // What did not change remembers nothing, and what has no source stays.
    assert_eq!(remember(&before, &before, &[memory("a")], &limits).unwrap(), before);
    assert_eq!(restore(&before, &ids(&["a"]), &limits).unwrap().svg, before);
}

#[test]
fn warps_of_warps_come_back_one_by_one() {
    let limits = Limits::default();
    let states: Vec<String> = (0..3).map(|i| file(&format!("<g id='g'><path id='a' d='M{i},0'/></g>"))).collect();
    let once = remember(&states[0], &states[1], &[memory("a")], &limits).unwrap();
    let twice = remember(&once, &once.replace("M1,0", "M2,0"), &[memory("g")], &limits).unwrap();
    let listed = objects(&twice, &limits).unwrap();
    let remembering: Vec<_> = listed.iter().filter(|o| o.recipe.is_some()).map(|o| o.id.as_str()).collect();
    assert_eq!(remembering, ["g"], "the path's own source is the group's now");
    let back = restore(&twice, &ids(&["g"]), &limits).unwrap().svg;
    assert_eq!(back, once);
    assert_eq!(restore(&back, &ids(&["a"]), &limits).unwrap().svg, states[0]);
}

#[test]
fn definitions_come_back_and_added_ones_go() {
    let limits = Limits::default();
    let before = file(
        "<defs><clipPath id='c'><path id='p' d='M0,0'/></clipPath><linearGradient id='l'/></defs>\
         <path id='a' clip-path='url(#c)' style='fill:url(#l)' d='M0,0'/>",
    );
    let after = file(
        "<defs><clipPath id='c'><path id='p' d='M5,5'/></clipPath><linearGradient id='l'/>\n<linearGradient \
         id='l-warped' xlink:href='#l'/></defs><path id='a' clip-path='url(#c)' style='fill:url(#l-warped)' d='M7,7'/>",
    );
    let with = remember(&before, &after, &[memory("a")], &limits).unwrap();
    assert_eq!(restore(&with, &ids(&["a"]), &limits).unwrap().svg, before);
    // An editor removes what nothing refers to.
    let without = with.replace("<linearGradient id='l'/>", "").replace(" xlink:href='#l'", "");
    let back = restore(&without, &ids(&["a"]), &limits).unwrap().svg;
    assert!(back.contains("<linearGradient id='l'/>") && !back.contains("l-warped"), "{back}");
    // Another object still needs the warped clip path, so the source gets a new one.
    let shared = with.replace("</svg>", "<path id='b' clip-path='url(#c)' d='M3,3'/></svg>");
    let back = restore(&shared, &ids(&["a"]), &limits).unwrap().svg;
    assert!(back.contains("<clipPath id='c-2'><path id='p' d='M0,0'/>"), "{back}");
    assert!(
        back.contains("clip-path='url(#c-2)'") && back.contains("<clipPath id='c'><path id='p' d='M5,5'/>"),
        "{back}"
    );
}

#[test]
fn a_copy_keeps_its_own_ids() {
    let limits = Limits::default();
    let before = file("<g id='g'><path id='a' d='M0,0'/><use xlink:href='#a'/></g>");
    let with = remember(&before, &before.replace("M0,0", "M9,9"), &[memory("g")], &limits).unwrap();
    let group = &with[HEAD.len()..with.len() - "</svg>".len()];
    let copy = group.replace("id='g'", "id='g9'").replace("id='a'", "id='a9'").replace("#a", "#a9");
    let both = file(&format!("{group}{copy}"));
    let back = restore(&both, &ids(&["g9"]), &limits).unwrap().svg;
    assert!(back.contains(group), "the original stays");
    assert!(back.contains("<g id='g9'><path id='a-2' d='M0,0'/><use xlink:href='#a-2'/></g>"), "{back}");
}

#[test]
fn damage_is_an_error() {
    let limits = Limits::default();
    let before = file("<path id='a' d='M0,0'/>");
    let with = remember(&before, &before.replace("M0", "M1"), &[memory("a")], &limits).unwrap();
    for (from, to) in
        [("pathwarp:source=\"", "pathwarp:source=\"!"), ("pathwarp:source=\"H4sI", "pathwarp:source=\"AAAA")]
    {
        assert!(restore(&with.replace(from, to), &ids(&["a"]), &limits).is_err(), "{to}");
    }
}

#[test]
fn moving_counts_the_transforms_around() {
    use pathwarp::kurbo::Affine;
    let limits = Limits::default();
    let svg =
        file("<g transform='scale(2)'><path id='a' d='M0,0'/><path id='b' transform='translate(1,0)' d='M0,0'/></g>");
    let out = moved(&svg, "a", Affine::translate((10.0, 4.0)), &limits).unwrap();
    assert!(out.contains("<path transform=\"matrix(1 0 0 1 5 2)\" id='a'"), "{out}");
    let out = moved(&svg, "b", Affine::translate((10.0, 4.0)), &limits).unwrap();
    assert!(out.contains("transform='matrix(1 0 0 1 6 2)'"), "{out}");
    assert_eq!(moved(&svg, "none", Affine::IDENTITY, &limits).unwrap(), svg);
}

#[test]
fn a_new_colour_and_label_are_kept() {
    let limits = Limits::default();
    let head = "<svg xmlns='http://www.w3.org/2000/svg' xmlns:i='http://www.inkscape.org/namespaces/inkscape'>";
    let path = |attributes: &str| format!("{head}<g id='g'><path id='a' {attributes}/></g></svg>");
    let then = path("fill='red' style='stroke-width:2;stroke:url(#s1)' d='M0,0'");
    let now = path("i:label='new' style='fill:blue;stroke-width:2;stroke:url(#s2)' fill='red' d='M0,0'");
    let new = path("fill='red' style='stroke-width:3;stroke:url(#s3)' d='M5,5'");
    let out = restyled([&then, &now, &new], "g", &[], &limits).unwrap();
    assert!(out.contains("style='stroke-width:3;stroke:url(#s3);fill:blue'"), "{out}");
    assert!(out.contains("<path i:label=\"new\" id='a'") && out.contains("d='M5,5'"), "{out}");
    let out = restyled([&then, &now, &new], "g", &["fill"], &limits).unwrap();
    assert!(out.contains("style='stroke-width:3;stroke:url(#s3)'"), "{out}");
    assert_eq!(restyled([&then, &then, &new], "g", &[], &limits).unwrap(), new);
}
