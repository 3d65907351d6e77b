//! The deformations: one file each, and this list of them.
//!
//! To add one, write `NAME.rs` and two lines here (`cargo xtask new-deformation NAME` does both).

mod affine;
mod anamorph;
mod bend;
mod bilinear;
mod birational;
mod bulge;
mod envelope;
mod expr;
mod ffd;
mod lens;
mod mesh;
mod mls;
mod mobius;
mod polar;
mod projective;
mod shaper;
mod similitude;
mod swirl;
mod triangle;
mod warp;
mod wave;
mod wordart;

use crate::error::Error;
use crate::map::Map;
use crate::param::{Args, Frame, Param, Settings};
use kurbo::{Affine, BezPath, Point};
use std::sync::Arc;

/// The deformations of this crate, in the order `pathwarp list` shows them.
#[must_use]
pub fn builtin() -> Vec<Arc<dyn Deformation>> {
    vec![
        Arc::new(shaper::Shaper),
        Arc::new(envelope::Envelope),
        Arc::new(warp::Warp),
        Arc::new(wordart::WordArt),
        Arc::new(bilinear::Bilinear),
        Arc::new(birational::BirationalDeformation),
        Arc::new(bend::Bend),
        Arc::new(polar::Polar),
        Arc::new(ffd::Ffd),
        Arc::new(mesh::Mesh),
        Arc::new(triangle::Triangle),
        Arc::new(mls::Mls),
        Arc::new(projective::Projective),
        Arc::new(anamorph::Anamorph),
        Arc::new(wave::Wave),
        Arc::new(swirl::Swirl),
        Arc::new(bulge::Bulge),
        Arc::new(lens::Lens),
        Arc::new(mobius::Mobius),
        Arc::new(expr::Expr),
        Arc::new(similitude::Similitude),
        Arc::new(affine::AffineDeformation),
    ]
}

/// An entry of the registry: builds a [`Map`] from [`Args`] in a [`Frame`].
pub trait Deformation: Send + Sync {
    /// What it is, for people and programs.
    fn info(&self) -> &Info;

