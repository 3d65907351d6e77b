//! Builds anamorphoses that are seen in mirrors.

use super::mirror::{Reflection, ScenePart};
use super::scene::{self, Eye, format_length};
use super::{Anamorph, Look, Mirror, direction, far_away};
use crate::deform::entry::{Built, InSpace, Place, Role, SightMark};
use crate::error::Error;
use crate::map::{AffineMap, Chain, Map};
use kurbo::{Affine, Point, Rect, Shape, Vec2};
use std::sync::Arc;

impl Anamorph {
    /// Builds the map onto the table under a mirror.
    pub(super) fn reflected(&self, mirror: Mirror) -> Result<Built, Error> {
        let others = [
            ("onto", self.onto.is_some()),
            ("view", self.look != Look::Unrolled),
            (self.net.as_ref().and_then(|n| n.pushes.first()).map_or("reference", |p| p.param()), self.net.is_some()),
            ("length", self.length.is_some()),
            ("local", self.local),
        ];
        if let Some((name, _)) = others.iter().find(|o| o.1) {
            let problem = "cannot go with `mirror`, whose drawing lies on the table; omit one of them";
            return Err(Error::usage(name, "", problem));
        }
        let eye = match (self.eye, self.distance, self.eye_height) {
            (Eye::Infinite(towards), None, None) => Eye::Infinite(direction(towards)?),
            (Eye::Infinite(_), ..) => {
                return Err(Error::usage("eye", "", "is at infinity; omit `distance` and `eye-height`"));
            }
            // The eye is straight above the mirror.
            (Eye::At(foot, _), None, Some(_)) => Eye::At(foot, 0.0),
            (Eye::At(foot, _), Some(distance), _) => Eye::At(foot, distance),
            (Eye::At(..), None, None) => {
                let hint =
                    "the eye's distance in front of the mirror, or `eye-height` alone for an eye straight above it";
                return Err(Error::missing("distance", hint));
            }
        };
        let mut scene = self.scene(eye)?;
        if let (Eye::At(_, distance), Some(height)) = (eye, self.eye_height) {
            scene.eye = Eye::At(mirror.anchor(scene.frame) - Vec2::new(0.0, height), distance);
        }
        let reflection = Reflection::new(mirror, &scene)?;
        let tip = reflection.check()?;
        let map: Arc<dyn Map> = Arc::new(reflection.clone());
        let scale = Arc::new(AffineMap(scene.scale)) as Arc<dyn Map>;
        let mut built = Built::new(Arc::new(Chain::new([scale, Arc::clone(&map)])));
        let units = self.units_per_px;
        built.note(scene.describe_sizes(&*map, units));
        let needed = reflection.needed_height();
        if needed > 0.0 {
            built.note(format!("the mirror shows it up to {} above its foot", format_length(needed, units)));
        }
        if tip.is_some() {
            built.warn("the cone's tip shows inside the artwork's box: what covers it lacks the outer edge; leave a hole there");
        }
        let extent = scene.extent(&*map).union(reflection.footprint().bounding_box());
        built.space = Some(InSpace { files: self.files.clone(), ..in_space(&reflection, scene.scale, extent) });
        built.sight = self.sight_mark.then(|| Box::new(sight(&reflection, eye, extent, units)));
        built.overlay(Role::Base, self.frame.to_path(0.1));
        if let Some(path) = scene.outline(&*map) {
            built.overlay(Role::Target, path);
        }
        Ok(built)
    }
}

/// Returns the drawing on the table in space, with the table, the mirror, and the artwork as the eye sees it. `extent` is the box of the
/// drawing and the mirror's foot.
fn in_space(reflection: &Reflection, scale: Affine, extent: Rect) -> InSpace {
    let part = |part: ScenePart, scale: Affine| -> Place {
        let reflection = reflection.clone();
        Arc::new(move |p| reflection.in_space(part, scale * p).filter(|q| q.iter().all(|v| v.is_finite())))
    };
    let (table, foot) = (extent.inflate(0.05 * extent.width(), 0.05 * extent.height()), reflection.foot);
    // The sheet lies a hair under the drawing.
    let hair = 1e-3 * reflection.height();
    let sheet: Place = Arc::new(move |p: Point| Some([p.x - foot.x, hair, foot.y - p.y]));
    let besides = vec![
        ("table", Some(table), sheet),
        ("mirror", Some(Rect::new(0.0, 0.0, 1.0, 1.0)), part(ScenePart::Mirror(reflection.height()), Affine::IDENTITY)),
        ("seen", None, part(ScenePart::Picture, scale)),
    ];
    InSpace { place: part(ScenePart::Table, scale), besides, files: Vec::new() }
}

/// Marks the eye's position on the table, and the mirror's foot.
fn sight(reflection: &Reflection, eye: Eye, extent: Rect, units: [f64; 2]) -> SightMark {
    let (at, label) = match (reflection.eye(), eye) {
        (Some((at, [distance, height])), _) => {
            let [distance, height] = [distance, height].map(|v| format_length(v, units));
            let here = format!("eye {height} above the round mark");
            let there = format!("eye {height} above the table, {distance} from the mirror's middle");
            (at, [here, there])
        }
        (None, Eye::Infinite([x, y, z])) => (reflection.foot + Vec2::new(x, -z) * 1e9, far_away(-y)),
        (None, Eye::At(..)) => (reflection.foot, far_away(1.0)),
    };
    let mut sight = scene::sight_mark(at, label, extent, units);
    sight.path.extend(reflection.footprint());
    sight
}
