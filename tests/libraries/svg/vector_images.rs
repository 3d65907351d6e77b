//! Drawings shown as images, warped as geometry. The reference is the original, transformed by the renderer itself or bent pixel by
//! pixel after rendering.

use pathwarp::kurbo::Affine;
use pathwarp_oracle::drawings::{Bend, check, curved, drawing, oblique, options, read, warp, warp_options};
use pathwarp_svg::{Document, Selection, Structure};

/// Encodes a drawing as a `data:` link, percent-encoded.
fn link(svg: &str) -> String {
    let code = |b: u8| match b {
        b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b' ' | b'.' | b'/' | b'=' | b':' | b'-' | b',' => {
            char::from(b).to_string()
        }
        _ => format!("%{b:02X}"),
    };
    format!("data:image/svg+xml,{}", svg.bytes().map(code).collect::<String>())
}

fn inner(attributes: &str, body: &str) -> String {
    link(&format!("<svg xmlns='http://www.w3.org/2000/svg' {attributes}>{body}</svg>"))
}

/// Returns names and drawings.
fn drawings() -> Vec<(&'static str, String)> {
    let plain =
        inner("width='20' height='10'", "<rect width='20' height='10' fill='gold'/><circle cx='10' cy='5' r='4'/>");
    let painted = inner(
        "viewBox='0 0 40 40' width='40' height='40'",
        "<style>.k{stroke:navy;stroke-width:3}</style><linearGradient id='a'><stop stop-color='red'/><stop offset='1' \
         stop-color='blue'/></linearGradient><clipPath id='c'><circle cx='20' cy='20' r='15'/></clipPath><g \
         clip-path='url(#c)'><rect id='r' class='k' x='2' y='2' width='36' height='36' fill='url(#a)'/></g>",
    );
    let wide = inner(
        "width='30' height='30'",
        "<circle cx='15' cy='15' r='13' fill='teal'/><path d='M1 1L29 29' stroke='red'/>",
    );
    vec![
        ("plain", format!("<image id='i' x='10' y='20' width='60' height='30' href=\"{plain}\"/>")),
        (
            "with names that the drawing around it has as well",
            format!(
                "<linearGradient id='a'><stop stop-color='lime'/><stop offset='1' stop-color='black'/></linearGradient><rect \
                 id='r' x='60' y='60' width='30' height='30' fill='url(#a)'/><image id='i' x='5' y='5' width='50' \
                 height='50' href=\"{painted}\"/>"
            ),
        ),
        (
            "in a turned group, with letterbox and slice",
            format!(
                "<g transform='rotate(10) scale(1 .8)' opacity='.8'><image id='i' x='15' y='5' width='30' height='40' \
                 href=\"{wide}\"/><image x='55' y='5' width='30' height='45' preserveAspectRatio='xMidYMid slice' \
                 href=\"{wide}\"/></g>"
            ),
        ),
        (
            "in a copy and with a transform of its own",
            format!(
                "<defs><image id='j' width='40' height='20' href=\"{plain}\"/></defs><use id='i' href='#j' x='10' y='60'/><image \
                 transform='translate(60 10) rotate(30)' width='40' height='20' href=\"{plain}\"/>"
            ),
        ),
    ]
}

#[test]
fn they_look_like_the_renderers_transform() {
    for (name, body) in drawings() {
        for structure in [Structure::Auto, Structure::Flatten] {
            for map in [oblique(), Affine::IDENTITY] {
                let _ = check(name, &drawing(&body), map, &warp_options().with_structure(structure));
            }
        }
    }
}

#[test]
fn under_a_curved_map_they_are_geometry() {
    for (name, body) in drawings() {
        let (w, gap) = curved(&drawing(&body), &warp_options());
        println!("{name}: {gap:?}");
        assert!(gap.mean <= 1.0, "{name}: {gap:?}");
        assert!(!w.svg.contains("<image id='i'") && w.svg.contains("<g id='i'"), "{name}: {}", w.svg);
        assert!(w.skipped.is_empty(), "{:?}", w.skipped);
        assert!(Document::read(w.svg.as_bytes(), "again", &options()).is_ok());
    }
}

