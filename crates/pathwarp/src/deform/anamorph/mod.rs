//! Anamorphosis: drawings that look right from one place only.
//!
//! Every point moves along its ray through the eye O: p̂ = O + (p − O)/δ(p). Three ways to say δ:
//!
//! - the eye lies in the plane of the drawing, and control points are pushed along rays ([`dilation`]);
//! - the eye stands in front of it, and the drawing is thrown onto a surface ([`surface`]): unrolled true to size, or seen
//!   by another camera ([`camera`]);
//! - the eye stands in front, and control points are pushed along rays in space: at degree 1 of a triangle they span a plane, at
//!   degree 2 a quadric through O, on which straight lines become conics.
//!
//! A point p prescribed to go to p/δ sets one control point, δᵢ = 1 + (δ − 1)/Bᵢ(p) (the paper's δ₃ = 1 + (δ − 1)/u₃); the
//! others stay, so that inside and outside of the reference join along the sides that do not move (its Fig. 9).
//!
//! The size on a ramp rising by α: the place at slant L is L·sin α high and L·cos α behind the picture plane, and is seen at
//! height H + (L·sin α − H)·D/(D + L·cos α) there, H being the eye's height and D its distance. `length` solves this for the
//! scale.
//!
//! J. Sánchez-Reyes, J. M. Chacón, *Anamorphic free-form deformation*, CAGD 46 (2016); D. Hansford, D. Collins, *Anamorphic 3D
//! geometry*, Computing 79 (2007).
//!

mod camera;
mod dilation;
mod net;
mod onto;
mod scene;
mod surface;
#[cfg(test)]
mod tests;

use super::built::{Built, InSpace, Role, SpaceFile};
use super::entry::{Case, Deformation, Example, Info, Law};
use crate::error::Error;
use crate::map::{AffineMap, Chain, Local, Map};
use crate::param::{Axis, Kind, Param, Settings};
use camera::Camera;
use kurbo::{Affine, Point, Shape};
use scene::Scene;
use std::sync::Arc;
use surface::{Anamorphosis, Radial, Surface};

pub(super) struct Anamorph;

