//! Anamorphosis: drawings that look right only from one point, the eye.
//!
//! Every point moves along its ray through the eye O: p̂ = O + (p − O)/δ(p). There are three ways to define δ:
//!
//! - the eye lies in the plane of the drawing, and control points are pushed along rays ([`dilation`]);
//! - the eye lies in front of the drawing, which is projected onto a surface ([`surface`]); the surface is laid flat true to size, or
//!   seen by another camera ([`Camera`](surface::Camera));
//! - the eye lies in front of the drawing, and control points are pushed along rays in space: at degree 1 of a triangle they span a
//!   plane, at degree 2 a quadric through O, on which straight lines become conics.
//!
//! A point p that must go to p/δ sets one control point, δᵢ = 1 + (δ − 1)/Bᵢ(p) (the paper's δ₃ = 1 + (δ − 1)/u₃). The others do not
//! move, so that the inside and the outside of the reference join along the sides without pushes (the paper's Fig. 9).
//!
//! On a ramp that rises by α, the point at slant L is L·sin α high and L·cos α behind the picture plane. With H the eye's height and D
//! its distance, it appears at the height H + (L·sin α − H)·D/(D + L·cos α) in that plane. `length` solves this for the scale.
//!
//! The paper is J. Sánchez-Reyes, J. M. Chacón, *Anamorphic free-form deformation*, CAGD 46 (2016); see also D. Hansford, D. Collins,
//! *Anamorphic 3D geometry*, Computing 79 (2007).

mod dilation;
mod hidden;
mod mirror;
mod net;
mod reading;
mod reflected;
mod scene;
mod surface;
#[cfg(test)]
mod tests;

use super::entry::{Built, ByHand, Case, Entry, Example, InSpace, Info, Law, Pairs, Role, SightMark, SpaceFile};
use super::triangle::polygon;
use crate::error::Error;
use crate::map::{AffineMap, Chain, Local, Map};
use crate::param::{Axis, Kind, Settings, parameters};
use hidden::{FoldedView, Sheet};
use kurbo::{Affine, Point, Rect, Shape, Vec2};
use net::{Push, PushedNet};
use reading::{eye, look, mirror, net, onto};
use scene::{Eye, HERE, Scene, format_length};
use std::sync::Arc;
use surface::{Anamorphosis, Radial, Surface};

pub use mirror::{Mirror, MirrorShape};
pub use surface::Onto;

