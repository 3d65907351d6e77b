//! Anamorphosis: drawings that look right from one place only.
//!
//! Every point moves along its ray through the eye O: p̂ = O + (p − O)/δ(p). There are three ways to define δ:
//!
//! - the eye lies in the plane of the drawing, and control points are pushed along rays ([`dilation`]);
//! - the eye is in front of it, and the drawing is projected onto a surface ([`surface`]): unrolled true to size, or seen by
//!   another camera ([`camera`]);
//! - the eye is in front, and control points are pushed along rays in space: at degree 1 of a triangle they span a plane, at
//!   degree 2 a quadric through O, on which straight lines become conics.
//!
//! A point p prescribed to go to p/δ sets one control point, δᵢ = 1 + (δ − 1)/Bᵢ(p) (the paper's δ₃ = 1 + (δ − 1)/u₃); the
//! others stay, so that inside and outside of the reference join along the sides that do not move (its Fig. 9).
//!
//! The size on a ramp rising by α: the point at slant L is L·sin α high and L·cos α behind the picture plane, and is seen at
//! height H + (L·sin α − H)·D/(D + L·cos α) there, H being the eye's height and D its distance. `length` solves this for the
//! scale.
//!
//! J. Sánchez-Reyes, J. M. Chacón, *Anamorphic free-form deformation*, CAGD 46 (2016); D. Hansford, D. Collins, *Anamorphic 3D
//! geometry*, Computing 79 (2007).
//!

mod camera;
mod dilation;
mod entry;
mod net;
mod onto;
mod scene;
mod surface;
#[cfg(test)]
mod tests;

pub(super) use entry::Entry;
pub use onto::Onto;

use super::built::{Built, InSpace, Role, SpaceFile};
use crate::error::{Error, within};
use crate::map::{AffineMap, Chain, Local, Map};
use camera::Camera;
use kurbo::{Affine, Point, Rect, Shape, Vec2};
use net::{Net, Push};
use scene::Scene;
use std::sync::Arc;
use surface::{Anamorphosis, Radial, Surface};

/// An anamorphosis: artwork drawn so that it looks right from one place only.
///
/// Every point moves along its ray through the eye O, p̂ = O + (p − O)/δ(p): onto a surface in space, which is unrolled or
/// seen by another camera, or by control points that are pushed towards the eye or away from it.
///
/// ```
/// use pathwarp::{deform::{Anamorph, Onto}, kurbo::{Point, Rect}, map::Map};
///
/// // Artwork that stands on the floor, 500 from an eye 400 above it.
/// let frame = Rect::new(0.0, 0.0, 100.0, 100.0);
/// let floor = Anamorph::new(frame).distance(500.0).eye_height(400.0).onto(Onto::Floor).build()?;
/// assert!((floor.map.point(Point::new(50.0, 0.0)).y - (100.0 - 500.0 / 3.0)).abs() < 1e-9);
/// # Ok::<(), pathwarp::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Anamorph {
    frame: Rect,
    eye: Point,
    eye_given: bool,
    distance: Option<f64>,
    eye_height: Option<f64>,
    picture_width: Option<f64>,
    length: Option<f64>,
    onto: Option<Onto>,
    look: Look,
    net: Option<Net>,
    local: bool,
    files: Vec<SpaceFile>,
}

/// The way a surface is shown.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Look {
    /// Laid flat, true to size.
    Unrolled,
    /// By the eye.
    Eye,
    /// By a camera at x, y, and z in front of the drawing.
    From([f64; 3]),
}

impl Anamorph {
    /// Creates an anamorphosis of the box `frame` for an eye in the drawing, at the middle of the box.
    #[must_use]
    pub fn new(frame: Rect) -> Self {
        Self {
            frame,
            eye: frame.center(),
            eye_given: false,
            distance: None,
            eye_height: None,
            picture_width: None,
            length: None,
            onto: None,
            look: Look::Unrolled,
            net: None,
            local: false,
            files: Vec::new(),
        }
    }

    /// Sets the eye, or its foot in the drawing.
    #[must_use]
    pub fn eye(self, eye: impl Into<Point>) -> Self {
        Self { eye: eye.into(), eye_given: true, ..self }
    }

    /// Sets the distance of the eye in front of the drawing, 1e-6 to 1e9 user units.
    #[must_use]
    pub fn distance(self, distance: f64) -> Self {
        Self { distance: Some(distance), ..self }
    }

    /// Sets the height of the eye above the artwork's bottom edge, instead of its foot.
    #[must_use]
    pub fn eye_height(self, height: f64) -> Self {
        Self { eye_height: Some(height), ..self }
    }

    /// Sets the apparent width of the artwork. Default: as drawn.
    #[must_use]
    pub fn picture_width(self, width: f64) -> Self {
        Self { picture_width: Some(width), ..self }
    }

