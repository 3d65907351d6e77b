//! The data model of a drawing as it is painted: usvg's tree in f64. Each shape has its source element, its exact outline and its
//! transform to root user space, the coordinate system inside the root `<svg>`.

use crate::source::elements::{ElementId, Unpatchable};
use crate::source::images::is_unread;
use pathwarp::Outline;
use pathwarp::kurbo::{Affine, Rect};
use std::collections::{HashMap, HashSet};
use std::fmt;
use std::ops::{Deref, Range};
use std::sync::{Arc, LazyLock};
use usvg::{BlendMode, Fill, PaintOrder, ShapeRendering, Stroke};

/// Role of a part in the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum PartRole {
    Paint,
    Clip,
    Mask,
    /// Content of a tile, which is never warped.
    Pattern,
}

/// A painted path, visible or not.
#[derive(Debug)]
pub(crate) struct Part {
    /// The shape element that the part is written to, if it has one.
    pub(crate) source: Option<ElementId>,
    /// The element to replace as a whole if the part changes: a `use`, a text, a shape with markers.
    pub(crate) owner: Option<ElementId>,
    pub(crate) role: PartRole,
    /// The source element that `local` was read from: `source`, or the original of a copy.
    pub(crate) drawn: Option<ElementId>,
    /// Outline in the part's user space.
    pub(crate) local: LazyOutline,
    /// From the part's user space to root user space.
    pub(crate) frame: Affine,
    pub(crate) fill: Option<Fill>,
    pub(crate) stroke: Option<Stroke>,
    pub(crate) paint_order: PaintOrder,
    pub(crate) rendering: ShapeRendering,
    pub(crate) visible: bool,
    /// `true` if the stroke width is in px regardless of the transform (`vector-effect`).
    pub(crate) fixed_width: bool,
    /// `true` if usvg draws the part differently from browsers, which the scene follows.
    pub(crate) differs_from_usvg: bool,
    /// Index of the innermost [`Slot`] around the part.
    pub(crate) slot: Option<usize>,
    /// Address of usvg's path, which the document keeps alive; 0 if there is none.
    #[cfg_attr(not(feature = "usvg"), expect(dead_code, reason = "for the module of that feature"))]
    pub(crate) path: usize,
    /// `true` for parts of laid-out pattern tiles. If such a part has a stroke, `local` is the outline of that stroke.
    pub(crate) in_tile: bool,
    /// Laid-out tiles of the patterns of fill and stroke.
    pub(crate) fill_tiles: Option<Tiles>,
    pub(crate) stroke_tiles: Option<Tiles>,
}

impl Part {
    /// A visible part without paint, slot or source.
    pub(crate) fn plain(role: PartRole, owner: Option<ElementId>, local: LazyOutline, frame: Affine) -> Self {
        Self {
            source: None,
            owner,
            role,
            drawn: None,
            local,
            frame,
            fill: None,
            stroke: None,
            paint_order: PaintOrder::default(),
            rendering: ShapeRendering::default(),
            visible: true,
            fixed_width: false,
            differs_from_usvg: false,
            slot: None,
            path: 0,
            in_tile: false,
            fill_tiles: None,
            stroke_tiles: None,
        }
    }

    /// Returns `true` if the part is visible and has a fill or a stroke.
    pub(crate) fn painted(&self) -> bool {
        self.visible && (self.fill.is_some() || self.stroke.is_some())
    }

    /// Outline in root user space.
    pub(crate) fn outline(&self) -> Arc<Outline> {
        if self.frame == Affine::IDENTITY { self.local.0.clone() } else { Arc::new(self.local.transformed(self.frame)) }
    }

    /// The element that the part belongs to.
    pub(crate) fn element(&self) -> Option<ElementId> {
        self.owner.or(self.source)
    }
}

/// Pattern tiles laid out over a shape, in the shape's user space. They extend past the shape.
#[derive(Debug)]
pub(crate) struct Tiles {
    pub(crate) opacity: f32,
    pub(crate) content: Group,
}

/// An outline computed on first use. Shapes that are written unchanged never need one.
pub(crate) struct LazyOutline(LazyLock<Arc<Outline>, Box<dyn FnOnce() -> Arc<Outline> + Send>>);