    /// The map for these settings.
    ///
    /// # Errors
    /// [`Error::Usage`] for values that contradict each other, [`Error::Geometry`] where the anchors allow no such map.
    fn build(&self, settings: &Settings<'_>) -> Result<Built, Error>;

    /// Checks `args` against the parameter table and builds the map.
    ///
    /// # Errors
    /// As [`Settings::new`] and [`Deformation::build`].
    fn build_from(&self, args: &Args, frame: &Frame) -> Result<Built, Error> {
        self.build(&Settings::new(self.info().params, args, frame)?)
    }
}

/// A deformation described.
#[derive(Debug, Clone, Copy)]
pub struct Info {
    /// Its name, kebab-case: the subcommand.
    pub name: &'static str,
    /// One line for the menu.
    pub title: &'static str,
    /// The menu heading it stands under.
    pub group: &'static str,
    /// What it does and when to reach for it, for help and docs: plain sentences.
    pub about: &'static str,
    /// Where the mathematics comes from.
    pub source: &'static str,
    /// Its parameters.
    pub params: &'static [Param],
    /// Values for the needed parameters that show what it does on artwork in the frame 0,0,100,100.
    pub demo: &'static [(&'static str, &'static str)],
    /// Command lines for help; the tests run every one.
    pub examples: &'static [Example],
    /// What holds for every instance; [`check::entry`](crate::check::entry) tests it.
    pub laws: &'static [Law],
    /// Values known from elsewhere; [`check::entry`](crate::check::entry) tests them.
    pub cases: &'static [Case],
}

/// A command line for help.
#[derive(Debug, Clone, Copy)]
pub struct Example {
    /// What it does.
    pub what: &'static str,
    /// The words after `pathwarp`, run from the project's root, `-o out.svg` included.
    pub command: &'static str,
}

/// Values of parameters, as typed.
pub type Pairs = &'static [(&'static str, &'static str)];

/// Something that always holds.
#[derive(Debug, Clone, Copy)]
pub enum Law {
    /// With these values nothing moves.
    Identity(Pairs),
    /// Both sets of values give the same map.
    Same(Pairs, Pairs),
    /// With these values straight lines stay straight.
    KeepsLines(Pairs),
    /// With these values straight lines in this direction stay straight.
    KeepsLinesAlong(Pairs, (f64, f64)),
    /// With these values nothing moves outside the box x0, y0, x1, y1.
    FixedOutside(Pairs, [f64; 4]),
    /// With these values every area is multiplied by this.
    Area(Pairs, f64),
    /// With these values angles between curves are kept (and nothing is mirrored).
    KeepsAngles(Pairs),
    /// The second set of values takes every point back to where it was before the first.
    Undoes(Pairs, Pairs),
}

/// A known value.
#[derive(Debug, Clone, Copy)]
pub struct Case {
    /// The parameters, in the frame 0,0,100,100.
    pub args: Pairs,
    /// A point of the source.
    pub at: (f64, f64),
    /// Where it goes.
    pub to: (f64, f64),
    /// How far off it may be, user units.
    pub tolerance: f64,
}

/// A deformation with its parameters settled.
#[derive(Clone)]
pub struct Built {
    /// The map.
    pub map: Arc<dyn Map>,
    /// What was decided on the user's behalf (`--explain`).
    pub notes: Vec<String>,
    /// What a preview draws over the artwork.
    pub overlays: Vec<Overlay>,
    /// What the user should know: said as warnings, and in the report.
    pub warnings: Vec<String>,
    /// A ray in the image plane, by its end and another point of it, where the map brings two edges of the artwork together: the
    /// inverse tears apart what crosses it, and a recipe that wants the inverse warns of that.
    pub seam: Option<[Point; 2]>,
    /// Files asked for by parameters of kind [`Save`](crate::param::Kind::Save): name and text.
    pub saves: Vec<(String, String)>,
    /// The artwork as often as the map is to bend it: where each copy stands in the source plane, the original included. Empty:
    /// the artwork alone. A map gives every point one image, so that copies are made before it; only the first step of a
    /// recipe can ask for them.
    pub copies: Vec<Affine>,
    /// For every letter of the frame the places it goes to, instead of where the map takes it: one affine map for each copy of
    /// the artwork. Empty: the map takes the letters as well. Only the first step of a recipe can place letters.
    pub letters: Vec<Vec<Affine>>,
    /// Where the source's points lie in space (x right, y down, z away, user units), for deformations onto surfaces: for the
    /// files that `--mesh` and `--curves` ask for. `None` where the surface is not met.
    pub space: Option<IntoSpace>,
}

/// Takes points of the source into space.
pub type IntoSpace = Arc<dyn Fn(Point) -> Option<[f64; 3]> + Send + Sync>;

impl Built {
    /// Just a map.
    #[must_use]
    pub fn new(map: Arc<dyn Map>) -> Self {
        Self {
            map,
            notes: Vec::new(),
            overlays: Vec::new(),
            warnings: Vec::new(),
            seam: None,
            saves: Vec::new(),
            copies: Vec::new(),
            letters: Vec::new(),
            space: None,
        }
    }
}

/// What an overlay stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// The cage the artwork is bent into.
    Cage,
    /// Where the deformation takes hold of the source.
    Base,
    /// Where it puts the result.
    Target,
}

/// A guide for the preview.
#[derive(Debug, Clone, PartialEq)]
pub struct Overlay {
    /// What it stands for.
    pub role: Role,
    /// Its curve, run in the order in which the deformation uses its anchors.
    pub path: BezPath,
}

/// The deformations a program knows.
#[derive(Clone)]
pub struct Registry {
    entries: Vec<Arc<dyn Deformation>>,
}

impl Registry {
    /// The deformations of this crate.
    #[must_use]
    pub fn builtin() -> Self {
        Self { entries: builtin() }
    }

    /// The same with one more; a name that is already there is replaced.
    #[must_use]
    pub fn with(mut self, entry: impl Deformation + 'static) -> Self {
        self.entries.retain(|e| e.info().name != entry.info().name);
        self.entries.push(Arc::new(entry));
        self
    }

    /// All entries, in menu order.
    #[must_use]
    pub fn entries(&self) -> &[Arc<dyn Deformation>] {
        &self.entries
    }

    /// The entry called `name`.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&Arc<dyn Deformation>> {
        self.entries.iter().find(|e| e.info().name == name)
    }
}
