//! What the editor gets from the command line: reading, options, formats, safe writing.

use super::artwork::EditedArtwork;
use crate::advice::Flags;
use crate::bitmap::encode;
use crate::coming_from;
use crate::export;
use crate::failure::Failure;
use crate::format::{Choice, DRAWINGS, Format, PICTURES};
use crate::input::{SvgArtwork, read_options};
use crate::options::Given;
use crate::output::PendingFile;
use crate::recipe_file;
use pathwarp::deform::Registry;
use pathwarp::recipe::Recipe;
use pathwarp_editor::{Host, Opened};
use pathwarp_raster::{RenderOptions, Size};
use pathwarp_svg::{Origin, ReadOptions, usvg_tree};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The width of pictures, in px: enough for a screen in full.
const PICTURE_WIDTH: u32 = 2000;

/// The command line around the editor.
pub(crate) struct EditorHost {
    registry: Arc<Registry>,
    /// Options where neither the user nor the drawing gives any.
    usual: Given,
    /// The options as given.
    given: Given,
    /// The files of plug-ins that a command line has to name.
    plugins: Vec<String>,
    flags: Arc<Flags>,
}

impl EditorHost {
    pub(crate) fn new(registry: Registry, usual: Given, given: Given) -> Self {
        let flags = Arc::new(Flags::of(&registry));
        Self { registry: Arc::new(registry), usual, given, plugins: Vec::new(), flags }
    }

    /// Names the files of plug-ins in command lines.
    pub(crate) fn with_plugins(self, files: &[PathBuf]) -> Self {
        Self { plugins: files.iter().map(|f| f.display().to_string()).collect(), ..self }
    }

    fn open_drawing(&self, file: &Path, bytes: &[u8]) -> Result<Opened, Failure> {
        let reading = self.given.read()?.reading;
        reading.check()?;
        let limits = reading.limits.for_input(bytes.len());
        let origin = Origin::of_file(bytes, "the drawing", &limits).unwrap_or(None);
        let folder = file.parent().unwrap_or(Path::new(""));
        let (source, saved) = match &origin {
            Some(origin) => {
                let saved = recipe_file::from_text(&*self.registry, &origin.recipe, folder, reading.external);
                (origin.source.as_slice(), Some(saved.map_err(|e| Failure::file(file, e))?))
            }
            None => (bytes, None),
        };
        let is_result = saved.is_some();
        let (recipe, given) = match saved {
            Some(saved) => (saved.recipe, self.usual.overridden_by(&saved.options).overridden_by(&self.given)),
            None => (Recipe::default(), self.usual.overridden_by(&self.given)),
        };
        let options = given.read()?;
        let svg = SvgArtwork::read(source, file, &options, None)?;
        let artwork = EditedArtwork::new(svg, &self.registry, given, options, &self.flags);
        let artwork = artwork.with_plugins(&self.plugins).in_folder(folder);
        Ok(Opened { artwork: Box::new(artwork), recipe, is_result })
    }

    fn converted(&self, svg: String, to: &Path) -> Result<(Vec<u8>, Vec<String>), Failure> {
        let options = self.given.read()?;
        let among: Vec<Format> = DRAWINGS.iter().chain(PICTURES).copied().collect();
        let format = Choice { what: "a drawing is", among: &among }.format(Some(to), None)?;
        let read = read_options(to, &options.reading);
        if format.of_picture(None).is_none() {
            let exported = export::drawing(svg, format, &read, &options, None)?;
            return Ok((exported.bytes, exported.warnings));
        }
        let tree = usvg_tree::parse_tree(svg.as_bytes(), "the result", &ReadOptions::default())?;
        let limits = options.reading.limits.for_input(svg.len());
        let drawn =
            RenderOptions { size: Size::Width(PICTURE_WIDTH), background: None }.render_within(&tree, &limits)?;
        Ok((encode(drawn, format, None)?, Vec::new()))
    }

    fn said<T>(&self, result: Result<T, Failure>) -> Result<T, String> {
        result.map_err(|f| f.message(&self.flags))
    }
}

impl Host for EditorHost {
    fn registry(&self) -> &Registry {
        &self.registry
    }

    fn foreign_words(&self) -> Vec<(&str, &str)> {
        let named = coming_from::all().filter_map(|w| Some((w.subcommand()?, w.words)));
        named.flat_map(|(name, words)| words.into_iter().map(move |w| (w, name))).collect()
    }

    fn open(&self, file: &Path, bytes: &[u8]) -> Result<Opened, String> {
        self.said(self.open_drawing(file, bytes))
    }

    fn reference(&self, file: &Path) -> String {
        recipe_file::from_here(file)
    }

    fn export(&self, svg: String, to: &Path) -> Result<(Vec<u8>, Vec<String>), String> {
        self.said(self.converted(svg, to))
    }

    fn write(&self, to: &Path, bytes: &[u8]) -> Result<(), String> {
        self.said(PendingFile::new(to, bytes).and_then(|file| PendingFile::commit_all(vec![file])))
    }
}
