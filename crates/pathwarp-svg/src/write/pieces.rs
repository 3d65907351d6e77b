//! A shape whose fill or stroke is no plain paint: patterns as geometry and gradients as pictures, clipped by the shape.

use crate::bend::image::BentImage;
use crate::bend::part::{Done, StrokeDone};
use crate::scene::model::{Group, Node, Tiles};
use crate::source::number::{escape, path_data, short};
use crate::write::fragment::{Properties, Writer};
use pathwarp::kurbo::Affine;
use usvg::{FillRule, PaintOrder};

impl<'a> Writer<'a> {
    /// Whether a part is written in pieces.
    pub(crate) fn pieced(&self, i: usize) -> bool {
        let painted = |d: &Done| d.fill_image.is_some() || d.stroke_image.is_some();
        self.job.outcomes[i].done().is_some_and(painted)
            || self.tiles(i, false).is_some()
            || self.tiles(i, true).is_some()
    }

    /// The tiles that make up a part's fill or stroke, if all of them could be warped.
    fn tiles(&self, i: usize, stroke: bool) -> Option<&'a Tiles> {
        let part = &self.job.document.scene().parts[i];
        let done = self.job.outcomes[i].done()?;
        let tiles = if stroke {
            part.stroke_tiles.as_ref().filter(|_| matches!(done.stroke, StrokeDone::Outlined(_)))
        } else {
            part.fill_tiles.as_ref()
        };
        tiles.filter(|t| self.whole(&t.content))
    }

    /// Whether everything in a group is warped.
    fn whole(&self, g: &Group) -> bool {
        let clips = &self.job.document.scene().clips;
        let mut clip = g.clip;
        while let Some(i) = clip {
            if !self.whole(&clips[i].root) {
                return false;
            }
            clip = clips[i].clip;
        }
        g.children.iter().all(|n| match n {
            Node::Group(g) => self.whole(g),
            Node::Part(i) => self.job.outcomes[*i].done().is_some(),
            Node::Image(_) | Node::Text { .. } => false,
        })
    }

    /// Fill and stroke one after the other.
    pub(crate) fn pieces(&mut self, i: usize, done: &Done, d: &str) -> String {
        let job = self.job;
        let p = &job.document.scene().parts[i];
        let inside = |w: &mut Self, tiles: Option<&Tiles>, image: Option<&BentImage>, opacity: f32| match (tiles, image)
        {
            (Some(t), _) => Some((w.group(&t.content, ""), t.opacity)),
            (None, Some(image)) => Some((w.bent(image, Affine::IDENTITY), opacity)),
            (None, None) => None,
        };
        // A fill may close along a line that the map has bent, or enclose nothing.
        let area = done.fill.as_ref().map_or_else(|| d.to_owned(), |a| path_data(a, done.decimals));
        let filled = p.fill.as_ref().filter(|_| !area.is_empty());
        let opacity = p.fill.as_ref().map_or(1.0, |f| f.opacity().get());
        let tiles = self.tiles(i, false);
        let within = inside(self, tiles, done.fill_image.as_ref(), opacity);
        let fill = match (filled, within) {
            (None, _) => String::new(),
            (Some(f), Some(within)) => {
                let rule = if f.rule() == FillRule::EvenOdd { "evenodd" } else { "nonzero" };
                self.cut_to(&area, rule, within, i)
            }
            (Some(_), None) => {
                let properties = self.properties_of(i, true, false);
                self.path(&area, "", &properties)
            }
        };
        let opacity = p.stroke.as_ref().map_or(1.0, |s| s.opacity().get());
        let tiles = self.tiles(i, true);
        let within = inside(self, tiles, done.stroke_image.as_ref(), opacity);
        let stroke = match (&p.stroke, &done.stroke, within) {
            (None, ..) => String::new(),
            (_, StrokeDone::Outlined(o), Some(within)) => {
                self.cut_to(&path_data(o, done.decimals), "nonzero", within, i)
            }
            (Some(s), StrokeDone::Outlined(o), None) => {
                let properties = self.outlined(p, s, done);
                self.path(&path_data(o, done.decimals), "", &properties)
            }
            (_, StrokeDone::Scaled(_), _) => {
                let properties = self.properties_of(i, false, true);
                self.path(d, "", &properties)
            }
        };
        if p.paint_order == PaintOrder::StrokeAndFill { stroke + &fill } else { fill + &stroke }
    }

    /// Content, with its opacity, within an outline.
    fn cut_to(&mut self, d: &str, rule: &'static str, (inner, opacity): (String, f32), i: usize) -> String {
        let scene = &self.job.document.scene();
        let owner = scene.parts[i].source.or(scene.parts[i].owner);
        let name = owner.and_then(|e| self.job.document.source.attr(e, "id")).filter(|n| !n.is_empty());
        let id = self.new_id(&name.map_or_else(|| "shape-edge".to_owned(), |n| format!("{n}-edge")));
        let mut properties = Properties::new();
        if rule != "nonzero" || self.may_inherit("clip-rule") {
            properties.push(("clip-rule", rule.into()));
        }
        let path = self.path(d, "", &properties);
        self.define(&format!("<{0} id=\"{1}\">{path}</{0}>", self.tag("clipPath"), escape(&id)));
        let mut outer = vec![("clip-path", format!("url(#{id})"))];
        if opacity < 1.0 {
            outer.push(("opacity", short(f64::from(opacity))));
        }
        format!("<{0}{1}>{inner}</{0}>", self.tag("g"), self.attributes(&outer))
    }
}
