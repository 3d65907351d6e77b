//! GIMP 2 agrees on the files written for it.

use super::installed::{DUMP, agree, dumped, gimp_2};
use crate::support::expect_code;
use crate::support::gimp::paths;
use pathwarp_gimp::{new_xcf, read};
use std::fs;

#[test]
fn gimp_2_agrees_on_the_files_written() {
    let dir = tempfile::tempdir().unwrap();
    let d = dir.path();
    let at = |name: &str| d.join(name).display().to_string();
    fs::write(at("new.xcf"), new_xcf([640, 400], &paths())).unwrap();
    // GIMP saves it with a layer, so that tiles follow the paths: with pointers of 32 and of 64 bits, and with a floating selection,
    // which points to its layer.
    let make = format!(
        r#"(let* ((i (car (gimp-file-load 1 "{0}" "{0}"))) (l (car (gimp-layer-new i 640 400 0 "Layer" 100 0))))
            (gimp-image-insert-layer i l 0 0) (gimp-drawable-fill l 2) (gimp-image-set-resolution i 300 200)
            (gimp-xcf-save 0 i l "{1}" "{1}") (gimp-image-convert-precision i 250) (gimp-xcf-save 0 i l "{2}" "{2}")
            (gimp-image-select-rectangle i 2 10 10 100 80) (gimp-edit-copy l) (gimp-edit-paste l 0)
            (gimp-xcf-save 0 i l "{3}" "{3}"))"#,
        at("new.xcf"),
        at("real.xcf"),
        at("deep.xcf"),
        at("floating.xcf")
    );
    let Some(said) = gimp_2(d, &make) else { return };
    assert!(d.join("floating.xcf").exists(), "{said}");
    let of = |name: &str| read(&fs::read(at(name)).unwrap()).unwrap();
    let version = |name: &str| fs::read(at(name)).unwrap()[9..13].to_vec();
    assert_eq!((version("real.xcf"), version("deep.xcf")), (b"file".to_vec(), b"v012".to_vec()));

    let mut script = String::from(DUMP);
    for file in ["real", "deep", "floating"] {
        let source = at(&format!("{file}.xcf"));
        assert_eq!(of(&format!("{file}.xcf")), paths());
        let into = |name: &str| at(&format!("{file}-{name}.xcf"));
        expect_code(0, &["affine", &source, "--into", &into("same")]);
        assert_eq!(fs::read(into("same")).unwrap(), fs::read(&source).unwrap());
        expect_code(0, &["wave", &source, "--merge", "off", "--tolerance", "1e-4", "--into", &into("waved"), "-q"]);
        assert_ne!(fs::metadata(into("waved")).unwrap().len(), fs::metadata(&source).unwrap().len());
        for name in ["same", "waved"] {
            script += &format!(
                "(let* ((i (car (gimp-file-load 1 \"{0}\" \"{0}\"))) (l (car (gimp-image-get-active-layer i))))
                   (dump i \"{1}.txt\") (file-png-save-defaults 1 i l \"{1}.png\" \"{1}.png\")
                   (if (> (car (gimp-image-get-floating-sel i)) 0) (call-with-output-file \"{1}.on\" (lambda (port)
                     (display (car (gimp-item-get-name (car (gimp-image-floating-sel-attached-to i)))) port)))))\n",
                into(name),
                at(&format!("{file}-{name}"))
            );
        }
    }
    expect_code(0, &["wave", &at("real.xcf"), "-o", &at("waved.svg"), "-q"]);
    expect_code(0, &["convert", &at("real.xcf"), "-o", &at("plain.svg")]);
    for (name, dpi) in [("plain", 72), ("plain", 300), ("waved", 72), ("waved", 300)] {
        script += &format!(
            "(let ((i (car (gimp-image-new 640 400 0)))) (gimp-image-set-resolution i {dpi} {dpi})
               (gimp-vectors-import-from-file i \"{}\" 0 0) (dump i \"{}\"))\n",
            at(&format!("{name}.svg")),
            at(&format!("{name}-{dpi}.txt"))
        );
    }
    fs::write(at("dump.scm"), script).unwrap();
    let said = gimp_2(d, &format!("(load \"{}\")", at("dump.scm"))).unwrap();
    assert!(d.join("waved-300.txt").exists(), "{said}");
    assert!(!said.to_lowercase().contains("corrupt"), "{said}");
    let pixels =
        |name: &str| pathwarp_raster::Picture::read(&fs::read(at(name)).unwrap()).unwrap().pixmap.data().to_vec();
    for file in ["real", "deep", "floating"] {
        // The dump has ten digits.
        agree(&dumped(&d.join(format!("{file}-same.txt"))), &paths(), 1e-6, true);
        agree(&dumped(&d.join(format!("{file}-waved.txt"))), &of(&format!("{file}-waved.xcf")), 1e-6, true);
        // The pixels are unchanged.
        assert!(pixels(&format!("{file}-same.png")) == pixels(&format!("{file}-waved.png")));
    }
    for name in ["same", "waved"] {
        assert_eq!(fs::read_to_string(at(&format!("floating-{name}.on"))).unwrap_or_default(), "Layer", "{said}");
    }
    for dpi in [72, 300] {
        agree(&dumped(&d.join(format!("plain-{dpi}.txt"))), &paths(), 0.01, false);
        agree(&dumped(&d.join(format!("waved-{dpi}.txt"))), &of("waved.svg"), 0.01, false);
    }
}