    /// Sets the length of the result on a floor or ramp. Needs the [`eye_height`](Self::eye_height).
    #[must_use]
    pub fn length(self, length: f64) -> Self {
        Self { length: Some(length), ..self }
    }

    /// Sets the surface that the artwork is projected onto. Needs the [`distance`](Self::distance).
    #[must_use]
    pub fn onto(self, surface: Onto) -> Self {
        Self { onto: Some(surface), ..self }
    }

    /// Gives the eye's view of the surface, which is the artwork itself.
    #[must_use]
    pub fn seen(self) -> Self {
        Self { look: Look::Eye, ..self }
    }

    /// Gives the view of a camera at (x, y), z in front of the drawing, that looks at its middle.
    #[must_use]
    pub fn view(self, x: f64, y: f64, z: f64) -> Self {
        Self { look: Look::From([x, y, z]), ..self }
    }

    fn with_net(mut self, change: impl FnOnce(&mut Net)) -> Self {
        change(self.net.get_or_insert_default());
        self
    }

    /// Lays the control points over a triangle, with this degree, 1 to 10.
    #[must_use]
    pub fn triangle(self, corners: [impl Into<Point>; 3], degree: usize) -> Self {
        let corners = corners.map(Into::into).to_vec();
        self.with_net(|net| (net.reference, net.degree) = (corners, [degree; 2]))
    }

    /// Lays the control points over a box, with these degrees across and down, 1 to 10. Default: the artwork's box, degree 1.
    #[must_use]
    pub fn grid(self, region: Rect, degree: [usize; 2]) -> Self {
        let corners = vec![region.origin(), Point::new(region.x1, region.y1)];
        self.with_net(|net| (net.reference, net.degree) = (corners, degree))
    }

    /// Takes a control point to this many times its distance from the eye. The third number of a box's control point is 0.
    #[must_use]
    pub fn push(self, node: [usize; 3], factor: f64) -> Self {
        self.with_net(|net| net.pushes.push(Push::By(node, factor)))
    }

    /// Takes a control point this much further from the eye, user units.
    #[must_use]
    pub fn push_away(self, node: [usize; 3], length: f64) -> Self {
        self.with_net(|net| net.pushes.push(Push::Away(node, length)))
    }

    /// Takes a control point to the point of its ray nearest to `to`. The eye must lie in the drawing.
    #[must_use]
    pub fn push_to(self, node: [usize; 3], to: impl Into<Point>) -> Self {
        let to = to.into();
        self.with_net(|net| net.pushes.push(Push::To(node, to)))
    }

    /// Takes a point to this many times its distance from the eye, by one control point near it.
    #[must_use]
    pub fn prescribe(self, point: impl Into<Point>, factor: f64) -> Self {
        let point = point.into();
        self.with_net(|net| net.pushes.push(Push::Prescribe(point, factor)))
    }

    /// Moves only artwork inside the reference. The eye must lie in the drawing.
    #[must_use]
    pub fn local(self, local: bool) -> Self {
        Self { local, ..self }
    }

    /// Builds the map, and for an eye in front of the drawing its surface ([`Built::space`]).
    ///
    /// # Errors
    /// [`Error::Usage`] or [`Error::Missing`] for values out of range, that contradict or lack each other, and for surfaces
    /// that a ray misses or that cannot be laid flat.
    pub fn build(&self) -> Result<Built, Error> {
        match self.distance {
            Some(distance) => self.in_front(within("distance", distance, 1e-6, 1e9)?),
            None => self.in_plane(),
        }
    }

    /// Builds the map for an eye in the plane of the drawing.
    fn in_plane(&self) -> Result<Built, Error> {
        let needs_distance = [
            ("onto", self.onto.is_some()),
            ("view", matches!(self.look, Look::From(_))),
            ("seen", self.look == Look::Eye),
            ("eye-height", self.eye_height.is_some()),
            ("picture-width", self.picture_width.is_some()),
            ("length", self.length.is_some()),
            ("mesh", self.files.iter().any(|f| f.filled)),
            ("curves", self.files.iter().any(|f| !f.filled)),
        ];
        if let Some((name, _)) = needs_distance.iter().find(|n| n.1) {
            return Err(Error::missing(
                "distance",
                format!("the eye's distance in front of the drawing; `{name}` needs it"),
            ));
        }
        let scene = Scene { frame: self.frame, scale: Affine::IDENTITY, eye: self.eye };
        let dilation = self.net.clone().unwrap_or_default().dilation(&scene, 0.0, self.local)?;
        let map = dilation.about(scene.eye, self.local);
        let pushed = dilation.lines(|p, delta| scene.eye + (p - scene.eye) / delta);
        let map: Arc<dyn Map> = if self.local {
            Arc::new(Local::new(&dilation.reference().corners(), Arc::new(map)))
        } else {
            map.simplest()
        };
        let mut built = Built::new(map);
        if self.local {
            net::warn_of_torn_sides(&dilation, scene.frame, &mut built);
        }
        built.overlay(Role::Base, dilation.outline());
        built.overlay(Role::Cage, pushed);
        Ok(built)
    }

