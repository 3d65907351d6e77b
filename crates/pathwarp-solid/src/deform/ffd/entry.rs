//! The registry's entry: reads an [`Ffd3`] from text.

use super::{Change3, FACES, Ffd3, MAX_CELLS, MAX_DEGREE, file};
use crate::deform::built::Built3;
use crate::deform::entry::{About3, Case3, Deformation3, Law3};
use crate::lattice::Lattice3;
use crate::settings::Settings3;
use pathwarp::Error;
use pathwarp::deform::{Example, Info, SavedFile};
use pathwarp::param::{Kind, Param};

pub(in crate::deform) struct Entry;

static ABOUT: About3 = About3 {
    info: Info::new("ffd", "pull a model about by a box of control points")
        .group("Lattices")
        .about("A box of control points lies around the model. Move some of them, and the model near them follows smoothly. Points \
are named i,j,k: from the left, from the bottom, from the back, each from 0. A box of degree 3x2x2 has 4 by 3 by 3 of them; \
higher degrees bend more finely.\n\nOr move points of the model themselves (--pin), and the box follows with the smallest \
change.\n\nWith an explicit region (--region) nothing moves outside it. To keep the model from tearing at a face of the region, \
freeze the outermost layer of points there (--freeze left:1); two keep it smooth, three keep its curvature.")
        .source("T. W. Sederberg, S. R. Parry, Free-form deformation of solid geometric models, SIGGRAPH 1986; P. Kalra et al., \
Simulation of facial muscle actions based on rational free form deformations, 1992; for --pin: W. M. Hsu, J. F. Hughes, \
H. Kaufman, Direct manipulation of free-form deformations, SIGGRAPH 1992")
        .params(&[
            Param::new("degree", Kind::Text("LxMxN"), "Degrees along x, y and z, 1 to 10 each: one less than the control points \
there. One number stands for all three.")
            .default("2x2x2"),
            Param::new("region", Kind::Text("model|X,Y,Z,W,H,D"), "The box of the control points; outside it nothing moves. The \
model's box has no outside: the map continues there.")
            .default("model"),
            Param::new("move", Kind::Text("I,J,K:DX,DY,DZ"), "Move control point i,j,k by dx,dy,dz (lengths, or % of the model's box).")
                .repeated(),
            Param::new("at", Kind::Text("I,J,K:X,Y,Z"), "Put control point i,j,k at x,y,z.").repeated(),
            Param::new("weight", Kind::Text("I,J,K:W"), "Give control point i,j,k this weight: above 1 it pulls harder than the others.")
                .repeated(),
            Param::new("pin", Kind::Text("X,Y,Z:X,Y,Z"), "Take the first point of the model to the second; the control points that \
are not frozen follow with the smallest change. Equal points hold a place.")
            .repeated(),
            Param::new("freeze", Kind::Text("FACE:COUNT,…"), "Keep layers of points along faces in their places, e.g. \
left:2,bottom:1: 1 for no tear at the region's face there, 2 for smooth, k+1 for k continuous derivatives. The faces are left, \
right, bottom, top, back, front."),
            Param::flag("extend", "Let the map continue outside the region instead of leaving everything there in place."),
            Param::flag("spline", "A B-spline box: each control point has influence on a few cells only."),
            Param::new("cells", Kind::Text("LxMxN"), "Cells of the B-spline box along x, y and z, 1 to 16 each: it has degree + \
cells control points. Default with --spline: 4x4x4."),
            Param::new("lattice", Kind::File, "Start from a saved box of points (JSON) instead of --degree and a regular one; with \
--region it is laid onto that."),
            Param::new("save-lattice", Kind::Save, "Save the box with everything that was moved, to use it again."),
        ])
        .demo(&[("degree", "2x2x1"), ("move", "1,2,0:0,40,0"), ("move", "2,1,1:15,0,20"), ("weight", "1,1,1:2")])
        .examples(&[
            Example {
                what: "Pull the middle of a model upwards",
                command: "solid ffd samples/solid/teapot.obj --move 1,2,1:0,60%,0 -o out.obj",
            },
            Example {
                what: "Stretch only the right part, smoothly joined to the rest",
                command: "solid ffd samples/solid/teapot.obj --region 60%,-10%,-10%,60%,120%,120% --degree 4x2x2 --freeze left:2 \
--move 3,1,1:30%,20%,0 -o out.obj",
            },
            Example {
                what: "Take one place of a model elsewhere and hold another, with a finer box that is saved for use again",
                command: "solid ffd samples/solid/teapot.obj --spline --cells 3 --pin 95%,60%,50%:110%,90%,50% --pin 50%,0%,50%:50%,0%,50% \
--save-lattice out.json -o out.obj",
            },
        ]),
    laws: &[
        Law3::Identity(&[]),
        Law3::Identity(&[("degree", "10x1x3"), ("region", "10,20,30,40,50,60")]),
        Law3::Identity(&[("degree", "3x2x1"), ("spline", "true"), ("extend", "true")]),
        Law3::Identity(&[("pin", "30,30,30:30,30,30")]),
        Law3::Same(&[("move", "1,2,0:0,0,0"), ("weight", "0,0,0:2")], &[("weight", "0,0,0:2")]),
        Law3::Same(&[("at", "1,1,1:50,40,55")], &[("move", "1,1,1:0,-10,5")]),
        Law3::KeepsLinesAlong(&[("degree", "4x1x2"), ("move", "1,0,0:5,20,3 3,1,2:9,-20,8"), ("weight", "2,0,1:3")], [0.0, 1.0, 0.0]),
        Law3::KeepsPlanes(&[("degree", "1"), ("move", "0,1,0:10,0,0 1,1,0:10,0,0 0,1,1:10,0,0 1,1,1:10,0,0")]),
        Law3::FixedOutside(&[("region", "20,30,40,50,40,30"), ("move", "1,1,1:10,5,5 2,2,2:-5,5,9")], [[20.0, 30.0, 40.0], [70.0, 70.0, 70.0]]),
        Law3::FixedOutside(
            &[("region", "20,30,40,50,40,30"), ("spline", "true"), ("cells", "3x2x1"), ("pin", "40,50,55:44,52,50"),
              ("freeze", "left:1,right:1,top:1,bottom:1,back:1,front:1")],
            [[20.0, 30.0, 40.0], [70.0, 70.0, 70.0]],
        ),
    ],
    cases: &[
        // The middle of degree 2: the middle point counts an eighth.
        Case3 { args: &[("move", "1,1,1:8,-16,24")], at: [50.0, 50.0, 50.0], to: [51.0, 48.0, 53.0], tolerance: 1e-13 },
        // With weight 8 it counts 8/15 instead of 1/8.
        Case3 { args: &[("move", "1,1,1:15,0,0"), ("weight", "1,1,1:8")], at: [50.0, 50.0, 50.0], to: [58.0, 50.0, 50.0], tolerance: 1e-13 },
        Case3 { args: &[("pin", "30,40,20:37,35,25")], at: [30.0, 40.0, 20.0], to: [37.0, 35.0, 25.0], tolerance: 1e-12 },
    ],
};

