//! The registry's entry: reads an [`Anamorph`] from text.

use super::net::{Net, Push};
use super::onto::Onto;
use super::{Anamorph, Look};
use crate::deform::built::{Built, SpaceFile};
use crate::deform::entry::{ByHand, Case, Deformation, Example, Info, Law, Pairs};
use crate::error::Error;
use crate::param::{Axis, Kind, Param, Settings};

pub(in crate::deform) struct Entry;

pub(super) static INFO: Info = Info::new("anamorph", "draw artwork that looks right from one place: road markings, mugs, domes")
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
cone:top=45mm,bottom=30mm,height=90mm  a cup; height by default the artwork's\n  \
sphere:radius=60mm     a ball; it cannot be laid flat, so it needs --view\n  \
sphere:eye             a dome with the eye on its near pole: lines become circles\n\
Add `,inside` to a cylinder, cone or sphere to see it from within, `,level` to a cylinder to lay it down. --seen gives the eye's view, \
which is the artwork itself; --view the view from elsewhere.\n\n\
In the plane: without --distance the eye lies in the drawing, and control points are pushed towards it or away from it (--push, \
--away, --at, --point). They lie over a --reference triangle or box. With --distance the same pushes bend a sheet in front of the eye: \
flat for a triangle of degree 1, otherwise shown with --view.")
    .source("J. Sánchez-Reyes, J. M. Chacón, Anamorphic Free-Form Deformation, CAGD 46, 2016")
    .params(&[
        Param::new("eye", Kind::Point, "Position of the eye, in the drawing or straight in front of this point.")
            .default("50%,50%"),
        Param::length("distance", Axis::X, "Distance of the eye in front of the drawing. Without it the eye lies in the drawing.")
            .within(1e-6, 1e9)
            .slider(10.0, 2000.0),
        Param::length("eye-height", Axis::Y, "Height of the eye above the artwork's bottom edge (the floor).").within(0.0, 1e9)
            .slider(0.0, 8000.0),
        Param::length("picture-width", Axis::X, "Apparent width of the artwork. Default: as drawn.")
            .within(1e-6, 1e9)
            .slider(1.0, 4000.0),
        Param::length("length", Axis::Y, "Length of the result on the floor or ramp; needs --eye-height.")
            .within(1e-6, 1e9)
            .slider(10.0, 40000.0),
        Param::new("onto", Kind::Text("SURFACE"), "The surface that the artwork is projected onto: plane:…, cylinder:…, cone:… or sphere:… as above."),
        Param::flag("seen", "Give the eye's view."),
        Param::new("view", Kind::Text("X,Y,Z"), "Give the view from here, Z in front of the drawing, looking at its middle."),
        Param::new(
            "reference",
            Kind::Text("X,Y X,Y [X,Y]"),
            "The region of the control points: three corners of a triangle, or two of a box. Default: the artwork's box.",
        ),
        Param::new("degree", Kind::Text("N|MxN"), "Degree of the net: control points along a side, less one; MxN across and down a box.").default("1"),
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
            "Takes a control point to the point of its ray nearest to here (eye in the drawing); may be given many times.",
        )
        .repeated(),
        Param::new(
            "point",
            Kind::Text("X,Y:FACTOR"),
            "Takes this point to so many times its distance from the eye, by pushing the control point nearest to it that is not on \
a fixed side: the first side of a triangle, the edge of a box if --local.",
        )
        .repeated(),
        Param::new("mesh", Kind::Save, "Write the filled artwork on the surface as a mesh in 3D (OBJ), for printing and CAD; needs --distance."),
        Param::new("curves", Kind::Save, "Write the artwork's outlines on the surface as polylines in 3D (OBJ); needs --distance."),
        Param::flag("local", "Move only artwork inside the reference."),
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
            command: "anamorph samples/lettering.svg --eye 50%,250% --degree 2x1 --push 1,0:140% -o out.svg",
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
        // A prescribed point.
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

const FLOOR: Pairs = &[("distance", "500"), ("eye-height", "400"), ("onto", "plane:floor")];
const PUSHED: Pairs = &[("eye", "0,0"), ("reference", "0,0 100,0 0,100"), ("push", "0,1,0:200%")];
const LOCAL: Pairs =
    &[("eye", "50,200"), ("reference", "0,100 100,100 50,0"), ("point", "50,40:1.25"), ("local", "true")];

impl Deformation for Entry {
    fn info(&self) -> &Info {
        &INFO
    }

    fn build(&self, s: &Settings<'_>) -> Result<Built, Error> {
        let files = |param: &'static str, filled: bool| {
            s.texts(param).into_iter().map(move |name| SpaceFile { param, name: name.to_owned(), filled })
        };
        let anamorph = Anamorph {
            frame: s.frame().rect,
            eye: s.point("eye")?,
            eye_given: s.given("eye"),
            distance: s.number_if("distance")?,
            eye_height: s.number_if("eye-height")?,
            picture_width: s.number_if("picture-width")?,
            length: s.number_if("length")?,
            onto: s.texts("onto").pop().map(|text| onto(s, text)).transpose()?,
            look: look(s)?,
            net: net(s)?,
            local: s.flag("local")?,
            files: files("mesh", true).chain(files("curves", false)).collect(),
        };
        // The surface as typed, rather than in user units.
        anamorph.build().map_err(|e| match (e, s.texts("onto").pop()) {
            (Error::Usage { param, problem, .. }, Some(text)) if param == "onto" => Error::usage("onto", text, problem),
            (e, _) => e,
        })
    }
}

