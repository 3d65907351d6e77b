//! Files made here from the format's description, read back.

use pathwarp_psd::{Error, Warps, warps};

fn text(t: &str) -> Vec<u8> {
    let units: Vec<u16> = t.encode_utf16().chain([0]).collect();
    [(units.len() as u32).to_be_bytes().to_vec(), units.iter().flat_map(|u| u.to_be_bytes()).collect()].concat()
}

/// Four letters after a zero, others after their length.
fn id(t: &str) -> Vec<u8> {
    let n = if t.len() == 4 { 0 } else { t.len() as u32 };
    [n.to_be_bytes().to_vec(), t.as_bytes().to_vec()].concat()
}

fn object(class: &str, items: &[(&str, Vec<u8>)]) -> Vec<u8> {
    let mut out = [text(""), id(class), (items.len() as u32).to_be_bytes().to_vec()].concat();
    for (key, value) in items {
        out.extend(id(key));
        out.extend(value);
    }
    out
}

fn tagged(kind: &str, value: Vec<u8>) -> Vec<u8> {
    [kind.as_bytes().to_vec(), value].concat()
}

fn double(v: f64) -> Vec<u8> {
    tagged("doub", v.to_be_bytes().to_vec())
}

fn pixels(v: f64) -> Vec<u8> {
    tagged("UntF", [b"#Pxl".to_vec(), v.to_be_bytes().to_vec()].concat())
}

fn name(kind: &str, v: &str) -> Vec<u8> {
    tagged("enum", [id(kind), id(v)].concat())
}

fn floats(v: &[f64]) -> Vec<u8> {
    let numbers = v.iter().flat_map(|v| v.to_be_bytes()).collect();
    tagged("UnFl", [b"#Pxl".to_vec(), (v.len() as u32).to_be_bytes().to_vec(), numbers].concat())
}

fn points(x: &[f64], y: &[f64]) -> Vec<u8> {
    let n = (x.len() as u32).to_be_bytes().to_vec();
    tagged("ObAr", [n, object("rationalPoint", &[("Hrzn", floats(x)), ("Vrtc", floats(y))])].concat())
}

fn slices(key: &str, v: &[f64]) -> Vec<u8> {
    let n = (v.len() as u32).to_be_bytes().to_vec();
    tagged("ObAr", [n, object("UnitFloat", &[(key, floats(v))])].concat())
}

