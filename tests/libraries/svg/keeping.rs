//! Parts of a file other than geometry: strokes that never scale, animations, links, `switch`, compressed files and embedded fonts.

use base64::Engine as _;
use pathwarp_oracle::drawings::{Bend, drawing, oblique, options, read, warp, warp_options};
use pathwarp_svg::engine::{BentImage, ImageRequest, ImageWarper, PictureError, compressed};
use pathwarp_svg::{Document, Images, OnError, Structure, WarpedDocument};
use std::sync::Arc;

fn flat(body: &str) -> WarpedDocument {
    read(&drawing(body)).warp(&Bend, &warp_options().with_structure(Structure::Flatten)).unwrap()
}

fn bent(body: &str) -> WarpedDocument {
    read(&drawing(body)).warp(&Bend, &warp_options()).unwrap()
}

/// A stroke that does not scale keeps its width, however that is specified; all other strokes scale.
#[test]
fn strokes_that_do_not_scale() {
    let line =
        |more: &str| format!("<path d='M10 20C30 0 60 50 90 20' fill='none' stroke='red' stroke-width='3' {more}/>");
    let css = "<style>.thin,rect{vector-effect:non-scaling-stroke} .not{vector-effect:none!important}</style>";
    for (fixed, body) in [
        (true, line("vector-effect='non-scaling-stroke'")),
        (true, line("style='vector-effect: non-scaling-stroke'")),
        (true, format!("{css}{}", line("class='thin'"))),
        (true, format!("{css}<rect x='5' y='5' width='50' height='40' stroke='red' stroke-width='3'/>")),
        (true, format!("{css}<defs>{}</defs><use href='#p'/>", line("id='p' class='thin'"))),
        (false, line("")),
        (false, format!("{css}{}", line(""))),
        (false, format!("{css}{}", line("class='thin not'"))),
        (false, line("style='vector-effect:none' vector-effect='non-scaling-stroke'")),
    ] {
        for w in [warp(&drawing(&body), oblique()), flat(&body)] {
            let drawn = w.svg.split("</style>").last().unwrap();
            let stays = drawn.contains("stroke-width='3'")
                || drawn.contains("stroke-width=\"3\"")
                || drawn.contains("stroke-width:3");
            // An outlined stroke is a fill, and a scaled one has another width.
            let outlined = ["fill=\"#ff0000\"", "fill=\"red\"", "fill:red"].iter().any(|fill| drawn.contains(fill));
            assert_eq!((stays && !outlined, outlined), (fixed, !fixed), "{body}\n{}", w.svg);
            let says = w.svg.contains("non-scaling-stroke");
            assert!(says || !fixed, "{body}\n{}", w.svg);
        }
    }
}

#[test]
fn animations_stay_where_they_still_fit() {
    let body = "<circle id='c' cx='20' cy='20' r='9'><animate id='a1' attributeName='r' to='20'/><animate id='a2' \
                attributeName='opacity' to='0'/><set id='a3' attributeName='fill' to='red'/></circle><g id='g'><path id='p' \
                d='M50 50h20v20z' stroke='blue'/><animateTransform id='a4' attributeName='transform' type='rotate' \
                to='90'/></g><animate id='a5' href='#p' attributeName='d' to='M0 0h9v9z'/><set id='a6' href='#p' \
                attributeName='stroke' to='red'/><text id='t' x='10' y='90'>Hi<animate id='a7' attributeName='x' \
                to='9'/><animate id='a8' attributeName='opacity' to='.5'/></text><use id='u' href='#c' x='50'><animate \
                id='a9' attributeName='visibility' to='hidden'/><animate id='a10' attributeName='x' to='0'/></use>";
    let w = bent(body);
    for (n, kept) in [false, true, true, false, false, false, false, true, true, false].into_iter().enumerate() {
        assert_eq!(w.svg.contains(&format!("id='a{}'", n + 1)), kept, "a{}: {}", n + 1, w.svg);
    }
    let said = |what: &str, whom: &str| {
        w.warnings.iter().any(|w| w.to_string().contains(what) && w.to_string().contains(whom))
    };
    assert!(said("geometry are dropped", "c, p"), "{:?}", w.warnings);
    assert!(said("move warped shapes", "g") && said("fill and stroke are dropped", "p"), "{:?}", w.warnings);
    assert!(Document::read(w.svg.as_bytes(), "again", &options()).is_ok());
    // Nothing is warped, so nothing is dropped.
    let still = pathwarp_svg::Selection { select: vec!["#none".into()], ..pathwarp_svg::Selection::default() };
    let w = read(&drawing(body)).warp(&Bend, &warp_options().with_selection(still)).unwrap();
    assert!(!w.warnings.iter().any(|w| w.to_string().contains("animations")), "{:?}", w.warnings);
    assert_eq!(w.svg, drawing(body));
    let w = flat(body);
    assert!(
        !w.svg.contains("<animate") && w.warnings.iter().any(|w| w.to_string().contains("animations")),
        "{:?}",
        w.warnings
    );
}

