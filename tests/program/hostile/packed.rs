//! Packed GIMP files, and GIMP files whose parts overlap.

use super::bounded::Folder;
use flate2::Compression;
use flate2::write::GzEncoder;
use std::io::Write as _;

fn words(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|w| w.to_be_bytes()).collect()
}

/// `PROP_VECTORS` with one path of two anchors.
fn path() -> Vec<u8> {
    path_named("p")
}

fn path_named(name: &str) -> Vec<u8> {
    let mut content = words(&[1, 0, 1, u32::try_from(name.len()).unwrap() + 1]);
    content.extend(name.as_bytes());
    content.push(0);
    content.extend(words(&[1, 1, 0, 0, 1, 1, 0, 2, 6]));
    for (i, [x, y]) in
        [[1.0, 2.0], [1.0, 2.0], [3.0, 9.0], [40.0, 5.0], [50.0, 60.0], [50.0, 60.0_f32]].iter().enumerate()
    {
        content.extend(words(&[u32::from(i % 3 != 1), x.to_bits(), y.to_bits()]));
    }
    [words(&[25, u32::try_from(content.len()).unwrap()]), content].concat()
}

fn xcf(version: &str, properties: &[u8]) -> Vec<u8> {
    let mut out = format!("gimp xcf {version}\0").into_bytes();
    out.extend(words(&[100, 100, 0]));
    if version >= "v004" {
        out.extend(words(&[150]));
    }
    out.extend(properties);
    out
}

const COMMANDS: [&[&str]; 4] = [
    &["paths", "a.xcf"],
    &["swirl", "a.xcf", "-o", "o.svg"],
    &["convert", "a.xcf", "-o", "o.json"],
    &["swirl", "a.xcf", "-o", "o.xcf"],
];

#[test]
fn packed_files_are_unpacked_up_to_the_limit() {
    let before = |zeros: usize| {
        let mut gz = GzEncoder::new(Vec::new(), Compression::fast());
        gz.write_all(&xcf("v011", &words(&[77, u32::try_from(zeros).unwrap()]))).unwrap();
        let block = vec![0; 1 << 20];
        (0..zeros >> 20).for_each(|_| gz.write_all(&block).unwrap());
        gz.write_all(&[path(), words(&[0; 8])].concat()).unwrap();
        Folder::with(&[("a.xcf", &gz.finish().unwrap())])
    };
    let small = before(1 << 20);
    let large = before(200 << 20);
    for command in &COMMANDS[..3] {
        assert_eq!(small.run(command).0, 0, "{command:?}");
        let (code, said) = large.run(command);
        assert_eq!((code, said.contains("--limit bytes=")), (3, true), "{command:?}: {said}");
    }
    assert_eq!(large.run(&["paths", "a.xcf", "--limit", "bytes=3e8"]).0, 0);
}

/// Thousands of layers start inside one long list of properties, at different offsets.
#[test]
fn overlapping_layers_are_damage() {
    const LAYERS: u32 = 50_000;
    let mut file = xcf("v003", &[path(), words(&[0, 0])].concat());
    let list = u32::try_from(file.len()).unwrap() + 4 * LAYERS + 8;
    file.extend((0..LAYERS).flat_map(|i| (list + 8 * i).to_be_bytes()));
    file.extend(words(&[0, 0]));
    file.extend((0..LAYERS + 9).flat_map(|_| words(&[9, 0])));
    file.extend(words(&[0; 16]));
    let folder = Folder::with(&[("a.xcf", &file)]);
    for command in COMMANDS {
        let (code, said) = folder.run(command);
        let rewrites = command.last() == Some(&"o.xcf");
        assert_eq!(code != 0, rewrites, "{command:?}: {code} {said}");
    }
    assert!(!folder.path().join("o.xcf").exists());
}

/// One name turns the terminal red and sets its title; another is as long as the file.
#[test]
fn names_are_fit_for_a_terminal() {
    let file = |name: &str| xcf("v003", &[path_named(name), words(&[0; 8])].concat());
    let (red, long) = ("\x1b[31mred\x1b]0;title\x07", "a".repeat(500_000));
    let folder = Folder::with(&[("red.xcf", &file(red)), ("long.xcf", &file(&long))]);
    let list = std::process::Command::new(crate::support::pathwarp_program())
        .args(["paths", "red.xcf"])
        .current_dir(folder.path())
        .output()
        .unwrap();
    let listed = String::from_utf8(list.stdout).unwrap();
    assert!(list.status.success() && listed.contains("\\u{1b}[31mred\\u{1b}]0;title\\u{7}"), "{listed}");
    for file in ["red.xcf", "long.xcf"] {
        let (code, said) = folder.run(&["bend", file, "--along", &format!("{file}#q"), "-o", "o.svg"]);
        assert_eq!((code, said.contains("there is no path of this name")), (3, true), "{said}");
        assert!(said.len() < 3000 && !said.contains('\x1b'), "{file}: {said}");
    }
}