impl Deformation3 for Entry {
    fn about(&self) -> &About3 {
        &ABOUT
    }

    fn build(&self, s: &Settings3<'_>) -> Result<Built3, Error> {
        let (lattice, from_file) = lattice(s)?;
        let extended = s.flat().flag("extend")? || (s.box_if("region")?.is_none() && !from_file);
        let mut ffd = Ffd3::new(lattice).freeze(frozen(s)?).extend(extended);
        for (node, change) in changes(s)? {
            ffd = ffd.change(node, change);
        }
        for (from, to) in s.point_pairs("pin")? {
            ffd = ffd.pin(from, to);
        }
        let (mut built, lattice) = ffd.build_with_lattice()?;
        if let Some(name) = s.last("save-lattice") {
            built.saves.push(SavedFile { name: name.to_owned(), text: file::write(&lattice) });
        }
        Ok(built)
    }
}

/// Reads the initial lattice. The flag is `true` if a file gave it its region.
fn lattice(s: &Settings3<'_>) -> Result<(Lattice3, bool), Error> {
    let region = s.box_if("region")?;
    let frame = s.bounds();
    if let Some(named) = s.file_if("lattice")? {
        for name in ["degree", "spline", "cells"] {
            if s.flat().given(name) {
                let problem = "cannot go with `lattice`, which is a whole box of points";
                return Err(Error::usage(name, s.words(name).join(" "), problem));
            }
        }
        let (lattice, has_region) = file::read(&named.name, &named.text, region.unwrap_or(frame))?;
        return Ok(match region {
            Some(r) => (lattice.on(r), true),
            None if s.flat().given("region") => (lattice.on(frame), false),
            None => (lattice, has_region),
        });
    }
    let degree = s.counts_if("degree", MAX_DEGREE)?.unwrap_or([2; 3]);
    let cells = match s.counts_if("cells", MAX_CELLS)? {
        Some(c) => c,
        None if s.flat().flag("spline")? => [4; 3],
        None => [1; 3],
    };
    Ok((Lattice3::regular(region.unwrap_or(frame), degree, cells), false))
}

/// Reads `at`, `move` and `weight`, in this order.
fn changes(s: &Settings3<'_>) -> Result<Vec<([usize; 3], Change3)>, Error> {
    let mut out = Vec::new();
    for name in ["at", "move", "weight"] {
        for word in s.words(name) {
            let (node, value) = s.flat().node_in::<3>(name, word)?;
            let change = match name {
                "at" => Change3::Place(s.point_in(name, value)?),
                "move" => Change3::Shift(s.vector_in(name, value)?),
                _ => Change3::Weight(s.flat().number_in(name, value)?),
            };
            out.push((node, change));
        }
    }
    Ok(out)
}

fn frozen(s: &Settings3<'_>) -> Result<[usize; 6], Error> {
    let mut counts = [0; 6];
    for word in s.words("freeze").into_iter().flat_map(|t| t.split(',')).filter(|w| !w.is_empty()) {
        let (face, count) = word.split_once(':').unwrap_or((word, "1"));
        let face = FACES.iter().position(|n| *n == face).ok_or_else(|| {
            let problem = format!("is not FACE:COUNT with a face {}, such as left:2", FACES.join(", "));
            Error::usage("freeze", word, problem)
        })?;
        counts[face] = count.parse().map_err(|_| Error::usage("freeze", word, "does not end with a number"))?;
    }
    Ok(counts)
}