impl LazyOutline {
    pub(crate) fn new(f: impl FnOnce() -> Arc<Outline> + Send + 'static) -> Self {
        Self(LazyLock::new(Box::new(f)))
    }
}

impl From<Outline> for LazyOutline {
    fn from(o: Outline) -> Self {
        Self::new(move || Arc::new(o))
    }
}

impl Deref for LazyOutline {
    type Target = Outline;

    fn deref(&self) -> &Outline {
        &self.0
    }
}

impl fmt::Debug for LazyOutline {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        (**self).fmt(f)
    }
}

/// A member of a group.
#[derive(Debug)]
pub(crate) enum Node {
    Group(Box<Group>),
    /// Index in [`Scene::parts`].
    Part(usize),
    /// Index in [`Scene::bitmaps`].
    Image(usize),
    Text {
        element: Option<ElementId>,
        content: Box<Group>,
        /// The source element of each child of the content; empty if nothing inside has a name, or a colour that is declared elsewhere.
        sources: Vec<ElementId>,
    },
}

/// Members that are painted together.
#[derive(Debug)]
pub(crate) struct Group {
    /// The element with the group's id.
    pub(crate) source: Option<ElementId>,
    /// The element to replace as a whole if something inside changes.
    pub(crate) owner: Option<ElementId>,
    /// From the group's space to the space around it.
    pub(crate) transform: Affine,
    pub(crate) opacity: f32,
    pub(crate) blend: BlendMode,
    pub(crate) isolate: bool,
    /// Indices in [`Scene::clips`] and [`Scene::masks`].
    pub(crate) clip: Option<usize>,
    pub(crate) mask: Option<usize>,
    pub(crate) filters: Vec<Arc<usvg::filter::Filter>>,
    /// The slot by which the group moves as a whole, if it does.
    pub(crate) slot: Option<usize>,
    pub(crate) children: Vec<Node>,
}

impl Group {
    /// A group that only transforms its content.
    pub(crate) fn plain(owner: Option<ElementId>, transform: Affine, children: Vec<Node>) -> Self {
        Self {
            source: None,
            owner,
            transform,
            opacity: 1.0,
            blend: BlendMode::default(),
            isolate: false,
            clip: None,
            mask: None,
            filters: Vec::new(),
            slot: None,
            children,
        }
    }
}

impl Default for Group {
    fn default() -> Self {
        Self::plain(None, Affine::IDENTITY, Vec::new())
    }
}

/// A group that moves as a whole: an affine fit of the map is applied to its transform. It holds content that cannot be bent
/// (filters with their regions and lengths, images). Its content is written in the moved frame.
#[derive(Debug)]
pub(crate) struct Slot {
    /// The enclosing slot.
    pub(crate) outer: Option<usize>,
    /// From the slot's coordinates to root user space.
    pub(crate) frame: Affine,
    /// Area to fit, in the slot's coordinates.
    pub(crate) area: Rect,
    /// `true` if the written transform is fit · transform, so that the slot's coordinates are not those of the group's filters; else it is
    /// transform · fit.
    pub(crate) fits_outside: bool,
    /// The element whose `transform` takes the fit.
    pub(crate) element: Option<ElementId>,
    pub(crate) owner: Option<ElementId>,
    /// The parts inside.
    pub(crate) parts: Range<usize>,
}

#[derive(Debug)]
pub(crate) struct Bitmap {
    pub(crate) image: Box<usvg::Image>,
    /// From pixels to root user space.
    pub(crate) frame: Affine,
    /// From pixels to the element's user space, derived by usvg from x, y, width and height.
    pub(crate) placing: Affine,
    pub(crate) slot: Option<usize>,
    /// The element by which the image is selected.
    pub(crate) owner: Option<ElementId>,
    /// `false` for images in tiles and filters, which are never bent.
    pub(crate) bends: bool,
    /// The visible pixels with `preserveAspectRatio="… slice"`. A clip path cuts off the others, too.
    pub(crate) crop: Option<Rect>,
}

impl Bitmap {
    /// Returns `true` if it is the placeholder for a picture that was not read.
    pub(crate) fn is_unread(&self) -> bool {
        is_unread(self.image.kind())
    }
}

