//! Meshes: artwork is bent by a quilt of bicubic patches, or by a warp that Photoshop stores with a layer.
//!
//! Each patch is the tensor product Bézier surface of sixteen points (see [`BicubicNet`](crate::map::BicubicNet)). Patches share the
//! points of the sides where they meet. Across a joint the map is C¹ if (p₊ − p)/after = (p − p₋)/before in every row, where p₋, p, p₊
//! are the control points around it, and before, after the patches' widths (G. Farin, *Curves and Surfaces for CAGD*, §15.4).

#[cfg(feature = "serde")]
mod file;
mod quilt;
#[cfg(test)]
mod tests;

use super::entry::{Built, ByHand, Case, Entry, Example, Info, Instead, Law, Role};
use crate::error::{Error, GeometryError, with_area};
use crate::map::Class;
use crate::param::{Kind, NamedText, Param, Settings};
use kurbo::{Point, Rect, Shape};
use quilt::{Contents, Quilt};

/// A mesh: a quilt of bicubic Bézier patches in rows and columns, which share the points of their common sides.
///
/// ```
/// use pathwarp::{deform::Mesh, kurbo::{Point, Rect}, map::Map};
///
/// // One patch; its bottom right corner is pulled down.
/// let mut rows: Vec<Vec<Point>> =
///     (0..4).map(|j| (0..4).map(|i| Point::new(30.0 * f64::from(i), 30.0 * f64::from(j))).collect()).collect();
/// rows[3][3].y += 20.0;
/// let mesh = Mesh::new(Rect::new(0.0, 0.0, 90.0, 90.0), rows).build()?;
/// assert!(mesh.map.point(Point::new(90.0, 90.0)).distance(Point::new(90.0, 110.0)) < 1e-12);
/// # Ok::<(), pathwarp::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    source: Source,
    smooth: bool,
    frame: Option<Rect>,
}

/// The control points, before or after they are checked.
#[derive(Debug, Clone, PartialEq)]
enum Source {
    Points { region: Rect, rows: Vec<Vec<Point>>, cuts: [Option<Vec<f64>>; 2] },
    Quilt(Quilt),
}

/// Smallest jump of the slope at a joint that is worth a warning, as a share of the slope.
const VISIBLE_KINK: f64 = 0.005;

/// Distance by which artwork may extend past the mesh's box without a warning, as a share of the box.
const BEYOND: f64 = 0.5;

impl Mesh {
    /// Lays a mesh onto the box `region`: rows of control points from the top, each from left to right, 3·columns + 1 points in
    /// each of 3·rows + 1 rows for up to 64 columns and rows of patches.
    #[must_use]
    pub fn new(region: Rect, rows: Vec<Vec<Point>>) -> Self {
        Self { source: Source::Points { region, rows, cuts: [None, None] }, smooth: false, frame: None }
    }

    /// Sets the positions where patches meet, as shares of the box across and down, rising between 0 and 1. Default: even.
    #[must_use]
    pub fn cuts(mut self, x: Vec<f64>, y: Vec<f64>) -> Self {
        if let Source::Points { cuts, .. } = &mut self.source {
            *cuts = [Some(x), Some(y)];
        }
        self
    }

    setters! {
        /// Makes the joints smooth; the points beside them move.
        smooth(smooth: bool);
        /// Sets the artwork's box, if it differs from the mesh's: artwork far outside the mesh gives a warning.
        frame(frame: Rect) => frame: Some(frame);
    }

