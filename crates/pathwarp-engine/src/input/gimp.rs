//! GIMP's paths as artwork: read into a drawing, bent like any other, and written in a format that GIMP reads.

use super::artwork::WarpedResult;
use super::files::{display, split_reference};
use super::gimp_file::GimpFile;
use super::svg::SvgArtwork;
use crate::export::{self, Exported, KerfReport};
use crate::failure::Failure;
use crate::format::{Choice, Format};
use crate::options::CommonOptions;
use crate::output::PendingFile;
use crate::report::ReportedShape;
use pathwarp::budget::Limits;
use pathwarp::{Error, Outline};
use pathwarp_gimp::{FileKind, GimpPath, Stroke, rewrite, to_svg};
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

/// Warnings, and the changes made by `--kerf`.
type Notices = (Vec<String>, Option<KerfReport>);

pub(super) use pathwarp_gimp::{HEAD, may_begin};

/// Opens an input for its paths; `None` if it is no GIMP file.
pub(super) fn open(
    input: &Path,
    options: &CommonOptions,
    target: Option<&Path>,
) -> Result<Option<SvgArtwork>, Failure> {
    let Some(file) = GimpFile::open(input, options.salvage, &options.reading.limits)? else { return Ok(None) };
    let format = format(options, &file, target)?;
    Ok(Some(SvgArtwork::of_paths(GimpPaths::new(file, options)?, format, options)?))
}

/// Returns the path called `name`, or the only one, of a file, in pixels; `None` if the file is not GIMP's.
pub fn gimp_outline(file: &Path, name: Option<&str>, limits: &Limits) -> Result<Option<Outline>, Error> {
    let Some(file) = GimpFile::read(file, false, limits)? else { return Ok(None) };
    Ok(Some(name.map_or_else(|| file.only_path(), |name| file.path_named(name))?.outline()))
}

/// The paths of a GIMP file, as the source of a drawing.
pub(super) struct GimpPaths {
    pub(super) file: GimpFile,
    /// The indices of the paths in the drawing, in its order.
    chosen: Vec<usize>,
}

impl GimpPaths {
    /// Selects paths by the options.
    fn new(file: GimpFile, options: &CommonOptions) -> Result<Self, Failure> {
        let (select, exclude) = (&options.select, &options.exclude);
        let name = |selector: &String| selector.strip_prefix('#').unwrap_or(selector).to_owned();
        select.iter().chain(exclude).try_for_each(|s| file.path_named(&name(s)).map(|_| ()))?;
        let is_among = |p: &GimpPath, list: &[String]| list.iter().any(|s| name(s) == p.name);
        let is_chosen = |p: &GimpPath| {
            !p.strokes.is_empty()
                && file.only.as_ref().is_none_or(|only| *only == p.name)
                && (select.is_empty() || is_among(p, select))
                && !is_among(p, exclude)
        };
        let all = file.file.paths.iter().enumerate();
        let chosen = all.filter(|(_, p)| is_chosen(p)).map(|(i, _)| i).collect();
        Ok(Self { file, chosen })
    }

    pub(super) fn name(&self) -> String {
        display(&self.file.path)
    }

    /// Returns the drawing. Its user space is the canvas.
    pub(super) fn drawing(&self) -> String {
        /// Enough decimals to tell all numbers apart.
        const ALL: u8 = 17;
        let paths: Vec<GimpPath> = self.chosen.iter().map(|&i| self.file.file.paths[i].clone()).collect();
        to_svg(self.file.canvas(), &paths, Some(ALL))
    }

    /// Reads the paths of a result, which are the chosen ones in their order. Unchanged paths keep data that SVG cannot hold.
    fn warped(&self, svg: &str) -> Result<Vec<GimpPath>, Failure> {
        if self.chosen.is_empty() {
            return Ok(Vec::new());
        }
        let read = |text: &str| {
            pathwarp_gimp::read(text.as_bytes()).map_err(|e| Failure::Input(format!("{}: {e}", self.name())))
        };
        let all = self.chosen.iter().zip(read(&self.drawing())?).zip(read(svg)?);
        let path = |((i, before), after): ((&usize, GimpPath), GimpPath)| {
            let source = &self.file.file.paths[*i];
            let strokes = if before == after { source.strokes.clone() } else { after.strokes };
            GimpPath { strokes, ..source.clone() }
        };
        Ok(all.map(path).collect())
    }

