//! The registry's entry: reads a [`Bend3`] from text.

use super::{Bend3, Handle3, Spine3};
use crate::deform::built::Built3;
use crate::deform::entry::{About3, Case3, Deformation3, Law3};
use crate::settings::Settings3;
use glam::DVec3;
use pathwarp::Error;
use pathwarp::deform::{Example, Info};
use pathwarp::param::{Kind, Param};

pub(in crate::deform) struct Entry;

/// The presets: Barr's deformations.
const PRESETS: &[&str] = &["twist", "taper", "bend"];

static ABOUT: About3 = About3 {
    info: Info::new("bend", "bend, twist or taper a model along a skeleton")
        .group("Along a curve")
        .about("One axis of the model (--along) follows a skeleton of control points (--skeleton), a Bézier curve of degree 1 to 3, \
several in a row, or a B-spline (--spline). The model keeps its size across: each leg of the skeleton has two handles, the images \
of a unit along the other two axes, which are perpendicular to it unless they are set (--side, --up). Handles of deeper levels \
(--shear) shear parts of the model.\n\nOr use a preset of Barr's: twist turns the model about the axis by --angle, taper scales its \
far end by --factor, bend rolls it up into an arc of --angle.")
        .source("The generalised de Casteljau algorithm (free-form deformation by iterated affine maps); A. H. Barr, Global and local \
deformations of solid primitives, SIGGRAPH 1984")
        .params(&[
            Param::new("skeleton", Kind::Text("X,Y,Z …"), "Control points of the skeleton, separated by spaces or semicolons."),
            Param::new("degree", Kind::Count, "Degree of the skeleton's pieces, which share their ends. Default: 3, or less for a \
skeleton of two or three points.")
            .within(1.0, 3.0),
            Param::flag("spline", "The points are those of a uniform clamped B-spline."),
            Param::new("along", Kind::Choice(&["x", "y", "z"]), "The model's axis that follows the skeleton. Its extent becomes the \
whole skeleton.")
            .default("x"),
            Param::new("through", Kind::Text("X,Y,Z"), "A point of the line in the model that becomes the skeleton. Default: the \
middle of the model's box."),
            Param::new("side", Kind::Text("I:DX,DY,DZ"), "The handle of leg I (from 0): the image of a unit along the axis after \
--along (y after x, z after y, x after z).")
            .repeated(),
            Param::new("up", Kind::Text("I:DX,DY,DZ"), "The other handle of leg I: the image of a unit along the third axis.").repeated(),
            Param::new("shear", Kind::Text("LEVEL,I:DX,DY,DZ:DX,DY,DZ"), "Both handles number I (from 0) of a deeper level, 2 or 3.")
                .repeated(),
            Param::new("preset", Kind::Choice(PRESETS), "Barr's twist, taper or bend instead of a skeleton."),
            Param::angle("angle", "Angle of the twist or bend over the model's length; turns from the axis after --along to the third, \
and bends towards the axis after --along.")
            .default("90"),
            Param::number("factor", "Size of the far end of a taper.").default("50%").within(0.0, 100.0).slider(0.0, 3.0),
        ])
        .demo(&[("skeleton", "0,50,50 33,50,50 66,55,45 100,70,40"), ("side", "1:0,1.2,0.1")])
        .examples(&[
            Example {
                what: "Twist a model by a quarter turn about its upright axis",
                command: "solid bend samples/solid/teapot.obj --preset twist --along y --angle 90 -o out.obj",
            },
            Example {
                what: "Make it narrower at the top",
                command: "solid bend samples/solid/teapot.obj --preset taper --along y --factor 60% -o out.obj",
            },
            Example {
                what: "Let it lean along a curve",
                command: "solid bend samples/solid/teapot.obj --along y --skeleton '50%,0%,50% 50%,50%,50% 60%,80%,50% 85%,100%,50%' -o out.obj",
            },
        ]),
    laws: &[
        Law3::Identity(&[("skeleton", "0,50,50 100,50,50")]),
        Law3::Identity(&[("skeleton", "50,0,50 50,25,50 50,50,50 50,75,50 50,100,50"), ("along", "y"), ("spline", "true"), ("degree", "1")]),
        Law3::Identity(&[("preset", "twist"), ("angle", "0")]),
        Law3::Identity(&[("preset", "taper"), ("factor", "1")]),
        Law3::Identity(&[("preset", "bend"), ("angle", "0"), ("along", "z")]),
        Law3::Volume(&[("preset", "twist"), ("angle", "200"), ("along", "z")], 1.0),
        Law3::KeepsLinesAlong(&[("preset", "twist"), ("angle", "200")], [0.0, 1.0, 0.7]),
        Law3::KeepsLinesAlong(&[("preset", "taper"), ("factor", "2")], [1.0, 0.0, 0.0]),
        Law3::KeepsLinesAlong(&[("skeleton", "0,50,50 40,50,50 80,60,40 100,110,30")], [0.0, 1.0, 0.3]),
        // A straight skeleton of any degree with handles of one size is the same.
        Law3::Same(
            &[("skeleton", "0,50,50 100,50,50"), ("side", "0:0,2,0")],
            &[("skeleton", "0,50,50 50,50,50 100,50,50"), ("side", "0:0,2,0 1:0,2,0")],
        ),
        // A taper is a skeleton of degree 2 whose handles differ in length.
        Law3::Same(
            &[("preset", "taper"), ("factor", "0.4")],
            &[("skeleton", "0,50,50 50,50,50 100,50,50"), ("side", "1:0,0.4,0"), ("up", "1:0,0,0.4")],
        ),
    ],
    cases: &[
        // Halfway through a quarter turn, 10 to the side of the axis: turned by 45°.
        Case3 {
            args: &[("preset", "twist"), ("angle", "90")],
            at: [50.0, 60.0, 50.0],
            to: [50.0, 57.071_067_811_865_476, 57.071_067_811_865_476],
            tolerance: 1e-13,
        },
        // Barr's linear taper: halfway the sides are three quarters.
        Case3 { args: &[("preset", "taper"), ("along", "z")], at: [90.0, 10.0, 50.0], to: [80.0, 20.0, 50.0], tolerance: 1e-13 },
        // A quarter of a circle of circumference 400 has the radius 200/π.
        Case3 {
            args: &[("preset", "bend"), ("angle", "90")],
            at: [100.0, 50.0, 20.0],
            to: [63.661_977_236_758_13, 113.661_977_236_758_13, 20.0],
            tolerance: 1e-13,
        },
        // C(1/2) = (P0 + 3·P1 + 3·P2 + P3)/8, S(1/2) = (s0 + 2·s1 + s2)/4.
        Case3 {
            args: &[("skeleton", "0,0,0 40,0,0 80,0,0 100,40,0"), ("side", "0:0,1,0 1:0,1,0 2:0,3,0"), ("up", "0:0,0,1 1:0,0,1 2:0,0,1")],
            at: [50.0, 58.0, 53.0],
            to: [57.5, 17.0, 3.0],
            tolerance: 1e-13,
        },
    ],
};

