//! A document under a map: every part's image, in parallel, and what to say about it.

use crate::bend::gradient::{GradientRequest, Shading};
use crate::bend::image::{self, BentImage, Picture};
use crate::bend::letters::{Piece, placed};
use crate::bend::options::{Gradients, OnError, PageFit, Patterns, Strokes, Structure, TextMode, WarpOptions};
use crate::bend::paint::{self, Fit};
use crate::bend::stroke;
use crate::document::Document;
use crate::scene::model::{Bitmap, Part, Role, Scene};
use crate::scene::resolve::Tiling;
use crate::source::number::MOST_DECIMALS;
use crate::source::read;
use crate::source::select::Selection;
use crate::write::page::Overhang;
use crate::write::{fragment as write, keep};
use pathwarp::kurbo::{Affine, BezPath, Line, ParamCurveNearest as _, Point, Rect, Shape as _};
use pathwarp::map::{AffineMap, Chain, Class, Map};
use pathwarp::outline::Subpath;
use pathwarp::refit::{self, Assurance};
use pathwarp::{Error, GeometryError, Outline, Seg};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// A warped document.
#[derive(Debug, Clone, PartialEq)]
pub struct Warped {
    /// The file.
    pub svg: String,
    /// What was done, per shape in painting order.
    pub shapes: Vec<ShapeReport>,
    /// What was not warped.
    pub skipped: Vec<Skipped>,
    /// What the owner should know.
    pub warnings: Vec<String>,
    /// How far the artwork leaves the page, if it does, the original did not, and the page was to stay ([`PageFit::None`]).
    pub overhang: Option<Overhang>,
}

/// What was done to a shape.
#[derive(Debug, Clone, PartialEq)]
pub struct ShapeReport {
    /// The source's id, or a readable stand-in such as `path at 12:5`.
    pub id: String,
    /// How often it stands in the result.
    pub copies: usize,
    /// Segments before, closing lines and copies included.
    pub segments_in: usize,
    /// Segments after.
    pub segments_out: usize,
    /// The largest distance between true image and output, rounding included; root user units.
    pub max_error: f64,
    /// How that is known.
    pub assurance: Assurance,
    /// Places in the source where the work budget ended before the tolerance was met.
    pub over_budget: Vec<Point>,
    /// The largest distance between the map and the affine fit that the shape's gradients or patterns follow; root user units,
    /// infinite where no affine map comes near. `None` where it has neither, or they stay or became pictures or geometry.
    pub paint_residual: Option<f64>,
    /// How many of its gradients became pictures.
    pub pictures: usize,
}

/// Something that was not warped: left as it was, or out of a drawing written anew where it cannot be.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Skipped {
    /// The source's id, or a readable stand-in.
    pub id: String,
    /// Why.
    pub why: String,
}

