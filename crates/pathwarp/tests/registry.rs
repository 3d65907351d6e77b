//! The registry is complete and consistent: every file in `src/deform/` is an entry, and names are unique.

use pathwarp::deform::Registry;
use std::path::Path;

#[test]
fn every_file_is_registered() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/deform");
    let list = std::fs::read_to_string(folder.join("mod.rs")).unwrap();
    for file in std::fs::read_dir(&folder).unwrap() {
        let stem = file.unwrap().path().file_stem().unwrap().to_string_lossy().into_owned();
        if stem == "mod" {
            continue;
        }
        assert!(list.contains(&format!("mod {stem};")), "deform/{stem}.rs is no module of deform/mod.rs");
        assert!(list.contains(&format!("Arc::new({stem}::")), "deform/{stem}.rs is not in builtin()");
        let name = stem.replace('_', "-");
        assert!(Registry::builtin().get(&name).is_some(), "deform/{stem}.rs does not hold an entry called `{name}`");
    }
}

#[test]
fn names_are_unique() {
    let mut names: Vec<_> = Registry::builtin().entries().iter().map(|e| e.info().name).collect();
    let all = names.len();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), all);
}
