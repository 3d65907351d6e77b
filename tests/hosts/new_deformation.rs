//! `cargo xtask new-deformation`: the generated code compiles, is registered and passes its tests.

use crate::support::{program, root};
use std::fs;
use std::path::Path;
use std::process::Command;

fn copy_folder(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let (entry, copy) = (entry.unwrap().path(), |e: &Path| to.join(e.file_name().unwrap()));
        if entry.is_dir() {
            copy_folder(&entry, &copy(&entry));
        } else {
            fs::copy(&entry, copy(&entry)).unwrap();
        }
    }
}

/// A test of the new deformation alone.
const SOUND: &str = "#[test] fn square_wave_is_sound() { assert_eq!(crate::check::entry(&ENTRY), [] as [String; 0]); }";

#[test]
fn the_new_deformation_passes_its_tests() {
    let copy = tempfile::tempdir().unwrap();
    let here = copy.path();
    for name in ["bezierfit", "pathwarp"] {
        let folder = here.join("crates").join(name);
        copy_folder(&root().join("crates").join(name).join("src"), &folder.join("src"));
        let manifest = fs::read_to_string(root().join("crates").join(name).join("Cargo.toml")).unwrap();
        let mut manifest: toml::Table = manifest.parse().unwrap();
        // The benchmarks and their dependencies are left out.
        manifest.retain(|table, _| table != "bench" && table != "dev-dependencies");
        fs::write(folder.join("Cargo.toml"), manifest.to_string()).unwrap();
    }
    fs::create_dir_all(here.join("all/src")).unwrap();
    fs::write(here.join("all/src/lib.rs"), "//! Asks for every dependency of the workspace.\n").unwrap();
    let manifest = fs::read_to_string(root().join("Cargo.toml")).unwrap();
    fs::write(here.join("all/Cargo.toml"), asking_for_all(&manifest)).unwrap();
    fs::write(here.join("Cargo.toml"), reduced(&manifest)).unwrap();
    fs::copy(root().join("Cargo.lock"), here.join("Cargo.lock")).unwrap();

    let mut create = Command::new(program("xtask"));
    let created = create.args(["new-deformation", "square-wave", "--root"]).arg(here).output().unwrap();
    assert!(created.status.success(), "{}", String::from_utf8_lossy(&created.stderr));
    let file = here.join("crates/pathwarp/src/deform/square_wave.rs");
    let written = fs::read_to_string(&file).unwrap();
    assert!(written.lines().count() <= 60, "{written}");
    fs::write(&file, written + SOUND).unwrap();
    // This test's target folder already has the dependencies.
    let target = std::env::current_exe().unwrap().ancestors().nth(3).unwrap().to_owned();
    let test = Command::new(env!("CARGO"))
        .args(["test", "--quiet", "-p", "pathwarp", "-p", "all", "--lib", "--target-dir"])
        .arg(target)
        .args(["--", "square_wave", "deform::registry::"])
        .env("CARGO_INCREMENTAL", "0")
        .current_dir(here)
        .output()
        .unwrap();
    let output = String::from_utf8_lossy(&test.stdout).into_owned() + &String::from_utf8_lossy(&test.stderr);
    assert!(test.status.success() && output.contains("4 passed"), "{output}");
}

/// Returns the workspace's manifest, reduced to the copied crates. They are not optimised: they run only once, so that would take longer
/// than it saves. Since they are built differently, they do not replace the workspace's crates in the target folder.
fn reduced(manifest: &str) -> String {
    let members = manifest.lines().find(|l| l.starts_with("members")).unwrap();
    let levels = ["bezierfit.opt-level", "pathwarp.opt-level"];
    let own = manifest.lines().filter(|l| {
        !l.contains("crates/pathwarp-") && !l.starts_with("default-members") && !levels.iter().any(|o| l.starts_with(o))
    });
    let profile = "[profile.dev.package]\n";
    assert!(manifest.contains(profile));
    own.collect::<Vec<&str>>()
        .join("\n")
        .replace(members, "members = [\"crates/pathwarp\", \"all\"]")
        .replace(profile, &format!("{profile}bezierfit.opt-level = 0\npathwarp.opt-level = 0\n"))
}

/// Returns the manifest of a crate that has all dependencies of the workspace, so that they keep their features and are not built again.
fn asking_for_all(manifest: &str) -> String {
    let table = manifest.split("[workspace.dependencies]").nth(1).unwrap().split("\n[").next().unwrap();
    let names = table.lines().filter(|l| !l.contains("path = ")).filter_map(|l| l.split_once(" = "));
    let names: String = names.map(|(name, _)| format!("{name}.workspace = true\n")).collect();
    format!("[package]\nname = \"all\"\nedition.workspace = true\n\n[dependencies]\n{names}")
}