/// Remarks, each said once with all it applies to.
#[derive(Debug, Default)]
pub(crate) struct Notes(BTreeMap<&'static str, BTreeSet<String>>);

impl Notes {
    /// `what` happened to `whom`.
    pub(crate) fn add(&mut self, what: &'static str, whom: &str) {
        self.0.entry(what).or_default().insert(whom.to_owned());
    }

    fn lines(self) -> impl Iterator<Item = String> {
        /// As many names as help to find the place.
        const NAMED: usize = 4;
        self.0.into_iter().map(|(what, whom)| {
            let names: Vec<&str> = whom.iter().map(String::as_str).filter(|n| !n.is_empty()).take(NAMED).collect();
            match (names.len(), whom.len()) {
                (0, _) => what.to_owned(),
                (n, all) if all > n => format!("{what}: {} and {} more", names.join(", "), all - n),
                _ => format!("{what}: {}", names.join(", ")),
            }
        })
    }
}

/// What becomes of one part.
#[derive(Debug)]
pub(crate) enum Outcome {
    /// It stays.
    Kept,
    Warped(Box<Done>),
}

#[derive(Debug)]
pub(crate) struct Done {
    /// In the part's own user space.
    pub(crate) path: BezPath,
    /// What is filled, where that is not `path`: an open path is filled as if it were closed by a line, and that line bends
    /// as well. Without elements where there is nothing to fill.
    pub(crate) fill: Option<BezPath>,
    pub(crate) decimals: u8,
    pub(crate) stroke: StrokeDone,
    /// How gradients and patterns follow; `None`: they stay.
    pub(crate) fit: Option<Fit>,
    /// What fill and stroke show, where a gradient had to become a picture.
    pub(crate) fill_image: Option<BentImage>,
    pub(crate) stroke_image: Option<BentImage>,
    /// Why it could not become one.
    unpainted: Option<String>,
    /// How far the fit is off for paints that follow it, in root user units.
    residual: Option<f64>,
    report: refit::PathReport,
    rounding: f64,
}

#[derive(Debug)]
pub(crate) enum StrokeDone {
    /// Widths and dashes times this.
    Scaled(f64),
    /// The stroke's outline, in the part's own user space.
    Outlined(BezPath),
}

impl Outcome {
    pub(crate) fn done(&self) -> Option<&Done> {
        match self {
            Self::Kept => None,
            Self::Warped(d) => Some(d),
        }
    }
}

/// The part of an error that a shape's width may have before the stroke is outlined.
const WIDTH_ERROR: f64 = 0.02;
/// Rounding may cost this part of the tolerance.
const ROUNDING: f64 = 0.01;

impl Document {
    /// The document with everything that `options` selects bent by `map`, a map of root user space.
    ///
    /// # Errors
    /// [`Error::Geometry`] naming the shape that the map cannot bend, unless [`OnError::Skip`]; [`Error::Input`] if the
    /// structure must be kept and cannot be.
    pub fn warp(&self, map: &dyn Map, options: &WarpOptions) -> Result<Warped, Error> {
        let mut out = Warped {
            svg: String::new(),
            shapes: Vec::new(),
            skipped: Vec::new(),
            warnings: Vec::new(),
            overhang: None,
        };
        // What nothing moves is left in the source's own words.
        if unmoved(map, options) && options.structure != Structure::Flatten && options.page == PageFit::None {
            self.source.text.clone_into(&mut out.svg);
            return Ok(out);
        }
        match self.laid_out(map, options)? {
            Some(tiled) => tiled.warp_resolved(map, options, out),
            None => self.warp_resolved(map, options, out),
        }
    }

    /// The document with those patterns' tiles as geometry that are to be warped one by one.
    fn laid_out(&self, map: &dyn Map, options: &WarpOptions) -> Result<Option<Self>, Error> {
        /// Half a pixel where the page is drawn a thousand pixels across.
        const VISIBLE: f64 = 5e-4;
        let view = self.view_box();
        let visible = match options.patterns {
            Patterns::Fit | Patterns::Keep => return Ok(None),
            Patterns::Auto if options.copies.len() <= 1 => Some(VISIBLE * view.width().hypot(view.height())),
            Patterns::Auto | Patterns::Instantiate => None,
        };
        if self.scene().tiles.is_empty() {
            return Ok(None);
        }
        let strokes = matches!(options.strokes, Strokes::Auto | Strokes::Outline);
        let chosen = options.selection.resolve(&self.source);
        let tiling = Tiling::new(map, visible, strokes, chosen, options.selection.is_everything());
        self.tiled(tiling).map(Some)
    }

    fn warp_resolved(&self, map: &dyn Map, options: &WarpOptions, mut out: Warped) -> Result<Warped, Error> {
        let identity = unmoved(map, options);
        let meant = self.chosen(options);
        let mut options = options.clone();
        if options.refit.merge && !identity {
            options.refit.shared = Arc::new(refit::SharedEdges::among(self.shapes().iter().map(|s| &s.outline)));
        }
        let options = &options;
        let parts = &self.scene().parts;
        let slots = self.place_slots(map, &meant, &options.selection);
        let shaded = |p: &usvg::Paint| usize::from(Shading::of(p).is_some());
        let on = |p: &Part| {
            p.fill.as_ref().map_or(0, |f| shaded(f.paint())) + p.stroke.as_ref().map_or(0, |s| shaded(s.paint()))
        };
        let exact = matches!(options.gradients, Gradients::Exact(_));
        let among = if exact { parts.iter().map(on).sum() } else { 0 };
        let pieces = self.pieces(options);
        let one = |((p, meant), pieces): ((&Part, &bool), &Vec<Piece>)| {
            let write = written(self.scene(), &slots, p.slot, p.frame);
            (*meant && !identity && usable(p.frame) && usable(write))
                .then(|| warp_part(p, write, map, options, pieces, (self.scene().to_px, among)))
        };
        /// Below so many segments the work is done before another thread has woken up.
        const WORTH_IT: usize = 100;
        let segments =
            || -> usize { parts.iter().map(|p| p.local.segs().count()).sum::<usize>() * options.copies.len().max(1) };
        let results: Vec<Option<Result<Done, GeometryError>>> = if identity || segments() < WORTH_IT {
            parts.iter().zip(&meant).zip(&pieces).map(one).collect()
        } else {
            parts.par_iter().zip(&meant).zip(&pieces).map(one).collect()
        };
        let mut outcomes = Vec::with_capacity(parts.len());
        let mut last = None;
        for (i, r) in results.into_iter().enumerate() {
            outcomes.push(match r {
                None => Outcome::Kept,
                Some(Ok(done)) => {
                    let owner = parts[i].owner.or(parts[i].source);
                    let id = &self.shapes()[i].id;
                    if let Some(why) = &done.unpainted {
                        out.warnings.push(format!("a gradient of {id} only follows the best affine fit: {why}"));
                    }
                    out.report(id.clone(), &done, options.copies.len().max(1), owner.is_some() && owner == last);
                    last = owner;
                    Outcome::Warped(Box::new(done))
                }
                // Tiles reach beyond their shape, perhaps to where the map does not; the pattern follows as a whole then.
                Some(Err(_)) if parts[i].in_tile => Outcome::Kept,
                Some(Err(e)) => {
                    let id = &self.shapes()[i].id;
                    let e = e.on_shape(id);
                    let seen = parts[i].painted();
                    if options.on_error == OnError::Stop && seen {
                        return Err(Error::Geometry(e));
                    }
                    out.skipped.push(Skipped { id: id.clone(), why: e.to_string() });
                    Outcome::Kept
                }
            });
        }
        if options.copies.len() > 1 && outcomes.iter().any(|o| o.done().is_some_and(|d| d.fit.is_some())) {
            out.warnings.push("gradients and patterns run over the whole row of copies, not over each".into());
        }
        if options.copies.len() > 1 && slots.iter().any(|s| s.fit != Affine::IDENTITY) {
            out.warnings
                .push("images and what filters work on are not repeated; they follow the row as a whole".into());
        }
        if !self.missed.fonts.is_empty() {
            let names = self.missed.fonts.join(", ");
            out.warnings
                .push(format!("text is set in another font, for want of {names}; install it or outline the text"));
        }
        let elements = options.selection.resolve(&self.source);
        let chosen = |b: &Bitmap| b.owner.map_or(options.selection.is_everything(), |e| elements[e]);
        let bend = |b: &Bitmap| image::bend(b, self.scene(), &slots, chosen(b), map, &options.images);
        let pictures: Vec<Picture> = self.scene().bitmaps.iter().map(bend).collect();
        let job = write::Job { document: self, outcomes: &outcomes, pictures: &pictures, slots: &slots, map, options };
        // The walk over the drawing's groups wants a stack as deep as they are. Nothing in there waits for other threads: a
        // caller that runs on a thread pool, as does the work above, would wait for itself.
        if self.shallow {
            self.write(&job, &mut out)?;
        } else {
            read::with_stack(&self.name, || self.write(&job, &mut out))?;
        }
        Ok(out)
    }

    fn write(&self, job: &write::Job<'_>, out: &mut Warped) -> Result<(), Error> {
        let structure = job.options.structure;
        let unread = self.unread(&job.options.selection);
        let mut notes = Notes::default();
        for (what, whom) in &self.scene().notes {
            notes.add(what, whom);
        }
        let kept = match (structure, &self.scene().unkeepable) {
            (Structure::Flatten, _) => None,
            (_, Some(why)) => Some(Err(why.clone())),
            _ => Some(keep::write(job, &mut out.skipped, &mut notes)),
        };
        out.svg = match (kept, structure) {
            (Some(Ok(svg)), _) => {
                out.skipped.extend(unread);
                svg
            }
            (Some(Err(why)), Structure::Keep) => {
                return Err(Error::input(&self.name, format!("the file's structure cannot be kept: {why}")));
            }
            (kept, _) => {
                if let Some(Err(why)) = kept {
                    out.warnings.push(format!("the file is written anew, its structure could not be kept: {why}"));
                }
                out.skipped.extend(unread.map(|s| Skipped { why: s.why + "; it is left out", ..s }));
                write::flat(job, &mut out.skipped, &mut notes)
            }
        };
        out.warnings.extend(notes.lines());
        out.overhang = job.overhang();
        Ok(())
    }

    /// The chosen elements whose pictures could not be read.
    fn unread(&self, selection: &Selection) -> impl Iterator<Item = Skipped> {
        let source = &self.source;
        let chosen = if self.missed.images.is_empty() { Vec::new() } else { selection.resolve(source) };
        let images = chosen.into_iter().enumerate().filter(|(e, chosen)| *chosen && source.elements[*e].tag == "image");
        images.filter_map(|(e, _)| {
            let own = source.link(e)?;
            let is_own =
                |link: &&String| **link == *own || link.starts_with(read::DATA) && own.starts_with(link.as_str());
            let link = self.missed.images.iter().find(is_own)?;
            let reason = if link.contains("://") { "is no file of this machine" } else { "cannot be read" };
            Some(Skipped { id: source.display_name(e), why: format!("its picture, {link}, {reason}") })
        })
    }

    /// Where filtered groups and images go: the affine fit of the map over each.
    fn place_slots(&self, map: &dyn Map, meant: &[bool], selection: &Selection) -> Vec<Placed> {
        let mut out: Vec<Placed> = Vec::with_capacity(self.scene().slots.len());
        let elements = selection.resolve(&self.source);
        for s in &self.scene().slots {
            let outer = written(self.scene(), &out, s.outer, s.frame);
            // What stands in tiles and in filters' pictures is never bent and has no say.
            let mut own = s.parts.clone().filter(|&i| self.scene().parts[i].role != Role::Pattern).peekable();
            let moved = if own.peek().is_some() {
                own.all(|i| meant[i])
            } else {
                s.owner.or(s.element).map_or(selection.is_everything(), |e| elements[e])
            };
            let fit = (moved && usable(s.frame) && usable(outer))
                .then(|| paint::fit(s.area, s.frame, outer, map))
                .flatten()
                .filter(|f| usable(f.affine) && !f.is_identity(s.area));
            let fit = fit.map_or(Affine::IDENTITY, |f| f.affine);
            out.push(Placed { fit, write: outer * fit });
        }
        out
    }

    /// For every part whether it is to be warped: clip paths and masks follow those that refer to them.
    fn chosen(&self, options: &WarpOptions) -> Vec<bool> {
        let mut meant = self.meant(&options.selection);
        let all = options.selection.is_everything();
        let elements = options.selection.resolve(&self.source);
        let refs = self.scene().clips.iter().map(|c| (&c.parts, &c.referrers));
        let refs = refs.chain(self.scene().masks.iter().map(|m| (&m.parts, &m.referrers)));
        for (parts, referrers) in refs {
            let any = all || referrers.iter().any(|r| r.owner.or(r.element).is_some_and(|e| elements[e]));
            meant[parts.clone()].fill(any);
        }
        for (m, p) in meant.iter_mut().zip(&self.scene().parts) {
            let text = p.owner.is_some_and(|e| self.source.elements[e].tag == "text");
            *m &= p.role != Role::Pattern && !(text && options.text == TextMode::Skip);
        }
        meant
    }
}

impl Warped {
    fn report(&mut self, id: String, done: &Done, copies: usize, same_as_last: bool) {
        let r = &done.report;
        let error = r.max_error + done.rounding;
        let pictures = usize::from(done.fill_image.is_some()) + usize::from(done.stroke_image.is_some());
        match self.shapes.last_mut() {
            Some(last) if same_as_last => {
                last.segments_in += r.segments_in;
                last.segments_out += r.segments_out;
                last.max_error = last.max_error.max(error);
                last.assurance = last.assurance.min(r.assurance);
                last.over_budget.extend(&r.over_budget);
                last.pictures += pictures;
                last.paint_residual = [last.paint_residual, done.residual].into_iter().flatten().reduce(f64::max);
            }
            _ => self.shapes.push(ShapeReport {
                id,
                copies,
                segments_in: r.segments_in,
                segments_out: r.segments_out,
                max_error: error,
                assurance: r.assurance,
                over_budget: r.over_budget.clone(),
                paint_residual: done.residual,
                pictures,
            }),
        }
    }
}

/// Whether everything stays where it is.
fn unmoved(map: &dyn Map, options: &WarpOptions) -> bool {
    map.class() == Class::Affine(Affine::IDENTITY) && options.copies.is_empty() && options.letters.places.is_empty()
}

/// A slot under the map.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Placed {
    /// What its transform is multiplied with.
    pub(crate) fit: Affine,
    /// From inside to root user space, as written.
    write: Affine,
}