parameters! {
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
    pub struct Anamorph(s) {
        /// Position of the eye, in the drawing or straight in front of this point; or inf:DX,DY[,DZ], infinitely far away in this
        /// direction, DZ in front of the drawing, or inf: and two angles to the right and up, such as inf:30deg,20deg.
        param = new("eye", Kind::Point).default("50%,50%");
        /// Distance of the eye in front of the drawing. Without it the eye lies in the drawing.
        distance: Option<f64> = length("distance", Axis::X).within(1e-6, 1e9).slider(10.0, 2000.0);
        /// Height of the eye above the artwork's bottom edge (the floor).
        eye_height: Option<f64> = length("eye-height", Axis::Y).within(0.0, 1e9).slider(0.0, 8000.0);
        /// Apparent width of the artwork. Default: as drawn.
        picture_width: Option<f64> = length("picture-width", Axis::X).within(1e-6, 1e9).slider(1.0, 4000.0);
        /// Length of the result on the floor or ramp; needs --eye-height.
        length: Option<f64> = length("length", Axis::Y).within(1e-6, 1e9).slider(10.0, 40000.0);
        /// The surface that the artwork is projected onto: plane:…, cylinder:…, cone:… or sphere:… as above.
        param = new("onto", Kind::Text("SURFACE"));
        /// The mirror in which the artwork appears, on a table under it: cylinder:…, cone:… or sphere:… as above.
        param = new("mirror", Kind::Text("SHAPE"));
        /// Place of the mirror's foot on the page, such as on the photograph of a drawing that --inverse restores. Default: below
        /// the artwork's middle.
        param = new("foot", Kind::Point);
        /// Draw beside the result where the eye belongs, with its distance and height, and the mirror's foot.
        sight_mark: bool = flag("sight-mark");
        /// Give the eye's view.
        param = flag("seen");
        /// Give the view from here, Z in front of the drawing, looking at its middle.
        param = new("view", Kind::Text("X,Y,Z"));
        /// The region of the control points: three corners of a triangle, or two of a box. Default: the artwork's box.
        param = new("reference", Kind::Text("X,Y X,Y [X,Y]"));
        /// Degree of the net: control points along a side, less one; MxN across and down a box.
        param = new("degree", Kind::Text("N|MxN")).default("1");
        /// Takes a control point to this many times its distance from the eye.
        param = new("push", Kind::Text("I,J[,K]:FACTOR")).repeated();
        /// Takes a control point this much further from the eye, or nearer if negative.
        param = new("away", Kind::Text("I,J[,K]:LENGTH")).repeated();
        /// Takes a control point to the point of its ray nearest to here (eye in the drawing).
        param = new("at", Kind::Text("I,J[,K]:X,Y")).repeated();
        /// Takes this point to so many times its distance from the eye (a length further from an eye at infinity), by pushing the control point nearest to it that is not on
        /// a fixed side: the first side of a triangle, the edge of a box if --local.
        param = new("point", Kind::Text("X,Y:FACTOR|LENGTH")).repeated();
        /// Write the filled artwork on the surface as a mesh in 3D (OBJ), for printing and CAD; needs --distance.
        param = new("mesh", Kind::Save);
        /// Write the artwork's outlines on the surface as polylines in 3D (OBJ); needs --distance.
        param = new("curves", Kind::Save);
        /// Move only artwork inside the reference.
        local: bool = flag("local");
        let frame: Rect = s.frame().rect;
        let eye: Eye = eye(s)?;
        let eye_given: bool = s.given("eye");
        let onto: Option<Onto> = s.texts("onto").pop().map(|text| onto(s, text)).transpose()?;
        let mirror: Option<Mirror> = mirror(s)?;
        let look: Look = look(s)?;
        let net: Option<PushedNet> = net(s)?;
        let files: Vec<SpaceFile> = files(s, "mesh", true).chain(files(s, "curves", false)).collect();
        // For the sizes of the note.
        let units_per_px: [f64; 2] = s.frame().units_per_px;
    }
}

/// The view in which a surface is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Look {
    /// Laid flat, true to size.
    Unrolled,
    /// Seen by the eye.
    Eye,
    /// Seen by a camera at x, y, and z in front of the drawing.
    From([f64; 3]),
}

impl Anamorph {
    /// Creates an anamorphosis of the box `frame` for an eye in the drawing, at the middle of the box.
    #[must_use]
    pub fn new(frame: Rect) -> Self {
        Self::defaults(frame)
    }

    setters! {
        /// Sets the eye, or its foot in the drawing.
        eye(eye: impl Into<Point>) => eye: Eye::At(eye.into(), 0.0), eye_given: true;
        /// Puts the eye at infinity in a direction: in the drawing's plane if z is 0, otherwise z in front of it.
        eye_at_infinity(x: f64, y: f64, z: f64) => eye: Eye::Infinite([x, y, -z]), eye_given: true;
        /// Sets the surface that the artwork is projected onto. Needs the [`distance`](Self::distance).
        onto(surface: Onto) => onto: Some(surface);
        /// Sets the mirror in which the artwork appears.
        mirror(mirror: Mirror) => mirror: Some(mirror);
        /// Gives the view of a camera at (x, y), z in front of the drawing, that looks at its middle.
        view(x: f64, y: f64, z: f64) => look: Look::From([x, y, z]);
    }

    /// Shows the eye's view of the surface, which is the artwork itself.
    #[must_use]
    pub fn seen(self) -> Self {
        Self { look: Look::Eye, ..self }
    }

    fn with_net(mut self, change: impl FnOnce(&mut PushedNet)) -> Self {
        change(self.net.get_or_insert_default());
        self
    }

    /// Lays the control points over a triangle, with a degree of 1 to 10.
    #[must_use]
    pub fn triangle(self, corners: [impl Into<Point>; 3], degree: usize) -> Self {
        let corners = corners.map(Into::into).to_vec();
        self.with_net(|net| (net.reference, net.degree) = (corners, [degree; 2]))
    }

