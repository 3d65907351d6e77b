//! [`Host`]: what the editor needs from the program around it, which knows files, formats and options.

use crate::words::Words;
use pathwarp::Outline;
use pathwarp::deform::{Info, Registry};
use pathwarp::kurbo::{Point, Rect};
use pathwarp::recipe::{BuiltRecipe, Recipe};
use pathwarp_svg::{Document, ReadOptions};
use serde::Deserialize;
use std::fmt;
use std::path::{Path, PathBuf};

/// The usual width of pictures, in px: enough for a screen in full.
const PICTURE_WIDTH: u32 = 2000;

/// What a picture of a drawing is like.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(default)]
pub struct PictureOptions {
    /// The width in px, unless there is a scale.
    pub width: u32,
    /// Pixels for each px of the drawing.
    pub scale: Option<f32>,
    /// The colour behind the drawing, as in CSS; `None` for none, which is white in a JPEG.
    pub background: Option<String>,
}

impl Default for PictureOptions {
    fn default() -> Self {
        Self { width: PICTURE_WIDTH, scale: None, background: None }
    }
}

impl PictureOptions {
    /// The options of `pathwarp render` for such a picture.
    pub(crate) fn options(&self) -> Vec<(&'static str, String)> {
        let size = self.scale.map_or_else(|| ("width", self.width.to_string()), |s| ("scale", s.to_string()));
        let background = self.background.as_ref().map(|b| ("background", b.clone()));
        [size].into_iter().chain(background).collect()
    }
}

/// The program around the editor. Errors are sentences for the user.
pub trait Host: Send + Sync {
    /// The deformations on offer.
    fn registry(&self) -> &Registry;

    /// What changes a drawing before it is bent, as steps that come before all others.
    fn first(&self) -> &[Info] {
        &[]
    }

    /// Names that other programs have for deformations, each with that of the deformation: what a user may search for.
    fn foreign_words(&self) -> Vec<(&str, &str)> {
        Vec::new()
    }

    /// The families of the fonts there are.
    ///
    /// # Errors
    /// The options that name fonts are wrong.
    fn families(&self) -> Result<Vec<String>, String>;

    /// Sets words as a drawing, and lists the characters that no font has.
    ///
    /// # Errors
    /// The font is missing, or the words cannot be set.
    fn set_words(&self, words: &Words) -> Result<(String, Vec<char>), String>;

    /// Reads a drawing. If it is the result of an earlier run with its source embedded, that source is opened, with its recipe.
    ///
    /// # Errors
    /// The bytes are not a drawing that can be read.
    fn open(&self, file: &Path, bytes: &[u8]) -> Result<Opened, String>;

    /// The text that names a file in a step.
    fn reference(&self, file: &Path) -> String;

    /// Writes a file completely or not at all.
    ///
    /// # Errors
    /// The file cannot be written.
    fn write(&self, to: &Path, bytes: &[u8]) -> Result<(), String>;
}

/// A drawing that has been read.
pub struct Opened {
    /// The drawing to be bent.
    pub artwork: Box<dyn Artwork>,
    /// The steps that the file was made by; empty for a drawing that was not bent.
    pub recipe: Recipe,
    /// The file is the result of an earlier run, so saving replaces it.
    pub is_result: bool,
}

impl fmt::Debug for Opened {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Opened")
            .field("recipe", &self.recipe)
            .field("is_result", &self.is_result)
            .finish_non_exhaustive()
    }
}

/// A drawing, ready to be bent again and again.
pub trait Artwork: Send {
    /// The drawing.
    fn document(&self) -> &Document;

    /// The drawing with the captions of a recipe.
    ///
    /// # Errors
    /// A caption cannot be set.
    fn captioned(&mut self, recipe: &Recipe) -> Result<&Document, String>;

    /// The options that it was read with, which results are read with, too.
    fn reading(&self) -> &ReadOptions;

    /// The box that percentages of the first step refer to.
    fn frame(&self) -> Rect;

    /// The outlines of the artwork.
    fn outlines(&self) -> Vec<&Outline>;

    /// Bends the drawing by a recipe.
    ///
    /// # Errors
    /// A step cannot be built, or the drawing cannot be bent.
    fn bend(&mut self, recipe: &Recipe, fineness: Fineness) -> Result<Bent, String>;

    /// Bends the drawing and writes it in the format that the extension of `to` names, an SVG with the recipe and the source in it, and with
    /// its linked pictures if it does not `stay` on this machine. Returns the bytes and what the format cannot hold.
    ///
    /// # Errors
    /// As for [`bend`](Self::bend), or the format is unknown.
    fn written(
        &mut self,
        recipe: &Recipe,
        to: &Path,
        stays: bool,
        picture: &PictureOptions,
    ) -> Result<(Vec<u8>, Vec<String>), String>;

    /// Looks up the recipe's references and builds its steps, without bending anything.
    ///
    /// # Errors
    /// A step cannot be built.
    fn settle(&mut self, recipe: &Recipe) -> Result<(Recipe, BuiltRecipe), String>;

    /// The options that the command line would need for the same result beside those of the steps, by name.
    fn options(&self) -> Vec<(String, String)>;

    /// The text of a recipe file with these steps.
    ///
    /// # Errors
    /// The recipe cannot be written as text.
    fn recipe_text(&self, recipe: &Recipe) -> Result<String, String>;
}

/// The effort that a picture is worth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fineness {
    /// While something is dragged: curves within this distance in user units, gradients by affine fits, no report.
    Draft(f64),
    /// For a picture of some dozens of pixels: as a draft, and of a large drawing only a bitmap is bent.
    Small(f64),
    /// As the program writes it, but on the page of the source.
    Exact,
}

/// A drawing under a recipe.
#[derive(Debug)]
pub struct Bent {
    /// The text of the result.
    pub svg: String,
    /// The page that the saved result has, if that is not the source's, in user units.
    pub page: Option<Rect>,
    /// The recipe with its references looked up.
    pub resolved: Recipe,
    /// The recipe, built.
    pub built: BuiltRecipe,
    /// What was done; `None` for a draft.
    pub summary: Option<Summary>,
    /// Messages about the result.
    pub warnings: Vec<String>,
}

/// What was done to a drawing.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Summary {
    /// Segments of the drawing before.
    pub segments_in: usize,
    /// Segments of the result.
    pub segments_out: usize,
    /// The largest distance to the exact image, in user units.
    pub max_error: f64,
    /// The distance that was asked for, in user units.
    pub tolerance: f64,
    /// The shapes that fold over, with the places in the source where they begin to.
    pub folds: Vec<(String, Point)>,
}

/// The use of the steps once they are chosen.
#[derive(Debug, Clone)]
pub enum Purpose {
    /// Results are saved to files; `out` is the one that *Save* writes, `None` a name beside the drawing.
    Files {
        /// The file that *Save* writes.
        out: Option<PathBuf>,
    },
    /// A program waits for the steps, and nothing is written. Without a page, it would wait in vain, so that is an error.
    Program {
        /// Its name.
        name: String,
        /// The drawing's name there.
        drawing: String,
    },
}

impl Purpose {
    /// The program that waits.
    pub(crate) fn program(&self) -> Option<&str> {
        if let Self::Program { name, .. } = self { Some(name) } else { None }
    }
}
