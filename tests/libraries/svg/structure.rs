//! Preservation of a file's text.

use pathwarp::kurbo::Affine;
use pathwarp::map::AffineMap;
use pathwarp_oracle::drawings::{Bend, Hidden, drawing, oblique, read, warp, warp_options};
use pathwarp_svg::{Selection, Structure};

#[test]
fn only_the_edited_attributes_change() {
    let svg = "<?xml version=\"1.0\"?>\n<!-- mine -->\n<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 100 100\">\n  \
               <title>Mine</title><g  id='g' class=\"a b\" data-x='1'\n  transform='scale(2)'><path  id=\"p\" \
               d='M0 0h10v10z' style=\"fill: red\" /></g><!-- end -->\n</svg>\n<!-- after -->";
    let out = warp(svg, oblique()).svg;
    let d = out.find("d='M").unwrap() + 3;
    let end = d + out[d..].find('\'').unwrap();
    let at = svg.find("M0 0").unwrap();
    assert_eq!(format!("{}M0 0h10v10z{}", &out[..d], &out[end..]), svg);
    assert_eq!(d, at);
}

#[test]
fn the_exact_identity_and_an_empty_selection_give_the_bytes_back() {
    let svg = drawing("<rect  width='10'   height='10'/>\r\n");
    let d = read(&svg);
    assert_eq!(d.warp(&AffineMap(Affine::IDENTITY), &warp_options()).unwrap().svg, svg);
    let nothing = Selection { select: vec!["#none".into()], ..Selection::default() };
    let w = d.warp(&Hidden(oblique()), &warp_options().with_selection(nothing)).unwrap();
    assert_eq!(w.svg, svg);
    assert!(w.shapes.is_empty());
}

#[test]
fn shapes_become_paths_and_keep_their_names() {
    let w = warp(&drawing("<circle id='c' class='k' cx='50%' cy='50' r='10'><title>Sun</title></circle>"), oblique());
    assert!(w.svg.contains("<path id='c' class='k' d=\"M"), "{}", w.svg);
    assert!(w.svg.contains("<title>Sun</title></path>"), "{}", w.svg);
    assert_eq!(w.shapes[0].id, "c");
}

#[test]
fn text_says_what_it_said() {
    let w =
        warp(&drawing("<text id='t' class='k' x='5' y='50' font-size='20'>a <tspan>b&lt;</tspan></text>"), oblique());
    assert!(
        w.svg.contains("<g id='t' class='k' font-size='20' aria-label=\"a b&lt;\"><title>a b&lt;</title><path"),
        "{}",
        w.svg
    );
    assert_eq!(w.shapes.len(), 1);
}

#[test]
fn a_copy_becomes_a_group_of_the_same_name() {
    let body = "<path id='p' d='M0 0h9v9z'/><use id='u' class='k' data-n='2' href='#p' x='50'><title>two</title></use>";
    let w = warp(&drawing(body), oblique());
    assert!(w.svg.contains("<g id='u' class='k' data-n='2' transform="), "{}", w.svg);
    assert!(w.svg.contains("<title>two</title><path"), "{}", w.svg);
    let again = read(&w.svg);
    assert_eq!(again.paths().len(), 2);
}

#[test]
fn similarity_scales_strokes_and_anything_else_outlines_them() {
    let svg = drawing("<path d='M10 10L60 30L20 70' fill='none' style='stroke:red; stroke-width:2'/>");
    let w = warp(&svg, Affine::rotate(0.3) * Affine::scale(2.0));
    assert!(
        w.svg.contains("style='fill:none;stroke:red;stroke-width:4'") || w.svg.contains("stroke-width:4"),
        "{}",
        w.svg
    );
    let w = warp(&svg, oblique());
    assert!(w.svg.contains("<g ") && w.svg.contains("fill=\"red\""), "{}", w.svg);
}

#[test]
fn guides_stay_and_are_no_artwork() {
    let svg = drawing("<rect width='10' height='10'/><g id='cage'><path id='q' d='M0 0h90v90h-90z'/></g>");
    let d = read(&svg);
    let selection = Selection { guides: vec!["cage".into()], ..Selection::default() };
    assert_eq!(d.artwork_box(&selection).unwrap().width(), 10.0);
    let w = d.warp(&Bend, &warp_options().with_selection(selection)).unwrap();
    assert!(w.svg.contains("<g id='cage'><path id='q' d='M0 0h90v90h-90z'/></g>"));
}