impl Deformation3 for Entry {
    fn about(&self) -> &About3 {
        &ABOUT
    }

    fn build(&self, s: &Settings3<'_>) -> Result<Built3, Error> {
        let axis = ["x", "y", "z"].iter().position(|n| Some(*n) == s.flat().choice("along").ok()).unwrap_or(0);
        let mut bend = Bend3::new(s.bounds(), spine(s)?).axis(axis);
        if let Some(p) = s.point_if("through")? {
            bend = bend.through(p);
        }
        for handle in handles(s)? {
            bend = bend.handle(handle);
        }
        bend.build()
    }
}

fn spine(s: &Settings3<'_>) -> Result<Spine3, Error> {
    if s.flat().given("preset") {
        for name in ["skeleton", "spline", "degree"] {
            if s.flat().given(name) {
                return Err(Error::usage(
                    name,
                    s.words(name).join(" "),
                    "cannot go with `preset`, which has its own skeleton",
                ));
            }
        }
        let angle = s.flat().number("angle")?.to_radians();
        return Ok(match s.flat().choice("preset")? {
            "twist" => Spine3::Twist(angle),
            "taper" => Spine3::Taper(s.flat().number("factor")?),
            _ => Spine3::Arc(angle),
        });
    }
    for name in ["angle", "factor"] {
        if s.flat().given(name) {
            return Err(Error::usage(name, s.words(name).join(" "), "is for a `preset`"));
        }
    }
    let words = s.words("skeleton").into_iter().flat_map(|w| w.split(';')).filter(|w| !w.is_empty());
    let points: Vec<DVec3> = words.map(|w| s.point_in("skeleton", w)).collect::<Result<_, _>>()?;
    if points.len() < 2 {
        return Err(Error::missing("skeleton", "two or more points X,Y,Z, unless there is a `preset`"));
    }
    // The range is checked, so that the cast is exact.
    let degree = s.flat().number_if("degree")?.map_or((points.len() - 1).min(3), |d| d as usize);
    Ok(if s.flat().flag("spline")? { Spine3::Spline(points, degree) } else { Spine3::Bezier(points, degree) })
}

/// Reads `side`, `up` and `shear`.
fn handles(s: &Settings3<'_>) -> Result<Vec<Handle3>, Error> {
    let mut out = Vec::new();
    for name in ["side", "up"] {
        for word in s.words(name) {
            let ([index], value) = s.flat().node_in::<1>(name, word)?;
            let v = s.vector_in(name, value)?;
            let (side, up) = if name == "side" { (Some(v), None) } else { (None, Some(v)) };
            out.push(Handle3 { level: 1, index, side, up });
        }
    }
    for word in s.words("shear") {
        let ([level, index], value) = s.flat().node_in::<2>("shear", word)?;
        let wrong = || Error::usage("shear", word, "is not LEVEL,I:DX,DY,DZ:DX,DY,DZ with a level from 2");
        let (side, up) = value.split_once(':').filter(|_| level >= 2).ok_or_else(wrong)?;
        let (side, up) = (s.vector_in("shear", side)?, s.vector_in("shear", up)?);
        out.push(Handle3 { level, index, side: Some(side), up: Some(up) });
    }
    Ok(out)
}
