//! Drawings shown as images: their content is warped like everything else, within the edge of the image.

use super::tiles::blends;
use super::{Builder, Context};
use crate::scene::model::{Clip, Group, Node, Part, Referrer, Role};
use pathwarp::Outline;
use pathwarp::kurbo::{Affine, Point};
use usvg::{PaintOrder, ShapeRendering};

/// Whether a group's only content is a drawing shown as an image.
pub(super) fn holds_vector(g: &usvg::Group) -> bool {
    match g.children() {
        [usvg::Node::Image(i)] => matches!(i.kind(), usvg::ImageKind::SVG(_)),
        [usvg::Node::Group(g)] => g.id().is_empty() && holds_vector(g),
        _ => false,
    }
}

impl Builder<'_> {
    /// The content of a drawing shown as an image; `frame` leads from its px to root user space.
    pub(super) fn vector_image(
        &mut self,
        image: &usvg::Image,
        tree: &usvg::Tree,
        frame: Affine,
        context: Context,
    ) -> Group {
        if context.owner.is_none() {
            self.unkept("an image cannot be told from another with the same id");
        }
        // It is a picture of its own, and blends with nothing below it.
        let isolate = blends(tree.root());
        let mut out = Group { isolate, ..Group::plain(context.owner, Affine::IDENTITY, Vec::new()) };
        if !image.is_visible() {
            return out;
        }
        // Its ids are none of the source's.
        let gradients = tree.linear_gradients().iter().map(|g| std::sync::Arc::as_ptr(g) as usize);
        let gradients = gradients.chain(tree.radial_gradients().iter().map(|g| std::sync::Arc::as_ptr(g) as usize));
        let filters = tree.filters().iter().map(|f| std::sync::Arc::as_ptr(f) as usize);
        self.foreign.extend(gradients.chain(filters));
        self.abroad += 1;
        let size = tree.size();
        let (w, h) = (f64::from(size.width()), f64::from(size.height()));
        let b = tree.root().abs_layer_bounding_box();
        // Rounding is no overflow.
        let slack = 1e-4 * (w + h) as f32;
        let over =
            b.left() < -slack || b.top() < -slack || b.right() > w as f32 + slack || b.bottom() > h as f32 + slack;
        if over && !matches!(context.role, Role::Pattern) {
            out.clip = Some(self.image_edge(w, h, frame, context));
        }
        let inner = self.group(tree.root(), frame, context);
        self.abroad -= 1;
        out.children.push(Node::Group(Box::new(inner)));
        out
    }

    /// The edge of an image as a clip path.
    fn image_edge(&mut self, w: f64, h: f64, frame: Affine, context: Context) -> usize {
        let corners = [(0.0, 0.0), (w, 0.0), (w, h), (0.0, h)].map(Point::from);
        let first = self.parts.len();
        self.parts.push(Part {
            source: None,
            owner: context.owner,
            role: Role::Clip,
            drawn: None,
            local: Outline::from_points(&corners, true).into(),
            frame,
            fill: None,
            stroke: None,
            paint_order: PaintOrder::FillAndStroke,
            rendering: ShapeRendering::GeometricPrecision,
            visible: true,
            fixed_width: false,
            slot: context.slot,
            in_tile: false,
            fill_tiles: None,
            stroke_tiles: None,
        });
        let edge = Node::Part(first);
        let root = Group::plain(None, Affine::IDENTITY, vec![edge]);
        self.clips.push(Clip {
            id: "image-edge".to_owned(),
            transform: Affine::IDENTITY,
            clip: None,
            root,
            referrers: vec![Referrer { element: None, owner: context.owner }],
            parts: first..first + 1,
            foreign: true,
        });
        self.clips.len() - 1
    }
}
