//! The session: one drawing with its steps, shared by all open pages.

use crate::catalogue::{example_values, opening_values, variant_values};
use crate::command_line::{command_line, quoted};
use crate::draft::{self, Draft, History, Moment, NO_FOLDER};
use crate::grips::{caption_grips, carried_net_values, grips, rect};
use crate::guard::Guard;
use crate::host::{Bent, Fineness, Host, Opened, PictureOptions, Purpose};
use crate::picture::Picture;
use crate::protocol::{PageStep, Target, recipe, steps};
use crate::stretch::stretch;
use crate::words::Words;
use crate::{presets, saving};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use pathwarp::kurbo::{Point, Rect};
use pathwarp::map::{Map, inverse_over};
use pathwarp::param::Args;
use pathwarp::recipe::{BuiltRecipe, Recipe, Step};
use pathwarp_engine::caption::{self, is_caption};
use pathwarp_engine::framed::is_framed;
use pathwarp_svg::engine::DrawingPart;
use pathwarp_svg::{Document, ReadOptions, Selection};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Most parts of a drawing in the list.
const MOST_PARTS: usize = 2000;
/// Decimals of coordinates in pictures, in px. Pictures may be zoomed, drafts hardly.
const DECIMALS: u8 = 4;
const DRAFT_DECIMALS: u8 = 2;
/// Tolerance of thumbnails, as a share of the artwork's diagonal: far below a pixel of theirs.
const THUMBNAIL_TOLERANCE: f64 = 1e-3;

/// Largest distance of a preimage's image from the point, as a share of the frame's width plus height.
const PREIMAGE_TOLERANCE: f64 = 1e-6;

/// The drawing and its steps.
pub(crate) struct Session {
    host: Arc<dyn Host>,
    /// The file on show; results go to its folder.
    file: PathBuf,
    /// The file that the editor was started with, if another one is on show.
    started_with: Option<PathBuf>,
    purpose: Purpose,
    /// `true` if the user has confirmed the steps as the session's result.
    handed_over: bool,
    opened: Opened,
    /// The words that the drawing was set from, if any.
    words: Option<Words>,
    history: History,
    /// The user's folder for drafts and addresses.
    drafts: Option<PathBuf>,
    draft: Draft,
    /// A name for the drawing on show. It differs for other drawings, and for other words.
    drawing: String,
    /// The file saved last, and the state in it.
    saved: Option<(PathBuf, Moment)>,
    /// `true` if the steps come from a draft of an earlier run.
    restored: bool,
    /// The error of writing the draft, if any.
    problem: Option<String>,
}

/// A bent drawing with all that a page shows about it.
pub(crate) struct Shown {
    pub(crate) svg: String,
    /// `true` for a preview while something is dragged.
    pub(crate) is_draft: bool,
    pub(crate) about: Value,
    reading: ReadOptions,
}

impl Shown {
    /// Returns the picture of the drawing.
    pub(crate) fn picture(&self) -> Result<Picture, String> {
        Picture::from_svg(&self.svg, if self.is_draft { DRAFT_DECIMALS } else { DECIMALS }, &self.reading)
    }
}

impl Session {
    /// Opens a drawing, with its draft if an earlier run has left one.
    pub(crate) fn open(
        host: Arc<dyn Host>,
        file: &Path,
        bytes: &[u8],
        purpose: Purpose,
        drafts: Option<PathBuf>,
    ) -> Result<Self, String> {
        let opened = host.open(file, bytes)?;
        let draft = Draft::for_drawing(drafts.as_deref(), file, bytes);
        let restored = draft.read();
        let problem = (drafts.is_none() && purpose.program().is_none()).then(|| NO_FOLDER.to_owned());
        let as_opened = History::new(steps(&opened.recipe));
        let saved = opened.is_result.then(|| (file.to_owned(), as_opened.now.clone()));
        Ok(Self {
            host,
            file: file.to_owned(),
            started_with: None,
            purpose,
            handed_over: false,
            words: Words::of(opened.artwork.document().text()),
            opened,
            restored: restored.is_some(),
            history: restored.unwrap_or(as_opened),
            drafts,
            drawing: draft.key.clone(),
            draft,
            saved,
            problem,
        })
    }

    /// Stores the address of the page for the next run. If that fails, only pages that are open now cannot reconnect.
    pub(crate) fn keep_address(&self, guard: &Guard) {
        if let Some(state) = &self.drafts {
            let _ = guard.keep(&*self.host, state, &self.file);
        }
    }