/// A clip path in one frame.
#[derive(Debug)]
pub(crate) struct Clip {
    pub(crate) id: String,
    /// The definition's `transform`: from the content to the user space of the referrers.
    pub(crate) transform: Affine,
    /// Index of the clip path that clips this one.
    pub(crate) clip: Option<usize>,
    pub(crate) root: Group,
    pub(crate) referrers: Vec<Referrer>,
    /// If several maps bend parts of the drawing, the index in `Bends::each` of the one that bends the referrers.
    pub(crate) bend: Option<usize>,
    /// The parts inside.
    pub(crate) parts: Range<usize>,
    /// `true` if the source has no such definition, as in laid-out tiles and in a drawing shown as an image.
    pub(crate) foreign: bool,
}

impl Clip {
    /// A clip path that the source does not define.
    pub(crate) fn foreign(id: &str, root: Group, owner: Option<ElementId>, parts: Range<usize>) -> Self {
        Self {
            id: id.to_owned(),
            transform: Affine::IDENTITY,
            clip: None,
            root,
            referrers: vec![Referrer { element: None, owner }],
            bend: None,
            parts,
            foreign: true,
        }
    }
}

/// A mask in one frame.
#[derive(Debug)]
pub(crate) struct Mask {
    pub(crate) id: String,
    /// Area outside which the mask hides everything, in the frame's coordinates.
    pub(crate) rect: Rect,
    pub(crate) kind: usvg::MaskType,
    /// Index of the mask that masks this one.
    pub(crate) mask: Option<usize>,
    pub(crate) root: Group,
    /// From the referrers' user space to root user space.
    pub(crate) frame: Affine,
    pub(crate) slot: Option<usize>,
    pub(crate) referrers: Vec<Referrer>,
    /// If several maps bend parts of the drawing, the index in `Bends::each` of the one that bends the referrers.
    pub(crate) bend: Option<usize>,
    /// The parts inside.
    pub(crate) parts: Range<usize>,
    /// `true` if the source has no such definition.
    pub(crate) foreign: bool,
    /// Bounding box of the content in the frame's coordinates.
    pub(crate) content: Rect,
}

/// The tile of a pattern.
#[derive(Debug)]
pub(crate) struct PatternTile {
    pub(crate) pattern: Arc<usvg::Pattern>,
    pub(crate) root: Group,
}

/// An element that refers to a clip path or mask.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Referrer {
    /// The element with the property, if known.
    pub(crate) element: Option<ElementId>,
    /// The enclosing element that is replaced as a whole.
    pub(crate) owner: Option<ElementId>,
}

/// A remark on an object that could not be resolved as requested, with the object's name.
#[derive(Debug, Clone)]
pub(crate) struct SceneNote {
    pub(crate) text: &'static str,
    pub(crate) name: String,
}

/// A painted text.
#[derive(Debug)]
pub(crate) struct PlacedText {
    /// Address of usvg's text, which the document keeps alive.
    pub(crate) text: usize,
    /// The element of the whole text, if any.
    pub(crate) owner: Option<ElementId>,
    /// Maps the text to root user space.
    pub(crate) frame: Affine,
    /// Index of its first part.
    pub(crate) first: usize,
}

/// A resolved drawing.
#[derive(Debug, Default)]
pub(crate) struct Scene {
    pub(crate) root: Group,
    pub(crate) parts: Vec<Part>,
    pub(crate) clips: Vec<Clip>,
    pub(crate) masks: Vec<Mask>,
    pub(crate) tiles: Vec<PatternTile>,
    /// Content of `feImage`s by the address of usvg's group, which the document keeps alive.
    pub(crate) pictures: HashMap<usize, Group>,
    pub(crate) bitmaps: Vec<Bitmap>,
    /// Addresses of gradients and filters that the source does not define.
    pub(crate) foreign: HashSet<usize>,
    pub(crate) slots: Vec<Slot>,
    pub(crate) texts: Vec<PlacedText>,
    /// Indices of the parts written to each element.
    pub(crate) by_source: HashMap<ElementId, Vec<usize>>,
    /// Root user space to px.
    pub(crate) to_px: Affine,
    /// Reason why the source cannot be patched in place, regardless of the map.
    pub(crate) unpatchable: Option<Unpatchable>,
    pub(crate) notes: Vec<SceneNote>,
}