#[test]
fn links_go_on_linking() {
    let body = "<a id='l' xlink:href='http://example.org/?a=1&amp;b=2' target='_top'><title>There</title><rect x='20' y='20' \
                width='50' height='50'/></a><use href='#l' y='5'/>";
    let w = bent(body);
    let link = "<a id='l' xlink:href='http://example.org/?a=1&amp;b=2' target='_top'><title>There</title><path";
    assert!(w.svg.contains(link), "{}", w.svg);
    let w = flat(body);
    assert!(w.svg.contains("<a id=\"l\" xlink:href=\"http://example.org/?a=1&amp;b=2\"><path"), "{}", w.svg);
}

#[test]
fn choices_symbols_and_viewports_stay() {
    let body = "<symbol id='s' viewBox='0 0 10 10'><circle cx='5' cy='5' r='4'/></symbol><use id='u' href='#s' width='30' \
                height='30'/><switch id='w'><g systemLanguage='xx'><rect id='no' width='50' height='50'/></g><rect id='yes' \
                x='50' y='50' width='20' height='20'/></switch><svg id='v' x='10' y='60' width='30' height='30' viewBox='0 0 9 \
                9'><path id='p' d='M1 1h7v7z'/></svg>";
    let w = bent(body);
    for kept in [
        "<symbol id='s' viewBox='0 0 10 10'><circle cx='5' cy='5' r='4'/></symbol>",
        "<g id='u'",
        "<switch id='w'>",
        "<rect id='no' width='50' height='50'/>",
        "<path id='yes'",
        "<svg id='v' x='10' y='60'",
        "<path id='p' d='M",
    ] {
        assert!(w.svg.contains(kept), "{kept}: {}", w.svg);
    }
    assert!(w.warnings.is_empty(), "{:?}", w.warnings);
}

#[test]
fn what_is_no_geometry_keeps_its_bytes() {
    let rest = "<!-- mine --><metadata  id='m'><x xmlns='urn:x' y = '1'/></metadata><script>if (1 &lt; 2) f()</script>\
                <foreignObject x='5' width='9' height='9'><p xmlns='http://www.w3.org/1999/xhtml'>p</p></foreignObject><desc \
                >d</desc><style><![CDATA[@keyframes k{from{opacity:0}} .q:hover{fill:red}]]></style>";
    let w = bent(&format!("{rest}<path class='q' d='M10 10h50v50z'/>"));
    assert!(w.svg.contains(rest) && !w.svg.contains("M10 10h50"), "{}", w.svg);
}

struct Unasked;

impl ImageWarper for Unasked {
    fn warp(&self, _: &ImageRequest<'_>) -> Result<BentImage, PictureError> {
        Err("asked".into())
    }
}

#[test]
fn images_that_are_not_bent_follow_the_fit() {
    for aspect in ["xMidYMid slice", "none"] {
        let body = format!(
            "<image id='i' x='10' y='20' width='60' height='30' preserveAspectRatio='{aspect}' href='data:image/png;base64,\
             iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=='/>"
        );
        let options = warp_options().with_images(Images::Warp(Arc::new(Unasked)));
        let w = read(&drawing(&body)).warp(&Bend, &options).unwrap();
        let [s] = w.skipped.as_slice() else { panic!("{:?}", w.skipped) };
        assert!(s.id == "i" && s.why.contains("asked") && s.why.contains("affine fit"), "{s:?}");
        assert!(w.svg.contains("<image id='i'") && w.svg.contains("transform=\"matrix("), "{}", w.svg);
    }
}

#[test]
fn compressed_files_come_back() {
    let svg = drawing("<path id='p' d='M0 0h9v9z'/>");
    let packed = compressed(&svg).unwrap();
    assert!(packed.starts_with(&[0x1f, 0x8b]) && packed == compressed(&svg).unwrap());
    let d = Document::read(&packed, "f.svgz", &options()).unwrap();
    assert_eq!(d.shapes()[0].id, "p");
    assert_eq!(d.warp(&pathwarp::map::AffineMap(pathwarp::kurbo::Affine::IDENTITY), &warp_options()).unwrap().svg, svg);
}

const FONT: &[u8] = include_bytes!("../../../crates/pathwarp-svg/fonts/NotoSans-Regular.subset.ttf");