#[test]
fn what_cannot_be_patched_is_flattened_or_refused() {
    let svg = "<!DOCTYPE svg [<!ENTITY r \"<rect id='x' width='30' height='20'/>\">]><svg xmlns='http://www.w3.org/2000/svg' \
               viewBox='0 0 100 100'><title>E</title>&r;</svg>";
    let w = warp(svg, oblique());
    assert!(w.warnings.iter().any(|w| w.to_string().contains("flattened")), "{:?}", w.warnings);
    assert!(w.svg.contains("viewBox=\"0 0 100 100\"") && w.svg.contains("<title>E</title>"), "{}", w.svg);
    let keep = warp_options().with_structure(Structure::Keep);
    assert!(read(svg).warp(&Bend, &keep).is_err());
}

#[test]
fn precision_follows_the_tolerance_and_the_transform() {
    let svg = drawing("<g transform='scale(1000)'><path d='M0 0L.1 0L.1 .1z'/></g><path d='M0 0L90 0L90 90z'/>");
    let w = read(&svg).warp(&Hidden(oblique()), &warp_options()).unwrap();
    assert!(w.shapes.iter().all(|s| s.path.max_error < 1.01e-4), "{:?}", w.shapes);
    let coarse = warp_options().with_precision(Some(1));
    let w = read(&svg).warp(&Hidden(oblique()), &coarse).unwrap();
    assert!(w.shapes[0].path.max_error > 1.0, "{:?}", w.shapes);
}

#[test]
fn large_coordinates_keep_their_detail() {
    let svg = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 2000000 2000000'><g transform='translate(1000000.001 0)'>\
               <path d='M100000.001 5L100000.002 5L100000.002 6z'/></g></svg>";
    let d = read(svg);
    let o = &d.shapes()[0].outline;
    assert_eq!(o.subpaths[0].start.x, 1_100_000.002);
    assert!((o.bounding_box().unwrap().width() - 0.001).abs() < 1e-9);
}

#[test]
fn an_animation_of_the_geometry_is_named() {
    let body = "<circle id='c' r='9'><animate attributeName='r' to='20'/></circle><circle r='5'><animate \
                attributeName='opacity' to='0'/></circle>";
    let w = warp(&drawing(body), oblique());
    assert!(
        w.warnings.iter().any(|w| w.to_string().contains("animations") && w.to_string().ends_with(": c")),
        "{:?}",
        w.warnings
    );
}

#[test]
fn flattened_filters_saturate_beyond_one() {
    let svg = drawing("<rect width='90' height='90' fill='seagreen' filter='saturate(2)'/>");
    let flat = warp_options().with_structure(Structure::Flatten);
    let out = read(&svg).warp(&AffineMap(Affine::IDENTITY), &flat).unwrap().svg;
    let middle = |svg: &str| {
        let tree =
            pathwarp_svg::usvg_tree::parse_tree(svg.as_bytes(), "test", &pathwarp_oracle::drawings::options()).unwrap();
        let mut p = resvg::tiny_skia::Pixmap::new(100, 100).unwrap();
        resvg::render(&tree, resvg::tiny_skia::Transform::identity(), &mut p.as_mut());
        let c = p.pixel(45, 45).unwrap();
        [c.red(), c.green(), c.blue()]
    };
    let (expected, found) = (middle(&svg), middle(&out));
    assert_ne!(expected, [46, 139, 87], "the filter does nothing");
    assert!(expected.iter().zip(found).all(|(a, b)| a.abs_diff(b) <= 1), "{expected:?} {found:?}");
}

#[test]
fn the_caps_of_dots_follow_the_map() {
    for cap in ["square", "round"] {
        let d = "M50 50h0M20 20l0 0l0 0M80 30l0 0";
        let svg =
            drawing(&format!("<path d='{d}' fill='none' stroke='red' stroke-width='16' stroke-linecap='{cap}'/>"));
        let _ = pathwarp_oracle::drawings::check(cap, &svg, oblique(), &warp_options());
    }
}

#[test]
fn names_inside_clip_paths_and_masks_stay() {
    let body = "<mask id='m' maskContentUnits='objectBoundingBox'><g id='g'><rect id='r' width='.5' height='1' \
                fill='white'/></g><circle id='c' cx='.7' cy='.5' r='.2' fill='white' stroke='gray' stroke-width='.1' \
                opacity='.5'/></mask><clipPath id='k' clipPathUnits='objectBoundingBox'><path id='p' d='M0 0h1L.5 \
                1z'/></clipPath><rect width='80' height='60' mask='url(#m)'/><rect y='50' width='80' height='40' fill='red' \
                mask='url(#m)' clip-path='url(#k)'/>";
    let w = pathwarp_oracle::drawings::check("names", &drawing(body), oblique(), &warp_options());
    for id in ["m", "r", "c", "k", "p"] {
        let found = w.svg.matches(&format!(" id='{id}'")).count() + w.svg.matches(&format!(" id=\"{id}\"")).count();
        assert_eq!(found, 1, "{id}: {}", w.svg);
    }
}