/// A frame as it is in the result: inside a slot it has moved along.
pub(crate) fn written(scene: &Scene, placed: &[Placed], slot: Option<usize>, frame: Affine) -> Affine {
    match slot.and_then(|s| Some((placed.get(s)?, scene.slots.get(s)?))) {
        Some((p, s)) if p.write != s.frame => p.write * s.frame.inverse() * frame,
        _ => frame,
    }
}

/// Whether there is a way back from root user space.
pub(crate) fn usable(frame: Affine) -> bool {
    frame.is_finite() && frame.determinant() != 0.0 && frame.inverse().is_finite()
}

/// The most that `m` stretches anything.
pub(crate) fn stretch(m: Affine) -> f64 {
    let [a, b, c, d, ..] = m.as_coeffs();
    // The larger singular value.
    let (s, t) = ((a + d).hypot(b - c), (a - d).hypot(b + c));
    (s + t) / 2.0
}

fn warp_part(
    p: &Part,
    write: Affine,
    map: &dyn Map,
    options: &WarpOptions,
    pieces: &[Piece],
    (to_px, among): (Affine, usize),
) -> Result<Done, GeometryError> {
    let whole = p.outline();
    // Letters that are placed go on from there; everything else goes through the map.
    let (outline, last): (Outline, &dyn Map) = if pieces.is_empty() {
        (whole.repeated(&options.copies), map)
    } else {
        (placed(&whole, pieces), &options.letters.after)
    };
    let back = write.inverse();
    let size = stretch(write);
    let tolerance = options.refit.tolerance;
    let decimals = options.precision.unwrap_or_else(|| {
        let needed = (size * std::f64::consts::FRAC_1_SQRT_2 / (ROUNDING * tolerance)).log10().ceil();
        if needed.is_finite() { needed.clamp(0.0, f64::from(MOST_DECIMALS)) as u8 } else { MOST_DECIMALS }
    });
    let rounding = size * std::f64::consts::FRAC_1_SQRT_2 * 0.1_f64.powi(i32::from(decimals));
    // What rounding takes is not the refit's to spend.
    let left = (tolerance - rounding).max(0.5 * tolerance);
    let warped = refit::warp_path(&outline, last, &options.refit.clone().with_tolerance(left))?;
    let mut done = Done {
        path: local(warped.path, back),
        fill: None,
        decimals,
        stroke: StrokeDone::Scaled(1.0),
        fit: None,
        fill_image: None,
        stroke_image: None,
        unpainted: None,
        residual: None,
        report: warped.report,
        rounding,
    };
    let painted_by_server = |p: &usvg::Paint| !matches!(p, usvg::Paint::Color(_));
    let served = p.fill.as_ref().is_some_and(|f| painted_by_server(f.paint()))
        || p.stroke.as_ref().is_some_and(|s| painted_by_server(s.paint()));
    if served {
        let result = done.path.bounding_box();
        let fit = |b| match pieces {
            // A gradient follows a letter that has a path of its own.
            [Piece { places, .. }] if places.len() == 1 => {
                paint::fit(b, places[0] * p.frame, write, &options.letters.after)
            }
            _ => paint::fit_copies(b, p.frame, write, map, &options.copies, result),
        };
        done.fit = p.local.bounding_box().and_then(fit);
    }
    let stroked = p.stroke.is_some() && p.role != Role::Clip;
    // Who wants centre lines wants each of them once: there, only a fill without a stroke is closed.
    let wanted = !(stroked && options.strokes == Strokes::Keep);
    if let Some(area) = filled_area(p, &outline, last, tolerance).filter(|a| wanted || a.is_empty()) {
        if area.is_empty() {
            done.fill = Some(BezPath::new());
        } else {
            let area = refit::warp_path(&area, last, &options.refit.clone().with_tolerance(left))?;
            *(if stroked { done.fill.insert(BezPath::new()) } else { &mut done.path }) = local(area.path, back);
        }
    }
    // A gradient on a stroke can only be a picture where the stroke is an outline.
    let outlines = matches!(options.strokes, Strokes::Auto | Strokes::Outline) && !p.fixed_width;
    let stroke_shading = p.stroke.as_ref().filter(|_| outlines);
    let stroke_shading = stroke_shading.and_then(|s| exact(p, s.paint(), write, map, &done, options));
    if p.in_tile && p.stroke.is_some() {
        done.stroke = StrokeDone::Outlined(done.path.clone());
    } else if let Some(s) = p.stroke.as_ref().filter(|_| !p.fixed_width) {
        let width = || {
            if pieces.is_empty() {
                return stroke::width(&outline, p.frame, write, map, s);
            }
            let each = pieces.iter().flat_map(|piece| piece.places.iter().map(move |m| (piece, *m)));
            let widths = each.map(|(piece, m)| {
                let mut way = Chain::new([Arc::new(AffineMap(m)) as Arc<dyn Map>]);
                way.push(Arc::new(options.letters.after.clone()));
                stroke::width(&piece.of(&whole), p.frame, write, &way, s)
            });
            stroke::Width::common(&widths.collect::<Option<Vec<_>>>()?)
        };
        let outlined = || outline_stroke(p, s, write, last, options, pieces);
        match options.strokes {
            Strokes::Keep => {}
            Strokes::Scale => done.stroke = StrokeDone::Scaled(width().map_or(1.0, |w| w.scale)),
            Strokes::Outline => done.stroke = StrokeDone::Outlined(outlined()?),
            Strokes::Auto => match width().filter(|_| p.stroke_tiles.is_none() && stroke_shading.is_none()) {
                Some(w) if w.error <= WIDTH_ERROR => done.stroke = StrokeDone::Scaled(w.scale),
                w => {
                    // An outline may reach where the map does not; one width then is better than none.
                    done.stroke = match outlined() {
                        Ok(path) => StrokeDone::Outlined(path),
                        Err(_) => StrokeDone::Scaled(w.map_or(1.0, |w| w.scale)),
                    };
                }
            },
        }
    }
    let fill_shading = p.fill.as_ref().and_then(|f| exact(p, f.paint(), write, map, &done, options));
    if let Gradients::Exact(painter) = &options.gradients {
        let mut paint = |shading: Shading, target: &BezPath| {
            let request = GradientRequest {
                color: &|q| shading.color(q),
                area: reached(p),
                placed: p.frame,
                map,
                after: back,
                target: target.bounding_box(),
                to_px,
                among,
            };
            painter.paint(&request).map_err(|why| done.unpainted = Some(why)).ok()
        };
        let fill = fill_shading.and_then(|s| paint(s, &done.path));
        let stroke = match (stroke_shading, &done.stroke) {
            (Some(s), StrokeDone::Outlined(o)) => paint(s, o),
            _ => None,
        };
        (done.fill_image, done.stroke_image) = (fill, stroke);
    }
    done.residual = done.fit.filter(|_| follows(p, &done, options)).map(|f| f.miss * stretch(write));
    Ok(done)
}