    /// Opens a drawing that was dropped on the page, with its draft; the present draft stays.
    pub(crate) fn replace(&mut self, name: &str, bytes: &str) -> Result<(), String> {
        self.refuse_for_program("another drawing cannot be opened")?;
        let file = saving::file_beside(name, &self.file)?;
        let content = STANDARD.decode(bytes).map_err(|e| format!("{name}: {e}"))?;
        let (host, purpose) = (Arc::clone(&self.host), Purpose::Files { out: None });
        let mut other = Self::open(host, &file, &content, purpose, self.drafts.clone())?;
        let started_with = self.started_with.take().or_else(|| Some(std::mem::take(&mut self.file)));
        // Another file may have this name in the folder.
        let saved = other.saved.take().filter(|(there, _)| std::fs::read(there).is_ok_and(|c| c == content));
        *self = Self { started_with, saved, ..other };
        Ok(())
    }

    /// Returns the families of the available fonts.
    pub(crate) fn families(&self) -> Result<Vec<String>, String> {
        self.host.families()
    }

    /// Sets words as the drawing, in a file beside the present one. If that consists of words, the new ones replace them under its steps,
    /// whose paths are mapped onto the new box. Lists the characters that no font has.
    pub(crate) fn set_words(&mut self, words: &Words) -> Result<Vec<char>, String> {
        self.refuse_for_program("words cannot be set")?;
        let (svg, lacking) = self.host.set_words(words)?;
        let svg = words.written(&svg);
        let replaces_file = self.words.is_some() && !self.opened.is_result;
        let file = if replaces_file { self.file.clone() } else { saving::words_file(&words.text, &self.file) };
        if self.words.is_some() {
            self.edit_words(&file, svg)?;
            return Ok(lacking);
        }
        let other = self.with_drawing(&file, &svg)?;
        self.host.write(&file, svg.as_bytes())?;
        let started_with = self.started_with.take().or_else(|| Some(self.file.clone()));
        *self = Self { started_with, ..other };
        Ok(lacking)
    }

    /// Replaces words by the drawing `svg` of other words, under the same steps.
    fn edit_words(&mut self, file: &Path, svg: String) -> Result<(), String> {
        let old = self.opened.artwork.document().text().to_owned();
        if svg == old {
            return Ok(());
        }
        let mut other = self.with_drawing(file, &svg)?;
        let (old_steps, mut steps) = (self.history.now.steps.clone(), Vec::new());
        let frames = self.frames(&old_steps)?;
        for (step, from) in old_steps.into_iter().zip(frames) {
            // Keep a step as it is while the letters that it applies to are missing.
            let lacks_parts = self.lacks_parts(&step) || other.lacks_parts(&step);
            let to = if lacks_parts { from } else { other.frame_of(&steps, &step.select)? };
            steps.push(presets::fit_to_box(other.host.registry(), step, from, to));
        }
        let mut history = self.history.clone();
        history.push_drawing(&old, svg, steps);
        self.switch_drawing(other, history)
    }

    /// Restricts the steps to existing parts of the drawing. Steps without any such part are hidden.
    fn present(&mut self, given: &[PageStep]) -> Vec<PageStep> {
        let mut out = given.to_vec();
        if given.iter().all(|s| s.select.is_empty() && s.exclude.is_empty()) {
            return out;
        }
        // A wrong caption is reported when the drawing is bent.
        let Ok(document) = self.opened.artwork.captioned(&recipe(given)) else { return out };
        let exists = |selector: &String| {
            let select = vec![selector.clone()];
            document.check_selection(&Selection { select, ..Selection::default() }).is_ok()
        };
        for step in &mut out {
            let is_for_all = step.select.is_empty();
            step.select.retain(exists);
            step.exclude.retain(exists);
            step.hidden |= step.select.is_empty() && !is_for_all;
        }
        out
    }

    /// Returns `true` if a step applies to missing parts only.
    fn lacks_parts(&mut self, step: &PageStep) -> bool {
        !step.hidden && self.present(std::slice::from_ref(step)).iter().all(|s| s.hidden)
    }

    /// Returns the recipe of the steps, restricted to existing parts.
    fn recipe(&mut self, given: &[PageStep]) -> Recipe {
        recipe(&self.present(given))
    }

    /// Returns the recipe for results. Without steps, as for words, it has one that moves nothing.
    fn result_recipe(&mut self) -> Recipe {
        let mut recipe = self.recipe(&self.history.now.steps.clone());
        if recipe.steps.is_empty() {
            recipe.steps.push(Step::new("affine", Args::new()));
        }
        recipe
    }

