//! Reads files that are built from the description of the format.

use crate::support::psd::{block, file, layer, object, placed, points, slices, smart, tagged, text, warp, written};
use pathwarp_psd::{Error, LayerWarps, warps};

fn sixteen() -> (Vec<f64>, Vec<f64>) {
    let x = (0..16).map(|k| 20.0 + 40.0 * f64::from(k % 4)).collect();
    let y = (0..16).map(|k| 10.0 + 20.0 * f64::from(k / 4) + if k == 5 { 3.0 } else { 0.0 }).collect();
    (x, y)
}

fn all(wide: bool) -> Vec<u8> {
    let (x, y) = sixteen();
    let custom =
        vec![("customEnvelopeWarp", tagged("Objc", object("customEnvelopeWarp", &[("meshPoints", points(&x, &y))])))];
    let across: Vec<f64> = (0..28).map(|k| f64::from(k % 7)).collect();
    let down: Vec<f64> = (0..28).map(|k| f64::from(k / 7)).collect();
    let quilt = vec![
        ("deformNumRows", tagged("long", 4_i32.to_be_bytes().to_vec())),
        ("deformNumCols", tagged("long", 7_i32.to_be_bytes().to_vec())),
        (
            "customEnvelopeWarp",
            tagged(
                "Objc",
                object(
                    "customEnvelopeWarp",
                    &[
                        ("quiltSliceX", slices("quiltSliceX", &[20.0, 50.0, 140.0])),
                        ("meshPoints", points(&across, &down)),
                    ],
                ),
            ),
        ),
    ];
    let plain = warp("warpNone", 0.0, vec![]);
    file(
        wide,
        &[
            layer(
                wide,
                "arc",
                &[
                    block("luni", text("Bögen")),
                    block("SoLd", smart(&[("warp", tagged("Objc", warp("warpArc", 33.5, vec![])))])),
                ],
            ),
            layer(wide, "nothing", &[]),
            layer(wide, "custom", &[block("PlLd", placed(warp("warpCustom", 0.0, custom)))]),
            layer(wide, "words", &[block("TySh", written(warp("warpFlag", -20.0, vec![])))]),
            layer(
                wide,
                "quilt",
                &[block(
                    "SoLd",
                    smart(&[
                        ("warp", tagged("Objc", plain)),
                        ("quiltWarp", tagged("Objc", warp("warpCustom", 0.0, quilt))),
                    ]),
                )],
            ),
        ],
    )
}

fn found(w: &LayerWarps) -> Vec<(&str, &str, f64)> {
    w.warps.iter().map(|w| (w.layer.as_str(), w.style.as_str(), w.value)).collect()
}

#[test]
fn every_kind_of_layer_is_read_from_psd_and_psb() {
    for wide in [false, true] {
        let w = warps(&all(wide)).unwrap();
        assert_eq!(
            found(&w),
            [
                ("Bögen", "warpArc", 33.5),
                ("custom", "warpCustom", 0.0),
                ("words", "warpFlag", -20.0),
                ("quilt", "warpCustom", 0.0)
            ]
        );
        let arc = &w.warps[0];
        assert_eq!((arc.perspective, arc.perspective_other, arc.vertical), (5.0, -7.0, true));
        let net = w.warps[1].mesh.as_ref().unwrap();
        assert_eq!((net.region, net.points.len(), net.points[1][1]), ([20.0, 10.0, 120.0, 60.0], 4, [60.0, 33.0]));
        assert_eq!((&net.x, &net.y), (&None, &None));
        let quilt = w.warps[3].mesh.as_ref().unwrap();
        assert_eq!((quilt.points.len(), quilt.points[0].len(), quilt.points[2][5]), (4, 7, [5.0, 2.0]));
        assert_eq!((quilt.x.as_deref(), quilt.y.as_deref()), (Some(&[0.25][..]), None));
    }
}

#[test]
fn damaged_files_are_errors() {
    assert_eq!(warps(b"GIF89a"), Err(Error::NotPsd));
    assert_eq!(warps(b""), Err(Error::NotPsd));
    let whole = all(false);
    // Truncated anywhere, or with any byte set to 255, a file gives a result or an error, never a panic.
    for n in 0..whole.len() {
        let _ = warps(&whole[..n]);
        let mut bad = whole.clone();
        bad[n] = 255;
        let _ = warps(&bad);
    }
    assert!(matches!(warps(&whole[..200]), Err(Error::Format { at, .. }) if at <= 200));
    // Deeply nested descriptors.
    let mut deep = warp("warpArc", 1.0, vec![]);
    for _ in 0..100 {
        deep = object("a", &[("warp", tagged("Objc", deep))]);
    }
    let deep = file(false, &[layer(false, "deep", &[block("SoLd", smart(&[("warp", tagged("Objc", deep))]))])]);
    assert!(warps(&deep).unwrap_err().to_string().contains("nested more than 32 deep"));
}

/// Writes seeds for the fuzz target `psd`: `PATHWARP_FUZZ_SEEDS=fuzz/seeds cargo test --test libraries psd`.
#[test]
fn seeds_are_read() {
    let folder = std::env::var_os("PATHWARP_FUZZ_SEEDS").map(|f| crate::support::root().join(f).join("psd"));
    for (name, wide) in [("psd", false), ("psb", true)] {
        assert_eq!(warps(&all(wide)).unwrap().warps.len(), 4);
        if let Some(folder) = &folder {
            std::fs::create_dir_all(folder).unwrap();
            std::fs::write(folder.join(name), all(wide)).unwrap();
        }
    }
}