static INFO: Info = Info::new("anamorph", "draw what looks right from one place: road markings, mugs, domes")
    .group("Perspective and anamorphosis")
    .about("Stretches the artwork so that it looks as drawn to an eye at one place.\n\n\
On a surface: say where the eye is (--distance, --eye or --eye-height) and what the artwork is thrown onto (--onto). The result is \
that surface laid flat, true to size, to be painted, cut or printed:\n  \
plane:floor            the ground under the artwork's bottom edge\n  \
plane:ceiling          above its top edge\n  \
plane:left plane:right a side wall along its left or right edge\n  \
plane:ramp=20          ground that rises by an angle away from the eye\n  \
plane:wall=30          an upright wall, its right side turned away by an angle\n  \
cylinder:radius=40mm   a mug, its front touching the artwork's middle\n  \
cone:top=45mm,bottom=30mm,height=90mm  a cup; height by default the artwork's\n  \
sphere:radius=60mm     a ball; it cannot be laid flat, so it needs --view\n  \
sphere:eye             a dome with the eye on its near pole: lines become circles\n\
Add `,inside` to a cylinder, cone or sphere to see it from within, `,level` to a cylinder to lay it down. --seen gives what the eye \
sees, which is the artwork itself; --view what is seen from elsewhere.\n\n\
In the plane: without --distance the eye lies in the drawing, and control points are pushed towards it or away from it (--push, \
--away, --at, --point). They lie over a --reference triangle or box. With --distance the same pushes bend a sheet in front of the eye: \
flat for a triangle of degree 1, else to be looked at with --view.")
    .source("J. Sánchez-Reyes, J. M. Chacón, Anamorphic Free-Form Deformation, CAGD 46, 2016")
    .params(&[
        Param::new("eye", Kind::Point, "Where the eye is, in the drawing or straight in front of this place.")
            .default("50%,50%"),
        Param::length("distance", Axis::X, "How far in front of the drawing the eye is. Without it the eye lies in the drawing.")
            .within(1e-6, 1e9)
            .slider(10.0, 2000.0),
        Param::length("eye-height", Axis::Y, "How high the eye is above the artwork's bottom edge (the floor).").within(0.0, 1e9)
            .slider(0.0, 8000.0),
        Param::length("picture-width", Axis::X, "How wide the artwork is where it seems to stand. Default: as drawn.")
            .within(1e-6, 1e9)
            .slider(1.0, 4000.0),
        Param::length("length", Axis::Y, "How long the result is to be on the floor or ramp; needs --eye-height.")
            .within(1e-6, 1e9)
            .slider(10.0, 40000.0),
        Param::new("onto", Kind::Text("SURFACE"), "What the artwork is thrown onto: plane:…, cylinder:…, cone:… or sphere:… as above."),
        Param::flag("seen", "Give what the eye sees."),
        Param::new("view", Kind::Text("X,Y,Z"), "Give what is seen from here, Z in front of the drawing, looking at its middle."),
        Param::new(
            "reference",
            Kind::Text("X,Y X,Y [X,Y]"),
            "Where the control points are: three corners of a triangle, or two of a box. Default: the artwork's box.",
        ),
        Param::new("degree", Kind::Text("N|MxN"), "How finely the reference is divided; MxN across and down a box.").default("1"),
        Param::new(
            "push",
            Kind::Text("I,J[,K]:FACTOR"),
            "Takes a control point to this many times its distance from the eye; may be given many times.",
        )
        .repeated(),
        Param::new(
            "away",
            Kind::Text("I,J[,K]:LENGTH"),
            "Takes a control point this much further from the eye, or nearer if negative; may be given many times.",
        )
        .repeated(),
        Param::new(
            "at",
            Kind::Text("I,J[,K]:X,Y"),
            "Takes a control point to the place on its ray nearest to here (eye in the drawing); may be given many times.",
        )
        .repeated(),
        Param::new(
            "point",
            Kind::Text("X,Y:FACTOR"),
            "Takes this place to so many times its distance from the eye, by pushing the control point nearest to it that is not on \
a held side: the first side of a triangle, the edge of a box if --local.",
        )
        .repeated(),
        Param::new("mesh", Kind::Save, "Write the filled artwork on the surface as a mesh in 3D (OBJ), for printing and CAD; needs --distance."),
        Param::new("curves", Kind::Save, "Write the artwork's outlines on the surface as polylines in 3D (OBJ); needs --distance."),
        Param::flag("local", "Move only what lies inside the reference."),
    ])
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
            command: "anamorph samples/logo.svg --distance 40cm --picture-width 50mm --onto cone:top=45mm,bottom=30mm,height=100mm -o out.svg",
        },
        Example {
            what: "Into a dome, as another visitor sees it",
            command: "anamorph samples/grid.svg --distance 200 --onto sphere:eye --view 105,120,150 -o out.svg",
        },
        Example {
            what: "Swell a word away from an eye below it",
            command: "anamorph samples/lettering.svg --eye 50%,250% --degree 2x1 --push 1,0:140% --fit grow -o out.svg",
        },
    ])
    .laws(&[
        Law::Identity(&[]),
        Law::Identity(&[("distance", "120"), ("onto", "cylinder:radius=90"), ("seen", "true")]),
        Law::Identity(&[("distance", "400"), ("onto", "cone:top=90,bottom=70"), ("eye", "40,70"), ("seen", "true")]),
        Law::Identity(&[("distance", "120"), ("onto", "sphere:radius=150,inside"), ("seen", "true")]),
        Law::Identity(&[("distance", "99"), ("degree", "2x3"), ("push", "1,1:2"), ("seen", "true")]),
        Law::Identity(&[("distance", "70"), ("onto", "plane:ramp=90")]),
        Law::Identity(&[("distance", "70"), ("onto", "plane:wall=0"), ("eye", "0,300")]),
        Law::KeepsLines(&[("distance", "500"), ("eye-height", "400"), ("onto", "plane:floor")]),
        Law::KeepsLines(&[("distance", "500"), ("onto", "plane:wall=-35"), ("view", "20,30,200")]),
        Law::KeepsLines(&[("reference", "0,0 100,0 0,100"), ("push", "0,1,0:1.5"), ("eye", "-40,20")]),
        Law::Same(
            &[("distance", "500"), ("onto", "cylinder:radius=80")],
            &[("distance", "500"), ("onto", "cone:top=80,bottom=80,height=7")],
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
        // In the plane: one corner of a triangle twice as far; halfway along its side δ is the mean of 1 and ½.
        Case { args: PUSHED, at: (100.0, 0.0), to: (200.0, 0.0), tolerance: 1e-12 },
        Case { args: PUSHED, at: (50.0, 0.0), to: (50.0 / 0.75, 0.0), tolerance: 1e-12 },
        // A place prescribed.
        Case {
            args: &[("eye", "50,200"), ("reference", "0,100 100,100 50,0"), ("point", "50,40:1.25")],
            at: (50.0, 40.0),
            to: (50.0, 0.0),
            tolerance: 1e-12,
        },
        // The same locally: the first side stays, and so does what lies outside.
        Case { args: LOCAL, at: (30.0, 100.0), to: (30.0, 100.0), tolerance: 1e-12 },
        Case { args: LOCAL, at: (5.0, 40.0), to: (5.0, 40.0), tolerance: 0.0 },
    ]);

const FLOOR: super::entry::Pairs = &[("distance", "500"), ("eye-height", "400"), ("onto", "plane:floor")];
const PUSHED: super::entry::Pairs = &[("eye", "0,0"), ("reference", "0,0 100,0 0,100"), ("push", "0,1,0:200%")];
const LOCAL: super::entry::Pairs =
    &[("eye", "50,200"), ("reference", "0,100 100,100 50,0"), ("point", "50,40:1.25"), ("local", "true")];

impl Deformation for Anamorph {
    fn info(&self) -> &Info {
        &INFO
    }

    fn build(&self, s: &Settings<'_>) -> Result<Built, Error> {
        match s.number_if("distance")? {
            Some(distance) => in_front(s, distance),
            None => in_plane(s),
        }
    }
}

/// The eye in the plane of the drawing.
fn in_plane(s: &Settings<'_>) -> Result<Built, Error> {
    if let Some(name) =
        ["onto", "view", "seen", "eye-height", "picture-width", "length", "mesh", "curves"].iter().find(|n| s.given(n))
    {
        let hint = format!("how far in front of the drawing the eye is; `{name}` wants it");
        return Err(Error::Missing { param: "distance".into(), hint });
    }
    let scene = Scene { frame: s.frame().rect, scale: Affine::IDENTITY, eye: s.point("eye")? };
    let local = s.flag("local")?;
    let dilation = net::dilation(s, &scene, 0.0)?;
    let map = dilation.about(scene.eye, local);
    let still = dilation.lines(|p, delta| scene.eye + (p - scene.eye) / delta);
    let map: Arc<dyn Map> =
        if local { Arc::new(Local::new(&dilation.reference().corners(), Arc::new(map))) } else { map.simplest() };
    let mut built = Built::new(map);
    if local {
        net::tell_torn_sides(&dilation, scene.frame, &mut built);
    }
    built.overlay(Role::Base, dilation.outline());
    built.overlay(Role::Cage, still);
    Ok(built)
}

/// The eye in front of the drawing.
fn in_front(s: &Settings<'_>, distance: f64) -> Result<Built, Error> {
    if s.flag("local")? {
        return Err(Error::usage("local", "", "works for an eye in the drawing only, without `distance`"));
    }
    let scene = scene(s, distance)?;
    let foot = scene.eye;
    let surface = match s.texts("onto").pop() {
        Some(text) => {
            if let Some(name) = net::NAMES.iter().find(|n| s.given(n)) {
                return Err(Error::usage(name, "", "moves control points, but `onto` has the surface already"));
            }
            onto::surface(s, text, &scene, distance)?
        }
        None => {
            let dilation = net::dilation(s, &scene, distance)?;
            net::flat(&dilation, foot, distance).map_or_else(|| Surface::Radial(Radial::net(&dilation)), Surface::Plane)
        }
    };
    let cast = Anamorphosis { foot, distance, surface };
    onto::must_be_met(s, &cast, scene.frame)?;
    let map = if s.flag("seen")? {
        if s.given("view") {
            return Err(Error::usage("view", "", "and `seen` exclude each other"));
        }
        cast.seen()
    } else if let Some(text) = s.texts("view").pop() {
        let at = onto::view(s, text, &scene)?;
        let middle = scene.frame.center();
        let camera = Camera::new(at, cast.point(middle), middle)
            .ok_or_else(|| Error::usage("view", text, "is on the surface itself; move it away"))?;
        let map = cast.viewed(&camera, scene.frame);
        onto::must_be_in_view(text, &cast, &camera, scene.frame)?;
        map
    } else {
        cast.unrolled().ok_or_else(|| {
            let hint = "such a surface cannot be laid flat; say from where it is to be seen, X,Y,Z with Z in front of the drawing, or give `seen`";
            Error::Missing { param: "view".into(), hint: hint.into() }
        })?
    };
    let mut built =
        Built::new(Arc::new(Chain::new([Arc::new(AffineMap(scene.scale)) as Arc<dyn Map>, Arc::clone(&map)])));
    let (scale, solid) = (scene.scale, cast.clone());
    let place = Arc::new(move |p| {
        let p = scale * p;
        (solid.defined(p) > 0.0).then(|| solid.point(p)).filter(|q| q.iter().all(|v| v.is_finite()))
    });
    let asked = |param: &'static str, filled: bool| {
        s.texts(param).into_iter().map(move |name| SpaceFile { param, name: name.to_owned(), filled })
    };
    built.space = Some(InSpace { place, files: asked("mesh", true).chain(asked("curves", false)).collect() });
    built.note(scene.size(&*map));
    built.overlay(Role::Base, s.frame().rect.to_path(0.1));
    if let Some(path) = scene.outline(&*map) {
        built.overlay(Role::Target, path);
    }
    Ok(built)
}

