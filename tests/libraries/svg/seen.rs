//! Only visible artwork counts, for the frame and for the page.

use pathwarp::kurbo::{Affine, Rect};
use pathwarp_oracle::drawings::{Hidden, drawing, read, warp_options};
use pathwarp_svg::{PageFit, Selection};

const BIG: &str = "<rect id='r' x='-200' y='-300' width='900' height='800'";

/// Returns drawings of the square from 0 to 100, of which the square from 20 to 60 is visible.
fn drawings() -> Vec<(&'static str, String)> {
    let clip = "<clipPath id='c'><circle cx='40' cy='40' r='20'/></clipPath>";
    let see = "<rect x='20' y='20' width='40' height='40'/>";
    vec![
        ("all", see.to_owned()),
        ("clip path", format!("{clip}{BIG} clip-path='url(#c)'/>")),
        ("clip path of a group", format!("{clip}<g clip-path='url(#c)'><g transform='scale(2)'>{BIG}/></g></g>")),
        (
            "clipped clip path",
            format!(
                "<clipPath id='d'><rect width='60' height='900'/></clipPath><clipPath id='c' clip-path='url(#d)'><rect x='20' \
                     y='20' width='900' height='40'/></clipPath>{BIG} clip-path='url(#c)'/>"
            ),
        ),
        (
            "mask",
            format!(
                "<mask id='m' maskUnits='userSpaceOnUse' x='0' y='0' width='60' height='99'><rect x='20' y='20' width='90' \
                     height='40' fill='white'/></mask>{BIG} mask='url(#m)'/>"
            ),
        ),
        ("nested viewport", format!("<svg x='20' y='20' width='40' height='40'>{BIG}/></svg>")),
        ("group without opacity", format!("{see}<g opacity='0'>{BIG}/></g>")),
        ("fill without opacity", format!("{see}{BIG} fill-opacity='0'/>")),
        ("hidden", format!("{see}{BIG} visibility='hidden'/>")),
        ("off the page", format!("{see}<rect x='200' y='300' width='50' height='10'/>")),
    ]
}

#[test]
fn the_frame_is_what_is_seen() {
    for (name, body) in drawings() {
        let b = read(&drawing(&body)).seen_box(&Selection::default()).unwrap();
        let wanted = Rect::new(20.0, 20.0, 60.0, 60.0);
        let off = [b.x0 - wanted.x0, b.y0 - wanted.y0, b.x1 - wanted.x1, b.y1 - wanted.y1];
        assert!(off.iter().all(|d| d.abs() < 1e-3), "{name}: {b:?}");
    }
    // Artwork partly off the page, and wholly off it.
    let b = |body: &str| read(&drawing(body)).seen_box(&Selection::default()).unwrap();
    assert_eq!(b(&format!("{BIG}/>")), Rect::new(0.0, 0.0, 100.0, 100.0));
    assert_eq!(b("<rect x='200' y='300' width='50' height='10'/>"), Rect::new(200.0, 300.0, 250.0, 310.0));
    // A file without a page shows everything.
    let all = format!("<svg xmlns='http://www.w3.org/2000/svg'>{BIG}/></svg>");
    assert_eq!(read(&all).seen_box(&Selection::default()).unwrap(), Rect::new(-200.0, -300.0, 700.0, 500.0));
}

/// A picture of 2 × 1 pixels counts where it is drawn: in the middle of its box, and as wide as that.
#[test]
fn pictures_count() {
    let picture = |attributes: &str| {
        let data = "data:image/gif;base64,R0lGODdhAgABAIAAAP8AAAAA/ywAAAAAAgABAAACAkQKADs=";
        format!("<image {attributes} width='40' height='40' href='{data}'/>")
    };
    let b = |body: &str| read(&drawing(body)).seen_box(&Selection::default()).unwrap();
    assert_eq!(b(&picture("x='20' y='20'")), Rect::new(20.0, 30.0, 60.0, 50.0));
    let caption = "<rect x='30' y='70' width='20' height='5'/>";
    assert_eq!(b(&(picture("x='20' y='20'") + caption)), Rect::new(20.0, 30.0, 60.0, 75.0));
    // Hidden pictures do not count, nor do those that cannot be read.
    assert_eq!(b(&(picture("visibility='hidden'") + caption)), Rect::new(30.0, 70.0, 50.0, 75.0));
    assert_eq!(
        b(&format!("<image width='40' height='40' href='none.png'/>{caption}")),
        Rect::new(30.0, 70.0, 50.0, 75.0)
    );
}

