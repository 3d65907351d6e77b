//! Dependencies run one way: cli → {svg, raster, gimp, mesh} → {pathwarp, text} → kurbo.

mod support;

use serde_json::Value;
use std::process::Command;

#[test]
fn dependencies_run_one_way() {
    let out = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version", "1", "--no-deps", "--offline"])
        .current_dir(support::root())
        .output()
        .unwrap();
    let metadata: Value = serde_json::from_slice(&out.stdout).unwrap();
    let of = |name: &str| -> Vec<String> {
        let package = metadata["packages"].as_array().unwrap().iter().find(|p| p["name"] == name).unwrap();
        let normal = package["dependencies"].as_array().unwrap().iter().filter(|d| d["kind"].is_null());
        normal.map(|d| d["name"].as_str().unwrap().to_owned()).collect()
    };
    // The core: curves, path data, the JSON that deformations read, and error types, nothing else.
    assert_eq!(of("pathwarp"), ["kurbo", "serde", "serde_json", "svgtypes", "thiserror"]);
    let allowed = |name: &str, ours: &[&str]| {
        for d in of(name).iter().filter(|d| d.starts_with("pathwarp")) {
            assert!(ours.contains(&d.as_str()), "{name} must not depend on {d}");
        }
    };
    allowed("pathwarp-text", &[]);
    allowed("pathwarp-svg", &["pathwarp", "pathwarp-text"]);
    allowed("pathwarp-raster", &["pathwarp"]);
    allowed("pathwarp-gimp", &["pathwarp"]);
    allowed("pathwarp-mesh", &["pathwarp"]);
    allowed("pathwarp-psd", &[]);
    let below_cli = [
        "pathwarp",
        "pathwarp-gimp",
        "pathwarp-mesh",
        "pathwarp-psd",
        "pathwarp-svg",
        "pathwarp-raster",
        "pathwarp-text",
    ];
    allowed("pathwarp-cli", &below_cli);
    for name in below_cli {
        assert!(
            !of(name).iter().any(|d| d.starts_with("clap") || d == "indicatif" || d.starts_with("ans")),
            "{name} prints"
        );
    }
}
