//! The registry's entry: reads an [`Anamorph3`] from text.

use super::dilation::MAX_DEGREE;
use super::{Anamorph3, Push3, Reference3};
use crate::deform::built::Built3;
use crate::deform::entry::{About3, Case3, Deformation3, Law3};
use crate::settings::{Extent, Settings3};
use glam::DVec3;
use pathwarp::Error;
use pathwarp::deform::{Example, Info, Pairs};
use pathwarp::param::{Kind, Param};

pub(in crate::deform) struct Entry;

/// A tetrahedron in the frame of laws and cases, with its eye.
const TETRAHEDRON: &str = "0,0,0 100,0,0 0,100,0 0,0,100";

static ABOUT: About3 = About3 {
    info: Info::new("anamorph", "deform a model so that it looks unchanged from one place")
        .group("Perspective and anamorphosis")
        .about("Moves every point along its ray through the eye (--eye), so that the picture from there stays the same, and from \
everywhere else the model is distorted: Ames rooms, sculptures that come together at one spot, reliefs.\n\n\
Control points of a reference (--reference) are pushed along their rays, and the model follows:\n  \
four points: a tetrahedron, whose control points I,J,K,L add up to the degree. At degree 1 planes stay plane.\n  \
two points: a box with control points I,J,K from the left, bottom and back; if it is flat, a sheet.\n  \
three points: a triangle as a sheet, control points I,J,K. All points of a ray through a sheet are moved by one factor.\n\n\
With --local nothing outside the reference moves: leave the control points of the face where the model leaves the reference in \
place, or a second layer of them for a smooth transition.")
        .source("J. Sánchez-Reyes, J. M. Chacón, Anamorphic free-form deformation, CAGD 46, 2016; D. Hansford, D. Collins, \
Anamorphic 3D geometry, Computing 79, 2007")
        .params(&[
            Param::new("eye", Kind::Text("X,Y,Z"), "The place from which the model looks unchanged.").needed(),
            Param::new("reference", Kind::Text("X,Y,Z …"), "Corners of the reference: four points, three, or two opposite corners of a \
box. Default: the model's box."),
            Param::new("degree", Kind::Text("N|LxMxN"), "Degree of the reference, 1 to 10; a box may have one along each axis.").default("1"),
            Param::new("push", Kind::Text("NODE:FACTOR"), "Take control point I,J,K (or I,J,K,L) to FACTOR times its distance from the \
eye, such as 1,1,0:150%.")
            .repeated(),
            Param::new("away", Kind::Text("NODE:LENGTH"), "Take a control point LENGTH further from the eye; a negative one comes closer.")
                .repeated(),
            Param::new("at", Kind::Text("NODE:X,Y,Z"), "Take a control point to the point of its ray nearest to X,Y,Z.").repeated(),
            Param::new("point", Kind::Text("X,Y,Z:FACTOR"), "Take a point of the model to FACTOR times its distance from the eye, by the \
control point that has most influence there and is not on the fixed face (the first three corners of a tetrahedron).")
            .repeated(),
            Param::flag("local", "Leave everything outside the reference in place."),
        ])
        .demo(&[("eye", "50,60,400"), ("degree", "2x1x1"), ("push", "1,1,0:1.6 0,0,1:0.8")])
        .examples(&[
            Example {
                what: "Stretch a model away from the eye: a perspective collineation",
                command: "solid anamorph samples/solid/teapot.obj --eye 50%,60%,600% --reference '0%,0%,100% 100%,0%,100% 0%,100%,100% 50%,50%,-50%' \
--push 0,0,0,1:160% -o out.obj",
            },
            Example {
                what: "Bend a model to and fro along its rays",
                command: "solid anamorph samples/solid/teapot.obj --eye 50%,60%,600% --degree 3x1x1 --push 1,0,0:1.3 --push 1,1,0:1.3 \
--push 2,0,1:0.8 --push 2,1,1:0.8 -o out.obj",
            },
            Example {
                what: "Draw out the spout alone: the three corners around its foot stay",
                command: "solid anamorph samples/solid/teapot.obj --eye 50%,60%,600% --local --reference \
'79%,-100%,-300% 79%,-100%,400% 79%,400%,50% 115%,60%,50%' --point 98%,70%,50%:125% -o out.obj",
            },
        ]),
    laws: &[
        Law3::Identity(&[("eye", "50,50,300")]),
        Law3::Identity(&[("eye", "50,50,300"), ("degree", "3x2x1"), ("push", "1,1,1:1")]),
        Law3::Identity(&[("eye", "50,50,300"), ("reference", "0,0,0 100,0,0 0,100,0"), ("degree", "3")]),
        Law3::KeepsPlanes(&[("eye", "50,60,300"), ("reference", TETRAHEDRON), ("push", "0,0,0,1:1.4 1,0,0,0:0.8")]),
        Law3::KeepsRays(&[("eye", "50,60,300"), ("reference", TETRAHEDRON), ("push", "0,0,0,1:1.4 1,0,0,0:0.8")], [50.0, 60.0, 300.0]),
        Law3::KeepsRays(&[("eye", "50,60,300"), ("reference", TETRAHEDRON), ("degree", "2"), ("push", "0,0,1,1:1.4")], [50.0, 60.0, 300.0]),
        Law3::KeepsRays(&[("eye", "50,60,300"), ("degree", "3x2x1"), ("push", "1,1,1:1.3 2,0,0:0.7")], [50.0, 60.0, 300.0]),
        Law3::KeepsRays(&[("eye", "50,60,300"), ("reference", "0,0,0 100,0,0 0,100,0"), ("degree", "2"), ("push", "1,1,0:1.3")], [50.0, 60.0, 300.0]),
        Law3::KeepsRays(&[("eye", "50,60,300"), ("reference", "0,0,0 100,100,0"), ("degree", "2"), ("push", "1,1,0:1.3")], [50.0, 60.0, 300.0]),
        // The same tetrahedron with its degree raised: δ of the middles of edges are means.
        Law3::Same(
            &[("eye", "50,60,300"), ("reference", TETRAHEDRON), ("push", "0,0,0,1:0.5")],
            &[("eye", "50,60,300"), ("reference", TETRAHEDRON), ("degree", "2"),
              ("push", "0,0,0,2:0.5 1,0,0,1:66.66666666666667% 0,1,0,1:66.66666666666667% 0,0,1,1:66.66666666666667%")],
        ),
        // A multiple of the distance, or the distance itself: control point 1,1,1 is 50, 40 and 200 away from the eye.
        Law3::Same(
            &[("eye", "50,60,300"), ("push", "1,1,1:2")],
            &[("eye", "50,60,300"), ("away", "1,1,1:210.0")],
        ),
        Law3::FixedOutside(LOCAL, [[20.0, 20.0, 20.0], [80.0, 80.0, 80.0]]),
    ],
    cases: &[
        // From rest the fourth corner takes the whole push: δ₃ = 1 + (δ − 1)/u₃ with u₃ = 1/4, δ = 4/5, so δ₃ = 1/5.
        Case3 {
            args: &[("eye", "0,0,300"), ("reference", TETRAHEDRON), ("point", "20,20,25:1.25")],
            at: [20.0, 20.0, 25.0],
            to: [25.0, 25.0, 300.0 - 275.0 * 1.25],
            tolerance: 1e-11,
        },
        // The plane of the three corners that stay is the axis.
        Case3 {
            args: &[("eye", "0,0,300"), ("reference", TETRAHEDRON), ("push", "0,0,0,1:3")],
            at: [37.0, 12.0, 0.0],
            to: [37.0, 12.0, 0.0],
            tolerance: 1e-12,
        },
    ],
};