    /// Builds the map. Kinks at the joints give a warning.
    ///
    /// # Errors
    /// [`Error::Geometry`] when the box is flat, [`Error::Input`] when rows have an illegal length or differ in it.
    pub fn build(&self) -> Result<Built, Error> {
        let mut quilt = match &self.source {
            Source::Quilt(quilt) => quilt.clone(),
            Source::Points { region, rows, cuts: [x, y] } => {
                Quilt::new("mesh", with_area(*region)?, rows.clone(), x.clone(), y.clone())?
            }
        };
        if self.smooth {
            quilt.smooth();
        }
        let [columns, rows] = quilt.size();
        let (kinks, worst_kink) = quilt.kinks();
        let r = quilt.region;
        let frame = self.frame.unwrap_or(r);
        let map = quilt.map().ok_or(GeometryError::FlatFrame { width: r.width(), height: r.height() })?;
        let map = crate::anchors::simplified(map, frame);
        let mut built = Built::new(map);
        let joints = if worst_kink < VISIBLE_KINK { "smooth" } else { "kinked" };
        built.note(format!("mesh: {columns} by {rows} patches; joints: {joints}"));
        let controlled = r.inflate(BEYOND * r.width(), BEYOND * r.height());
        if !matches!(built.map.class(), Class::Affine(_)) && frame.union(controlled) != controlled {
            built.warn(format!(
                "mesh: the artwork extends far past its box {} {} to {} {}, where a mesh has little control: `region artwork` \
lays it onto the artwork",
                r.x0, r.y0, r.x1, r.y1
            ));
        }
        if worst_kink >= VISIBLE_KINK {
            built.warn(format!(
                "mesh: {kinks} pairs of control points beside joints make kinks (by up to {:.0} % of the slope); `smooth` evens them out",
                100.0 * worst_kink
            ));
        }
        built.overlay(Role::Base, r.to_path(0.1));
        built.overlay(Role::Cage, quilt.curves());
        Ok(built)
    }
}

static INFO: Info = Info::new("mesh", "bend artwork by a mesh of bicubic patches, or by a Photoshop warp")
    .group("Lattices and nets")
    .by_hand(ByHand {
        labels: &[("mesh", "File of points"), ("psd", "Photoshop file")],
        fixed: &["net"],
        neutral: &[(
            "net",
            "M0,0 C16.6667,0 33.3333,0 50,0 C66.6667,0 83.3333,0 100,0 \
             M0,33.3333 C16.6667,33.3333 33.3333,33.3333 50,33.3333 C66.6667,33.3333 83.3333,33.3333 100,33.3333 \
             M0,66.6667 C16.6667,66.6667 33.3333,66.6667 50,66.6667 C66.6667,66.6667 83.3333,66.6667 100,66.6667 \
             M0,100 C16.6667,100 33.3333,100 50,100 C66.6667,100 83.3333,100 100,100",
        )],
        // The region in a file is in units of the drawing for which it was made.
        instead: &[
            Instead { param: "mesh", others: &["net", "psd"], with: Some(("region", "artwork")) },
            Instead { param: "psd", others: &["net", "mesh"], with: None },
        ],
        ..ByHand::NONE
    })
    .guides(&["net"], 1)
    .about("A quilt of patches, side by side in rows and columns, each with sixteen control points; neighbours share the points of their common \
sides. Give it as a path with one line of curves per row of control points (--net: a path of 4 lines with one curve each is one \
patch, of 7 lines with two curves each four), or as a file (--mesh, JSON or TOML): {\"region\": [x,y,w,h], \"points\": [[[x,y], …], \
…]}, rows from the top, and optionally \"x\" and \"y\", the positions where patches meet, as shares of the region.\n\n--psd takes the warp of a \
layer of a Photoshop file: a style with its bend and distortions, sixteen points, or a quilt; it is laid onto the artwork's box. JSON of \
a warp works too: {\"style\": \"warpFlag\", \"value\": 50, \"perspective\": 0, \"perspective_other\": 0, \"vertical\": false} (value \
and perspectives in percent), or {\"style\": \"warpCustom\", \"mesh\": {\"region\": …, \"points\": …}} with a mesh as above.\n\n\
--smooth evens out the joints, so that lines cross them without a kink.")
    .source("Tensor product Bézier patches: G. Farin, Curves and Surfaces for CAGD, chapter 15; Adobe Photoshop File Formats \
Specification, descriptor structure and placed layer data")
    .params(&[
        Param::path("net", "A path with 3·rows+1 subpaths of as many cubics as there are columns of patches."),
        Param::new("mesh", Kind::File, "A file of control points (JSON or TOML)."),
        Param::new("psd", Kind::File, "A Photoshop file with a warped layer, or JSON of such a warp."),
        Param::new("layer", Kind::Text("NAME"), "The layer of the Photoshop file; needed if several are warped."),
        Param::new(
            "region",
            Kind::Text("artwork|X,Y,W,H"),
            "The box that the mesh is laid onto. Default: the file's region, else the artwork's box.",
        ),
        Param::flag("smooth", "Make the joints smooth: points beside them move."),
    ])
    .demo(&[("net", DEMO)])
    .examples(&[
        Example {
            what: "Two patches side by side, from a path",
            command: "mesh samples/logo.svg --net samples/meshes.svg#quilt --smooth -o out.svg",
        },
        Example {
            what: "A file, laid onto the artwork",
            command: "mesh samples/badge.svg --mesh samples/pinch.json --region artwork -o out.svg",
        },
    ])
    .laws(&[
        Law::Identity(&[("net", REST)]),
        Law::Identity(&[("net", REST), ("smooth", "true")]),
        Law::Same(
            &[("net", REST), ("region", "0,0,50,50")],
            &[(
                "net",
                "M0,0 C66.66666666666667,0 133.33333333333334,0 200,0 M0,66.66666666666667 C66.66666666666667,66.66666666666667 133.33333333333334,66.66666666666667 200,66.66666666666667 M0,133.33333333333334 C66.66666666666667,133.33333333333334 133.33333333333334,133.33333333333334 200,133.33333333333334 M0,200 C66.66666666666667,200 133.33333333333334,200 200,200",
            )],
        ),
    ])
    .cases(&[
        // Joints and corners go to their control points.
        Case { args: &[("net", DEMO)], at: (0.0, 0.0), to: (0.0, 10.0), tolerance: 1e-12 },
        Case { args: &[("net", DEMO)], at: (50.0, 0.0), to: (50.0, 0.0), tolerance: 1e-12 },
        Case { args: &[("net", DEMO)], at: (100.0, 100.0), to: (100.0, 110.0), tolerance: 1e-12 },
        Case { args: &[("net", DEMO)], at: (25.0, 0.0), to: (25.0, 5.0), tolerance: 1e-12 },
    ]);

