//! `cargo xtask docs`: writes the generated pages and all pictures of the documentation.

mod coming_from;
mod deformations;
mod guides;
mod shapes;

use crate::chore::{Chore, ChoreError, program_option, workspace};
use crate::shell;
use clap::{ArgMatches, Command};

pub(crate) const CHORE: Chore = Chore { command, run };

/// The picture in docs/gimp.md and the README, and the command that draws it.
const GIMP_PICTURE: &str = "docs/images/gimp-paper.png";
const GIMP_EXAMPLE: &str = "shaper samples/paper.xcf --base '#Base' --target '#Target' --shaper '#Shaper'";

/// The sheet of styles in the README, and its artwork.
const SHEET: &str = "docs/images/styles.png";
const SHEET_ARTWORK: &str = "samples/logo.svg";

fn command() -> Command {
    Command::new("docs")
        .about("Write a page and a picture for every deformation, and the pictures of the guides")
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
    Ok(format!("wrote {pages} pages of deformations and all pictures; look at every picture before you commit it"))
}