    /// Opens the drawing `svg`, which will be the content of `file`, in a session with the same settings.
    fn with_drawing(&self, file: &Path, svg: &str) -> Result<Self, String> {
        let (host, purpose) = (Arc::clone(&self.host), self.purpose.clone());
        Self::open(host, file, svg.as_bytes(), purpose, self.drafts.clone())
    }

    /// Switches to another drawing and its history, and writes the drawing's file.
    fn switch_drawing(&mut self, other: Self, history: History) -> Result<(), String> {
        let mut other = Self { history, saved: self.saved.clone(), restored: false, ..other };
        // Store the draft first: if the program crashes before the next line, nothing is lost.
        other.store_draft();
        self.host.write(&other.file, other.opened.artwork.document().text().as_bytes())?;
        if other.draft != self.draft {
            self.draft.remove();
        }
        *self = Self { started_with: self.started_with.take(), ..other };
        Ok(())
    }

    /// Writes a file that a step reads beside the drawing, unless an equal one is there. Answers with the text that names it in a step.
    pub(crate) fn bring(&self, name: &str, bytes: &str) -> Result<Value, String> {
        self.refuse_for_program("a file cannot be put beside the drawing")?;
        let to = saving::file_beside(name, &self.file)?;
        let content = STANDARD.decode(bytes).map_err(|e| format!("{name}: {e}"))?;
        let copied = match std::fs::read(&to) {
            Ok(old) if old == content => false,
            Ok(_) => return Err(format!("another file called {name} is beside the drawing; rename one of them")),
            Err(e) if e.kind() == ErrorKind::NotFound => {
                self.host.write(&to, &content)?;
                true
            }
            Err(e) => return Err(format!("{}: {e}", to.display())),
        };
        Ok(json!({ "written": self.host.reference(&to), "copied": copied }))
    }

    /// Describes the session for a page.
    pub(crate) fn state(&self) -> Value {
        let document = self.opened.artwork.document();
        let page = document.view_box();
        let name = |p: &Path| p.file_name().map(|n| n.to_string_lossy().into_owned());
        let saved = self.saved.as_ref().filter(|(_, saved)| *saved == self.history.now);
        let again = saved.map(|(p, _)| p).or(self.started_with.as_ref()).unwrap_or(&self.file);
        let again = std::path::absolute(again).unwrap_or_else(|_| again.clone());
        json!({
            "file": if let Purpose::Program { drawing, .. } = &self.purpose { Some(drawing.clone()) } else { name(&self.file) },
            "again": format!("pathwarp edit {}", quoted(&again.display().to_string())),
            "program": self.purpose.program(),
            "folder": folder_of(&self.file),
            "drawing": self.drawing,
            "steps": self.history.now.steps,
            "undo": !self.history.undo.is_empty(),
            "redo": !self.history.redo.is_empty(),
            "saved": saved.is_some(),
            "savedTo": self.saved.as_ref().and_then(|(p, _)| name(p)),
            "savedIn": self.saved.as_ref().map(|(p, _)| folder_of(p)).filter(|f| *f != folder_of(&self.file)),
            "target": name(&self.target()),
            "restored": self.restored,
            "problem": self.problem,
            "toPx": document.user_to_px().as_coeffs(),
            "page": [page.x0, page.y0, page.width(), page.height()],
            "words": self.words,
            "photograph": is_framed(document.text(), page.size()),
            "missing": document.missing(),
        })
    }

    pub(crate) fn catalogue(&self) -> Value {
        let edits = if self.purpose.program().is_some() { &[] } else { self.host.first() };
        crate::catalogue::catalogue(self.host.registry(), edits, &self.host.foreign_words())
    }

    /// Bends the drawing by these steps; `draft` is the tolerance while something is dragged.
    pub(crate) fn bend(&mut self, given: &[PageStep], draft: Option<f64>) -> Result<Shown, String> {
        let fineness = draft.map_or(Fineness::Exact, Fineness::Draft);
        let present = self.present(given);
        let bent = self.opened.artwork.bend(&recipe(&present), fineness)?;
        let about = self.about(given, &present, &bent);
        let reading = self.opened.artwork.reading().clone();
        Ok(Shown { svg: bent.svg, is_draft: draft.is_some(), about, reading })
    }

    /// Returns the drawing without steps.
    pub(crate) fn before(&self) -> Result<Picture, String> {
        let artwork = &self.opened.artwork;
        Picture::from_svg(artwork.document().text(), DECIMALS, artwork.reading())
    }

