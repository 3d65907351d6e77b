//! The drawing as it is painted: usvg's tree in f64, each shape with its source element, its true outline and its transform
//! to root user space.
//!
//! Root user space is the coordinate system inside the root `<svg>` (viewBox units).

use crate::scene::lettering::Line;
use crate::source::text::ElementId;
use pathwarp::Outline;
use pathwarp::kurbo::{Affine, Rect};
use std::collections::{HashMap, HashSet};
use std::fmt;
use std::ops::{Deref, Range};
use std::sync::{Arc, LazyLock};
use usvg::{BlendMode, Fill, PaintOrder, ShapeRendering, Stroke};

/// What a shape does for the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
    Paint,
    Clip,
    Mask,
    /// A tile's content; never warped.
    Pattern,
}

/// One painted path, or one that would be if it were visible.
#[derive(Debug)]
pub(crate) struct Part {
    /// The element it is written as, if that is a shape element of its own.
    pub(crate) source: Option<ElementId>,
    /// The element that is replaced as a whole if this part changes: a `use`, a text, a shape with markers.
    pub(crate) owner: Option<ElementId>,
    pub(crate) role: Role,
    /// The element whose geometry `local` is, read from the source itself: its own, or the one it is a copy of.
    pub(crate) drawn: Option<ElementId>,
    /// In its own user space.
    pub(crate) local: Local,
    /// From there to root user space.
    pub(crate) frame: Affine,
    pub(crate) fill: Option<Fill>,
    pub(crate) stroke: Option<Stroke>,
    pub(crate) paint_order: PaintOrder,
    pub(crate) rendering: ShapeRendering,
    pub(crate) visible: bool,
    /// The stroke's width is in px whatever the transform (`vector-effect`).
    pub(crate) fixed_width: bool,
    pub(crate) slot: Option<usize>,
    /// Whether it is part of a pattern's tiles that are laid out; if it has a stroke, `local` is that stroke's outline.
    pub(crate) in_tile: bool,
    /// What its fill's pattern shows, and its stroke's, where that is geometry.
    pub(crate) fill_tiles: Option<Tiles>,
    pub(crate) stroke_tiles: Option<Tiles>,
}

/// The tiles that a pattern lays over a shape, in the shape's user space. They reach beyond the shape.
#[derive(Debug)]
pub(crate) struct Tiles {
    pub(crate) opacity: f32,
    pub(crate) content: Group,
}

/// An outline that is worked out when it is first looked at: what is only read and written again never is.
pub(crate) struct Local(LazyLock<Outline, Box<dyn FnOnce() -> Outline + Send>>);

impl Local {
    pub(crate) fn later(f: impl FnOnce() -> Outline + Send + 'static) -> Self {
        Self(LazyLock::new(Box::new(f)))
    }
}

impl From<Outline> for Local {
    fn from(o: Outline) -> Self {
        Self::later(move || o)
    }
}

impl Deref for Local {
    type Target = Outline;

    fn deref(&self) -> &Outline {
        &self.0
    }
}

impl fmt::Debug for Local {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        (**self).fmt(f)
    }
}

#[derive(Debug)]
pub(crate) enum Node {
    Group(Box<Group>),
    Part(usize),
    /// A bitmap, by number.
    Image(usize),
    Text {
        element: Option<ElementId>,
        content: Box<Group>,
        /// Of each node of the content the element it comes from; empty where nothing inside has a name.
        owners: Vec<ElementId>,
    },
}

#[derive(Debug)]
pub(crate) struct Group {
    pub(crate) source: Option<ElementId>,
    pub(crate) owner: Option<ElementId>,
    pub(crate) transform: Affine,
    pub(crate) opacity: f32,
    pub(crate) blend: BlendMode,
    pub(crate) isolate: bool,
    pub(crate) clip: Option<usize>,
    pub(crate) mask: Option<usize>,
    pub(crate) filters: Vec<Arc<usvg::filter::Filter>>,
    /// Its own slot, if it is moved as a whole.
    pub(crate) slot: Option<usize>,
    pub(crate) children: Vec<Node>,
}

impl Group {
    /// One that does nothing to what is in it but move it.
    pub(crate) fn plain(owner: Option<ElementId>, transform: Affine, children: Vec<Node>) -> Self {
        Self {
            source: None,
            owner,
            transform,
            opacity: 1.0,
            blend: BlendMode::Normal,
            isolate: false,
            clip: None,
            mask: None,
            filters: Vec::new(),
            slot: None,
            children,
        }
    }
}

