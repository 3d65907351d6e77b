//! The structure that ARCHITECTURE.md describes, checked: crates depend one way, folders never import in a circle, the rooms of
//! pathwarp-svg follow one another, and files and functions stay short.

mod graph;
mod messages;

use crate::support::root;
use graph::{Arrows, Crate, circles};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use syn::visit::{self, Visit};

/// Limit on the lines of a source file.
const LONGEST_FILE: usize = 900;
/// Limit on the lines of a function, unless it is a table.
const LONGEST_FUNCTION: usize = 80;
/// The rooms of pathwarp-svg. Each may import from those before it.
const SVG_ROOMS: [&str; 4] = ["source", "scene", "bend", "write"];

#[test]
fn dependencies_run_one_way() {
    // In the order of the manifest, which is alphabetical.
    let of = |name: &str| -> Vec<String> {
        let text = fs::read_to_string(root().join("crates").join(name).join("Cargo.toml")).unwrap();
        let manifest: toml::Table = text.parse().unwrap();
        manifest["dependencies"].as_table().unwrap().keys().cloned().collect()
    };
    // The core: curves, the fitter, path data, the JSON that deformations read, error types, and (optional) threads, nothing else.
    assert_eq!(of("pathwarp"), ["bezierfit", "kurbo", "rayon", "serde", "serde_json", "svgtypes", "thiserror"]);
    // linesweeper is optional: areas are united by it.
    assert_eq!(of("bezierfit"), ["kurbo", "linesweeper"]);
    let allowed = |name: &str, ours: &[&str]| {
        for d in of(name).iter().filter(|d| d.starts_with("pathwarp")) {
            assert!(ours.contains(&d.as_str()), "{name} must not depend on {d}");
        }
    };
    allowed("pathwarp-text", &[]);
    allowed("pathwarp-reader", &["pathwarp"]);
    allowed("pathwarp-svg", &["pathwarp", "pathwarp-reader", "pathwarp-text"]);
    allowed("pathwarp-raster", &["pathwarp"]);
    allowed("pathwarp-gimp", &["pathwarp"]);
    allowed("pathwarp-solid", &["pathwarp"]);
    allowed("pathwarp-plugin", &["pathwarp"]);
    allowed("pathwarp-psd", &[]);
    allowed("pathwarp-dxf", &["pathwarp"]);
    // pathwarp-pdf needs the core for its limits, since pictures in a PDF are counted.
    allowed("pathwarp-pdf", &["pathwarp", "pathwarp-raster"]);
    let below_engine = [
        "pathwarp",
        "pathwarp-dxf",
        "pathwarp-gimp",
        "pathwarp-pdf",
        "pathwarp-psd",
        "pathwarp-raster",
        "pathwarp-solid",
        "pathwarp-svg",
        "pathwarp-text",
    ];
    allowed("pathwarp-engine", &below_engine);
    allowed("pathwarp-editor", &["pathwarp", "pathwarp-engine", "pathwarp-raster", "pathwarp-svg", "pathwarp-text"]);
    for name in ["pathwarp-c", "pathwarp-python"] {
        allowed(name, &["pathwarp", "pathwarp-engine", "pathwarp-plugin"]);
    }
    let below_cli = [&below_engine[..], &["pathwarp-editor", "pathwarp-engine", "pathwarp-plugin"]].concat();
    allowed("pathwarp-cli", &below_cli);
    for name in [&below_cli[..], &["pathwarp-c", "pathwarp-python", "pathwarp-reader"]].concat() {
        let of_terminals = ["clap", "ans", "indicatif", "ctrlc", "walkdir"];
        let printing: Vec<String> =
            of(name).into_iter().filter(|d| of_terminals.iter().any(|t| d.starts_with(t))).collect();
        assert!(printing.is_empty(), "{name} prints, with {printing:?}");
    }
}

/// Returns every crate's `src` folder.
fn crates() -> Vec<(String, BTreeMap<String, String>)> {
    let folder = root().join("crates");
    let mut names: Vec<String> =
        fs::read_dir(&folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    let files = |name: &String| (name.clone(), rust_files(&folder.join(name).join("src")));
    names.iter().map(files).collect()
}

/// The Rust files below a folder by their path within it, with `/` between folders.
fn rust_files(folder: &Path) -> BTreeMap<String, String> {
    fn walk(folder: &Path, front: &str, out: &mut BTreeMap<String, String>) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_str().unwrap();
            if path.is_dir() && name != "target" {
                walk(&path, &format!("{front}{name}/"), out);
            } else if name.ends_with(".rs") {
                out.insert(format!("{front}{name}"), fs::read_to_string(&path).unwrap());
            }
        }
    }
    let mut out = BTreeMap::new();
    walk(folder, "", &mut out);
    out
}

