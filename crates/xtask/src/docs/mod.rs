//! `cargo xtask docs`: the generated pages and every picture of the documentation.

mod coming_from;
mod cookbook;
mod deformations;
mod guides;
mod lettering;
mod page;
mod shapes;

use crate::chore::{Chore, ChoreError, program_option, workspace};
use crate::shell;
use clap::{ArgMatches, Command};
use page::CookbookPage;
use std::path::Path;

/// See the module.
pub(crate) const CHORE: Chore = Chore { command, run };

/// All pages of commands with pictures.
const COOKBOOK_PAGES: [&CookbookPage; 2] = [&cookbook::PAGE, &lettering::PAGE];

/// The picture of docs/gimp.md and the README, and the command that draws it.
const GIMP_PICTURE: &str = "docs/images/gimp-paper.png";
const GIMP_EXAMPLE: &str = "shaper samples/paper.xcf --base '#Base' --target '#Target' --shaper '#Shaper'";

/// The sheet of styles that the README shows, and its artwork.
const SHEET: &str = "docs/images/styles.png";
const SHEET_ARTWORK: &str = "samples/logo.svg";

fn command() -> Command {
    Command::new("docs")
        .about("Write a page and a picture for every deformation, the cookbook, and the pictures of the guides")
        .arg(program_option())
}

fn run(arguments: &ArgMatches) -> Result<String, ChoreError> {
    let root = &workspace();
    let pages = deformations::write(root)?;
    let program = &shell::program(root, arguments)?;
    deformations::draw(root, program)?;
    shell::preview(root, program, GIMP_EXAMPLE, &root.join(GIMP_PICTURE))?;
    shell::pipe(root, program, &["gallery", SHEET_ARTWORK, "-o", SHEET].map(str::to_owned), &[])?;
    guides::draw(root, program)?;
    coming_from::write(root, program)?;
    shapes::write(root, program)?;
    for page in COOKBOOK_PAGES {
        write_cookbook(page, root, program)?;
    }
    let entries: usize = COOKBOOK_PAGES.iter().map(|page| page.entries.len()).sum();
    Ok(format!(
        "wrote {pages} pages of deformations and {entries} cookbook entries; look at every picture before you commit it"
    ))
}

fn write_cookbook(page: &CookbookPage, root: &Path, program: &Path) -> Result<(), ChoreError> {
    page.write(root)?;
    for entry in page.entries {
        shell::preview(root, program, entry.command, &page.picture(root, entry))?;
    }
    Ok(())
}

/// The command of every cookbook entry, without the leading `pathwarp`.
pub(crate) fn cookbook_commands() -> impl Iterator<Item = &'static str> {
    COOKBOOK_PAGES.iter().flat_map(|page| page.entries).map(|entry| entry.command)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The pages in the repository match their source, with exactly one picture for every entry.
    #[test]
    fn cookbook_pages_are_up_to_date() {
        let root = workspace();
        for page in COOKBOOK_PAGES {
            let stored = std::fs::read_to_string(root.join(page.file)).unwrap_or_default();
            assert!(stored == page.text(), "{} is out of date: run `cargo xtask docs`", page.file);
            let mut expected: Vec<String> = page.entries.iter().map(|e| format!("{}.png", e.name)).collect();
            let files = std::fs::read_dir(page.folder(&root)).unwrap();
            let mut found: Vec<String> = files.map(|f| f.unwrap().file_name().into_string().unwrap()).collect();
            expected.sort();
            found.sort();
            assert_eq!(expected, found);
        }
    }
}