#[test]
fn linked_drawings_are_geometry_too() {
    let samples = crate::support::root().join("samples");
    let svg = drawing("<image id='i' x='10' y='10' width='80' height='80' href='logo.svg'/>");
    let with = options().with_base_dir(Some(samples.clone()));
    let w = Document::read(svg.as_bytes(), "t.svg", &with).unwrap().warp(&Bend, &warp_options()).unwrap();
    let logo = std::fs::read(samples.join("logo.svg")).unwrap();
    let shapes = Document::read(&logo, "logo.svg", &options()).unwrap().shapes().len();
    assert!(shapes > 2 && read(&w.svg).shapes().len() >= shapes, "{}", w.svg);
    assert!(!w.svg.contains("<image") && w.svg.contains("<g id='i'"), "{}", w.svg);
    let embedded = svg.replace("'logo.svg'", &format!("\"{}\"", link(std::str::from_utf8(&logo).unwrap())));
    pathwarp_oracle::drawings::same("linked", &w.svg, &read(&embedded).warp(&Bend, &warp_options()).unwrap().svg);
}

/// A link may name anything in the file system. Without a base folder, it is not followed.
#[test]
fn what_is_no_plain_file_is_not_read() {
    let samples = crate::support::root().join("samples");
    let with = options().with_base_dir(Some(samples));
    let links = ["/dev/zero", "../samples", "no-such.svg", "../../../samples/logo.svg?", "data:image/bmp,"];
    for (link, with) in links.map(|l| (l, &with)).into_iter().chain([("samples/logo.svg", &options())]) {
        let svg = drawing(&format!("<image id='i' x='10' y='10' width='80' height='80' href='{link}'/>"));
        let w = Document::read(svg.as_bytes(), "t.svg", with).unwrap().warp(&Bend, &warp_options()).unwrap();
        assert!(w.svg.contains("<image id='i'"), "{link}: {}", w.svg);
        let [left] = &w.skipped[..] else { panic!("{link}: {:?}", w.skipped) };
        assert!(left.id == "i" && left.why.contains(link.trim_end_matches(',')), "{left:?}");
        // An image that is not selected is not reported, and flattened output omits it.
        let other = Selection { exclude: vec!["#i".into()], ..Selection::default() };
        let options = warp_options().with_selection(other);
        assert!(
            Document::read(svg.as_bytes(), "t.svg", with).unwrap().warp(&Bend, &options).unwrap().skipped.is_empty()
        );
        let options = warp_options().with_structure(Structure::Flatten);
        let flat = Document::read(svg.as_bytes(), "t.svg", with).unwrap().warp(&Bend, &options).unwrap();
        assert!(!flat.svg.contains("<image") && flat.skipped.iter().any(|s| s.why.contains("left out")));
    }
}

/// SVG 2, section 12.3, clips an image to the edge of its drawing. The renderer does not, so the reference is a group with such a clip
/// path.
#[test]
fn they_are_cut_at_their_edge() {
    let body = "<circle cx='15' cy='15' r='19' fill='teal'/>";
    let image = inner("width='30' height='30'", body);
    let image = format!("<g transform='rotate(10)'><image x='20' y='5' width='60' height='60' href=\"{image}\"/></g>");
    let group = format!(
        "<clipPath id='c'><rect width='30' height='30'/></clipPath><g transform='rotate(10) translate(20 5) scale(2)'><g \
         clip-path='url(#c)'>{body}</g></g>"
    );
    let [image, group] = [image, group].map(|b| warp(&drawing(&b), oblique()).svg);
    pathwarp_oracle::drawings::same("edge", &image, &group);
    let cut = read(&group).shapes().len();
    assert_eq!(cut, 2, "a shape and its clip path");
}

/// The comparison can fail: an affine placement alone differs a lot.
#[test]
fn an_affine_place_would_be_seen() {
    let (_, body) = drawings().swap_remove(0);
    let svg = drawing(&body);
    let placed =
        read(&svg).warp(&pathwarp_oracle::drawings::Hidden(Affine::translate((0.0, 4.0))), &warp_options()).unwrap();
    let gap = pathwarp_oracle::drawings::gap(&svg, &placed.svg);
    assert!(gap.mean > 10.0, "{gap:?}");
}