fn warp(style: &str, value: f64, more: Vec<(&'static str, Vec<u8>)>) -> Vec<u8> {
    let bounds = object(
        "Rctn",
        &[("Top ", pixels(10.0)), ("Left", pixels(20.0)), ("Btom", pixels(70.0)), ("Rght", pixels(140.0))],
    );
    let mut items = vec![
        ("warpStyle", name("warpStyle", style)),
        ("warpValue", double(value)),
        ("warpPerspective", double(5.0)),
        ("warpPerspectiveOther", double(-7.0)),
        ("warpRotate", name("Ornt", "Vrtc")),
        ("bounds", tagged("Objc", bounds)),
        ("uOrder", tagged("long", 4_i32.to_be_bytes().to_vec())),
        // Kinds that no warp needs are read over.
        ("note", tagged("TEXT", text("ok"))),
        (
            "list",
            tagged(
                "VlLs",
                [2_u32.to_be_bytes().to_vec(), tagged("bool", vec![1]), tagged("tdta", vec![0, 0, 0, 1, 9])].concat(),
            ),
        ),
    ];
    items.extend(more);
    object("warp", &items)
}

const SIXTEEN: u32 = 16;

fn smart(items: &[(&str, Vec<u8>)]) -> Vec<u8> {
    [b"soLD".to_vec(), 4_u32.to_be_bytes().to_vec(), SIXTEEN.to_be_bytes().to_vec(), object("null", items)].concat()
}

fn placed(warp: Vec<u8>) -> Vec<u8> {
    let head =
        [b"plcL".to_vec(), 3_u32.to_be_bytes().to_vec(), vec![3], b"abc".to_vec(), vec![0; 16], vec![0; 64]].concat();
    [head, 0_u32.to_be_bytes().to_vec(), SIXTEEN.to_be_bytes().to_vec(), warp].concat()
}

fn written(warp: Vec<u8>) -> Vec<u8> {
    let text = object("TxLr", &[("Txt ", tagged("TEXT", text("Word")))]);
    let v = SIXTEEN.to_be_bytes().to_vec();
    [vec![0, 1], vec![0; 48], vec![0, 50], v.clone(), text, vec![0, 1], v, warp, vec![0; 32]].concat()
}

fn block(key: &str, mut data: Vec<u8>) -> Vec<u8> {
    if data.len() % 2 == 1 {
        data.push(0);
    }
    [b"8BIM".to_vec(), key.as_bytes().to_vec(), (data.len() as u32).to_be_bytes().to_vec(), data].concat()
}

fn long(wide: bool, n: usize) -> Vec<u8> {
    if wide { (n as u64).to_be_bytes().to_vec() } else { (n as u32).to_be_bytes().to_vec() }
}

fn layer(wide: bool, name: &str, blocks: &[Vec<u8>]) -> Vec<u8> {
    let mut pascal = vec![name.len() as u8];
    pascal.extend(name.as_bytes());
    pascal.resize(pascal.len().next_multiple_of(4), 0);
    let extra = [vec![0; 8], pascal, blocks.concat()].concat();
    let channel = [vec![0, 0], long(wide, 2)].concat();
    [vec![0; 16], vec![0, 1], channel, b"8BIMnorm".to_vec(), vec![255, 0, 0, 0], long(false, extra.len()), extra]
        .concat()
}

fn file(wide: bool, layers: &[Vec<u8>]) -> Vec<u8> {
    let count = -(layers.len() as i16);
    let info = [count.to_be_bytes().to_vec(), layers.concat(), vec![0; 2 * layers.len()]].concat();
    let section = [long(wide, info.len()), info, vec![0; 4]].concat();
    let version = if wide { 2_u16 } else { 1 };
    let header = [
        b"8BPS".to_vec(),
        version.to_be_bytes().to_vec(),
        vec![0; 6],
        vec![0, 3, 0, 0, 0, 50, 0, 0, 0, 60, 0, 8, 0, 3],
    ]
    .concat();
    [header, vec![0; 4], vec![0, 0, 0, 2, 7, 7], long(wide, section.len()), section, vec![0; 9]].concat()
}

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

fn found(w: &Warps) -> Vec<(&str, &str, f64)> {
    w.warps.iter().map(|w| (w.layer.as_str(), w.style.as_str(), w.value)).collect()
}

#[test]
fn every_kind_of_layer_is_read_in_both_sizes_of_file() {
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
fn broken_files_are_told_and_end_soon() {
    assert_eq!(warps(b"GIF89a"), Err(Error::NotPsd));
    assert_eq!(warps(b""), Err(Error::NotPsd));
    let whole = all(false);
    // Cut anywhere, or with any byte made large: an answer or an error, never a panic.
    for n in 0..whole.len() {
        let _ = warps(&whole[..n]);
        let mut bad = whole.clone();
        bad[n] = 255;
        let _ = warps(&bad);
    }
    assert!(matches!(warps(&whole[..200]), Err(Error::Format { at, .. }) if at <= 200));
    // Descriptors in one another without end.
    let mut deep = warp("warpArc", 1.0, vec![]);
    for _ in 0..100 {
        deep = object("a", &[("warp", tagged("Objc", deep))]);
    }
    let deep = file(false, &[layer(false, "deep", &[block("SoLd", smart(&[("warp", tagged("Objc", deep))]))])]);
    assert!(warps(&deep).unwrap_err().to_string().contains("deep in one another"));
}
