//! Builds Photoshop files from the description of the format.

pub(crate) fn text(t: &str) -> Vec<u8> {
    let units: Vec<u16> = t.encode_utf16().chain([0]).collect();
    [(units.len() as u32).to_be_bytes().to_vec(), units.iter().flat_map(|u| u.to_be_bytes()).collect()].concat()
}

/// A key: four letters after a zero, others after their length.
pub(crate) fn id(t: &str) -> Vec<u8> {
    let n = if t.len() == 4 { 0 } else { t.len() as u32 };
    [n.to_be_bytes().to_vec(), t.as_bytes().to_vec()].concat()
}

pub(crate) fn object(class: &str, items: &[(&str, Vec<u8>)]) -> Vec<u8> {
    let mut out = [text(""), id(class), (items.len() as u32).to_be_bytes().to_vec()].concat();
    for (key, value) in items {
        out.extend(id(key));
        out.extend(value);
    }
    out
}

pub(crate) fn tagged(kind: &str, value: Vec<u8>) -> Vec<u8> {
    [kind.as_bytes().to_vec(), value].concat()
}

pub(crate) fn double(v: f64) -> Vec<u8> {
    tagged("doub", v.to_be_bytes().to_vec())
}

pub(crate) fn pixels(v: f64) -> Vec<u8> {
    tagged("UntF", [b"#Pxl".to_vec(), v.to_be_bytes().to_vec()].concat())
}

pub(crate) fn name(kind: &str, v: &str) -> Vec<u8> {
    tagged("enum", [id(kind), id(v)].concat())
}

pub(crate) fn floats(v: &[f64]) -> Vec<u8> {
    let numbers = v.iter().flat_map(|v| v.to_be_bytes()).collect();
    tagged("UnFl", [b"#Pxl".to_vec(), (v.len() as u32).to_be_bytes().to_vec(), numbers].concat())
}

pub(crate) fn points(x: &[f64], y: &[f64]) -> Vec<u8> {
    let n = (x.len() as u32).to_be_bytes().to_vec();
    tagged("ObAr", [n, object("rationalPoint", &[("Hrzn", floats(x)), ("Vrtc", floats(y))])].concat())
}

pub(crate) fn slices(key: &str, v: &[f64]) -> Vec<u8> {
    let n = (v.len() as u32).to_be_bytes().to_vec();
    tagged("ObAr", [n, object("UnitFloat", &[(key, floats(v))])].concat())
}

pub(crate) fn warp(style: &str, value: f64, more: Vec<(&'static str, Vec<u8>)>) -> Vec<u8> {
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
        // Types that no warp needs are skipped.
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

pub(crate) fn smart(items: &[(&str, Vec<u8>)]) -> Vec<u8> {
    [b"soLD".to_vec(), 4_u32.to_be_bytes().to_vec(), SIXTEEN.to_be_bytes().to_vec(), object("null", items)].concat()
}

pub(crate) fn placed(warp: Vec<u8>) -> Vec<u8> {
    let head =
        [b"plcL".to_vec(), 3_u32.to_be_bytes().to_vec(), vec![3], b"abc".to_vec(), vec![0; 16], vec![0; 64]].concat();
    [head, 0_u32.to_be_bytes().to_vec(), SIXTEEN.to_be_bytes().to_vec(), warp].concat()
}

pub(crate) fn written(warp: Vec<u8>) -> Vec<u8> {
    let text = object("TxLr", &[("Txt ", tagged("TEXT", text("Word")))]);
    let v = SIXTEEN.to_be_bytes().to_vec();
    [vec![0, 1], vec![0; 48], vec![0, 50], v.clone(), text, vec![0, 1], v, warp, vec![0; 32]].concat()
}

pub(crate) fn block(key: &str, mut data: Vec<u8>) -> Vec<u8> {
    if data.len() % 2 == 1 {
        data.push(0);
    }
    [b"8BIM".to_vec(), key.as_bytes().to_vec(), (data.len() as u32).to_be_bytes().to_vec(), data].concat()
}

pub(crate) fn long(wide: bool, n: usize) -> Vec<u8> {
    if wide { (n as u64).to_be_bytes().to_vec() } else { (n as u32).to_be_bytes().to_vec() }
}

pub(crate) fn layer(wide: bool, name: &str, blocks: &[Vec<u8>]) -> Vec<u8> {
    let mut pascal = vec![name.len() as u8];
    pascal.extend(name.as_bytes());
    pascal.resize(pascal.len().next_multiple_of(4), 0);
    let extra = [vec![0; 8], pascal, blocks.concat()].concat();
    let channel = [vec![0, 0], long(wide, 2)].concat();
    [vec![0; 16], vec![0, 1], channel, b"8BIMnorm".to_vec(), vec![255, 0, 0, 0], long(false, extra.len()), extra]
        .concat()
}

pub(crate) fn file(wide: bool, layers: &[Vec<u8>]) -> Vec<u8> {
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
