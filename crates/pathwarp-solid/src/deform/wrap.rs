//! Wraps models round a cylinder or a cone: a mug, a bottle, a ring, a cup.
//!
//! With θ = (x − x₀)/R, the angle, and ρ = R + (z − z₀), the distance from the axis, the image is
//! (x₀ + ρ·sin θ, y, z₀ − R + ρ·cos θ). Lengths on the surface z = z₀ are kept, and volumes grow by ρ/R. The inverse has a closed form.
//!
//! For a cone, the model is first turned by the slope β of its side, sin β = (R₁ − R₀)/H, about the middle of its back; R is the mean
//! of both radii. Lengths along the side are kept, as are lengths round it in the middle of its height; level lines stay level.

use super::entry::{About3, Built3, Case3, Entry, Law3};
use crate::map::{Chain3, Collineation, Creases3, Jet3, Map3};
use crate::settings::{Box3, Extent, Settings3};
use glam::{DMat3, DMat4, DVec3};
use pathwarp::Error;
use pathwarp::deform::{Example, Info};
use pathwarp::engine::decimal::trimmed;
use pathwarp::param::{Kind, Param};
use pathwarp::setters;
use std::sync::Arc;

/// Wraps a model round a cylinder.
///
/// ```
/// use glam::DVec3;
/// use pathwarp_solid::{Box3, deform::Wrap3, map::Map3};
///
/// let label = Box3::new(DVec3::ZERO, DVec3::new(80.0, 30.0, 2.0));
/// let built = Wrap3::new(label, 40.0).build()?;
/// // A point at the right end, on the surface: 1 radian from the middle.
/// let p = built.map.point(DVec3::new(80.0, 10.0, 0.0));
/// assert!((p - DVec3::new(40.0 + 40.0 * 1f64.sin(), 10.0, 40.0 * 1f64.cos() - 40.0)).length() < 1e-13);
/// # Ok::<(), pathwarp::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Wrap3 {
    bounds: Box3,
    radius: f64,
    level: bool,
    surface: Option<f64>,
    /// The other radius of a cone.
    far: Option<f64>,
}

impl Wrap3 {
    /// Wraps a model in this box round an upright cylinder of this radius, which its back touches in the middle.
    #[must_use]
    pub fn new(bounds: Box3, radius: f64) -> Self {
        Self { bounds, radius, level: false, surface: None, far: None }
    }

    setters! {
        /// Lays the cylinder's axis along x instead of y.
        level(level: bool);
        /// Sets the z that comes to lie on the cylinder, where lengths are kept. Defaults to the back of the box.
        surface(z: f64) => surface: Some(z);
        /// Wraps round a cone with this radius at the top. The one given to [`new`](Self::new) is that at the bottom (or at the left, if
        /// the axis is level).
        cone(radius: f64) => far: Some(radius);
    }

    /// Builds the map. A model longer than the circumference gives a warning.
    ///
    /// # Errors
    /// [`Error::Usage`] for a radius that is not positive, or radii that differ by more than the model is high.
    pub fn build(&self) -> Result<Built3, Error> {
        for (name, r) in [("radius", Some(self.radius)), ("top-radius", self.far)] {
            if let Some(r) = r.filter(|r| !(*r > 0.0 && r.is_finite())) {
                return Err(Error::usage(name, show(r), "must be larger than 0"));
            }
        }
        let across = usize::from(self.level);
        let far = self.far.unwrap_or(self.radius);
        let radius = 0.5 * (self.radius + far);
        let surface = self.surface.unwrap_or(self.bounds.min.z);
        let middle = self.bounds.center();
        let cylinder = Cylinder { across, middle: middle[across], surface, radius };
        let map: Arc<dyn Map3> = if far == self.radius {
            Arc::new(cylinder)
        } else {
            let height = self.bounds.size()[1 - across];
            let sine = (far - self.radius) / height;
            if sine.is_nan() || sine.abs() >= 1.0 {
                let problem = "differs from the other radius by more than the model's side is long";
                return Err(Error::usage("top-radius", show(far), format!("{problem}, {} mm", trimmed(height, 3))));
            }
            let mut chain = Chain3::default();
            chain.push(Arc::new(Collineation::new(slope(1 - across, middle[1 - across], surface, sine))));
            chain.push(Arc::new(cylinder));
            Arc::new(chain)
        };
        let (length, circumference) = (self.bounds.size()[across], std::f64::consts::TAU * radius);
        let mut built = Built3::new(map);
        let angle = (length / radius).to_degrees();
        let [mm, around] = [length, circumference].map(|v| trimmed(v, 3));
        built.note(format!("wrapped through {angle:.4}°, on a circumference of {around} mm"));
        if length > circumference {
            let advice = "its ends overlap; use a larger `radius`";
            built.warn(format!("the model is {mm} mm long and the circumference {around} mm: {advice}"));
        }
        Ok(built)
    }
}

