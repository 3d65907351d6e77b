//! Meshes: artwork bent by a quilt of bicubic patches, also by the warps that Photoshop keeps with its layers.
//!
//! Each patch is the tensor product Bézier surface of sixteen points (see [`BicubicNet`](crate::map::BicubicNet)); patches share the points of the
//! sides where they meet. Along such a joint the map is C¹ if the control points beside it divide evenly: (p₊ − p)/after =
//! (p − p₋)/before in every row (G. Farin, *Curves and Surfaces for CAGD*, §15.4).

mod psd;
mod quilt;

use super::built::{Built, Explanation, Overlay, Role};
use super::entry::{Case, Deformation, Example, Info, Law};
use crate::error::{Error, GeometryError};
use crate::map::{AffineMap, Class, Map};
use crate::param::{Kind, Param, Settings};
use kurbo::Shape;
use quilt::Quilt;
use std::sync::Arc;

pub(super) struct Mesh;

static INFO: Info = Info::new("mesh", "bend artwork by a mesh of bicubic patches, or by a Photoshop warp")
    .group("Lattices and nets")
    .about("A quilt of patches, side by side in rows and columns, each with sixteen control points; neighbours share the points where \
they meet. Give it as a path with one line of curves per row of control points (--net: a path of 4 lines with one curve each is one \
patch, of 7 lines with two curves each four), or as a file (--mesh, JSON or TOML): {\"region\": [x,y,w,h], \"points\": [[[x,y], …], \
…]}, rows from the top, and optionally \"x\" and \"y\", where patches meet, as shares of the region.\n\n--psd takes the warp of a \
layer of a Photoshop file: a style with its bend and distortions, sixteen points, or a quilt; it is laid onto the artwork's box. JSON of \
your own will do: {\"style\": \"warpFlag\", \"value\": 50, \"perspective\": 0, \"perspective_other\": 0, \"vertical\": false} (value \
and perspectives in percent), or {\"style\": \"warpCustom\", \"mesh\": {\"region\": …, \"points\": …}} with a mesh as above.\n\n\
--smooth evens out the joints, so that lines cross them without a kink.")
    .source("Tensor product Bézier patches: G. Farin, Curves and Surfaces for CAGD, chapter 15; Adobe Photoshop File Formats \
Specification, descriptor structure and placed layer data")
    .params(&[
        Param::path("net", "A path with 3·rows+1 subpaths of as many cubics as there are columns of patches."),
        Param::new("mesh", Kind::File, "A file of control points (JSON or TOML)."),
        Param::new("psd", Kind::File, "A Photoshop file with a warped layer, or JSON of such a warp."),
        Param::new("layer", Kind::Text("NAME"), "Which layer of the Photoshop file; needed if several are warped."),
        Param::new(
            "region",
            Kind::Text("artwork|X,Y,W,H"),
            "The box that the mesh is laid onto. Default: where a file says, else the artwork's.",
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
        // Joints and corners go where their control points are.
        Case { args: &[("net", DEMO)], at: (0.0, 0.0), to: (0.0, 10.0), tolerance: 1e-12 },
        Case { args: &[("net", DEMO)], at: (50.0, 0.0), to: (50.0, 0.0), tolerance: 1e-12 },
        Case { args: &[("net", DEMO)], at: (100.0, 100.0), to: (100.0, 110.0), tolerance: 1e-12 },
        Case { args: &[("net", DEMO)], at: (25.0, 0.0), to: (25.0, 5.0), tolerance: 1e-12 },
    ]);

/// How far artwork may reach beyond the mesh's box, in shares of it, before that is taken for a mistake.
const BEYOND: f64 = 0.5;

/// Two patches that rise in the middle: 3/8·(−0 …) is left to the cases.
const DEMO: &str = "M0,10 C20,10 30,0 50,0 C70,0 80,10 100,10 M0,40 C20,40 35,30 50,33 C65,36 80,40 100,40 \
M5,70 C20,70 30,60 50,66 C70,72 80,70 95,70 M0,100 C20,105 30,95 50,100 C70,105 80,105 100,110";
const REST: &str = "M0,0 C33.333333333333336,0 66.66666666666667,0 100,0 \
M0,33.333333333333336 C33.333333333333336,33.333333333333336 66.66666666666667,33.333333333333336 100,33.333333333333336 \
M0,66.66666666666667 C33.333333333333336,66.66666666666667 66.66666666666667,66.66666666666667 100,66.66666666666667 \
M0,100 C33.333333333333336,100 66.66666666666667,100 100,100";

impl Deformation for Mesh {
    fn info(&self) -> &Info {
        &INFO
    }

    fn build(&self, s: &Settings<'_>) -> Result<Built, Error> {
        let frame = s.frame().rect;
        let given: Vec<&str> = ["net", "mesh", "psd"].into_iter().filter(|n| s.given(n)).collect();
        let [source] = given[..] else {
            let hint = "a path (`net`), a file (`mesh`) or a Photoshop file (`psd`): one of them";
            return Err(Error::Missing { param: "net".into(), hint: hint.into() });
        };
        let own = s.rect_if("region")?;
        let region = own.unwrap_or(frame);
        if !(region.width() > 0.0 && region.height() > 0.0) {
            return Err(GeometryError::FlatFrame { width: region.width(), height: region.height() }.into());
        }
        let mut notes = Vec::new();
        let quilt = match source {
            "net" => match s.path_if("net")? {
                Some(path) => Quilt::from_path(&path, region)?,
                None => return Err(Error::Missing { param: "net".into(), hint: "a path".into() }),
            },
            "psd" => match psd::read(s, region)? {
                psd::Found::Style(built) => return Ok(built),
                psd::Found::Quilt(quilt, layer) => {
                    notes.push(format!("layer {layer}"));
                    quilt
                }
            },
            _ => match s.file_if("mesh")? {
                Some(file) => {
                    let quilt = Quilt::read(&file.name, &file.text, region)?;
                    if s.given("region") { quilt.on(region) } else { quilt }
                }
                None => return Err(Error::Missing { param: "mesh".into(), hint: "a file".into() }),
            },
        };
        built(s, quilt, notes)
    }
}

fn built(s: &Settings<'_>, mut quilt: Quilt, mut notes: Vec<String>) -> Result<Built, Error> {
    if s.flag("smooth")? {
        quilt.smooth();
    }
    let [columns, rows] = quilt.size();
    let (kinks, most) = quilt.kinks();
    notes.push(format!("mesh: {columns} by {rows} patches; joints: {}", if kinks == 0 { "smooth" } else { "kinked" }));
    let r = quilt.region;
    let map = quilt.map().ok_or(GeometryError::FlatFrame { width: r.width(), height: r.height() })?;
    let map: Arc<dyn Map> = match map.class() {
        Class::Affine(m) => Arc::new(AffineMap(crate::anchors::settled(m, s.frame()))),
        Class::Projective(_) | Class::Smooth => map,
    };
    let mut built = Built::new(map).explained(Explanation { notes, ..Explanation::default() });
    let (f, beyond) = (s.frame().rect, r.inflate(BEYOND * r.width(), BEYOND * r.height()));
    if !matches!(built.map.class(), Class::Affine(_)) && f.union(beyond) != beyond {
        built.warn(format!(
            "mesh: its box {} {} to {} {} does not hold the artwork, which runs far beyond it, where a mesh says little: `region artwork` \
lays it onto the artwork",
            r.x0, r.y0, r.x1, r.y1
        ));
    }
    if kinks > 0 {
        built.warn(format!(
            "mesh: {kinks} pairs of control points beside joints make kinks (by up to {:.0} % of the slope); `smooth` evens them out",
            100.0 * most
        ));
    }
    built.explanation.overlays =
        vec![Overlay { role: Role::Base, path: r.to_path(0.1) }, Overlay { role: Role::Cage, path: quilt.curves() }];
    Ok(built)
}

#[cfg(test)]
mod tests;