    /// Returns the picture of a drawing given as base64.
    pub(crate) fn drawn(&self, name: &str, bytes: &str) -> Result<Picture, String> {
        let wrong = |e: &dyn std::fmt::Display| format!("{name}: {e}");
        let content = STANDARD.decode(bytes).map_err(|e| wrong(&e))?;
        let reading = self.opened.artwork.reading();
        let document = Document::read(&content, name, reading).map_err(|e| wrong(&e))?;
        Picture::from_svg(document.text(), DECIMALS, reading)
    }

    /// Returns `true` for an edit, which comes before bending.
    fn is_edit(&self, step: &PageStep) -> bool {
        self.host.first().iter().any(|i| i.name == step.deformation)
    }

    /// Distributes values of the steps that bend, in order, to all steps; edits and hidden steps get `other`.
    fn for_all_steps<T: Clone>(&self, given: &[PageStep], bending: impl IntoIterator<Item = T>, other: &T) -> Vec<T> {
        let mut bending = bending.into_iter();
        let bends = |s: &PageStep| !s.hidden && !self.is_edit(s);
        let value = |s| if bends(s) { bending.next() } else { None };
        given.iter().map(value).map(|found| found.unwrap_or_else(|| other.clone())).collect()
    }

    /// Describes a drawing bent by these steps for a page; `present` are the steps restricted to existing parts.
    fn about(&self, given: &[PageStep], present: &[PageStep], bent: &Bent) -> Value {
        let artwork = &self.opened.artwork;
        let grips = grips(self.host.registry(), &bent.resolved, &bent.built);
        let without = json!({ "frame": rect(artwork.frame()), "params": {} });
        let mut grips = self.for_all_steps(present, grips, &without);
        for (step, grips) in given.iter().zip(&mut grips) {
            // Of the edits, only captions have handles.
            if let [caption] = &*recipe(std::slice::from_ref(step)).steps
                && is_caption(caption)
            {
                *grips = caption_grips(&caption.args, &caption::frame(artwork.document()));
            }
        }
        let gone: Vec<usize> = (0..given.len()).filter(|&i| present[i].hidden && !given[i].hidden).collect();
        let mut about = json!({
            "grips": grips,
            "gone": gone,
            "guides": guides(&bent.built),
            "warnings": bent.warnings.iter().map(|w| self.with_drawing_name(w)).collect::<Vec<_>>(),
            "page": bent.page.map(|p| [p.x0, p.y0, p.width(), p.height()]),
        });
        if let Some(s) = &bent.summary {
            let image = |p: Point| bent.built.map.point(p);
            let folds = s.folds.iter().map(|(id, p)| (id, image(*p))).filter(|(_, p)| p.is_finite());
            let folds: Vec<Value> = folds.map(|(id, p)| json!([id, [p.x, p.y]])).collect();
            about["summary"] = json!({
                "segmentsIn": s.segments_in, "segmentsOut": s.segments_out,
                "error": s.max_error, "tolerance": s.tolerance, "folds": folds,
            });
        }
        about
    }

    /// Replaces the steps, unless the drawing cannot be bent by the new ones. The picture is that of the first `shown` steps.
    pub(crate) fn commit(&mut self, given: Vec<PageStep>, shown: Option<usize>) -> Result<Shown, String> {
        let visible = visible(&given, shown);
        let picture = self.bend(visible, None)?;
        if visible.len() < given.len() {
            let all = self.recipe(&given);
            self.opened.artwork.settle(&all)?;
        }
        if given != self.history.now.steps {
            self.history.push_steps(given);
            self.store_draft();
        }
        Ok(picture)
    }

    /// Undoes the last change.
    pub(crate) fn undo(&mut self, shown: Option<usize>) -> Result<Shown, String> {
        let mut history = self.history.clone();
        history.undo();
        self.go_to(history, shown)
    }

    /// Redoes the change undone last.
    pub(crate) fn redo(&mut self, shown: Option<usize>) -> Result<Shown, String> {
        let mut history = self.history.clone();
        history.redo();
        self.go_to(history, shown)
    }

    /// Shows the present state of a history, which may have another drawing.
    fn go_to(&mut self, history: History, shown: Option<usize>) -> Result<Shown, String> {
        if history.now.drawing == self.history.now.drawing {
            self.history = history;
            self.store_draft();
        } else {
            let svg = history.drawing().ok_or("the draft lacks a drawing")?;
            self.switch_drawing(self.with_drawing(&self.file, svg)?, history)?;
        }
        let given = self.history.now.steps.clone();
        self.bend(visible(&given, shown), None)
    }