/// What a part fills, if its fill ends at a line that is not drawn and that the map bends: `outline` with these lines, without
/// the lines that enclose nothing.
fn filled_area(p: &Part, outline: &Outline, map: &dyn Map, tolerance: f64) -> Option<Outline> {
    /// Places along the line that are looked at.
    const LOOKS: u32 = 16;
    let bends = |a: Point, b: Point| {
        let (from, to) = (map.point(a), map.point(b));
        (1..LOOKS).any(|i| {
            let q = map.point(a.lerp(b, f64::from(i) / f64::from(LOOKS)));
            let off = Line::new(from, to).nearest(q, tolerance).distance_sq.sqrt();
            off > tolerance && q.is_finite()
        })
    };
    let open = |s: &Subpath| !s.closed && s.start != s.end();
    if p.fill.is_none() && p.role != Role::Clip
        || matches!(map.class(), Class::Affine(_))
        || !outline.subpaths.iter().any(|s| open(s) && bends(s.end(), s.start))
    {
        return None;
    }
    let closed = |s: &Subpath| {
        let mut s = s.clone();
        if open(&s) {
            s.segs.push(Seg::Line(Line::new(s.end(), s.start)));
            s.closed = true;
        }
        s
    };
    let encloses = |s: &&Subpath| !open(s) || !matches!(s.segs.as_slice(), [] | [Seg::Line(_)]);
    Some(Outline { subpaths: outline.subpaths.iter().filter(encloses).map(closed).collect() })
}

