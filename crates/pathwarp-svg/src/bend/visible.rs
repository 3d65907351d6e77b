//! Finds the visible area of a drawing.

use super::pictures::Painter;
use crate::scene::areas::{is_seen, picture_corners, stroked};
use crate::scene::drawing::Drawing;
use crate::scene::geometry::stretch;
use crate::scene::model::{Group, Node, Part, PartRole};
use pathwarp::edit::Area;
use pathwarp::kurbo::Point;
use pathwarp::refit;
use pathwarp::{GeometryError, Outline};
use usvg::{FillRule, ImageKind, MaskType, Paint};

/// The selected parts and bitmaps, with the settings for finding their visible area.
pub(super) struct Visible<'a> {
    pub(super) drawing: &'a Drawing,
    pub(super) parts: &'a [bool],
    pub(super) bitmaps: &'a [bool],
    /// Reads the opacity of pictures. Without it, they fill their boxes.
    pub(super) painter: Option<&'a Painter>,
    /// Tolerance of areas, in root user units.
    pub(super) tolerance: f64,
}

/// The content of a group that counts towards its area.
#[derive(Clone, Copy, PartialEq)]
enum Counted {
    /// Everything painted. Tiles lie within the shape that they paint, which counts.
    Paint,
    /// All areas, whatever their paint, as in clip paths.
    Clip,
    /// Everything painted that is not black, as in luminance masks. Pictures count as bright.
    Light,
}