fn look(s: &Settings<'_>) -> Result<Look, Error> {
    let Some(text) = s.texts("view").pop() else {
        return Ok(if s.flag("seen")? { Look::Eye } else { Look::Unrolled });
    };
    if s.flag("seen")? {
        return Err(Error::usage("view", text, "and `seen` exclude each other"));
    }
    let parts: Vec<&str> = text.split(',').collect();
    let [x, y, z] = parts[..] else {
        return Err(Error::usage("view", text, "is not a point X,Y,Z"));
    };
    let p = s.point_in("view", &format!("{x},{y}"))?;
    Ok(Look::From([p.x, p.y, s.length_in("view", z, Axis::X)?]))
}

/// Reads the control points; `None` if no parameter of theirs is given.
fn net(s: &Settings<'_>) -> Result<Option<Net>, Error> {
    const NAMES: [&str; 6] = ["reference", "degree", "push", "away", "at", "point"];
    if !NAMES.iter().any(|n| s.given(n)) {
        return Ok(None);
    }
    let reference = s.texts("reference").pop().map(|text| s.points_in("reference", text)).transpose()?;
    let text = s.texts("degree").pop().unwrap_or("1");
    let triangle = reference.as_ref().is_some_and(|r| r.len() == 3);
    let (m, n) = if triangle { (text, text) } else { text.split_once('x').unwrap_or((text, text)) };
    let degree = [degree(text, m)?, degree(text, n)?];
    let node = |name: &str, text: &str| -> Result<([usize; 3], String), Error> {
        if triangle {
            return s.node_in::<3>(name, text).map(|(node, rest)| (node, rest.to_owned()));
        }
        s.node_in::<2>(name, text).map(|([i, j], rest)| ([i, j, 0], rest.to_owned()))
    };
    let mut pushes = Vec::new();
    for text in s.texts("push") {
        let (node, rest) = node("push", text)?;
        pushes.push(Push::By(node, s.number_in("push", &rest)?));
    }
    for text in s.texts("away") {
        let (node, rest) = node("away", text)?;
        pushes.push(Push::Away(node, s.length_in("away", &rest, Axis::Diagonal)?));
    }
    for text in s.texts("at") {
        let (node, rest) = node("at", text)?;
        pushes.push(Push::To(node, s.point_in("at", &rest)?));
    }
    for text in s.texts("point") {
        let (place, factor) = text.rsplit_once(':').ok_or_else(|| Error::usage("point", text, "is not X,Y:FACTOR"))?;
        pushes.push(Push::Prescribe(s.point_in("point", place)?, s.number_in("point", factor)?));
    }
    Ok(Some(Net { reference: reference.unwrap_or_default(), degree, pushes }))
}

fn degree(text: &str, part: &str) -> Result<usize, Error> {
    let n = part.trim().parse().ok().filter(|n| (1..=10).contains(n));
    n.ok_or_else(|| {
        Error::usage("degree", text, "is not a degree: a number from 1 to 10, or for a box two such as 3x2")
    })
}

/// The parts of `KIND:WORD,NAME=VALUE,…`.
struct Words<'t> {
    text: &'t str,
    kind: &'t str,
    list: Vec<(&'t str, Option<&'t str>)>,
}