/// Shapes that the page cuts count whole, and no others; clip paths and masks still hide.
#[test]
fn the_uncut_box_holds_what_the_page_cuts_off() {
    let uncut = |body: &str| {
        let (doc, all) = (read(&drawing(body)), Selection::default());
        doc.uncut_box(&all, doc.seen_box(&all).unwrap())
    };
    for (name, body) in drawings() {
        assert_eq!(uncut(&body), None, "{name}");
        // A shape at the edge of the page has everything examined.
        let b = uncut(&format!("{body}<path d='M90 50H110V51Z'/>")).unwrap();
        let off = [b.x0 - 20.0, b.y0 - 20.0, b.x1 - 110.0, b.y1 - 60.0];
        assert!(off.iter().all(|d| d.abs() < 1e-3), "{name}: {b:?}");
    }
    assert_eq!(uncut(&format!("{BIG}/>")), Some(Rect::new(-200.0, -300.0, 700.0, 500.0)));
    assert_eq!(uncut("<rect x='0' y='0' width='100' height='100'/>"), None);
    // The part that a clip path leaves lies off the page, although the shape does not.
    let off = "<clipPath id='c'><path d='M300 0H400V9H300Z'/></clipPath>";
    assert_eq!(uncut(&format!("<rect width='100' height='50'/>{off}{BIG} clip-path='url(#c)'/>")), None);
}

/// The page follows the artwork that was visible: moved by 70, the square reaches from 90 to 130.
#[test]
fn the_page_holds_what_is_seen() {
    let map = Hidden(Affine::translate((70.0, 0.0)));
    for (name, body) in drawings() {
        let document = read(&drawing(&body));
        let warp = |page| document.warp(&map, &warp_options().with_page(page)).unwrap();
        let over = warp(PageFit::None).overhang.unwrap_or_else(|| panic!("{name}"));
        assert!((over.by[2] - 30.0).abs() < 0.1 && over.by[0] == 0.0 && over.by[3] == 0.0, "{name}: {over:?}");
        let view = warp(PageFit::Grow).svg.split("viewBox=\"").nth(1).unwrap().split('"').next().unwrap().to_owned();
        let view: Vec<f64> = view.split(' ').map(|v| v.parse().unwrap()).collect();
        let off = view.iter().zip([0.0, 0.0, 130.0, 100.0]).map(|(v, w)| (v - w).abs()).fold(0.0, f64::max);
        assert!(off < 0.1, "{name}: {view:?}");
    }
}

/// Artwork beside the page that the warp moves onto it is reported, unless it stays hidden.
#[test]
fn what_comes_onto_the_page_is_reported() {
    let came = |body: &str| {
        let all =
            read(&drawing(body)).warp(&Hidden(Affine::translate((0.0, -40.0))), &warp_options()).unwrap().warnings;
        all.iter().map(ToString::to_string).filter(|w| w.contains("lay off the page")).collect::<Vec<_>>()
    };
    let note = "<rect id='n' x='20' y='110' width='50' height='10'/>";
    assert_eq!(came(note), ["1 shape that lay off the page has moved onto it: n"]);
    let text =
        "<text id='t' x='20' y='125' font-size='12'>note</text><rect id='far' x='20' y='190' width='9' height='9'/>";
    assert_eq!(came(text), ["1 shape that lay off the page has moved onto it: t"]);
    // On the page before the warp, still off it, invisible, or clipped away.
    for hidden in [
        "<rect x='20' y='60' width='50' height='60'/>",
        "<rect x='20' y='150' width='50' height='10'/>",
        "<rect x='20' y='110' width='50' height='10' fill='none'/>",
        "<clipPath id='c'><rect y='200' width='99' height='9'/></clipPath><rect x='20' y='110' width='50' height='99' \
         clip-path='url(#c)'/>",
    ] {
        assert!(came(hidden).is_empty(), "{hidden}");
    }
}