    /// Lays the control points over a box, with degrees of 1 to 10 across and down. Default: the artwork's box, degree 1.
    #[must_use]
    pub fn grid(self, region: Rect, degree: [usize; 2]) -> Self {
        let corners = vec![region.origin(), Point::new(region.x1, region.y1)];
        self.with_net(|net| (net.reference, net.degree) = (corners, degree))
    }

    /// Moves a control point to `factor` times its distance from the eye. The third number of a box's control point is 0.
    #[must_use]
    pub fn push(self, node: [usize; 3], factor: f64) -> Self {
        self.with_net(|net| net.pushes.push(Push::By(node, factor)))
    }

    /// Moves a control point away from the eye by `length` user units.
    #[must_use]
    pub fn push_away(self, node: [usize; 3], length: f64) -> Self {
        self.with_net(|net| net.pushes.push(Push::Away(node, length)))
    }

    /// Moves a control point to the point of its ray nearest to `to`. The eye must lie in the drawing.
    #[must_use]
    pub fn push_to(self, node: [usize; 3], to: impl Into<Point>) -> Self {
        let to = to.into();
        self.with_net(|net| net.pushes.push(Push::To(node, to)))
    }

    /// Takes a point to `factor` times its distance from the eye, or away from an eye at infinity by `factor` user units. One control
    /// point near it moves.
    #[must_use]
    pub fn prescribe(self, point: impl Into<Point>, factor: f64) -> Self {
        let point = point.into();
        self.with_net(|net| net.pushes.push(Push::Prescribe(point, factor)))
    }

    /// Builds the map, and for an eye in front of the drawing its surface ([`Built::space`]).
    ///
    /// # Errors
    /// [`Error::Usage`] when values are out of range or contradict each other, or a ray misses the surface; [`Error::Missing`] when another
    /// value is needed, such as the view of a surface that cannot be laid flat.
    pub fn build(&self) -> Result<Built, Error> {
        self.check()?;
        if let Some(mirror) = self.mirror {
            return self.reflected(mirror);
        }
        match (self.eye, self.distance) {
            (Eye::At(foot, _), Some(distance)) => self.in_front(Eye::At(foot, distance)),
            (Eye::At(foot, _), None) => self.in_plane(Eye::At(foot, 0.0)),
            (Eye::Infinite(_), Some(_)) => {
                Err(Error::usage("distance", "", "is infinite for this `eye`; omit one of them"))
            }
            (Eye::Infinite(towards), None) => {
                let eye = Eye::Infinite(direction(towards)?);
                match towards[2] {
                    0.0 => self.in_plane(eye),
                    z if z < -1e-9 * surface::length(towards) => self.in_front(eye),
                    _ => Err(Error::usage("eye", "", "is behind the drawing; give a positive DZ, in front of it")),
                }
            }
        }
    }

    /// Marks the position of the eye beside the image on a surface laid flat.
    fn sight(&self, projection: &Anamorphosis, scene: &Scene, map: &dyn Map) -> Result<Option<SightMark>, Error> {
        if !self.sight_mark {
            return Ok(None);
        }
        if self.look != Look::Unrolled {
            return Err(Error::usage("sight-mark", "", "is for what is printed; omit it, or `view` and `seen`"));
        }
        let units = self.units_per_px;
        let (at, label) = match (&projection.surface, scene.eye) {
            (Surface::Plane(p), eye) => {
                let Some((at, height)) = p.nearest(eye) else { return Ok(None) };
                match eye {
                    Eye::At(..) => {
                        let height = format_length(height, units);
                        let here = format!("eye {height} straight above the round mark");
                        (at, [here, format!("eye {height} above the sheet{HERE}")])
                    }
                    Eye::Infinite(_) => (at, far_away(height)),
                }
            }
            (Surface::Cone(r), Eye::At(foot, distance)) => {
                // The mark lies straight in front of the axis, at the eye's height.
                let share = distance / (distance + r.axis());
                let front = match r.horizontal {
                    true => Point::new(foot.x, foot.y + (r.middle.y - foot.y) * share),
                    false => Point::new(foot.x + (r.middle.x - foot.x) * share, foot.y),
                };
                let apart = surface::length(surface::minus(projection.point(front), [foot.x, foot.y, -distance]));
                let distance = format_length(apart, units);
                let here = format!("eye {distance} in front of the round mark");
                let there = format!("eye {distance} in front of the surface{HERE}");
                (map.point(front), [here, there])
            }
            (_, Eye::At(..)) => return Ok(None),
            (_, Eye::Infinite([x, y, z])) => {
                let [right, up] = [x.atan2(-z), (-y).asin()].map(f64::to_degrees);
                let here = format!("eye far away, {right:.1}° to the right and {up:.1}° up");
                (map.point(scene.frame.center()), [here.clone(), here])
            }
        };
        Ok(Some(scene::sight_mark(at, label, scene.extent(map), units)))
    }