const LOCAL: Pairs = &[
    ("eye", "50,60,300"),
    ("reference", "20,20,20 80,80,80"),
    ("degree", "2"),
    ("push", "1,1,1:1.2"),
    ("local", "true"),
];

impl Deformation3 for Entry {
    fn about(&self) -> &About3 {
        &ABOUT
    }

    fn build(&self, s: &Settings3<'_>) -> Result<Built3, Error> {
        let eye = s
            .point_if("eye")?
            .ok_or_else(|| Error::missing("eye", "the place from which the model looks unchanged"))?;
        let mut points = Vec::new();
        for word in s.words("reference").into_iter().flat_map(|w| w.split(';')).filter(|w| !w.is_empty()) {
            points.push(s.point_in("reference", word)?);
        }
        if points.is_empty() {
            points = vec![s.bounds().min, s.bounds().max];
        }
        let degree = s.counts_if("degree", MAX_DEGREE)?.unwrap_or([1; 3]);
        let reference = Reference3::new(&points, degree, eye)?;
        let mut out = Anamorph3::new(eye, reference).local(s.flat().flag("local")?);
        for push in pushes(s, &reference)? {
            out = out.push(push);
        }
        out.build()
    }
}

/// Reads the pushes: control points first, then points.
fn pushes(s: &Settings3<'_>, reference: &Reference3) -> Result<Vec<Push3>, Error> {
    let mut out = Vec::new();
    for name in ["push", "away", "at"] {
        for word in s.words(name) {
            let (node, value) = if matches!(reference, Reference3::Tetrahedron(..)) {
                s.flat().node_in::<4>(name, word)?
            } else {
                let ([i, j, k], value) = s.flat().node_in::<3>(name, word)?;
                ([i, j, k, 0], value)
            };
            out.push(match name {
                "push" => Push3::By(node, s.flat().number_in(name, value)?),
                "away" => Push3::Away(node, s.length_in(name, value, Extent::Diagonal)?),
                _ => Push3::To(node, s.point_in(name, value)?),
            });
        }
    }
    for word in s.words("point") {
        let wrong = || Error::usage("point", word, "is not X,Y,Z:FACTOR, such as 10,20,30:150%");
        let (p, factor) = word.split_once(':').ok_or_else(wrong)?;
        let p: DVec3 = s.point_in("point", p)?;
        out.push(Push3::Prescribe(p, s.flat().number_in("point", factor)?));
    }
    Ok(out)
}