/// A place in the tree of groups where an affine fit of the map goes into the transforms, so that what cannot be bent (filters
/// with their regions and lengths, images) is moved along. What is inside is written in the moved frame.
#[derive(Debug)]
pub(crate) struct Slot {
    /// The slot around it.
    pub(crate) outer: Option<usize>,
    /// From inside to root user space.
    pub(crate) frame: Affine,
    /// What is to be fitted, in the coordinates inside.
    pub(crate) area: Rect,
    /// Whether it goes before the group's own transform, else after.
    pub(crate) before: bool,
    /// The element whose `transform` takes it up.
    pub(crate) element: Option<ElementId>,
    pub(crate) owner: Option<ElementId>,
    /// The parts inside.
    pub(crate) parts: Range<usize>,
}

/// A bitmap.
#[derive(Debug)]
pub(crate) struct Bitmap {
    pub(crate) image: Box<usvg::Image>,
    /// From its pixels to root user space.
    pub(crate) frame: Affine,
    /// From its pixels to the user space of its element: what usvg made of x, y, width and height.
    pub(crate) placing: Affine,
    pub(crate) slot: Option<usize>,
    /// The element that selects it.
    pub(crate) owner: Option<ElementId>,
    /// Whether it is part of the picture; tiles and filters' pictures never bend.
    pub(crate) bends: bool,
    /// Whether it is larger than its place and cut.
    pub(crate) sliced: bool,
}

/// A clip path as one frame sees it.
#[derive(Debug)]
pub(crate) struct Clip {
    pub(crate) id: String,
    pub(crate) transform: Affine,
    pub(crate) clip: Option<usize>,
    pub(crate) root: Group,
    pub(crate) referrers: Vec<Referrer>,
    /// The parts that belong to it.
    pub(crate) parts: Range<usize>,
    /// Whether it is none of the source's own definitions: in tiles that are laid out, in a drawing shown as an image.
    pub(crate) foreign: bool,
}

/// A mask as one frame sees it.
#[derive(Debug)]
pub(crate) struct Mask {
    pub(crate) id: String,
    pub(crate) rect: Rect,
    pub(crate) kind: usvg::MaskType,
    pub(crate) mask: Option<usize>,
    pub(crate) root: Group,
    /// Of those that refer to it: from their user space to root user space.
    pub(crate) frame: Affine,
    pub(crate) slot: Option<usize>,
    pub(crate) referrers: Vec<Referrer>,
    /// The parts that belong to it.
    pub(crate) parts: Range<usize>,
    /// Whether it is none of the source's own definitions.
    pub(crate) foreign: bool,
    /// What its content covers, in the frame's coordinates.
    pub(crate) content: Rect,
}

/// A pattern's tile.
#[derive(Debug)]
pub(crate) struct Tile {
    pub(crate) pattern: Arc<usvg::Pattern>,
    pub(crate) root: Group,
}

/// Who refers to a clip path or mask.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Referrer {
    /// The element that carries the property, where it is known.
    pub(crate) element: Option<ElementId>,
    /// The element that is replaced as a whole around it.
    pub(crate) owner: Option<ElementId>,
}

#[derive(Debug)]
pub(crate) struct Scene {
    pub(crate) root: Group,
    pub(crate) parts: Vec<Part>,
    pub(crate) clips: Vec<Clip>,
    pub(crate) masks: Vec<Mask>,
    pub(crate) tiles: Vec<Tile>,
    /// What filters show by `feImage`, by the address of usvg's group (which the document keeps alive).
    pub(crate) pictures: HashMap<usize, Group>,
    pub(crate) bitmaps: Vec<Bitmap>,
    /// Gradients and filters that are none of the source's own, by address.
    pub(crate) foreign: HashSet<usize>,
    pub(crate) slots: Vec<Slot>,
    /// Lines of lettering.
    pub(crate) lines: Vec<Line>,
    /// The parts written as each element.
    pub(crate) by_source: HashMap<ElementId, Vec<usize>>,
    /// Root user space to px.
    pub(crate) to_px: Affine,
    /// Why the source cannot be patched in place, whatever the map.
    pub(crate) unkeepable: Option<String>,
    /// What could not be resolved as asked, and where.
    pub(crate) notes: Vec<(&'static str, String)>,
}

impl Part {
    /// Whether it leaves a mark.
    pub(crate) fn painted(&self) -> bool {
        self.visible && (self.fill.is_some() || self.stroke.is_some())
    }

    /// In root user space.
    pub(crate) fn outline(&self) -> Outline {
        self.local.transformed(self.frame)
    }
}