/// Returns the matrix that turns an axis of the model to the slope of a cone's side, about the line through the axis's middle at the back.
fn slope(axis: usize, middle: f64, surface: f64, sine: f64) -> DMat4 {
    let cosine = (1.0 - sine * sine).sqrt();
    let (side, depth) = (DVec3::AXES[axis], DVec3::Z);
    let mut columns = DVec3::AXES;
    columns[axis] = side * cosine + depth * sine;
    columns[2] = depth * cosine - side * sine;
    let turn = DMat4::from_mat3(DMat3::from_cols(columns[0], columns[1], columns[2]));
    let center = side * middle + depth * surface;
    DMat4::from_translation(center) * turn * DMat4::from_translation(-center)
}

/// Wraps round a cylinder.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Cylinder {
    /// The axis along which the model is wrapped: 0 or 1.
    across: usize,
    /// The coordinate along `across` that stays.
    middle: f64,
    /// The z that comes to lie on the cylinder.
    surface: f64,
    radius: f64,
}

impl Cylinder {
    /// Returns the distance from the axis.
    fn rho(&self, p: DVec3) -> f64 {
        self.radius + p.z - self.surface
    }
}

impl Map3 for Cylinder {
    fn jet(&self, p: DVec3) -> Jet3 {
        let rho = self.rho(p);
        let (sin, cos) = ((p[self.across] - self.middle) / self.radius).sin_cos();
        let mut image = p;
        image[self.across] = self.middle + rho * sin;
        image.z = self.surface - self.radius + rho * cos;
        let unit = DVec3::AXES[self.across];
        let mut columns = DVec3::AXES;
        columns[self.across] = (unit * cos - DVec3::Z * sin) * (rho / self.radius);
        columns[2] = unit * sin + DVec3::Z * cos;
        Jet3 { p: image, d: DMat3::from_cols(columns[0], columns[1], columns[2]) }
    }

    fn creases(&self, out: &mut Creases3) {
        let map = *self;
        out.edge(move |p| map.rho(p));
    }

    fn inverse(&self) -> Option<Arc<dyn Map3>> {
        Some(Arc::new(Unwrapped(*self)))
    }
}

/// The inverse of [`Cylinder`], for angles up to half a turn to either side.
#[derive(Debug, Clone, Copy)]
struct Unwrapped(Cylinder);

impl Map3 for Unwrapped {
    fn jet(&self, q: DVec3) -> Jet3 {
        let c = &self.0;
        let (side, depth) = (q[c.across] - c.middle, q.z - (c.surface - c.radius));
        let mut p = q;
        p[c.across] = c.middle + c.radius * side.atan2(depth);
        p.z = c.surface + side.hypot(depth) - c.radius;
        Jet3 { p, d: c.jet(p).d.inverse() }
    }

    fn inverse(&self) -> Option<Arc<dyn Map3>> {
        Some(Arc::new(self.0))
    }
}

/// Reads a radius, given directly or as a diameter.
fn radius(s: &Settings3<'_>, [radius, diameter]: [&str; 2]) -> Result<Option<f64>, Error> {
    match (s.last(radius), s.last(diameter)) {
        (Some(_), Some(text)) => {
            Err(Error::usage(diameter, text, format!("and `{radius}` both set the radius; give one")))
        }
        (Some(text), None) => s.length_in(radius, text, Extent::X).map(Some),
        (None, Some(text)) => s.length_in(diameter, text, Extent::X).map(|d| Some(d / 2.0)),
        (None, None) => Ok(None),
    }
}