    /// Stores the draft, or removes it if all is saved. Without a folder for drafts, the page shows the problem.
    fn store_draft(&mut self) {
        if self.purpose.program().is_some() {
            return;
        }
        let is_saved = self.saved.as_ref().is_some_and(|(_, saved)| *saved == self.history.now);
        self.problem = if is_saved {
            self.draft.remove();
            None
        } else {
            self.draft.store(&*self.host, &self.history).err()
        };
    }

    /// Returns the stretch of these steps over the artwork's box.
    pub(crate) fn stretch(&mut self, given: &[PageStep]) -> Result<Value, String> {
        let given = self.recipe(given);
        let (_, built) = self.opened.artwork.settle(&given)?;
        Ok(stretch(&built.map, self.opened.artwork.frame()))
    }

    /// Returns the point that the last of these steps maps to `at`, if there is one.
    pub(crate) fn preimage(&mut self, given: &[PageStep], at: Point) -> Result<Value, String> {
        let given = self.recipe(given);
        let (_, built) = self.opened.artwork.settle(&given)?;
        let (Some(step), Some(frame)) = (built.steps.last(), built.frames.last()) else {
            return Ok(json!({ "at": [at.x, at.y] }));
        };
        let from = inverse_over(step.map.clone(), frame.rect).point(at);
        let tolerance = PREIMAGE_TOLERANCE * (frame.rect.width() + frame.rect.height());
        let from = (step.map.point(from).distance(at) <= tolerance).then_some([from.x, from.y]);
        Ok(json!({ "at": from }))
    }

    /// Changes the values of the last step that determine the size of its net, and adapts the net to bend as before, or nearly. Returns the
    /// step and the largest distance by which points move.
    pub(crate) fn renet(&mut self, given: &[PageStep], values: BTreeMap<String, Vec<String>>) -> Result<Value, String> {
        let present = self.recipe(given);
        let (resolved, built) = self.opened.artwork.settle(&present)?;
        let mut after = given.last().cloned().ok_or("there is no step")?;
        after.args.extend(values);
        let entry = self.host.registry().get(&after.deformation);
        if let (Some(entry), Some(old), Some(frame)) = (entry, resolved.steps.last(), built.frames.last()) {
            let mut undistorted = after.clone();
            undistorted.args.retain(|name, _| !["at", "move", "weight"].contains(&name.as_str()));
            let new = recipe(std::slice::from_ref(&undistorted));
            let net = new.steps.first().and_then(|new| carried_net_values(entry.info(), &old.args, &new.args, frame));
            if let Some(net) = net {
                after = undistorted;
                after.args.extend(net);
            }
        }
        after.args.retain(|_, values| !values.is_empty());
        let all = given.iter().take(given.len() - 1).chain([&after]).cloned().collect::<Vec<_>>();
        let all = self.recipe(&all);
        // Wrong values are reported when they are committed.
        let new = self.opened.artwork.settle(&all).ok();
        let new = new.as_ref().and_then(|(_, new)| new.steps.last());
        let both = built.steps.last().zip(built.frames.last()).zip(new);
        let moved = both.map_or(0.0, |((old, frame), new)| largest_distance(&old.map, &new.map, frame.rect));
        Ok(json!({ "step": after, "moved": moved }))
    }

    /// Returns the first values of a deformation that follows these steps.
    pub(crate) fn opening(
        &mut self,
        deformation: &str,
        variant: Option<&str>,
        given: &[PageStep],
        select: Vec<String>,
    ) -> Result<PageStep, String> {
        let frame = self.frame_of(given, &select)?;
        Ok(PageStep { select, ..self.first_step(deformation, variant, frame, false)? })
    }

    /// Returns the box of these parts of the drawing after these steps.
    fn frame_of(&mut self, given: &[PageStep], select: &[String]) -> Result<Rect, String> {
        if select.is_empty() {
            return self.frame_after(given);
        }
        // The frame of a further step for these parts, which moves nothing.
        let identity = PageStep { deformation: "affine".into(), select: select.to_vec(), ..PageStep::default() };
        let recipe = self.recipe(&[given, &[identity]].concat());
        let (_, built) = self.opened.artwork.settle(&recipe)?;
        built.frames.last().map(|f| f.rect).ok_or_else(|| "the parts have no box".into())
    }