/// A circle with the imports that close it.
fn shown(circle: &[String], arrows: &Arrows) -> String {
    let mut out = String::new();
    for from in circle {
        for (to, path) in arrows[from].iter().filter(|(to, _)| circle.contains(to)) {
            out += &format!("\n    {from} -> {to}: {path}");
        }
    }
    out
}

#[test]
fn folders_do_not_import_in_circles() {
    let mut found = String::new();
    for (name, files) in crates() {
        let arrows = Crate::read(&files).arrows();
        for circle in circles(&arrows) {
            found += &format!("\n  {name}, {} files:{}", circle.len(), shown(&circle, &arrows));
        }
    }
    assert!(found.is_empty(), "files of several folders import one another:{found}");
}

#[test]
fn the_rooms_of_pathwarp_svg_follow_one_another() {
    let files = rust_files(&root().join("crates/pathwarp-svg/src"));
    let arrows = Crate::read(&files).arrows();
    assert_eq!(against_the_order(&arrows), [] as [String; 0]);
    for room in SVG_ROOMS {
        assert!(files.keys().any(|f| f.starts_with(&format!("{room}/"))), "{room} is gone");
    }
}

/// Imports from a later room.
fn against_the_order(arrows: &Arrows) -> Vec<String> {
    let room = |file: &str| SVG_ROOMS.iter().position(|r| file.strip_prefix(r).is_some_and(|f| f.starts_with('/')));
    let mut out = Vec::new();
    for (from, to) in arrows.iter().flat_map(|(from, all)| all.keys().map(move |to| (from, to))) {
        if let (Some(a), Some(b)) = (room(from), room(to))
            && b > a
        {
            out.push(format!("{from} -> {to}"));
        }
    }
    out
}

/// The reader of imports finds such circles, so the tests above can fail.
#[test]
fn circles_are_found() {
    let read = |files: &[(&str, &str)]| {
        let files = files.iter().map(|(name, text)| ((*name).to_owned(), (*text).to_owned()));
        Crate::read(&files.collect()).arrows()
    };
    // Through a re-export, a renamed import, a path in a macro, one in an attribute, and a grandchild.
    let arrows = read(&[
        ("lib.rs", "mod a; mod b; mod c; mod d; pub use b::B;"),
        ("a.rs", "use crate::B as Other; pub struct A; fn f(_: Other) {}"),
        ("b/mod.rs", "mod deep; pub use deep::B;"),
        ("b/deep.rs", "pub struct B; fn g() { vec![crate::c::made()]; }"),
        (
            "c.rs",
            "#[derive(Error)] pub enum E { #[error(\"{}\", crate::d::MOST)] Large } pub fn made() -> E { E::Large }",
        ),
        ("d.rs", "use super::a; pub const MOST: usize = a::A::SIZE;"),
    ]);
    assert_eq!(circles(&arrows), [["a.rs", "b/deep.rs", "c.rs", "d.rs"]]);
    // No circle: a parent that only re-exports its child's definitions, tests, and names of other crates.
    let arrows = read(&[
        ("lib.rs", "mod a; pub use a::A; mod kurbo_like {}"),
        ("a/mod.rs", "mod b; mod c; pub use b::A;"),
        ("a/b.rs", "use super::c::C; pub struct A(C); #[cfg(test)] mod tests { use crate::A; }"),
        ("a/c.rs", "use std::fmt; pub struct C; #[cfg(test)] mod tests { use super::super::A; }"),
    ]);
    assert!(circles(&arrows).is_empty());
    assert_eq!(arrows["a/b.rs"]["a/c.rs"], "super::c::C");
    // A circle: a parent works with a folder, which uses the parent's definitions. Two files of one folder may import each other.
    let arrows = read(&[
        ("lib.rs", "mod child; pub struct P; fn f() { child::run() }"),
        ("child/mod.rs", "mod own; use crate::P; pub fn run() { own::g() } pub fn h() {}"),
        ("child/own.rs", "pub fn g() { super::h() }"),
    ]);
    assert_eq!(circles(&arrows), [["child/mod.rs", "child/own.rs", "lib.rs"]]);
    let arrows = read(&[
        ("lib.rs", "mod a; mod b;"),
        ("a.rs", "pub fn f() { crate::b::g() }"),
        ("b.rs", "pub fn g() { crate::a::f() }"),
    ]);
    assert!(arrows["a.rs"].contains_key("b.rs") && circles(&arrows).is_empty());
    let arrows = read(&[
        ("lib.rs", "mod source; mod write;"),
        ("source/mod.rs", "use crate::write::W;"),
        ("write/mod.rs", "pub struct W;"),
    ]);
    assert_eq!(against_the_order(&arrows), ["source/mod.rs -> write/mod.rs"]);
}