impl<'t> Words<'t> {
    fn new(text: &'t str) -> Self {
        let (kind, rest) = text.split_once(':').unwrap_or((text, ""));
        let list = rest.split(',').map(str::trim).filter(|w| !w.is_empty());
        let list = list.map(|w| w.split_once('=').map_or((w, None), |(n, v)| (n.trim(), Some(v.trim()))));
        Self { text, kind: kind.trim(), list: list.collect() }
    }

    fn has(&self, name: &str) -> bool {
        self.list.contains(&(name, None))
    }

    fn value(&self, name: &str) -> Option<&'t str> {
        self.list.iter().find(|w| w.0 == name).and_then(|w| w.1)
    }

    fn wrong(&self, problem: impl Into<String>) -> Error {
        Error::usage("onto", self.text, problem)
    }

    /// Refuses all but these words.
    fn only(&self, switches: &[&str], values: &[&str]) -> Result<(), Error> {
        for (name, value) in &self.list {
            let known = if value.is_some() { values } else { switches };
            if !known.contains(name) {
                let all: Vec<String> =
                    switches.iter().map(|s| (*s).to_owned()).chain(values.iter().map(|v| format!("{v}=…"))).collect();
                return Err(self.wrong(format!(
                    "has “{name}”, which a {} does not have; it has {}",
                    self.kind,
                    all.join(", ")
                )));
            }
        }
        Ok(())
    }

    fn size(&self, s: &Settings<'_>, name: &str) -> Result<Option<f64>, Error> {
        let Some(text) = self.value(name) else { return Ok(None) };
        let v = s.length_in("onto", text, Axis::X)?;
        if v > 0.0 && v < 1e9 { Ok(Some(v)) } else { Err(self.wrong(format!("has a {name} that is not positive"))) }
    }

    /// Reads the radius or the diameter.
    fn radius(&self, s: &Settings<'_>) -> Result<f64, Error> {
        match (self.size(s, "radius")?, self.size(s, "diameter")?) {
            (Some(r), None) => Ok(r),
            (None, Some(d)) => Ok(d / 2.0),
            _ => Err(self.wrong(format!("needs radius=… or diameter=…, such as {}:radius=40mm", self.kind))),
        }
    }
}

/// Reads the surface.
fn onto(s: &Settings<'_>, text: &str) -> Result<Onto, Error> {
    let w = Words::new(text);
    match w.kind {
        "plane" => plane(s, &w),
        "cylinder" => {
            w.only(&["inside", "level"], &["radius", "diameter"])?;
            Ok(Onto::Cylinder { radius: w.radius(s)?, level: w.has("level"), inside: w.has("inside") })
        }
        "cone" => {
            w.only(&["inside"], &["top", "bottom", "height"])?;
            let (Some(top), Some(bottom)) = (w.size(s, "top")?, w.size(s, "bottom")?) else {
                return Err(w.wrong(
                    "needs the radii at the top and the bottom, such as cone:top=45mm,bottom=30mm,height=100mm",
                ));
            };
            Ok(Onto::Cone { top, bottom, height: w.size(s, "height")?, inside: w.has("inside") })
        }
        "sphere" if w.has("eye") => {
            w.only(&["eye"], &[])?;
            Ok(Onto::Dome)
        }
        "sphere" => {
            w.only(&["inside"], &["radius", "diameter"])?;
            Ok(Onto::Sphere { radius: w.radius(s)?, inside: w.has("inside") })
        }
        _ => Err(w.wrong("is not a surface; there are plane:…, cylinder:…, cone:… and sphere:…")),
    }
}

fn plane(s: &Settings<'_>, w: &Words<'_>) -> Result<Onto, Error> {
    w.only(&["floor", "ceiling", "left", "right"], &["ramp", "wall"])?;
    let angle = |text: &Option<&str>| s.angle_in("onto", text.unwrap_or("0"));
    match &w.list[..] {
        [("floor", None)] => Ok(Onto::Floor),
        [("ceiling", None)] => Ok(Onto::Ceiling),
        [("left", None)] => Ok(Onto::LeftWall),
        [("right", None)] => Ok(Onto::RightWall),
        [("ramp", text)] => Ok(Onto::Ramp(angle(text)?)),
        [("wall", text)] => Ok(Onto::Wall(angle(text)?)),
        _ => Err(w.wrong(
            "is not one of plane:floor, plane:ceiling, plane:left, plane:right, plane:ramp=ANGLE, plane:wall=ANGLE",
        )),
    }
}
