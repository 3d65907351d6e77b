//! `cargo xtask public`: compares the public items of each library with the list in its folder, `public.txt`.

use crate::chore::{Chore, ChoreError, at, flag_option, workspace};
use clap::{ArgMatches, Command};
use std::fs;

pub(crate) const CHORE: Chore = Chore { command, run };

/// The libraries whose items are listed.
const CRATES: [&str; 8] = [
    "bezierfit",
    "pathwarp",
    "pathwarp-svg",
    "pathwarp-text",
    "pathwarp-gimp",
    "pathwarp-raster",
    "pathwarp-plugin",
    "pathwarp-solid",
];

fn command() -> Command {
    Command::new("public")
        .about("Compare the libraries' public items with the lists beside them")
        .arg(flag_option("write").help("Rewrite the lists"))
}

fn run(arguments: &ArgMatches) -> Result<String, ChoreError> {
    let root = workspace();
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut doc = std::process::Command::new(cargo);
    doc.args(["doc", "--quiet", "--workspace", "--no-deps", "--locked"])
        .env("RUSTDOCFLAGS", "-D warnings")
        .current_dir(&root);
    if !doc.status().map_err(|e| format!("cargo doc: {e}"))?.success() {
        return Err("cargo doc failed".into());
    }
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), Into::into);
    let (mut count, mut differences) = (0, Vec::new());
    for name in CRATES {
        let page = target.join("doc").join(name.replace('-', "_")).join("all.html");
        let found = items(&fs::read_to_string(&page).map_err(at(&page))?);
        count += found.lines().count();
        let list = root.join("crates").join(name).join("public.txt");
        if arguments.get_flag("write") {
            fs::write(&list, found).map_err(at(&list))?;
            continue;
        }
        let known = fs::read_to_string(&list).map_err(at(&list))?;
        let new = found.lines().filter(|l| known.lines().all(|k| k != *l)).map(|l| format!("{name}: new: {l}"));
        let gone = known.lines().filter(|k| found.lines().all(|l| l != *k)).map(|k| format!("{name}: gone: {k}"));
        differences.extend(new.chain(gone));
    }
    if differences.is_empty() {
        return Ok(format!("{count} public items of {} libraries", CRATES.len()));
    }
    Err(format!("{}\nIf that is meant, run `cargo xtask public --write`.", differences.join("\n")))
}

/// The kind and path of each item on rustdoc's page of all items, one per line.
fn items(page: &str) -> String {
    let item = |link: &str| {
        let (address, rest) = link.split_once("\">")?;
        let kind = address.rsplit('/').next()?.split_once('.').filter(|(_, file)| file.ends_with(".html"))?.0;
        let (path, _) = rest.split_once("</a>")?;
        (kind != "index").then(|| format!("{kind} {path}\n"))
    };
    let mut all: Vec<String> = page.split("<a href=\"").skip(1).filter_map(item).collect();
    all.sort_unstable();
    all.dedup();
    all.concat()
}

#[cfg(test)]
mod tests {
    #[test]
    fn items_are_read_from_the_page_of_all_items() {
        let page = "<a href=\"../a/index.html\">a</a><a href=\"#structs\">Structs</a><li><a href=\"m/struct.B.html\">m::B</a></li>\
                    <a href=\"fn.f.html\">f</a>";
        assert_eq!(super::items(page), "fn f\nstruct m::B\n");
    }
}