/// The scene at its real size.
fn scene(s: &Settings<'_>, distance: f64) -> Result<Scene, Error> {
    let drawn = s.frame().rect;
    let height = s.number_if("eye-height")?;
    if height.is_some() && s.given("eye") {
        return Err(Error::usage("eye-height", "", "and `eye` both say where the eye is; give one"));
    }
    let wanted = s.number_if("picture-width")?;
    let k = match (wanted, s.number_if("length")?) {
        (Some(_), Some(_)) => {
            return Err(Error::usage("length", "", "and `picture-width` both say how large the artwork is; give one"));
        }
        (Some(w), None) => w / drawn.width(),
        (None, Some(length)) => onto::scale_for(s, length, height, distance)?,
        (None, None) => 1.0,
    };
    if !k.is_finite() || k <= 0.0 {
        return Err(Error::usage("picture-width", "", "cannot be given to artwork that has no size"));
    }
    let anchor = Point::new(drawn.center().x, drawn.y1);
    let scale = if k == 1.0 { Affine::IDENTITY } else { Affine::scale_about(k, anchor) };
    let eye = match height {
        Some(h) => Point::new(anchor.x, anchor.y - h),
        None => scale * s.point("eye")?,
    };
    Ok(Scene { frame: scale.transform_rect_bbox(drawn), scale, eye })
}