    /// Builds the map for an eye in front of the drawing.
    fn in_front(&self, distance: f64) -> Result<Built, Error> {
        if self.local {
            return Err(Error::usage("local", "", "is for an eye in the drawing, without `distance`"));
        }
        let scene = self.scene(distance)?;
        let foot = scene.eye;
        let surface = match (self.onto, &self.net) {
            (Some(_), Some(net)) => {
                let name = net.pushes.first().map_or("reference", |p| p.param());
                return Err(Error::usage(name, "", "moves control points, but `onto` has the surface already"));
            }
            (Some(onto), None) => onto.surface(&scene, distance)?,
            // Without control points, the sheet in front of the eye is the drawing itself.
            (None, None) if self.look == Look::Unrolled => {
                let hint = "the surface in front of the eye, such as cylinder:radius=40mm; or bend a sheet there, with `push` or `at`";
                return Err(Error::missing("onto", hint));
            }
            (None, net) => {
                let dilation = net.clone().unwrap_or_default().dilation(&scene, distance, self.local)?;
                let flat = net::flat(&dilation, foot, distance);
                flat.map_or_else(|| Surface::Radial(Radial::net(&dilation)), Surface::Plane)
            }
        };
        let cast = Anamorphosis { foot, distance, surface };
        onto::check_met(self.onto, &cast, scene.frame)?;
        let map = self.shown(&cast, &scene)?;
        let mut built =
            Built::new(Arc::new(Chain::new([Arc::new(AffineMap(scene.scale)) as Arc<dyn Map>, Arc::clone(&map)])));
        let (scale, solid) = (scene.scale, cast);
        let place = Arc::new(move |p| {
            let p = scale * p;
            (solid.defined(p) > 0.0).then(|| solid.point(p)).filter(|q| q.iter().all(|v| v.is_finite()))
        });
        built.space = Some(InSpace { place, files: self.files.clone() });
        built.note(scene.size(&*map));
        built.overlay(Role::Base, self.frame.to_path(0.1));
        if let Some(path) = scene.outline(&*map) {
            built.overlay(Role::Target, path);
        }
        Ok(built)
    }

    /// Returns the requested view of the surface.
    fn shown(&self, cast: &Anamorphosis, scene: &Scene) -> Result<Arc<dyn Map>, Error> {
        match self.look {
            Look::Eye => Ok(cast.seen()),
            Look::From([x, y, z]) => {
                let p = scene.scale * Point::new(x, y);
                let middle = scene.frame.center();
                let text = format!("{x},{y},{z}");
                let camera = Camera::new([p.x, p.y, -z], cast.point(middle), middle)
                    .ok_or_else(|| Error::usage("view", text.clone(), "is on the surface itself; move it away"))?;
                let map = cast.viewed(&camera, scene.frame);
                onto::check_in_view(&text, cast, &camera, scene.frame)?;
                Ok(map)
            }
            Look::Unrolled => cast.unrolled().ok_or_else(|| {
                let hint = "such a surface cannot be laid flat; give the camera's position X,Y,Z with Z in front of the drawing, or `seen`";
                Error::missing("view", hint)
            }),
        }
    }

    /// Returns the artwork at its apparent size, and the eye.
    fn scene(&self, distance: f64) -> Result<Scene, Error> {
        let drawn = self.frame;
        if self.eye_height.is_some() && self.eye_given {
            return Err(Error::usage("eye-height", "", "and `eye` both place the eye; give one"));
        }
        let k = match (self.picture_width, self.length) {
            (Some(_), Some(_)) => {
                return Err(Error::usage("length", "", "and `picture-width` both size the artwork; give one"));
            }
            (Some(w), None) => w / drawn.width(),
            (None, Some(length)) => onto::scale_for(self.onto, length, drawn.height(), self.eye_height, distance)?,
            (None, None) => 1.0,
        };
        if !k.is_finite() || k <= 0.0 {
            return Err(Error::usage("picture-width", "", "cannot be given to artwork that has no size"));
        }
        let anchor = Point::new(drawn.center().x, drawn.y1);
        let scale = if k == 1.0 { Affine::IDENTITY } else { Affine::scale_about(k, anchor) };
        let eye = match self.eye_height {
            Some(h) => anchor - Vec2::new(0.0, h),
            None => scale * self.eye,
        };
        Ok(Scene { frame: scale.transform_rect_bbox(drawn), scale, eye })
    }
}
