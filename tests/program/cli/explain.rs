//! `--explain` names the frame: its box, its size on the page, and the reason for it.

use super::common::text;
use crate::support::pathwarp_in;

const DRAWING: &str = "<svg xmlns='http://www.w3.org/2000/svg' width='100mm' viewBox='0 0 100 50'>\
                       <rect x='20' y='10' width='40' height='30'/><rect x='500' width='9' height='9'/></svg>";

#[test]
fn the_frame_is_named() {
    let dir = tempfile::tempdir().unwrap();
    let said = |args: &[&str], stdin: &[u8]| {
        let out = pathwarp_in(dir.path(), &[args, &["--explain"]].concat(), stdin);
        text(&out.stderr)
    };
    let word = pathwarp_in(dir.path(), &["text", "Word"], b"").stdout;
    let empty = DRAWING.replace("rect", "metadata");
    for (args, stdin, part) in [
        (
            &["warp"][..],
            DRAWING.as_bytes(),
            "frame: 40.0000 × 30.0000 user units at 20.0000,10.0000 (40.00 × 30.00 mm): the visible artwork",
        ),
        (&["warp", "--frame", "viewbox"], DRAWING.as_bytes(), "(100.00 × 50.00 mm): the page (--frame viewbox)"),
        (
            &["warp", "--frame", "10mm,0,20,1cm"],
            DRAWING.as_bytes(),
            "frame: 20.0000 × 10.0000 user units at 10.0000,0.0000 (20.00 × 10.00 mm): given by --frame",
        ),
        (&["warp"], empty.as_bytes(), "(100.00 × 50.00 mm): the page, as no artwork is visible"),
        (&["bend", "--along", "circle:r=90mm"], &word, "the artwork is lettering (--frame baseline-ascent)"),
        (&["warp", "--frame", "ink"], &word, "the lettering (--frame)"),
    ] {
        let said = said(args, stdin);
        assert!(said.contains(part), "{args:?}: {said}");
    }
}