/// Whether a paint of a part follows the affine fit.
fn follows(p: &Part, done: &Done, options: &WarpOptions) -> bool {
    // Gradients become pictures and patterns tiles, never the other way round.
    let follows = |paint: &usvg::Paint, picture: bool, tiles: bool| options.moves(paint) && !picture && !tiles;
    let fill = p.fill.as_ref().map(|f| follows(f.paint(), done.fill_image.is_some(), p.fill_tiles.is_some()));
    let stroke = p.stroke.as_ref().map(|s| follows(s.paint(), done.stroke_image.is_some(), p.stroke_tiles.is_some()));
    fill.unwrap_or(false) || stroke.unwrap_or(false)
}

/// The gradient of a part that has to become a picture to look right.
fn exact(
    p: &Part,
    paint: &usvg::Paint,
    write: Affine,
    map: &dyn Map,
    done: &Done,
    options: &WarpOptions,
) -> Option<Shading> {
    // Over copies a gradient runs as over one shape, which the map knows nothing of; in tiles it is too small to tell.
    let repeated = options.copies.len() > 1 || !options.letters.places.is_empty();
    if !matches!(options.gradients, Gradients::Exact(_)) || repeated || p.in_tile || !p.painted() {
        return None;
    }
    let shading = Shading::of(paint)?;
    let shows = done.fit.is_none_or(|f| shading.shows(reached(p), p.frame, write.inverse(), map, &f));
    shows.then_some(shading)
}

