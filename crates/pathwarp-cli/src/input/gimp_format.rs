//! File names of GIMP's formats, and the format of a result.

use super::gimp_file::GimpFile;
use super::read::display;
use super::reference_name::split_reference;
use crate::failure::Failure;
use crate::format::{Choice, Format};
use crate::options::CommonOptions;
use pathwarp_gimp::FileKind;
use std::path::Path;

/// The form in which warped GIMP paths are written.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum GimpFormat {
    Paths(Format),
    /// A copy of the input XCF.
    IntoXcf,
}

/// The formats of GIMP paths.
pub(crate) const PATHS: &[Format] = &[Format::Svg, Format::Svgz, Format::Pdf, Format::Dxf, Format::PointList];

/// The format for the options and the target, `None` being standard output.
///
/// # Errors
/// The options ask for something that this file cannot be written as.
pub(super) fn format(options: &CommonOptions, input: &GimpFile, target: Option<&Path>) -> Result<GimpFormat, Failure> {
    if options.embed_recipe {
        return Err(Failure::usage(
            "--embed-recipe is for SVG files; --write-recipe saves the recipe beside the result",
        ));
    }
    if let Some(copy) = &options.into {
        check_into(input, copy)?;
        return Ok(GimpFormat::IntoXcf);
    }
    if target.is_some_and(|t| Format::of(t) == Some(Format::Xcf)) {
        return Err(Failure::usage(
            "an XCF holds more than paths; --into COPY.xcf writes a copy of the input with its paths warped (--into \
             INPUT.xcf --in-place overwrites the input)",
        ));
    }
    Ok(GimpFormat::Paths(Choice { what: "GIMP paths are", among: PATHS }.format(target, options.format)?))
}

/// Checks that the paths of `input` can be written into its copy.
fn check_into(input: &GimpFile, copy: &Path) -> Result<(), Failure> {
    let problem = match input.file.kind {
        FileKind::Xcf(_) if input.damage.is_some() => "is damaged; write its paths to SVG or JSON (-o)",
        FileKind::Xcf(_) => "",
        FileKind::PackedXcf(_) => "is packed; unpack it first",
        _ => "is not an XCF",
    };
    if !problem.is_empty() {
        let file = display(&input.path);
        return Err(Failure::usage(format!("--into copies a plain, undamaged XCF; {file} {problem}")));
    }
    if !copy.extension().is_some_and(|e| e.eq_ignore_ascii_case("xcf")) {
        return Err(Failure::usage(format!("--into writes an XCF; give {} the extension .xcf", copy.display())));
    }
    Ok(())
}

/// The name of the SVG made from a GIMP input: `art.xcf.gz#Cage` gives `art-Cage.svg`. `None` for other inputs.
pub(crate) fn svg_name(input: &Path) -> Option<String> {
    const ENDINGS: [&str; 6] = [".xcf", ".xcf.gz", ".xcf.bz2", ".xcf.xz", ".json", ".txt"];
    let text = input.to_string_lossy();
    let (file, name) = if input.is_file() { (input.to_owned(), None) } else { split_reference(&text) };
    let file = file.file_name()?.to_string_lossy().into_owned();
    let stem = ENDINGS.iter().rev().find_map(|e| file.strip_suffix(e))?;
    Some(match name {
        Some(name) => format!("{stem}-{}.svg", file_name(name)),
        None => format!("{stem}.svg"),
    })
}

/// A path's name as part of a file name: letters and digits of any script are kept, everything else becomes a hyphen.
pub(crate) fn file_name(name: &str) -> String {
    let plain = name.chars().map(|c| if c.is_alphanumeric() || matches!(c, '_' | '.' | '-') { c } else { '-' });
    plain.collect::<String>().trim_matches(['-', '.']).to_owned()
}
