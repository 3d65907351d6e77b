//! Other formats: pictures and filters in a PDF, polylines in a DXF.

use super::bounded::{Folder, RECT, svg};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

/// A drawing of 4000 × 4000 px.
fn large(body: &str) -> Folder {
    let text = String::from_utf8(svg(body)).unwrap();
    let text = text.replace("width='100' height='100'>", "width='4000' height='4000'>");
    Folder::with(&[("a.svg", text.as_bytes())])
}

#[test]
fn filters_become_pictures_within_bounds() {
    let kernel = "1 ".repeat(10_000);
    let table = "0 1 ".repeat(50_000);
    for filter in [
        "<feTurbulence numOctaves='20' baseFrequency='.1'/>",
        "<feMorphology operator='dilate' radius='40'/>",
        "<feGaussianBlur stdDeviation='1000'/><feGaussianBlur stdDeviation='1000'/>",
        &"<feDropShadow stdDeviation='50'/>".repeat(20),
        &"<feDiffuseLighting><feDistantLight azimuth='9'/></feDiffuseLighting>".repeat(100),
        &"<feSpecularLighting><fePointLight z='5'/></feSpecularLighting>".repeat(20),
        &format!("<feConvolveMatrix order='100' kernelMatrix='{kernel}'/>"),
        &"<feDisplacementMap scale='1000' in2='SourceGraphic'/>".repeat(20),
        &"<feImage href='#r'/>".repeat(50),
        &"<feFlood/>".repeat(200),
        &format!("<feMerge>{}</feMerge>", "<feMergeNode/>".repeat(5000)),
        &format!("<feComponentTransfer><feFuncR type='table' tableValues='{table}'/></feComponentTransfer>"),
    ] {
        let name = &filter[..filter.len().min(40)];
        let area = "x='-9' y='-9' width='20' height='20'";
        let folder = large(&format!("<filter id='f' {area}>{filter}</filter><g id='r' filter='url(#f)'>{RECT}</g>"));
        for args in [["convert", "a.svg", "-o", "o.pdf"], ["swirl", "a.svg", "-o", "s.pdf"]] {
            let (code, said) = folder.run(&args);
            let told = said.contains("fewer pixels") || said.contains("--limit");
            assert!([0, 1, 3].contains(&code) && (code != 3 || told), "{name}: {code} {said}");
        }
        let previewed = folder.run(&["swirl", "a.svg", "-o", "o.svg", "--preview", "p.png"]);
        assert!([0, 1, 3].contains(&previewed.0), "{name}: {previewed:?}");
        let compared = folder.run(&["compare", "a.svg", "a.svg"]);
        assert!([0, 3].contains(&compared.0), "{name}: {compared:?}");
    }
    // A small filter is drawn at the wanted resolution, without a message.
    let small = Folder::with(&[(
        "a.svg",
        &svg(&format!("<filter id='f'><feOffset dx='3'/></filter><g filter='url(#f)'>{RECT}</g>")),
    )]);
    let (code, said) = small.run(&["convert", "a.svg", "-o", "o.pdf"]);
    assert_eq!((code, said.contains("fewer")), (0, false), "{said}");
}

#[test]
fn a_repeated_picture_is_stored_once() {
    let mut picture = resvg::tiny_skia::Pixmap::new(900, 900).unwrap();
    for (i, p) in picture.data_mut().iter_mut().enumerate() {
        *p = if i % 4 == 3 { 255 } else { (i * i % 251) as u8 };
    }
    let png = STANDARD.encode(picture.encode_png().unwrap());
    let size = |uses: usize| {
        let image = format!("<defs><image id='i' width='9' height='9' href='data:image/png;base64,{png}'/></defs>");
        let folder = Folder::with(&[("a.svg", &svg(&format!("{image}{}", "<use href='#i'/>".repeat(uses))))]);
        assert_eq!(folder.run(&["convert", "a.svg", "-o", "o.pdf"]).0, 0);
        std::fs::metadata(folder.path().join("o.pdf")).unwrap().len()
    };
    assert!(size(300) < size(1) + 50_000);
}

#[test]
fn polylines_are_counted() {
    let path = format!("<path d='M0 0{}'/>", "c9 90 9-90 1 1".repeat(20_000));
    let folder = Folder::with(&[("a.svg", &svg(&path))]).ample();
    let fine = ["convert", "a.svg", "--dxf-curves", "polyline", "--tolerance", "1e-7", "-o", "o.dxf"];
    let (code, said) = folder.run(&fine);
    assert_eq!((code, said.contains("--limit work=")), (3, true), "{said}");
    assert!(!folder.path().join("o.dxf").exists());
    assert_eq!(folder.run(&["convert", "a.svg", "--dxf-curves", "polyline", "-o", "o.dxf"]).0, 0);
}