/// Formats a length for messages, in millimetres without the error of its unit's conversion.
fn show(length: f64) -> String {
    format!("{} mm", trimmed(length, 6))
}

static ABOUT: About3 = About3 {
    info: Info::new("wrap", "wrap a model round a mug, a bottle, a cup or a ring")
        .group("Along a curve")
        .about("Rolls the model round a cylinder of the given radius, which it touches with its back (--surface): lengths there are \
kept, so that a word of 50 mm is 50 mm long on the mug. The middle stays where it is. With another width at its top (--top-diameter or --top-radius) the model is rolled round a cone: lengths along its side are kept, and lengths round it in \
the middle of its height. Use --refine to give long faces enough corners.")
        .source("(x, y, z) to cylinder coordinates: θ = x/R, ρ = R + z")
        .params(&[
            Param::new("radius", Kind::Text("LENGTH"), "Radius of the cylinder; of a cone, at the bottom of the model."),
            Param::new("diameter", Kind::Text("LENGTH"), "The same as a diameter, as one measures a cup."),
            Param::new(
                "top-radius",
                Kind::Text("LENGTH"),
                "Radius at the top of the model (at its right end if the axis is level), for a cup or another cone.",
            ),
            Param::new("top-diameter", Kind::Text("LENGTH"), "The same as a diameter."),
            Param::new("axis", Kind::Choice(&["y", "x"]), "The cylinder's axis: y for upright, x for level.").default("y"),
            Param::new("surface", Kind::Text("Z"), "The z that comes to lie on the cylinder. Default: the back of the model."),
        ])
        .demo(&[("radius", "60")])
        .examples(&[
            Example {
                what: "A word 3 mm thick, for a mug of 41 mm radius",
                command: "solid wrap samples/lettering.svg --extrude 3mm --radius 41mm --refine 0.05mm -o out.obj",
            },
            Example {
                what: "The same for a cup that is wider at the top",
                command: "solid wrap samples/lettering.svg --extrude 3mm --diameter 64mm --top-diameter 80mm --refine 0.05mm -o out.obj",
            },
            Example {
                what: "Round a bottle that lies",
                command: "solid wrap samples/lettering.svg --extrude 2mm --radius 30mm --axis x --refine 0.05mm -o out.obj",
            },
        ]),
    laws: &[
        Law3::KeepsLinesAlong(&[("radius", "70")], [0.0, 1.0, 0.0]),
        Law3::KeepsLinesAlong(&[("radius", "70")], [0.0, 0.0, 1.0]),
        Law3::KeepsLinesAlong(&[("radius", "70"), ("axis", "x")], [1.0, 0.0, 0.0]),
        Law3::KeepsLinesAlong(&[("radius", "70"), ("top-diameter", "100")], [0.0, 1.0, 0.0]),
        Law3::Same(&[("radius", "70")], &[("diameter", "140"), ("top-radius", "70")]),
    ],
    cases: &[
        // A quarter turn: 50 is a quarter of the circumference of radius 100/π.
        Case3 {
            args: &[("radius", "31.830988618379067"), ("surface", "0")],
            at: [100.0, 20.0, 0.0],
            to: [81.830_988_618_379_07, 20.0, -31.830_988_618_379_067],
            tolerance: 1e-12,
        },
        Case3 { args: &[("radius", "30"), ("axis", "x")], at: [10.0, 50.0, 25.0], to: [10.0, 50.0, 25.0], tolerance: 1e-13 },
    ],
};

/// Reads the deformation from text.
pub(in crate::deform) const ENTRY: Entry = Entry(&ABOUT, |s| {
    let radius = radius(s, ["radius", "diameter"])?;
    let radius =
        radius.ok_or_else(|| Error::missing("radius", "the radius of what is wrapped round; or its diameter"))?;
    let mut wrap = Wrap3::new(s.bounds(), radius).level(s.flat().choice("axis")? == "x");
    if let Some(top) = self::radius(s, ["top-radius", "top-diameter"])? {
        wrap = wrap.cone(top);
    }
    if let Some(z) = s.last("surface") {
        let from = if z.trim().ends_with('%') { s.bounds().min.z } else { 0.0 };
        wrap = wrap.surface(from + s.length_in("surface", z, Extent::Z)?);
    }
    wrap.build()
});