/// Returns the bundled font with another number of units per em, for letters of another size.
fn resized(units: u16) -> Vec<u8> {
    let mut font = FONT.to_vec();
    let count = usize::from(u16::from_be_bytes([font[4], font[5]]));
    let head = (0..count).map(|i| 12 + 16 * i).find(|&at| &font[at..at + 4] == b"head").unwrap();
    let at = u32::from_be_bytes(font[head + 8..head + 12].try_into().unwrap()) as usize + 18;
    font[at..at + 2].copy_from_slice(&units.to_be_bytes());
    font
}

/// Packs a font file as WOFF 1.0, by the specification.
fn woff(font: &[u8]) -> Vec<u8> {
    use std::io::Write as _;
    let count = usize::from(u16::from_be_bytes([font[4], font[5]]));
    let long = |at: usize| u32::from_be_bytes(font[at..at + 4].try_into().unwrap());
    let (mut entries, mut tables) = (Vec::new(), Vec::new());
    for at in (0..count).map(|i| 12 + 16 * i) {
        let data = &font[long(at + 8) as usize..][..long(at + 12) as usize];
        let mut z = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::best());
        z.write_all(data).unwrap();
        let packed = Some(z.finish().unwrap()).filter(|p| p.len() < data.len()).unwrap_or_else(|| data.to_vec());
        entries.extend(&font[at..at + 4]);
        let offset = (44 + 20 * count + tables.len()) as u32;
        for v in [offset, packed.len() as u32, data.len() as u32, long(at + 4)] {
            entries.extend(v.to_be_bytes());
        }
        tables.extend(packed);
        tables.resize(tables.len().next_multiple_of(4), 0);
    }
    let mut out = b"wOFF".to_vec();
    out.extend(&font[..4]);
    out.extend(((44 + entries.len() + tables.len()) as u32).to_be_bytes());
    out.extend((count as u16).to_be_bytes());
    out.extend([0; 2]);
    out.extend((font.len() as u32).to_be_bytes());
    out.extend([0; 24]);
    [out, entries, tables].concat()
}

#[test]
fn embedded_fonts_set_the_text() {
    let units = u16::from_be_bytes(
        FONT[FONT.windows(4).position(|w| w == [0x5f, 0x0f, 0x3c, 0xf5]).unwrap() + 6..][..2].try_into().unwrap(),
    );
    let text =
        |css: &str| format!("{css}<text id='t' x='0' y='50' font-size='20' font-family='My Face'>Hamburg</text>");
    let width = |body: &str| {
        let d = read(&drawing(body));
        let b = d.artwork_box(&pathwarp_svg::Selection::default()).unwrap();
        (b.width(), d.warp(&Bend, &warp_options()).unwrap().warnings)
    };
    let (plain, warnings) = width(&text(""));
    assert!(warnings.iter().any(|w| w.to_string().contains("My Face")), "{warnings:?}");
    for (kind, data) in [("ttf", resized(units * 2)), ("woff", woff(&resized(units * 2)))] {
        let data = base64::engine::general_purpose::STANDARD.encode(data);
        let css = format!(
            "<style>@font-face {{ font-family: 'My Face'; font-weight: 400; src: url(data:font/{kind};base64,{data}) \
             format('{kind}') }}</style>"
        );
        let (half, warnings) = width(&text(&css));
        assert!((half / plain - 0.5).abs() < 1e-3, "{kind}: {half} of {plain}");
        assert!(warnings.is_empty(), "{warnings:?}");
    }
    // Nothing in a font may crash the program.
    for k in 0..60 {
        let mut data = FONT.to_vec();
        for (i, at) in (0..data.len()).step_by(7 + k * 3).enumerate().skip(k) {
            data[at] = data[at].wrapping_mul(31).wrapping_add(i as u8);
        }
        let data = base64::engine::general_purpose::STANDARD.encode(if k % 2 == 0 {
            data
        } else {
            woff(FONT).into_iter().take(900 * k).collect()
        });
        let svg = drawing(&text(&format!(
            "<style>@font-face{{font-family:'My Face';src:url(data:x;base64,{data})}}</style>"
        )));
        if let Ok(d) = Document::read(svg.as_bytes(), "f.svg", &options()) {
            assert!(d.warp(&Bend, &warp_options().with_on_error(OnError::Skip)).is_ok());
        }
    }
    // A damaged font counts as missing.
    for bad in ["d09GRgABAAAA", "AAEAAAAA", "%%%%", "d09GMgABAAAA"] {
        let css = format!("<style>@font-face{{font-family:'My Face';src:url('data:font/x;base64,{bad}')}}</style>");
        let (same, warnings) = width(&text(&css));
        assert!(
            same == plain && warnings.iter().any(|w| w.to_string().contains("My Face")),
            "{bad}: {same} {warnings:?}"
        );
    }
}