/// What a part paints, in its own user space.
fn reached(p: &Part) -> Rect {
    let reach = p.stroke.as_ref().map_or(0.0, |s| 0.5 * f64::from(s.width().get()));
    p.local.bounding_box().unwrap_or_default().inflate(reach, reach)
}

fn outline_stroke(
    p: &Part,
    s: &usvg::Stroke,
    write: Affine,
    map: &dyn Map,
    options: &WarpOptions,
    pieces: &[Piece],
) -> Result<BezPath, GeometryError> {
    // The expansion is an approximation of its own; a quarter of the tolerance is its share.
    let fine = (options.refit.tolerance / stretch(p.frame) * 0.25).max(1e-9);
    let expanded = |local: &Outline, places: &[Affine]| {
        stroke::outline(local, s, fine).transformed(p.frame).repeated(places).subpaths
    };
    let outline = if pieces.is_empty() {
        expanded(&p.local, &options.copies)
    } else {
        pieces.iter().flat_map(|piece| expanded(&piece.of(&p.local), &piece.places)).collect()
    };
    let warped = refit::warp_path(&Outline { subpaths: outline }, map, &options.refit)?;
    Ok(local(warped.path, write.inverse()))
}

fn local(mut path: BezPath, back: Affine) -> BezPath {
    if back != Affine::IDENTITY {
        path.apply_affine(back);
    }
    path
}
