//! The file under construction: its objects, and the function that draws groups.

use crate::options::Options;
use crate::stream::{Stream, pdf_rect};
use flate2::Compression;
use flate2::write::ZlibEncoder;
use kurbo::{Rect, Vec2};
use pathwarp::budget::Budget;
use pathwarp_raster::Error;
use pdf_writer::types::{BlendMode, MaskType, OverprintMode};
use pdf_writer::{Filter, Name, Pdf, Ref};
use std::collections::HashMap;
use std::io::Write as _;
use std::sync::Arc;

/// A PDF under construction.
pub(crate) struct File<'a> {
    pub(crate) pdf: Pdf,
    pub(crate) options: &'a Options<'a>,
    /// Number of groups that became pictures.
    pub(crate) pictures: usize,
    /// Number of these pictures that have fewer pixels than requested.
    pub(crate) coarser: usize,
    /// Bounds the work on pictures.
    pub(crate) budget: Budget,
    /// The first error about a picture. Since the file will be dropped, later pictures are not drawn.
    pub(crate) failed: Option<Error>,
    /// The objects of embedded pictures, by their data, with `true` if they are interpolated.
    pub(crate) embedded: HashMap<(Arc<Vec<u8>>, bool), Ref>,
    /// Number of the last object.
    last: i32,
    states: HashMap<State, Ref>,
    inks: HashMap<String, Ref>,
}

/// Parameters of a graphics state.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub(crate) struct State {
    /// Opacity as bits.
    opacity: Option<u32>,
    blend: Option<BlendMode>,
    mask: Option<(MaskType, Ref)>,
    overprint: bool,
}

impl State {
    pub(crate) fn opacity(mut self, opacity: f32) -> Self {
        self.opacity = (opacity < 1.0).then_some(opacity.to_bits());
        self
    }

    pub(crate) fn mask(mut self, kind: MaskType, group: Ref) -> Self {
        self.mask = Some((kind, group));
        self
    }

    /// Prints inks over the paint below.
    pub(crate) fn overprint(mut self) -> Self {
        self.overprint = true;
        self
    }

    pub(crate) fn blend(mut self, mode: usvg::BlendMode) -> Self {
        self.blend = BLEND_MODES.iter().find(|(m, _)| *m == mode).map(|(_, mode)| *mode);
        self
    }

    /// Returns `true` if the state changes nothing.
    pub(crate) fn is_plain(self) -> bool {
        self == Self::default()
    }
}

/// All blend modes except the normal one.
const BLEND_MODES: [(usvg::BlendMode, BlendMode); 15] = [
    (usvg::BlendMode::Multiply, BlendMode::Multiply),
    (usvg::BlendMode::Screen, BlendMode::Screen),
    (usvg::BlendMode::Overlay, BlendMode::Overlay),
    (usvg::BlendMode::Darken, BlendMode::Darken),
    (usvg::BlendMode::Lighten, BlendMode::Lighten),
    (usvg::BlendMode::ColorDodge, BlendMode::ColorDodge),
    (usvg::BlendMode::ColorBurn, BlendMode::ColorBurn),
    (usvg::BlendMode::HardLight, BlendMode::HardLight),
    (usvg::BlendMode::SoftLight, BlendMode::SoftLight),
    (usvg::BlendMode::Difference, BlendMode::Difference),
    (usvg::BlendMode::Exclusion, BlendMode::Exclusion),
    (usvg::BlendMode::Hue, BlendMode::Hue),
    (usvg::BlendMode::Saturation, BlendMode::Saturation),
    (usvg::BlendMode::Color, BlendMode::Color),
    (usvg::BlendMode::Luminosity, BlendMode::Luminosity),
];

impl<'a> File<'a> {
    pub(crate) fn new(options: &'a Options<'a>) -> Self {
        let mut pdf = Pdf::new();
        pdf.set_version(1, 7);
        // Bytes above 127 make programs treat the file as binary.
        pdf.set_binary_marker(b"\xe2\xe3\xcf\xd3");
        Self {
            pdf,
            options,
            pictures: 0,
            coarser: 0,
            budget: Budget::new(options.limits),
            failed: None,
            embedded: HashMap::new(),
            last: 0,
            states: HashMap::new(),
            inks: HashMap::new(),
        }
    }

    /// Allocates a number for a new object.
    pub(crate) fn new_ref(&mut self) -> Ref {
        self.last += 1;
        Ref::new(self.last)
    }

    /// Adds a compressed stream.
    pub(crate) fn compressed(&mut self, object: Ref, bytes: &[u8]) {
        self.pdf.stream(object, &deflated(bytes)).filter(Filter::FlateDecode);
    }

    /// Adds an isolated group with the content that `draw` draws. `bounds` is in the group's coordinates, which are written with the
    /// [shift](Stream::shift) of the stream that shows the group.
    pub(crate) fn group(&mut self, bounds: Rect, shift: Vec2, draw: impl FnOnce(&mut Self, &mut Stream)) -> Ref {
        let mut stream = Stream::shifted(shift);
        draw(self, &mut stream);
        let (bytes, used) = stream.finish();
        let group = self.new_ref();
        let bytes = deflated(&bytes);
        let mut out = self.pdf.form_xobject(group, &bytes);
        out.filter(Filter::FlateDecode);
        out.bbox(pdf_rect(bounds - shift));
        used.write(&mut out.resources());
        out.group().transparency().isolated(true).pair(Name(b"CS"), Name(b"DeviceRGB"));
        group
    }

    /// Returns the colour space of an ink, adding it if it is new. A device without that ink shows it as magenta, or `All` as all process
    /// colours.
    pub(crate) fn ink(&mut self, name: &str) -> Ref {
        if let Some(known) = self.inks.get(name) {
            return *known;
        }
        let space = self.new_ref();
        self.inks.insert(name.to_owned(), space);
        // Cyan, magenta, yellow and black of the full tint.
        let full = if name == "All" { [1.0; 4] } else { [0.0, 1.0, 0.0, 0.0] };
        let mut ink = self.pdf.color_space(space).separation(Name(name.as_bytes()));
        ink.alternate_color_space().device_cmyk();
        ink.tint_exponential().domain([0.0, 1.0]).n(1.0).c0([0.0; 4]).c1(full);
        space
    }

    /// Returns the graphics state with these parameters, adding it if it is new.
    pub(crate) fn state(&mut self, state: State) -> Ref {
        if let Some(known) = self.states.get(&state) {
            return *known;
        }
        let at = self.new_ref();
        self.states.insert(state, at);
        let mut out = self.pdf.ext_graphics(at);
        if let Some(opacity) = state.opacity.map(f32::from_bits) {
            out.non_stroking_alpha(opacity).stroking_alpha(opacity);
        }
        if let Some(mode) = state.blend {
            out.blend_mode(mode);
        }
        if state.overprint {
            out.overprint(true).overprint_fill(true).overprint_mode(OverprintMode::IgnoreZeroChannel);
        }
        if let Some((kind, group)) = state.mask {
            out.soft_mask().subtype(kind).group(group);
        }
        at
    }
}

/// Compresses bytes for `FlateDecode`.
pub(crate) fn deflated(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    // Writing to memory cannot fail.
    let _ = encoder.write_all(bytes);
    encoder.finish().unwrap_or_default()
}