    /// Writes the paths of a result: without `guides` in a format, or all into a copy of the XCF, which raises no warnings.
    pub(super) fn written(
        &self,
        svg: &str,
        guides: &[String],
        (format, options, tolerance): (Format, &CommonOptions, f64),
        shapes: &mut [ReportedShape],
    ) -> Result<(WarpedResult, Notices), Failure> {
        let mut paths = self.warped(svg)?;
        let Some(copy) = &options.into else {
            paths.retain(|p| !guides.contains(&p.name));
            let Exported { bytes, warnings, kerf } =
                export::paths(self.file.canvas(), &paths, format, options, Some(tolerance))?;
            return Ok((WarpedResult::Bytes(bytes), (warnings, kerf)));
        };
        for s in shapes {
            let strokes = paths.iter().filter(|p| p.name == s.shape.id).flat_map(|p| &p.strokes);
            s.shape.path.max_error += strokes.map(single_precision_error).fold(0.0, f64::max);
        }
        let strokes = self.chosen.iter().copied().zip(paths.into_iter().map(|p| p.strokes));
        let copy = copy_with_paths(&self.file.path, copy, &strokes.collect::<Vec<_>>())?;
        Ok((WarpedResult::File(copy), Notices::default()))
    }
}

/// Copies the XCF `from` to `copy` with new strokes for some paths.
fn copy_with_paths(from: &Path, copy: &Path, strokes: &[(usize, Vec<Stroke>)]) -> Result<PendingFile, Failure> {
    let source = File::open(from).map_err(|e| Failure::file(from, format!("cannot be read: {e}")))?;
    PendingFile::with_writer(copy, |file| {
        let mut to = BufWriter::new(file);
        rewrite(source, &mut to, strokes).map_err(|e| e.to_string())?;
        to.flush().map_err(|e| format!("cannot be written: {e}"))
    })
}

/// Returns the largest distance by which rounding to single precision, which an XCF uses, moves a point of the stroke.
fn single_precision_error(s: &Stroke) -> f64 {
    let error = |v: f64| f64::from(v as f32) - v;
    s.points.iter().map(|&[x, y]| error(x).hypot(error(y))).fold(0.0, f64::max)
}

/// The formats of GIMP paths.
pub(crate) const PATHS: &[Format] = &[Format::Svg, Format::Svgz, Format::Pdf, Format::Dxf, Format::PointList];

/// Chooses the format by the options and the target, `None` being standard output.
///
/// # Errors
/// [`Failure::Usage`] if this file cannot be written as the options ask.
fn format(options: &CommonOptions, input: &GimpFile, target: Option<&Path>) -> Result<Format, Failure> {
    if options.embed_recipe {
        let advice = "--write-recipe saves the recipe beside the result";
        return Err(Failure::usage(format!("--embed-recipe is for SVG files; {advice}")));
    }
    if let Some(copy) = &options.into {
        check_into(input, copy)?;
        return Ok(Format::Svg);
    }
    if target.is_some_and(|t| Format::of(t) == Some(Format::Xcf)) {
        return Err(Failure::usage(
            "an XCF holds more than paths; --into COPY.xcf writes a copy of the input with its paths warped (--into \
             INPUT.xcf --in-place overwrites the input)",
        ));
    }
    Choice { what: "GIMP paths are", among: PATHS }.format(target, options.format)
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

/// Returns the name of the SVG made from a GIMP input: `art.xcf.gz#Cage` gives `art-Cage.svg`. `None` for other inputs.
pub fn svg_name(input: &Path) -> Option<String> {
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

/// Makes a path's name fit for a file's: letters and digits of any script are kept, everything else becomes a hyphen.
pub fn file_name(name: &str) -> String {
    let plain = name.chars().map(|c| if c.is_alphanumeric() || matches!(c, '_' | '.' | '-') { c } else { '-' });
    plain.collect::<String>().trim_matches(['-', '.']).to_owned()
}