    /// Returns the last of these steps for other parts of the drawing, with its paths mapped onto their box.
    pub(crate) fn scope(&mut self, mut given: Vec<PageStep>, select: Vec<String>) -> Result<PageStep, String> {
        let Some(step) = given.pop() else { return Err("there is no step".into()) };
        let [from, to] = [self.frame_of(&given, &step.select)?, self.frame_of(&given, &select)?];
        let step = presets::fit_to_box(self.host.registry(), step, from, to);
        Ok(PageStep { select, ..step })
    }

    /// Lists the parts of the drawing.
    pub(crate) fn parts(&mut self) -> Result<Value, String> {
        let document = self.opened.artwork.captioned(&recipe(&self.history.now.steps))?;
        let parts = document.parts().into_iter().take(MOST_PARTS);
        let part = |p: DrawingPart| json!({ "name": p.name, "selector": p.selector, "label": p.label, "element": p.element, "depth": p.depth });
        Ok(parts.map(part).collect())
    }

    /// Returns the box that each of these steps refers to.
    fn frames(&mut self, given: &[PageStep]) -> Result<Vec<Rect>, String> {
        let present = self.present(given);
        let (_, built) = self.opened.artwork.settle(&recipe(&present))?;
        Ok(self.for_all_steps(&present, built.frames.iter().map(|f| f.rect), &self.opened.artwork.frame()))
    }

    /// Returns the frame of a step that follows these.
    fn frame_after(&mut self, given: &[PageStep]) -> Result<Rect, String> {
        let given = self.recipe(given);
        let (_, built) = self.opened.artwork.settle(&given)?;
        let artwork = &self.opened.artwork;
        let image = (!given.steps.is_empty()).then(|| built.image_box(artwork.outlines().into_iter())).flatten();
        Ok(image.unwrap_or_else(|| artwork.frame()))
    }

    /// Returns the names of all presets.
    pub(crate) fn presets(&self) -> Result<Vec<String>, String> {
        Ok(presets::all()?.into_iter().map(|p| p.name).collect())
    }

    /// Stores the present steps as a preset. Returns the names of all presets.
    pub(crate) fn keep_preset(&mut self, name: &str) -> Result<Vec<String>, String> {
        let given = self.history.now.steps.clone();
        let frames = self.frames(&given)?;
        presets::keep(&*self.host, name, given, &frames)?;
        self.presets()
    }

    /// Deletes a preset. Returns the names of the others.
    pub(crate) fn forget_preset(&self, name: &str) -> Result<Vec<String>, String> {
        presets::forget(&*self.host, name)?;
        self.presets()
    }

    /// Returns the steps of a preset, adapted to this drawing.
    pub(crate) fn preset(&mut self, name: &str) -> Result<Vec<PageStep>, String> {
        let preset = presets::all()?.into_iter().find(|p| p.name == name);
        let preset = preset.ok_or_else(|| format!("there is no preset {name}"))?;
        let mut out = Vec::new();
        for (step, from) in preset.steps_with_frames() {
            let to = self.frame_of(&out, &[])?;
            out.push(presets::adapted(self.host.registry(), step, from, to));
        }
        Ok(out)
    }

    /// Returns a small picture of the drawing under these steps.
    pub(crate) fn thumbnail(&mut self, given: &[PageStep]) -> Result<String, String> {
        let frame = self.opened.artwork.frame();
        let tolerance = THUMBNAIL_TOLERANCE * frame.width().hypot(frame.height());
        let given = self.recipe(given);
        let bent = self.opened.artwork.bend(&given, Fineness::Small(tolerance))?;
        Picture::thumbnail(&bent.svg, self.opened.artwork.reading())
    }

    /// Returns a deformation with the values of its example.
    pub(crate) fn example(&self, deformation: &str, variant: Option<&str>) -> Result<PageStep, String> {
        self.first_step(deformation, variant, self.opened.artwork.frame(), true)
    }

    /// Returns a deformation with its first values for artwork in this frame, or with those of its example.
    fn first_step(
        &self,
        deformation: &str,
        variant: Option<&str>,
        frame: Rect,
        is_example: bool,
    ) -> Result<PageStep, String> {
        let bending = self.host.registry().get(deformation).map(|e| e.info());
        let info = bending.or_else(|| self.host.first().iter().find(|i| i.name == deformation));
        let info = info.ok_or_else(|| format!("there is no deformation {deformation}"))?;
        let args = match variant {
            Some(label) => variant_values(info, label, frame, is_example)?,
            None if is_example => example_values(info, frame),
            None => opening_values(info, frame),
        };
        Ok(PageStep { deformation: deformation.to_owned(), args, ..PageStep::default() })
    }