#[test]
fn files_and_functions_are_short() {
    /// Tables of expected values: one entry after the other, without connections between lines.
    const TABLES: [&str; 3] =
        ["table", "the_guides_ends_are_the_formulas", "the_two_curve_family_reproduces_its_guides"];
    let mut long = Vec::new();
    for folder in ["crates", "tests", "examples", "fuzz"] {
        for (file, text) in rust_files(&root().join(folder)) {
            let lines = text.lines().count();
            if lines > LONGEST_FILE {
                long.push(format!("{folder}/{file}: {lines} lines"));
            }
            for (name, lines) in functions(&text) {
                if lines > LONGEST_FUNCTION && !TABLES.contains(&name.as_str()) {
                    long.push(format!("{folder}/{file}: fn {name} has {lines} lines"));
                }
            }
        }
    }
    assert!(long.is_empty(), "too long:\n  {}", long.join("\n  "));
    let made = format!("fn long() {{\n{}}}", "f();\n".repeat(90));
    assert_eq!(functions(&made), [("long".to_owned(), 92)]);
}

/// The functions of a file and their lengths in lines.
fn functions(text: &str) -> Vec<(String, usize)> {
    struct Lengths(Vec<(String, usize)>);
    impl Lengths {
        fn add(&mut self, signature: &syn::Signature, body: &syn::Block) {
            let from = signature.fn_token.span.start().line;
            let to = body.brace_token.span.close().end().line;
            self.0.push((signature.ident.to_string(), to - from + 1));
        }
    }
    impl<'ast> Visit<'ast> for Lengths {
        fn visit_item_fn(&mut self, f: &'ast syn::ItemFn) {
            self.add(&f.sig, &f.block);
            visit::visit_item_fn(self, f);
        }
        fn visit_impl_item_fn(&mut self, f: &'ast syn::ImplItemFn) {
            self.add(&f.sig, &f.block);
            visit::visit_impl_item_fn(self, f);
        }
    }
    let mut out = Lengths(Vec::new());
    out.visit_file(&syn::parse_file(text).unwrap());
    out.0
}

/// Lists all messages, to be read in one go; `PATHWARP_STORE=1` writes the list anew. A message names the problem, then what to do.
#[test]
fn messages_are_listed_and_short() {
    /// Most characters of a problem, before the advice.
    const LONGEST: usize = 160;
    let file = root().join("tests/program/architecture/messages.txt");
    let mut listed = String::new();
    let for_developers = ["pathwarp-oracle", "xtask"];
    for (name, files) in crates().into_iter().filter(|(name, _)| !for_developers.contains(&&**name)) {
        let all: BTreeSet<String> = files
            .iter()
            .filter(|(f, _)| !f.ends_with("tests.rs"))
            .flat_map(|(_, text)| messages::of_source(text))
            .collect();
        for message in &all {
            let problem = message.split([';', ':']).next().unwrap_or_default();
            assert!(problem.chars().count() <= LONGEST, "{name}: too long before the advice: {message}");
        }
        listed += &format!("{name}\n{}\n", all.iter().map(|m| format!("  {m}\n")).collect::<String>());
    }
    if std::env::var_os("PATHWARP_STORE").is_some() {
        fs::write(&file, &listed).unwrap();
    }
    let stored = fs::read_to_string(&file).unwrap();
    let new: Vec<&str> = listed.lines().filter(|line| !stored.lines().any(|l| l == *line)).collect();
    assert!(
        stored == listed,
        "messages differ from {}, which PATHWARP_STORE=1 writes anew; new: {new:#?}",
        file.display()
    );
}

#[test]
fn messages_are_found_in_source() {
    let found = messages::of_source(
        r#"/// Not this doc comment.
        fn f() -> String { panic!("not a bug report"); let m = format!("no such file {}; {}", 1, "look at it"); m.expect("not this one") }
        #[cfg(test)] mod tests { const A: &str = "not this test text"; }"#,
    );
    assert_eq!(found.into_iter().collect::<Vec<_>>(), ["look at it", "no such file {}; {}"]);
}