impl Visible<'_> {
    /// The visible area in root user space.
    pub(super) fn area(&self) -> Result<Area, GeometryError> {
        self.group_area(&self.drawing.scene().root, Counted::Paint)
    }

    fn group_area(&self, g: &Group, counted: Counted) -> Result<Area, GeometryError> {
        let mut areas = Vec::new();
        self.add_group(g, counted, &mut areas)?;
        Area::union(&areas, self.tolerance)
    }

    fn add_group(&self, g: &Group, counted: Counted, out: &mut Vec<Area>) -> Result<(), GeometryError> {
        if g.opacity <= 0.0 && counted != Counted::Clip {
            return Ok(());
        }
        let first = out.len();
        for n in &g.children {
            match n {
                Node::Group(g) => self.add_group(g, counted, out)?,
                Node::Text { content, .. } => self.add_group(content, counted, out)?,
                Node::Image(i) if counted == Counted::Light || (counted == Counted::Paint && self.bitmaps[*i]) => {
                    out.push(self.picture_area(*i)?);
                }
                Node::Image(_) => {}
                Node::Part(i) if counted == Counted::Light && is_black(&self.drawing.scene().parts[*i]) => {
                    // Black covers what is painted beneath it in a luminance mask.
                    let black = self.fill_area(*i)?;
                    for area in &mut out[first..] {
                        *area = area.difference(&black, self.tolerance)?;
                    }
                }
                Node::Part(i) => self.add_part(*i, counted, out)?,
            }
        }
        if (g.clip.is_some() || g.mask.is_some()) && out.len() > first {
            let mut area = Area::union(&out[first..], self.tolerance)?;
            if let Some(clip) = g.clip {
                area = area.intersection(&self.clip_area(clip)?, self.tolerance)?;
            }
            if let Some(mask) = g.mask {
                area = area.intersection(&self.mask_area(mask)?, self.tolerance)?;
            }
            out.splice(first.., [area]);
        }
        Ok(())
    }

    fn add_part(&self, i: usize, counted: Counted, out: &mut Vec<Area>) -> Result<(), GeometryError> {
        let p = &self.drawing.scene().parts[i];
        if counted == Counted::Clip {
            out.extend(p.visible.then(|| self.fill_area(i)).transpose()?);
            return Ok(());
        }
        if !is_seen(p) || p.in_tile || (p.role == PartRole::Paint && !self.parts[i]) {
            return Ok(());
        }
        let shows = |paint: &Paint| counted == Counted::Paint || is_bright(paint);
        if p.fill.as_ref().is_some_and(|f| f.opacity().get() > 0.0 && shows(f.paint())) {
            out.push(self.fill_area(i)?);
        }
        if p.stroke.as_ref().is_some_and(|s| s.opacity().get() > 0.0 && shows(s.paint())) {
            let drawing = self.drawing;
            let stroke =
                stroked(p, drawing.scene().to_px, self.tolerance, &drawing.budget).map_err(GeometryError::Limit)?;
            out.extend(stroke.map(|s| Area::of(&s, false, self.tolerance)).transpose()?);
        }
        Ok(())
    }

    fn fill_area(&self, i: usize) -> Result<Area, GeometryError> {
        let fill = self.drawing.scene().parts[i].fill.as_ref();
        let even_odd = fill.is_some_and(|f| f.rule() == FillRule::EvenOdd);
        Area::of(&self.drawing.shapes()[i].outline, even_odd, self.tolerance)
    }

    fn clip_area(&self, i: usize) -> Result<Area, GeometryError> {
        let clip = &self.drawing.scene().clips[i];
        let area = self.group_area(&clip.root, Counted::Clip)?;
        match clip.clip {
            Some(next) => area.intersection(&self.clip_area(next)?, self.tolerance),
            None => Ok(area),
        }
    }

    /// The area in which a mask is neither black nor transparent.
    fn mask_area(&self, i: usize) -> Result<Area, GeometryError> {
        let mask = &self.drawing.scene().masks[i];
        let r = mask.rect;
        let corners = [(r.x0, r.y0), (r.x1, r.y0), (r.x1, r.y1), (r.x0, r.y1)].map(|p| mask.frame * Point::from(p));
        let region = Area::of(&Outline::from_points(&corners, true), false, self.tolerance)?;
        let counted = if mask.kind == MaskType::Luminance { Counted::Light } else { Counted::Paint };
        let area = self.group_area(&mask.root, counted)?.intersection(&region, self.tolerance)?;
        match mask.mask {
            Some(next) => area.intersection(&self.mask_area(next)?, self.tolerance),
            None => Ok(area),
        }
    }

    /// The area in which a picture is more than half opaque.
    fn picture_area(&self, i: usize) -> Result<Area, GeometryError> {
        /// Tolerance, in pixels, of the traced edge of a picture.
        const EDGE_UNCERTAINTY: f64 = 0.2;
        let b = &self.drawing.scene().bitmaps[i];
        let Some(corners) = picture_corners(b) else { return Ok(Area::default()) };
        let shown = Area::of(&Outline::from_points(&corners, true), false, self.tolerance)?;
        let (ImageKind::PNG(data) | ImageKind::GIF(data) | ImageKind::WEBP(data)) = b.image.kind() else {
            return Ok(shown);
        };
        let Some(opacity) = self.painter.and_then(|p| p.opacity(data)).filter(|o| !o.is_full()) else {
            return Ok(shown);
        };
        let traced = opacity.traced().transformed(b.frame);
        let options = refit::Options::new(self.tolerance.max(EDGE_UNCERTAINTY * stretch(b.frame)))
            .with_nodes(refit::Nodes::Source);
        let outline = Outline::from(&refit::simplified(&traced, None, &options, &[])?.path);
        Area::of(&outline, false, self.tolerance)?.intersection(&shown, self.tolerance)
    }
}

/// Returns `true` if a part paints opaque black.
fn is_black(p: &Part) -> bool {
    let fill = p.fill.as_ref().filter(|f| f.opacity().get() >= 1.0);
    p.visible && fill.is_some_and(|f| !is_bright(f.paint()))
}

/// Returns `true` if a paint has another colour than black. Patterns count as bright.
fn is_bright(paint: &Paint) -> bool {
    let is_bright = |c: usvg::Color| [c.red, c.green, c.blue] != [0; 3];
    match paint {
        Paint::Color(c) => is_bright(*c),
        Paint::LinearGradient(g) => g.stops().iter().any(|s| is_bright(s.color())),
        Paint::RadialGradient(g) => g.stops().iter().any(|s| is_bright(s.color())),
        Paint::Pattern(_) => true,
    }
}