    /// Returns the file that *Save* writes by default.
    fn target(&self) -> PathBuf {
        let saved = self.saved.as_ref().map(|(p, _)| p.clone());
        saved.or_else(|| self.out().cloned()).unwrap_or_else(|| saving::default_result(&self.file))
    }

    /// Returns the file that a page names.
    fn target_file(&self, target: &Target) -> Result<PathBuf, String> {
        let Some(name) = &target.name else { return Ok(self.target()) };
        let named = saving::file_beside(name, &self.file)?;
        let folder = target.folder.as_deref().map(str::trim).filter(|f| !f.is_empty() && *f != folder_of(&self.file));
        let Some(folder) = folder else { return Ok(named) };
        let folder = saving::folder(folder, &self.file)?;
        Ok(folder.join(named.file_name().unwrap_or_default()))
    }

    /// Returns the output file that the user named, if any.
    fn out(&self) -> Option<&PathBuf> {
        if let Purpose::Files { out } = &self.purpose { out.as_ref() } else { None }
    }

    /// Replaces the name of the drawing's file in a message by the drawing's name in the program that waits, if any.
    pub(crate) fn with_drawing_name(&self, text: &str) -> String {
        let Purpose::Program { drawing, .. } = &self.purpose else { return text.to_owned() };
        let name = self.file.file_name().unwrap_or_default().to_string_lossy();
        text.replace(&*self.file.to_string_lossy(), drawing).replace(&*name, drawing)
    }

    fn refuse_for_program(&self, what: &str) -> Result<(), String> {
        self.purpose.program().map_or(Ok(()), |name| Err(format!("{what}: {name} waits for this drawing")))
    }

    /// Confirms the present steps as the result for the program that waits.
    pub(crate) fn hand_over(&mut self) -> Result<(), String> {
        if self.purpose.program().is_none() {
            return Err("no program waits for the steps".into());
        }
        self.handed_over = true;
        Ok(())
    }

    /// Returns the result, if the user has confirmed it.
    pub(crate) fn result(&self) -> Option<Recipe> {
        self.handed_over.then(|| recipe(&self.history.now.steps))
    }

    /// Writes the result. Answers with the file's name, or reports that the file exists.
    pub(crate) fn save(&mut self, target: &Target, replace: bool) -> Result<Value, String> {
        self.refuse_for_program("nothing can be saved")?;
        let to = self.target_file(target)?;
        let was_saved = self.saved.as_ref().is_some_and(|(p, _)| saving::same_file(p, &to));
        if !was_saved && !self.opened.is_result && saving::same_file(&to, &self.file) {
            return Err(format!("{} is the drawing itself; choose another name", to.display()));
        }
        if self.started_with.as_ref().is_some_and(|file| saving::same_file(&to, file)) {
            return Err(format!("{} is the drawing that was open first; choose another name", to.display()));
        }
        let is_out = self.out().is_some_and(|out| saving::same_file(out, &to));
        if to.exists() && !was_saved && !is_out && !replace {
            return Ok(json!({ "exists": to.file_name().map(|n| n.to_string_lossy()) }));
        }
        let (bytes, mut losses) = self.encoded(&to, true, &target.picture)?;
        if let Err(why) = self.host.write(&to, &bytes) {
            return Ok(json!({ "unwritable": why }));
        }
        let given = self.history.now.steps.clone();
        if self.present(&given).iter().any(|s| s.hidden) {
            let which = if given.iter().any(|s| s.hidden) { "hidden steps" } else { "steps whose letters are gone" };
            losses.push(format!("{which} are not in the file"));
        }
        if is_svg(&to) {
            self.saved = Some((to.clone(), self.history.now.clone()));
            self.draft.remove();
            self.restored = false;
            if saving::same_file(&to, &self.file) {
                self.draft = Draft::for_drawing(self.drafts.as_deref(), &self.file, &bytes);
            }
        }
        Ok(json!({ "written": to.display().to_string(), "warnings": losses }))
    }

    /// Returns the contents that *Save* would write to this file, for a download.
    pub(crate) fn download(&mut self, target: &Target) -> Result<Value, String> {
        self.refuse_for_program("nothing can be downloaded")?;
        let to = self.target_file(target)?;
        let (bytes, losses) = self.encoded(&to, false, &target.picture)?;
        let name = to.file_name().map(|n| n.to_string_lossy());
        Ok(json!({ "written": name, "bytes": STANDARD.encode(bytes), "warnings": losses }))
    }

