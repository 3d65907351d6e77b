//! [`Host`]: the editor's interface to the program that contains it, which knows files, formats and options.

use crate::words::Words;
use pathwarp::Outline;
use pathwarp::deform::{Info, Registry};
use pathwarp::kurbo::{Point, Rect};
use pathwarp::recipe::{BuiltRecipe, Recipe};
use pathwarp_svg::{Document, ReadOptions};
use serde::Deserialize;
use std::fmt;
use std::path::{Path, PathBuf};

/// The usual width of pictures, in px: enough for a full screen.
const PICTURE_WIDTH: u32 = 2000;

/// The properties of a picture of a drawing.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(default)]
pub struct PictureOptions {
    /// The width in px, if `scale` is `None`.
    pub width: u32,
    /// Pixels for each px of the drawing.
    pub scale: Option<f32>,
    /// The colour behind the drawing, as in CSS. Without one, pictures are transparent, and JPEG files white.
    pub background: Option<String>,
}

impl Default for PictureOptions {
    fn default() -> Self {
        Self { width: PICTURE_WIDTH, scale: None, background: None }
    }
}

impl PictureOptions {
    /// Returns the options of `pathwarp render` for such a picture.
    pub(crate) fn options(&self) -> Vec<(&'static str, String)> {
        let size = self.scale.map_or_else(|| ("width", self.width.to_string()), |s| ("scale", s.to_string()));
        let background = self.background.as_ref().map(|b| ("background", b.clone()));
        [size].into_iter().chain(background).collect()
    }
}

/// The program that contains the editor. Errors are sentences for the user.
pub trait Host: Send + Sync {
    /// Returns the available deformations.
    fn registry(&self) -> &Registry;

    /// Returns the edits, which change a drawing before it is bent and therefore come before all other steps.
    fn first(&self) -> &[Info];

    /// Returns names of deformations in other programs, which users may search for, each with the deformation's name.
    fn foreign_words(&self) -> Vec<(&str, &str)>;

    /// Returns the families of the available fonts.
    ///
    /// # Errors
    /// A sentence if the options that name fonts are wrong.
    fn families(&self) -> Result<Vec<String>, String>;

    /// Sets words as a drawing, and lists the characters that no font has.
    ///
    /// # Errors
    /// A sentence if the font is missing, or the words cannot be set.
    fn set_words(&self, words: &Words) -> Result<(String, Vec<char>), String>;

    /// Reads a drawing. For the result of an earlier run with its source embedded, this is the source, with its recipe.
    ///
    /// # Errors
    /// A sentence if the bytes are not a readable drawing.
    fn open(&self, file: &Path, bytes: &[u8]) -> Result<Opened, String>;

    /// Returns the text that names a file in a step.
    fn reference(&self, file: &Path) -> String;

    /// Writes a file completely or not at all.
    ///
    /// # Errors
    /// A sentence if the file cannot be written.
    fn write(&self, to: &Path, bytes: &[u8]) -> Result<(), String>;
}

/// A drawing that has been opened.
pub struct Opened {
    /// The drawing to bend.
    pub artwork: Box<dyn Artwork>,
    /// The steps of the file; empty if it was not made by bending.
    pub recipe: Recipe,
    /// `true` for the result of an earlier run, which saving replaces.
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
    /// Returns the drawing.
    fn document(&self) -> &Document;

    /// Returns the drawing with the texts that the recipe's `caption` steps set.
    ///
    /// # Errors
    /// A sentence if a caption cannot be set.
    fn captioned(&mut self, recipe: &Recipe) -> Result<&Document, String>;

    /// Returns the options for reading the drawing and its results.
    fn reading(&self) -> &ReadOptions;

    /// Returns the box that percentages of the first step refer to.
    fn frame(&self) -> Rect;

    /// Returns the outlines of the artwork.
    fn outlines(&self) -> Vec<&Outline>;

    /// Bends the drawing by a recipe.
    ///
    /// # Errors
    /// A sentence if a step cannot be built, or the drawing cannot be bent.
    fn bend(&mut self, recipe: &Recipe, fineness: Fineness) -> Result<Bent, String>;

    /// Bends the drawing and writes it in the format of `to`'s extension: an SVG with its recipe and source, and with linked pictures
    /// embedded unless it `stays` on this machine. Returns the bytes and the losses of the format.
    ///
    /// # Errors
    /// A sentence if a step cannot be built, the drawing cannot be bent, or the format is unknown.
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
    /// A sentence if a step cannot be built.
    fn settle(&mut self, recipe: &Recipe) -> Result<(Recipe, BuiltRecipe), String>;

    /// Returns the options, by name, that a command line needs beside a recipe's steps for the same result.
    fn options(&self) -> Vec<(String, String)>;

    /// Returns the text of a recipe file with these steps.
    ///
    /// # Errors
    /// A sentence if the recipe cannot be written as text.
    fn recipe_text(&self, recipe: &Recipe) -> Result<String, String>;
}

/// The quality of a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fineness {
    /// For dragging: curves within this distance in user units, affine fits of gradients, no report.
    Draft(f64),
    /// For thumbnails: a draft, for which a bitmap replaces a large drawing.
    Small(f64),
    /// The final result, on the page of the source.
    Exact,
}

/// A drawing bent by a recipe.
#[derive(Debug)]
pub struct Bent {
    /// The result's text.
    pub svg: String,
    /// The page of the saved result in user units, if it differs from the source's.
    pub page: Option<Rect>,
    /// The recipe with its references looked up.
    pub resolved: Recipe,
    /// The recipe, built.
    pub built: BuiltRecipe,
    /// Measures of the result; `None` for a draft.
    pub summary: Option<Summary>,
    /// Messages about the result.
    pub warnings: Vec<String>,
}

/// Measures of a bent drawing.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Summary {
    /// Number of segments of the drawing.
    pub segments_in: usize,
    /// Number of segments of the result.
    pub segments_out: usize,
    /// The largest distance to the exact image, in user units.
    pub max_error: f64,
    /// The tolerance in user units.
    pub tolerance: f64,
    /// The shapes that fold over, each with the point of the source where that begins.
    pub folds: Vec<(String, Point)>,
}

/// The use of the finished steps.
#[derive(Debug, Clone)]
pub enum Purpose {
    /// Results are saved to files.
    Files {
        /// The file that *Save* writes; `None` for a name beside the drawing.
        out: Option<PathBuf>,
    },
    /// A program waits for the steps, and nothing is written. It is an error if the editor does not open in a browser.
    Program {
        /// The program's name.
        name: String,
        /// The drawing's name in the program.
        drawing: String,
    },
}

impl Purpose {
    /// Returns the name of the program that waits, if any.
    pub(crate) fn program(&self) -> Option<&str> {
        if let Self::Program { name, .. } = self { Some(name) } else { None }
    }
}
