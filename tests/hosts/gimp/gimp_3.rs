//! GIMP 3 agrees on the files written for it.

use super::installed::{IN_GIMP_3, agree, gimp_3};
use crate::support::expect_code;
use crate::support::gimp::paths;
use pathwarp_gimp::{read, to_json};
use std::fs;

/// Includes paths stored as items, which GIMP writes when several are selected.
#[test]
fn gimp_3_agrees_on_the_files_written() {
    let dir = tempfile::tempdir().unwrap();
    let d = dir.path();
    let at = |name: &str| d.join(name).display().to_string();
    fs::write(at("in.json"), to_json(Some([640.0, 400.0]), &paths())).unwrap();
    let make = format!(
        r#"{IN_GIMP_3}
image = Gimp.Image.new(640, 400, Gimp.ImageBaseType.RGB)
layer = Gimp.Layer.new(image, "Layer", 640, 400, Gimp.ImageType.RGB_IMAGE, 100, Gimp.LayerMode.NORMAL)
image.insert_layer(layer, None, 0)
build(image, "{0}")
for chosen, file in [(image.get_paths(), "{1}"), (image.get_paths()[:1], "{2}")]:
    image.set_selected_paths(chosen)
    Gimp.file_save(Gimp.RunMode.NONINTERACTIVE, image, Gio.File.new_for_path(file), None)
"#,
        at("in.json"),
        at("items.xcf"),
        at("block.xcf")
    );
    let Some(said) = gimp_3(d, &make) else { return };
    assert!(d.join("block.xcf").exists(), "{said}");
    let of = |name: &str| read(&fs::read(at(name)).unwrap()).unwrap();
    let mut dumps = String::new();
    for file in ["items", "block"] {
        let source = at(&format!("{file}.xcf"));
        let items = fs::read(&source).unwrap()[9..13] >= b"v018"[..];
        assert_eq!(items, file == "items");
        assert_eq!(of(&format!("{file}.xcf")), paths());
        let waved = at(&format!("{file}-waved.xcf"));
        expect_code(0, &["wave", &source, "--merge", "off", "--tolerance", "1e-4", "--into", &waved, "-q"]);
        assert!(fs::metadata(&waved).unwrap().len() > fs::metadata(&source).unwrap().len());
        let json = at(&format!("{file}-waved.json"));
        dumps +=
            &format!("dump(Gimp.file_load(Gimp.RunMode.NONINTERACTIVE, Gio.File.new_for_path({waved:?})), {json:?})\n");
    }
    expect_code(0, &["convert", &at("items.xcf"), "-o", &at("plain.svg")]);
    let script = format!(
        r#"{IN_GIMP_3}
{dumps}
for dpi in (72, 300):
    image = Gimp.Image.new(640, 400, Gimp.ImageBaseType.RGB)
    image.set_resolution(dpi, dpi)
    image.import_paths_from_file(Gio.File.new_for_path("{0}"), False, False)
    dump(image, "{1}/plain-%d.json" % dpi)
"#,
        at("plain.svg"),
        d.display()
    );
    let said = gimp_3(d, &script).unwrap();
    assert!(d.join("plain-300.json").exists(), "{said}");
    for file in ["items", "block"] {
        assert_eq!(of(&format!("{file}-waved.json")), of(&format!("{file}-waved.xcf")), "{said}");
        assert_ne!(of(&format!("{file}-waved.json")), paths());
    }
    for dpi in [72, 300] {
        agree(&of(&format!("plain-{dpi}.json")), &paths(), 0.01, false);
    }
}