/// Two patches that rise in the middle.
const DEMO: &str = "M0,10 C20,10 30,0 50,0 C70,0 80,10 100,10 M0,40 C20,40 35,30 50,33 C65,36 80,40 100,40 \
M5,70 C20,70 30,60 50,66 C70,72 80,70 95,70 M0,100 C20,105 30,95 50,100 C70,105 80,105 100,110";
/// The control points of the identity.
const REST: &str = "M0,0 C33.333333333333336,0 66.66666666666667,0 100,0 \
M0,33.333333333333336 C33.333333333333336,33.333333333333336 66.66666666666667,33.333333333333336 100,33.333333333333336 \
M0,66.66666666666667 C33.333333333333336,66.66666666666667 66.66666666666667,66.66666666666667 100,66.66666666666667 \
M0,100 C33.333333333333336,100 66.66666666666667,100 100,100";

/// Reads the deformation from text.
pub(super) const ENTRY: Entry = Entry::new(&INFO, |s| {
    let frame = s.frame().rect;
    let given: Vec<&str> = ["net", "mesh", "psd"].into_iter().filter(|n| s.given(n)).collect();
    let [source] = given[..] else {
        return Err(Error::missing("net", "a path (`net`), a file (`mesh`) or a Photoshop file (`psd`): one of them"));
    };
    let region = with_area(s.rect_if("region")?.unwrap_or(frame))?;
    let (quilt, layer) = if source == "net" {
        let path = s.path_if("net")?.ok_or_else(|| Error::missing("net", "a path"))?;
        (Quilt::from_path(&path, region)?, None)
    } else {
        let file = s.file_if(source)?.ok_or_else(|| Error::missing(source, "its file"))?;
        match contents(s, source, file, region)? {
            Contents::Style(built) => return Ok(built),
            Contents::Quilt(quilt, layer) => (quilt, layer),
        }
    };
    let mut built = Mesh { source: Source::Quilt(quilt), smooth: s.flag("smooth")?, frame: Some(frame) }.build()?;
    if let Some(layer) = layer {
        built.explanation.notes.insert(0, format!("layer {layer}"));
    }
    Ok(built)
});

/// Reads the file of the parameter `param`: a mesh or a Photoshop file.
#[cfg(feature = "serde")]
fn contents(s: &Settings<'_>, param: &str, file: &NamedText, region: Rect) -> Result<Contents, Error> {
    if param == "psd" {
        return file::read_psd(file, s.texts("layer").last().copied(), region);
    }
    let quilt = file::read(&file.name, &file.text, region)?;
    Ok(Contents::Quilt(if s.given("region") { quilt.laid_onto(region) } else { quilt }, None))
}

#[cfg(not(feature = "serde"))]
fn contents(_: &Settings<'_>, _: &str, file: &NamedText, _: Rect) -> Result<Contents, Error> {
    Err(crate::error::no_json(&file.name))
}