    /// Builds the map for an eye in the plane of the drawing.
    fn in_plane(&self, eye: Eye) -> Result<Built, Error> {
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
            let hint = format!("the eye's distance in front of the drawing; `{name}` needs it");
            return Err(Error::missing("distance", hint));
        }
        let scene = Scene { frame: self.frame, scale: Affine::IDENTITY, eye };
        let dilation = self.net.clone().unwrap_or_default().dilation(&scene, self.local)?;
        let map = dilation.about(eye, self.local);
        let pushed_net = dilation.lines(|p, delta| match eye {
            Eye::At(eye, _) => eye + (p - eye) / delta,
            Eye::Infinite([x, y, _]) => p + Vec2::new(x, y) * (delta - 1.0),
        });
        let map: Arc<dyn Map> = if self.local {
            Arc::new(Local::new(&dilation.reference.corners(), Arc::new(map)))
        } else {
            map.simplest()
        };
        let mut built = Built::new(Arc::clone(&map));
        if self.sight_mark {
            let (at, there) = match eye {
                Eye::At(at, _) => (at, "eye in the plane of the drawing, from here"),
                Eye::Infinite([x, y, _]) => {
                    (scene.frame.center() + Vec2::new(x, y) * 1e9, "eye far away in this direction")
                }
            };
            let label = ["eye".into(), there.into()];
            built.sight = Some(Box::new(scene::sight_mark(at, label, scene.extent(&*map), self.units_per_px)));
        }
        if self.local {
            net::warn_of_torn_sides(&dilation, scene.frame, &mut built);
        }
        built.overlay(Role::Base, polygon(&dilation.reference.corners()));
        built.overlay(Role::Cage, pushed_net);
        Ok(built)
    }

    /// Builds the map for an eye in front of the drawing.
    fn in_front(&self, eye: Eye) -> Result<Built, Error> {
        if self.local {
            return Err(Error::usage("local", "", "is for an eye in the drawing, without `distance`"));
        }
        let scene = self.scene(eye)?;
        let surface = match (self.onto, &self.net) {
            (Some(_), Some(net)) => {
                let name = net.pushes.first().map_or("reference", |p| p.param());
                return Err(Error::usage(name, "", "moves control points, but `onto` has the surface already"));
            }
            (Some(onto), None) => onto.surface(&scene)?,
            // Without control points, the sheet in front of the eye would be the drawing itself.
            (None, None) if self.look == Look::Unrolled => {
                let hint = "the surface in front of the eye, such as cylinder:radius=40mm; or bend a sheet there, with `push` or `at`";
                return Err(Error::missing("onto", hint));
            }
            (None, net) => {
                let dilation = net.clone().unwrap_or_default().dilation(&scene, self.local)?;
                let flat = net::plane_of_corners(&dilation, scene.eye);
                flat.map_or_else(|| Surface::Radial(Radial::net(&dilation)), Surface::Plane)
            }
        };
        let projection = Anamorphosis { eye: scene.eye, surface };
        surface::check_hit(self.onto, &projection, scene.frame)?;
        // Files in space need no view; the drawing then shows one that is chosen.
        let chosen = match self.look {
            Look::Unrolled if !self.files.is_empty() && projection.unrolled().is_none() => {
                self.side_view(&projection, &scene)
            }
            _ => None,
        };
        let map = chosen.as_ref().unwrap_or(self).view_map(&projection, &scene)?;
        let scale = Arc::new(AffineMap(scene.scale)) as Arc<dyn Map>;
        let mut built = Built::new(Arc::new(Chain::new([scale, Arc::clone(&map)])));
        let (scale, surface) = (scene.scale, projection.clone());
        let place = Arc::new(move |p| {
            let p = scale * p;
            (surface.defined(p) > 0.0).then(|| surface.point(p)).filter(|q| q.iter().all(|v| v.is_finite()))
        });
        built.space = Some(InSpace { place, besides: Vec::new(), files: self.files.clone() });
        if let Look::From(at) = chosen.as_ref().unwrap_or(self).look {
            let (camera, surface) = (surface::camera(at, &projection, &scene)?, projection.clone());
            let depth = Box::new(move |p| camera.depth(surface.point(scale * p)));
            if let Some(sheet) = Sheet::folded(Arc::clone(&built.map), depth, self.frame) {
                let sheet = Arc::new(sheet);
                built.map = Arc::new(FoldedView(Arc::clone(&sheet)));
                built.hidden = Some(Arc::new(move |tolerance| sheet.hidden(tolerance)));
            }
        }
        built.sight = self.sight(&projection, &scene, &*map)?.map(Box::new);
        if let Some(Self { look: Look::From([x, y, z]), .. }) = chosen {
            built.note(format!(
                "such a surface cannot be laid flat: the drawing is the view from {x:.4},{y:.4},{z:.4} (`view`)"
            ));
        }
        built.note(scene.describe_sizes(&*map, self.units_per_px));
        built.overlay(Role::Base, self.frame.to_path(0.1));
        if let Some(path) = scene.outline(&*map) {
            built.overlay(Role::Target, path);
        }
        Ok(built)
    }

    /// Returns this anamorphosis with a view from the side, for a sheet that cannot be laid flat. Of some cameras, the first is taken for
    /// which no part of the sheet hides another.
    fn side_view(&self, projection: &Anamorphosis, scene: &Scene) -> Option<Self> {
        /// Positions to the right and down from the sheet's middle, in units of the eye's distance from it.
        const POSITIONS: [[f64; 2]; 5] = [[0.5, -0.35], [-0.5, -0.35], [0.25, -0.2], [-0.25, -0.2], [0.05, -0.05]];
        let middle = projection.point(scene.frame.center());
        let distance = scene.eye.distance_to(middle);
        let from = |[x, y]: [f64; 2]| {
            let p = scene.scale.inverse() * Point::new(middle[0] + x * distance, middle[1] + y * distance);
            Self { look: Look::From([p.x, p.y, 0.8 * distance - middle[2]]), ..self.clone() }
        };
        let shows_all = |view: &Self| {
            let map = view.view_map(projection, scene);
            map.is_ok_and(|m| surface::box_samples(scene.frame).all(|p| m.jet(p).det() > 0.0))
        };
        POSITIONS.map(from).into_iter().find(shows_all)
    }

    /// Returns the requested view of the surface.
    fn view_map(&self, projection: &Anamorphosis, scene: &Scene) -> Result<Arc<dyn Map>, Error> {
        match self.look {
            Look::Eye => Ok(projection.eye_view()),
            Look::From(at) => Ok(projection.camera_view(&surface::camera(at, projection, scene)?, scene.frame)),
            Look::Unrolled => projection.unrolled().ok_or_else(|| {
                let hint = "such a surface cannot be laid flat; give the camera's position X,Y,Z with Z in front of the drawing, or `seen`";
                Error::missing("view", hint)
            }),
        }
    }

    /// Returns the artwork at its apparent size, scaled about the middle of its bottom edge, and the eye.
    fn scene(&self, eye: Eye) -> Result<Scene, Error> {
        let drawn = self.frame;
        let conflict = |name, problem| Err(Error::usage(name, "", problem));
        if self.eye_height.is_some() && self.eye_given {
            return conflict("eye-height", "and `eye` both place the eye; give one");
        }
        let factor = match (self.picture_width, self.length) {
            (Some(_), Some(_)) => return conflict("length", "and `picture-width` both size the artwork; give one"),
            (Some(w), None) => w / drawn.width(),
            (None, Some(length)) => surface::scale_for(self.onto, length, drawn.height(), self.eye_height, eye)?,
            (None, None) => 1.0,
        };
        if !factor.is_finite() || factor <= 0.0 {
            return conflict("picture-width", "cannot be given to artwork that has no size");
        }
        let anchor = Point::new(drawn.center().x, drawn.y1);
        let scale = if factor == 1.0 { Affine::IDENTITY } else { Affine::scale_about(factor, anchor) };
        let eye = match (eye, self.eye_height) {
            (Eye::At(_, distance), Some(h)) => Eye::At(anchor - Vec2::new(0.0, h), distance),
            (Eye::At(foot, distance), None) => Eye::At(scale * foot, distance),
            (infinite, _) => infinite,
        };
        Ok(Scene { frame: scale.transform_rect_bbox(drawn), scale, eye })
    }
}

