//! Numbers beyond the range in which programs compute.

use super::bounded::{Folder, RECT, expect, svg};

#[test]
fn shapes_out_of_range_stay_and_are_reported() {
    for body in [
        "<path d='M0 0 L1e308 1e308 L50 10 Z'/>",
        "<path d='M19.598 3.4e38h.143c.06 0 .1.01.12.03a.107.107 0 0 1 .034.083z'/>",
        "<path d='M5 5A1 2 0 0 1 3.4e38 7z'/>",
        "<path d='M0 0L50 10' stroke='red' stroke-width='1e20' stroke-dasharray='1e20 1e20'/>",
        "<path d='M0 0L50 10' style='stroke:red;stroke-width:1e20'/>",
        "<style>path{stroke:red;stroke-width:1e12}</style><path d='M0 0L50 10'/>",
        "<text y='20' font-size='1e30'>Abc</text>",
        "<rect width='12345678901' height='5'/>",
        "<g transform='scale(1e8)'><rect width='50' height='30'/></g>",
        "<circle r='9' transform='matrix(1e30 0 0 1 0 0)'/>",
        "<polygon points='0,0 1e12,0 5,5'/>",
    ] {
        let folder = Folder::with(&[("a.svg", &svg(&format!("{body}{RECT}")))]);
        let all = folder.run_all("a.svg");
        let (code, said) = &all[0];
        assert_eq!(*code, 1, "{body}: {said}");
        assert!(said.contains("is out of range") || said.contains("beyond the range"), "{body}: {said}");
        // Elements out of range keep their text. The rest is warped.
        let out = std::fs::read_to_string(folder.path().join("out.svg")).unwrap();
        assert!(out.contains(&body[body.len() - 20..]), "{body}: {out}");
        assert!(!out.contains(RECT), "{body}: {out}");
    }
}

/// Below the bound, the renderer accepts every size.
#[test]
fn the_renderer_stands_what_it_is_given() {
    for size in ["1e4", "1e5", "1e6", "1e7", "4e7"] {
        for (body, strokes) in [
            (format!("<path d='M0 0L{size} {size}L-{size} 50Z'/>"), ""),
            (format!("<circle r='{size}'/><ellipse cx='{size}' rx='{size}' ry='.001'/>"), ""),
            (
                format!("<path d='M0 0L50 10L20 30C{size} 0 0 {size} 9 9' fill='none'/>"),
                "stroke='red' stroke-width='3'",
            ),
            (
                "<path d='M0 0L50 10L20 30' fill='none'/>".into(),
                &*format!("stroke='red' stroke-width='{size}' stroke-dasharray='{size}'"),
            ),
            (
                "<path d='M0 0L50 .001L0 0'/>".into(),
                "stroke='red' stroke-linejoin='round' stroke-width='30' stroke-miterlimit='1e6'",
            ),
        ] {
            let all = Folder::with(&[("a.svg", &svg(&format!("<g {strokes}>{body}</g>")))]).run_all("a.svg");
            assert!([0, 3].contains(&all[3].0), "{size} {body}: {}", all[3].1);
        }
    }
    expect("<path d='M0 0L1e8 9L5 5Z'/><path d='M0 0L9e8 9L5 5Z'/>", [0, 3], "");
}

/// These numbers are longer than any width in a format string.
#[test]
fn numbers_may_have_any_number_of_digits() {
    let digits = "1".repeat(70_000);
    let folder = Folder::with(&[("a.svg", &svg(&format!("<path d='M0 0L{digits} 0.{digits}L9 9'/>{RECT}")))]);
    let all = folder.run_all("a.svg");
    assert_eq!((all[0].0, all[0].1.contains("is out of range")), (1, true), "{}", all[0].1);
}

#[test]
fn filters_move_pictures_within_range() {
    for moved in ["<feOffset dx='1e30'/>", "<feDropShadow dy='-4e7' stdDeviation='1'/>"] {
        let body = format!("<filter id='f'>{moved}</filter><g filter='url(#f)'>{RECT}</g>");
        let folder = Folder::with(&[("a.svg", &svg(&body))]);
        folder.run_all("a.svg");
        for args in [
            &["render", "a.svg", "-o", "o.png", "--width", "1000"][..],
            &["convert", "a.svg", "-o", "o.pdf"],
            &["compare", "a.svg", "a.svg"],
            &["swirl", "a.svg", "-o", "o.svg", "--preview", "o.png"],
        ] {
            let (code, said) = folder.run(args);
            assert!(code == 3 && said.contains("pixels from the picture"), "{args:?}: {code} {said}");
        }
    }
}

#[test]
fn far_out_a_closed_skeleton_ends() {
    let page = String::from_utf8(svg(RECT)).unwrap().replace("0 0 100 100", "0 0 1e30 1e30");
    let folder = Folder::with(&[("a.svg", page.as_bytes())]);
    folder.run(&["bend", "a.svg", "--along", "circle:r=30", "--stretch", "repeat", "-o", "o.svg"]);
}