    /// Returns the result in the format of the file `to`, and the losses of the format. Unless it `stays` there, pictures are embedded.
    fn encoded(&mut self, to: &Path, stays: bool, picture: &PictureOptions) -> Result<(Vec<u8>, Vec<String>), String> {
        let given = self.result_recipe();
        if saving::has_extension(to, &["toml"]) {
            return Ok((self.opened.artwork.recipe_text(&given)?.into_bytes(), Vec::new()));
        }
        self.opened.artwork.written(&given, to, stays, picture)
    }

    /// Returns the file that a command line bends, a command to run first, and the file's name if it was written now: a drawing that was
    /// dropped on the page, or a picture, may not exist as a file.
    fn source(&self) -> Result<(PathBuf, String, Option<String>), String> {
        let content = self.opened.artwork.document().source();
        let file_content = |holds: &dyn Fn(&[u8]) -> bool| std::fs::read(&self.file).is_ok_and(|bytes| holds(&bytes));
        if !self.opened.is_result && file_content(&|bytes| bytes == content) {
            return Ok((self.file.clone(), String::new(), None));
        }
        let (source, exists) = saving::source_of(&self.file, content).ok_or("the drawing has no name")?;
        if exists {
            return Ok((source, String::new(), None));
        }
        if self.opened.is_result && file_content(&|bytes| draft::key(&self.file, bytes) == self.draft.key) {
            let [result, name] = [&self.file, &source].map(|p| quoted(&p.display().to_string()));
            return Ok((source, format!("pathwarp unwarp {result} -o {name} && "), None));
        }
        self.host.write(&source, content)?;
        let name = source.file_name().map(|n| n.to_string_lossy().into_owned());
        Ok((source, String::new(), name))
    }

    /// Returns the command line that writes the same result as *Save*, and the name of the drawing's file if it was written now.
    pub(crate) fn command_line(&mut self, target: &Target) -> Result<Value, String> {
        let to = self.target_file(target)?;
        let (given, mut options) = (self.result_recipe(), self.opened.artwork.options());
        let (source, before, written) = self.source()?;
        let name = to.display().to_string();
        let line = |options: &[(String, String)], out: &Path| {
            before + &command_line(self.host.registry(), &given, options, &source, out)
        };
        let streamed = Path::new("-");
        let text = if saving::has_extension(&to, &["toml"]) {
            options.push(("write-recipe".to_owned(), name));
            line(&options, streamed) + " > /dev/null"
        } else if is_svg(&to) {
            options.push(("embed-recipe".to_owned(), String::new()));
            line(&options, &to)
        } else if saving::has_extension(&to, &["pdf", "dxf"]) {
            line(&options, &to)
        } else {
            let picture = target.picture.options();
            let picture: String = picture.iter().map(|(name, value)| format!(" --{name} {}", quoted(value))).collect();
            format!("{} | pathwarp render -{picture} -o {}", line(&options, streamed), quoted(&name))
        };
        Ok(json!({ "text": text, "written": written }))
    }
}

/// Returns the largest distance between two images of the same point, over a grid in a box.
fn largest_distance(a: &dyn Map, b: &dyn Map, r: Rect) -> f64 {
    /// Number of points along a side.
    const SAMPLES: u32 = 25;
    let share = |k: u32| f64::from(k) / f64::from(SAMPLES - 1);
    let shares = (0..SAMPLES * SAMPLES).map(|k| (share(k % SAMPLES), share(k / SAMPLES)));
    let points = shares.map(|(x, y)| Point::new(r.x0 + x * r.width(), r.y0 + y * r.height()));
    points.map(|p| a.point(p).distance(b.point(p))).filter(|d| d.is_finite()).fold(0.0, f64::max)
}

/// Returns the folder of a file, for display.
fn folder_of(file: &Path) -> String {
    let folder = file.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    folder.canonicalize().unwrap_or_else(|_| folder.to_owned()).display().to_string()
}

/// Returns `true` for a file that stores the source and the steps.
fn is_svg(file: &Path) -> bool {
    saving::has_extension(file, &["svg", "svgz"])
}

/// Returns the steps whose effect the page shows.
fn visible(steps: &[PageStep], shown: Option<usize>) -> &[PageStep] {
    steps.get(..shown.unwrap_or(steps.len()).min(steps.len())).unwrap_or_default()
}

/// Returns the guides of the last step that no parameter defines: cages and images of the base.
fn guides(built: &BuiltRecipe) -> Value {
    let overlays = built.steps.last().map(|s| s.explanation.overlays.as_slice()).unwrap_or_default();
    overlays.iter().map(|o| o.path.to_svg()).collect()
}