/// Returns the unit vector of a direction.
fn direction(towards: [f64; 3]) -> Result<[f64; 3], Error> {
    let size = surface::length(towards);
    if (1e-100..1e100).contains(&size) {
        return Ok(towards.map(|v| v / size));
    }
    Err(Error::usage("eye", "", "has no direction; give one, such as inf:1,0,2"))
}

/// Describes an eye at infinity by the sine of its elevation.
fn far_away(sine: f64) -> [String; 2] {
    let up = sine.clamp(-1.0, 1.0).asin().to_degrees();
    let there = format!("eye far away in this direction, {up:.1}° above the sheet");
    [there.clone(), there]
}

static INFO: Info = Info::new("anamorph", "draw artwork that looks right from one place: road markings, mugs, domes")
    .group("Perspective and anamorphosis")
    .by_hand(ByHand {
        label: Some("Anamorphosis"),
        showing: &[("distance", "300%"), ("onto", "cylinder:radius=80%")],
        ..ByHand::NONE
    })
    .about("Stretches the artwork so that it looks as drawn to an eye at one place.\n\n\
On a surface: give the position of the eye (--distance, --eye or --eye-height) and the surface that the artwork is projected onto (--onto). The result is \
that surface laid flat, true to size, to be painted, cut or printed:\n  \
plane:floor            the ground under the artwork's bottom edge\n  \
plane:ceiling          above its top edge\n  \
plane:left plane:right a side wall along its left or right edge\n  \
plane:ramp=20          ground that rises by an angle away from the eye\n  \
plane:wall=30          a vertical wall, its right side turned away by an angle\n  \
cylinder:radius=40mm   a mug, its front touching the artwork's middle\n  \
cone:top-diameter=90mm,bottom-diameter=60mm,height=110mm  a cup; or slant=…, along its side\n  \
sphere:radius=60mm     a ball; it cannot be laid flat, so it needs --view\n  \
sphere:eye             a dome with the eye on its near pole: lines become circles\n\
Add `,inside` to a cylinder, cone or sphere to see it from within, `,level` to a cylinder to lay it down. --seen gives the eye's view, \
which is the artwork itself; --view the view from elsewhere, in which parts of the artwork's box hide others.\n\n\
In a mirror (--mirror): the artwork appears in a mirror that stands on a table, from the eye at --distance in front of it and \
--eye-height above the table (without --distance straight above it). The result is the drawing on the table, seen from above with the \
viewer at the bottom; lay it out with --sight-mark, which draws the mirror's foot:\n  \
cylinder:diameter=60mm  the artwork stands in it; --explain says how high it must be\n  \
cone:diameter=60mm,height=80mm  seen from above, around it; leave a hole in the middle for the tip\n  \
sphere:diameter=80mm    the artwork appears below its middle\n\
Add `,lift=10mm` to raise the artwork, `,tilt=10` to lean a cylinder or cone away from you.\n\n\
In the plane: without --distance the eye lies in the drawing, and control points are pushed towards it or away from it (--push, \
--away, --at, --point). They lie over a --reference triangle or box. With --distance the same pushes bend a sheet in front of the eye: \
flat for a triangle of degree 1, otherwise shown with --view.")
    .source("J. Sánchez-Reyes, J. M. Chacón, Anamorphic Free-Form Deformation, CAGD 46, 2016")
    .params(Anamorph::PARAMS)
    .demo(&[("distance", "300"), ("onto", "cylinder:radius=80")])
    .examples(&[
        Example {
            what: "A word on the floor that seems to stand upright",
            command: "anamorph samples/lettering.svg --eye-height 350 --distance 400 --onto plane:floor --fit page -o out.svg",
        },
        Example {
            what: "A road marking 10 m long, for a driver whose eye is 1.2 m high and 20 m away",
            command: "anamorph samples/lettering.svg --eye-height 1.2m --distance 20m --length 10m --onto plane:floor --fit page -o out.svg",
        },
        Example {
            what: "A label for a mug, seen from half a metre",
            command: "anamorph samples/badge.svg --distance 50cm --onto cylinder:radius=42mm -o out.svg",
        },
        Example {
            what: "The same as a mesh for a 3D printer, and its outlines for CAD",
            command: "anamorph samples/badge.svg --distance 50cm --onto cylinder:radius=42mm --mesh out.obj --curves out-curves.obj -o out.svg",
        },
        Example {
            what: "A paper cup",
            command: "anamorph samples/logo.svg --distance 40cm --picture-width 50mm --onto cone:top-diameter=90mm,bottom-diameter=60mm,height=100mm -o out.svg",
        },
        Example {
            what: "A word that shows in a mirror, 60 mm thick, with marks for the mirror and the eye",
            command: "anamorph samples/lettering.svg --mirror cylinder:diameter=60mm --picture-width 50mm --distance 40cm --eye-height 30cm --sight-mark --fit a4 -o out.svg",
        },
        Example {
            what: "A relief that is right in a parallel projection from above on the left",
            command: "anamorph samples/logo.svg --eye inf:-1,-2,3 --onto plane:floor --fit page -o out.svg",
        },
        Example {
            what: "Into a dome, as another visitor sees it",
            command: "anamorph samples/grid.svg --distance 200 --onto sphere:eye --view 105,120,150 -o out.svg",
        },
        Example {
            what: "Swell a word away from an eye below it",
            command: "anamorph samples/lettering.svg --eye 50%,250% --degree 2x1 --push 1,0:140% -o out.svg",
        },
    ])
    .laws(&[
        Law::Identity(&[]),
        Law::Identity(&[("distance", "120"), ("onto", "cylinder:radius=90"), ("seen", "true")]),
        Law::Identity(&[("distance", "400"), ("onto", "cone:top-radius=90,bottom-radius=70"), ("eye", "40,70"), ("seen", "true")]),
        Law::Identity(&[("distance", "120"), ("onto", "sphere:radius=150,inside"), ("seen", "true")]),
        Law::Identity(&[("distance", "99"), ("degree", "2x3"), ("push", "1,1:2"), ("seen", "true")]),
        Law::Identity(&[("distance", "70"), ("onto", "plane:ramp=90")]),
        Law::Identity(&[("distance", "70"), ("onto", "plane:wall=0"), ("eye", "0,300")]),
        Law::KeepsLines(&[("distance", "500"), ("eye-height", "400"), ("onto", "plane:floor")]),
        Law::KeepsLines(&[("distance", "500"), ("onto", "plane:wall=-35"), ("view", "20,30,200")]),
        Law::KeepsLines(&[("reference", "0,0 100,0 0,100"), ("push", "0,1,0:1.5"), ("eye", "-40,20")]),
        Law::Same(
            &[("distance", "500"), ("onto", "cylinder:radius=80")],
            &[("distance", "500"), ("onto", "cone:top-radius=80,bottom-diameter=160,height=7")],
        ),
        Law::KeepsLines(&[("eye", "inf:0.3,-1,2"), ("onto", "plane:floor")]),
        Law::KeepsLines(&[("eye", "inf:0.3,-1,2"), ("onto", "plane:wall=20"), ("view", "20,30,200")]),
        Law::KeepsLines(&[("eye", "inf:1,2"), ("reference", "0,0 100,0 0,100"), ("away", "0,1,0:30")]),
        Law::Identity(&[("eye", "inf:0.1,-0.2,1"), ("onto", "cylinder:radius=90"), ("seen", "true")]),
        Law::Same(
            &[("eye", "inf:30deg,20deg"), ("onto", "cylinder:radius=130")],
            &[("eye", "inf:0.46984631039295416,-0.3420201433256687,0.8137976813493738"), ("onto", "cylinder:radius=130")],
        ),
        Law::Same(
            &[("mirror", "cylinder:radius=60"), ("distance", "300"), ("eye-height", "200"), ("foot", "50,100")],
            &[("mirror", "cylinder:diameter=120,tilt=0,height=200"), ("distance", "300"), ("eye", "50,-100")],
        ),
        Law::Same(
            &[("eye", "-30,20"), ("push", "1,1:2")],
            &[("eye", "-30,20"), ("away", "1,1:152.6433752247"), ("reference", "100,100 0,0")],
        ),
    ])
    .cases(&[
        // A hundred wide, its top 100 above the floor, the eye 400 above it and 500 away: the top lands 500·100/300 further and
        // 400/300 times as wide.
        Case { args: FLOOR, at: (0.0, 0.0), to: (50.0 - 50.0 * 4.0 / 3.0, 100.0 - 500.0 / 3.0), tolerance: 1e-11 },
        Case { args: FLOOR, at: (13.0, 100.0), to: (13.0, 100.0), tolerance: 1e-12 },
        // A cylinder seen from its axis: a ray at 45° ends an eighth of a turn along.
        Case {
            args: &[("distance", "100"), ("eye", "50,50"), ("onto", "cylinder:radius=100,inside")],
            at: (150.0, 50.0),
            to: (50.0 + 25.0 * std::f64::consts::PI, 50.0),
            tolerance: 1e-11,
        },
        // A mirror shows the middle of its foot where the eye's ray leaves its front as it came: as far before as that is behind it.
        Case {
            args: &[("mirror", "cylinder:radius=60"), ("distance", "300"), ("eye-height", "200")],
            at: (50.0, 100.0),
            to: (50.0, 220.0),
            tolerance: 1e-11,
        },
        // In the plane: one corner of a triangle twice as far; halfway along its side δ is the mean of 1 and ½.
        Case { args: PUSHED, at: (100.0, 0.0), to: (200.0, 0.0), tolerance: 1e-12 },
        Case { args: PUSHED, at: (50.0, 0.0), to: (50.0 / 0.75, 0.0), tolerance: 1e-12 },
        // A prescribed point.
        Case {
            args: &[("eye", "50,200"), ("reference", "0,100 100,100 50,0"), ("point", "50,40:1.25")],
            at: (50.0, 40.0),
            to: (50.0, 0.0),
            tolerance: 1e-12,
        },
        // Locally, neither the first side nor the outside moves.
        Case { args: LOCAL, at: (30.0, 100.0), to: (30.0, 100.0), tolerance: 1e-12 },
        Case { args: LOCAL, at: (5.0, 40.0), to: (5.0, 40.0), tolerance: 0.0 },
    ]);

const FLOOR: Pairs = &[("distance", "500"), ("eye-height", "400"), ("onto", "plane:floor")];
const PUSHED: Pairs = &[("eye", "0,0"), ("reference", "0,0 100,0 0,100"), ("push", "0,1,0:200%")];
const LOCAL: Pairs =
    &[("eye", "50,200"), ("reference", "0,100 100,100 50,0"), ("point", "50,40:1.25"), ("local", "true")];

/// Reads the deformation from text.
pub(super) const ENTRY: Entry = Entry::new(&INFO, |s| {
    // The error shows the surface as typed, instead of in user units.
    Anamorph::read(s)?.build().map_err(|e| match e {
        Error::Usage { param, value, problem, advice } => {
            let typed = ["onto", "mirror"].iter().find(|n| **n == param).and_then(|n| s.texts(n).pop());
            Error::Usage { value: typed.map_or(value, str::to_owned), param, problem, advice }
        }
        e => e,
    })
});

/// Returns the files that a parameter asks for.
fn files(s: &Settings<'_>, param: &'static str, filled: bool) -> impl Iterator<Item = SpaceFile> {
    s.texts(param).into_iter().map(move |name| SpaceFile { param, name: name.to_owned(), filled })
}
