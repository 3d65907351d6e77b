//! The engine's implementation of drawings in the editor.

use crate::host::{Artwork, Bent, Fineness, Host, Opened, PictureOptions, Summary};
use crate::names::Names;
use crate::picture as page;
use crate::words::Words;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use pathwarp::Outline;
use pathwarp::deform::{Info, Registry};
use pathwarp::kurbo::Rect;
use pathwarp::param::Args;
use pathwarp::recipe::{BuiltRecipe, Recipe, Step};
use pathwarp_engine::advice::Flags;
use pathwarp_engine::bitmap::{background, encode};
use pathwarp_engine::caption::{captioned, is_caption};
use pathwarp_engine::edits::EDITS;
use pathwarp_engine::export::Exported;
use pathwarp_engine::failure::Failure;
use pathwarp_engine::format::{Choice, DRAWINGS, Format, PICTURES};
use pathwarp_engine::framed::framed;
use pathwarp_engine::input::{Artwork as _, FileArtwork as _, SvgArtwork, WarpRequest, WarpedResult, Which};
use pathwarp_engine::lettering::set_plainly;
use pathwarp_engine::links::Destination;
use pathwarp_engine::options::{CommonOptions, Given};
use pathwarp_engine::output::PendingFile;
use pathwarp_engine::recipe_file::SavedRecipe;
use pathwarp_engine::report::ReportedShape;
use pathwarp_engine::session::{Framed, Ready, Session};
use pathwarp_engine::steps::OF_STEPS;
use pathwarp_engine::{coming_from, recipe_file, references};
use pathwarp_raster::{RenderOptions, Size};
use pathwarp_svg::engine::{Relinking, families};
use pathwarp_svg::{Document, Origin, ReadOptions, usvg_tree};
use pathwarp_text::TextStyle;
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A version of the drawing for one purpose.
#[derive(Debug, Clone, Copy)]
enum Version {
    /// The drawing, for results.
    File,
    /// The drawing with an id for every element, for the page.
    Page,
    /// The drawing of the page with large pictures reduced to few pixels, while something is dragged.
    Light,
    /// The drawing, or a bitmap of it if it is large, for thumbnails.
    Small,
}

struct EditedArtwork {
    svg: SvgArtwork,
    /// The drawing with an id for every element, which tells the page what is clicked; `None` if all elements have one.
    shown: Option<SvgArtwork>,
    /// The drawing with the captions requested last.
    captioned: Option<(Vec<Step>, Document)>,
    /// The drawing of the page with large pictures reduced to few pixels, once it has been needed; inside, `None` without such pictures.
    light: Option<Option<SvgArtwork>>,
    /// A bitmap that replaces a large drawing, once thumbnails have been requested.
    sketch: Option<SvgArtwork>,
    registry: Arc<Registry>,
    given: Given,
    options: CommonOptions,
    flags: Arc<Flags>,
    names: Arc<Names>,
    /// The options that name plug-ins.
    plugins: Vec<(String, String)>,
    /// The drawing's file; results go to its folder.
    file: PathBuf,
    /// The frame of the last picture.
    last_frame: Option<Framed>,
}

impl EditedArtwork {
    fn folder(&self) -> &Path {
        self.file.parent().unwrap_or(Path::new(""))
    }

    /// Makes the bitmap of a large drawing, unless it exists.
    fn draw_sketch(&mut self) -> Result<(), Failure> {
        /// Length of a drawing's text, with pictures embedded, from which thumbnails bend a bitmap of it: a page shows fifty thumbnails.
        const LARGE: usize = 256 << 10;
        /// The longer side of the bitmap, in pixels; thumbnails are half as large.
        const PIXELS: f32 = 256.0;
        let (document, reading) = (self.svg.document(), self.svg.reading());
        let with_pictures = Relinking { embed: true, ..Relinking::default() };
        if self.sketch.is_some()
            || with_pictures.of(document.text(), reading)?.as_deref().unwrap_or(document.text()).len() < LARGE
        {
            return Ok(());
        }
        let bitmap = page::Picture::bitmap(document.text(), PIXELS, reading);
        let (png, filled_box) = bitmap.map_err(Failure::Input)?;
        let image = document.user_to_px().inverse().transform_rect_bbox(filled_box);
        let xywh = |r: Rect| [r.x0, r.y0, r.width(), r.height()];
        let ([x, y, width, height], page) = (xywh(image), xywh(document.view_box()).map(|v| v.to_string()).join(" "));
        // Drafts draw one pixel for 4 px of the page in each direction, so this width keeps the resolution.
        let svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"{page}\" width=\"{}\"><image preserveAspectRatio=\"none\" x=\"{x}\" \
             y=\"{y}\" width=\"{width}\" height=\"{height}\" href=\"data:image/png;base64,{}\"/></svg>",
            4.0 * PIXELS,
            STANDARD.encode(png)
        );
        self.sketch = Some(SvgArtwork::read(svg.as_bytes(), &self.file, &self.options, None)?);
        Ok(())
    }

    /// Makes the version with reduced pictures, unless that has been tried.
    fn lighten(&mut self) -> Result<(), Failure> {
        if self.light.is_none() {
            let document = self.shown.as_ref().unwrap_or(&self.svg).document();
            let with_pictures = Relinking { embed: true, ..Relinking::default() };
            let embedded = with_pictures.of(document.text(), self.svg.reading())?;
            let light = page::lightened(embedded.as_deref().unwrap_or(document.text()), self.svg.reading());
            let read = |text: String| SvgArtwork::read(text.as_bytes(), &self.file, &self.options, None);
            self.light = Some(light.map(read).transpose()?);
        }
        Ok(())
    }

    /// Looks up files, and applies `work` to a version of the drawing and a session with these steps.
    fn with_steps<T>(
        &mut self,
        recipe: &Recipe,
        version: Version,
        work: impl FnOnce(&Session<'_>, &mut SvgArtwork, Ready) -> Result<T, Failure>,
    ) -> Result<T, Failure> {
        let mut resolved = recipe.clone();
        references::resolve_files(&*self.registry, &mut resolved, &self.options.reading)?;
        let Self { svg, shown, light, sketch, registry, given, options, last_frame, .. } = self;
        let (svg, frame_cache) = match version {
            Version::File => (svg, last_frame),
            Version::Page => (shown.as_mut().unwrap_or(svg), last_frame),
            Version::Light => (light.as_mut().and_then(Option::as_mut).or(shown.as_mut()).unwrap_or(svg), last_frame),
            Version::Small => match sketch {
                // The bitmap's frame differs.
                Some(sketch) => (sketch, &mut None),
                None => (svg, last_frame),
            },
        };
        svg.renew_budget();
        svg.restore(options); // The last result may have been divided into parts.
        let session = Session { registry, recipe: &resolved, options, given };
        let ready = session.ready(svg, Some(frame_cache))?;
        work(&session, svg, ready)
    }

    /// Bends the version of the drawing that suits a picture of this quality.
    fn bend_version(&mut self, recipe: &Recipe, fineness: Fineness) -> Result<Bent, Failure> {
        let version = match fineness {
            Fineness::Small(_) => {
                self.draw_sketch()?;
                Version::Small
            }
            Fineness::Draft(_) => {
                self.lighten()?;
                Version::Light
            }
            Fineness::Exact => Version::Page,
        };
        self.with_steps(recipe, version, |session, svg, ready| bend(session, svg, ready, recipe, fineness))
    }

    /// Returns the result as a file of this format; for a picture, as the SVG to draw it from.
    fn exported(&mut self, recipe: &Recipe, format: Format, to: Destination) -> Result<Exported, Failure> {
        let folder = self.folder().to_owned();
        self.with_steps(recipe, Version::File, |session, svg, ready| {
            let embeds = matches!(format, Format::Svg | Format::Svgz);
            let text = || {
                let (recipe, given) = for_command_line(recipe, session.given)?;
                recipe_file::write(session.registry, &recipe, &given, &folder)
            };
            let embedded_recipe = embeds.then(text).transpose()?;
            let request = WarpRequest { recipe, embedded_recipe, ..session.request(svg, &ready)? };
            if !PICTURES.contains(&format) {
                svg.set_output(format, to);
            }
            let result = svg.result(&request);
            svg.set_output(Format::Svg, Destination::Back); // For the next result.
            ready.checked(result)
        })
    }

    /// Returns the contents of the file `to`, and the losses of its format. Linked pictures are embedded unless it `stays` on this machine.
    fn written(
        &mut self,
        recipe: &Recipe,
        to: &Path,
        stays: bool,
        picture: &PictureOptions,
    ) -> Result<(Vec<u8>, Vec<String>), Failure> {
        let formats: Vec<Format> = DRAWINGS.iter().chain(PICTURES).copied().collect();
        let format = Choice { what: "a drawing is", among: &formats }.format(Some(to), None)?;
        let destination = if stays { Destination::of(Some(to)) } else { Destination::Anywhere };
        let Exported { bytes, mut warnings, kerf } = self.exported(recipe, format, destination)?;
        warnings.extend(kerf.map(|k| k.note()));
        if !PICTURES.contains(&format) {
            return Ok((bytes, warnings));
        }
        let limits = self.options.reading.limits.for_input(bytes.len());
        let tree = usvg_tree::parse_tree(&bytes, "the result", self.svg.reading())?;
        let size = picture.scale.map_or(Size::Width(picture.width), Size::Scale);
        let background = picture.background.as_deref().map(background).transpose().map_err(Failure::usage)?;
        let background = background.and_then(|b| b.0);
        let drawn = RenderOptions { size, background }.render_within(&tree, &limits)?;
        Ok((encode(drawn, format, None)?, warnings))
    }

    /// Turns a failure into a sentence in the page's terms.
    fn explained<T>(&self, result: Result<T, Failure>) -> Result<T, String> {
        result.map_err(|f| self.names.without_options(&f.message(&self.flags)))
    }
}

/// Turns the options that abbreviate edits into steps, as the page shows only these.
fn edits_to_steps(saved: &mut SavedRecipe) -> Result<(), Failure> {
    let mut edits = saved.options.read()?.edits;
    ["simplify", "outset"].iter().for_each(|name| drop(saved.options.take(name)));
    let exclude = saved.recipe.steps.first().map(|s| s.exclude.clone()).unwrap_or_default();
    edits.iter_mut().for_each(|s| s.exclude.clone_from(&exclude));
    // Words without steps are saved with a step that moves nothing; earlier versions did so for edits.
    let is_identity = |s: &Step| *s == Step { exclude: exclude.clone(), ..Step::new("affine", Args::new()) };
    let only_identity = matches!(&*saved.recipe.steps, [only] if is_identity(only));
    saved.recipe.steps.splice(0..usize::from(only_identity), edits);
    Ok(())
}

/// The selector of the whole drawing.
const WHOLE_DRAWING: &str = "svg";

/// Adapts a recipe to a command line: an only step's selection becomes an option; in a chain with selections, other steps select all.
fn for_command_line(recipe: &Recipe, given: &Given) -> Result<(Recipe, Given), Failure> {
    let (mut recipe, mut given) = (recipe.clone(), given.clone());
    if let [step] = &mut *recipe.steps {
        for (option, selectors) in OF_STEPS {
            std::mem::take(selectors(step)).iter().try_for_each(|s| given.set(option, s)).map_err(Failure::Usage)?;
        }
    } else if recipe.steps.iter().any(|s| !s.select.is_empty()) {
        recipe.steps.iter_mut().filter(|s| s.select.is_empty()).for_each(|s| s.select.push(WHOLE_DRAWING.into()));
    }
    Ok((recipe, given))
}

/// Bends the drawing by these steps; `given` has them with their references.
fn bend(
    session: &Session<'_>,
    svg: &SvgArtwork,
    ready: Ready,
    given: &Recipe,
    fineness: Fineness,
) -> Result<Bent, Failure> {
    let mut request = WarpRequest { recipe: given, same_view: true, ..session.request(svg, &ready)? };
    if let Fineness::Draft(draft) | Fineness::Small(draft) = fineness {
        (request.tolerance, request.suited) = (draft.max(request.tolerance), false); // Also for small contours.
        let (svg, page) = ready.checked(svg.draft(&request))?;
        let Ready { recipe: resolved, built, .. } = ready;
        return Ok(Bent { svg, page, resolved, built: built.whole, summary: None, warnings: Vec::new() });
    }
    let tolerance = request.tolerance;
    let warped = ready.checked(svg.warp(&request))?;
    let WarpedResult::Bytes(bytes) = warped.result else {
        return Err(Failure::Input("the result is not a drawing".into()));
    };
    let edited = svg.edited();
    let svg = String::from_utf8(bytes).map_err(|e| Failure::Input(e.to_string()))?;
    let Ready { recipe: resolved, built, .. } = ready;
    let shapes = &warped.shapes;
    let fold = |s: &ReportedShape| s.fold.at.map(|at| (s.shape.id.clone(), at));
    let [bent_in, bent_out] =
        [0, 1].map(|i| shapes.iter().map(|s| [s.shape.path.segments_in, s.shape.path.segments_out][i]).sum());
    // Edits change the drawing before it is bent.
    let [segments_in, edited_out] = edited.unwrap_or([bent_in, bent_out]);
    let summary = Summary {
        segments_in,
        segments_out: if shapes.is_empty() { edited_out } else { bent_out },
        max_error: shapes.iter().map(|s| s.shape.path.max_error).fold(0.0, f64::max),
        tolerance,
        folds: shapes.iter().filter_map(fold).collect(),
    };
    let of_steps = built.whole.steps.iter().flat_map(|s| &s.explanation.warnings);
    let mut warnings: Vec<String> = of_steps.cloned().chain(warped.warnings).collect();
    warnings.extend(warped.page.arrivals.iter().map(ToString::to_string));
    warnings.extend(warped.skipped.iter().map(ToString::to_string));
    let page = warped.page.change.map(|[_, after]| after);
    Ok(Bent { svg, page, resolved, built: built.whole, summary: Some(summary), warnings })
}

impl Artwork for EditedArtwork {
    fn document(&self) -> &Document {
        self.svg.document()
    }

    fn captioned(&mut self, recipe: &Recipe) -> Result<&Document, String> {
        let captions: Vec<Step> = recipe.steps.iter().filter(|s| is_caption(s)).cloned().collect();
        // Each check of selectors counts as work.
        self.svg.renew_budget();
        if captions.is_empty() {
            return Ok(self.svg.document());
        }
        if self.captioned.as_ref().is_none_or(|(known, _)| *known != captions) {
            let set = captioned(self.svg.document(), &captions, self.svg.reading(), &self.options);
            let (document, _) = self.explained(set)?;
            self.captioned = Some((captions, document));
        }
        Ok(match &mut self.captioned {
            Some((_, document)) => {
                document.renew_budget();
                document
            }
            None => self.svg.document(),
        })
    }

    fn reading(&self) -> &ReadOptions {
        self.svg.reading()
    }

    fn frame(&self) -> Rect {
        let known = self.last_frame.as_ref().map(|f| f.frame.rect);
        known.or_else(|| self.svg.bounding_box(Which::All)).unwrap_or_else(|| self.document().view_box())
    }

    fn outlines(&self) -> Vec<&Outline> {
        self.svg.outlines(Which::All)
    }

    fn bend(&mut self, recipe: &Recipe, fineness: Fineness) -> Result<Bent, String> {
        let bent = self.bend_version(recipe, fineness);
        let mut bent = self.explained(bent)?;
        bent.warnings.iter_mut().for_each(|w| *w = self.names.without_options(w));
        Ok(bent)
    }

    fn written(
        &mut self,
        recipe: &Recipe,
        to: &Path,
        stays: bool,
        picture: &PictureOptions,
    ) -> Result<(Vec<u8>, Vec<String>), String> {
        let written = Self::written(self, recipe, to, stays, picture);
        let (bytes, warnings) = self.explained(written)?;
        Ok((bytes, warnings.iter().map(|w| self.names.without_options(w)).collect()))
    }

    fn settle(&mut self, recipe: &Recipe) -> Result<(Recipe, BuiltRecipe), String> {
        let settled = self.with_steps(recipe, Version::File, |_, _, ready| Ok((ready.recipe, ready.built.whole)));
        self.explained(settled)
    }

    fn options(&self) -> Vec<(String, String)> {
        let stored = self.given.stored();
        let stored = stored.flat_map(|(name, values)| values.into_iter().map(move |v| (name.to_owned(), v)));
        stored.chain(self.plugins.iter().cloned()).collect()
    }

    fn recipe_text(&self, recipe: &Recipe) -> Result<String, String> {
        let (recipe, given) = self.explained(for_command_line(recipe, &self.given))?;
        self.explained(recipe_file::write(&*self.registry, &recipe, &given, self.folder()))
    }
}

/// A [`Host`] that opens drawings by the engine, with a registry and options.
pub struct EngineHost {
    registry: Arc<Registry>,
    /// Options that hold if neither the user nor the drawing gives them.
    usual: Given,
    /// The options that the user gives.
    given: Given,
    /// The options that name plug-ins.
    plugins: Vec<(String, String)>,
    flags: Arc<Flags>,
    names: Arc<Names>,
}

impl fmt::Debug for EngineHost {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("EngineHost").finish_non_exhaustive()
    }
}

impl EngineHost {
    /// Creates a host from defaults for options that neither the user nor the drawing gives, and the user's options.
    #[must_use]
    pub fn new(registry: Registry, usual: Given, given: Given) -> Self {
        let flags = Arc::new(Flags::of(&registry));
        let names = Names::of(registry.entries().iter().map(|e| e.info()).chain(&EDITS));
        Self { registry: Arc::new(registry), usual, given, plugins: Vec::new(), flags, names: Arc::new(names) }
    }

    /// Adds the options that name plug-ins in command lines.
    #[must_use]
    pub fn with_plugins(self, options: Vec<(String, String)>) -> Self {
        Self { plugins: options, ..self }
    }

    fn open_drawing(&self, file: &Path, bytes: &[u8]) -> Result<Opened, Failure> {
        let reading = self.given.read()?.reading;
        reading.check()?;
        let limits = reading.limits.for_input(bytes.len());
        let as_svg = framed(bytes, &limits).map_err(|e| Failure::file(file, e.message(&self.flags)))?;
        let bytes = as_svg.as_deref().unwrap_or(bytes); // A picture is opened as a drawing of it.
        let origin = Origin::of_file(bytes, "the drawing", &limits).unwrap_or(None);
        let folder = file.parent().unwrap_or(Path::new(""));
        let (source, saved) = match &origin {
            Some(origin) => {
                let saved = recipe_file::from_text(&*self.registry, &origin.recipe, folder, reading.external);
                (origin.source.as_slice(), Some(saved.map_err(|e| Failure::file(file, e))?))
            }
            None => (bytes, None),
        };
        let is_result = saved.is_some();
        let (recipe, given) = match saved {
            Some(mut saved) => {
                if let [step] = &mut *saved.recipe.steps {
                    OF_STEPS.iter().for_each(|(option, selectors)| selectors(step).extend(saved.options.take(option)));
                }
                saved.recipe.steps.iter_mut().filter(|s| s.select == [WHOLE_DRAWING]).for_each(|s| s.select.clear());
                edits_to_steps(&mut saved)?;
                (saved.recipe, self.usual.overridden_by(&saved.options).overridden_by(&self.given))
            }
            None => (Recipe::default(), self.usual.overridden_by(&self.given)),
        };
        let options = given.read()?;
        let svg = SvgArtwork::read(source, file, &options, None)?;
        let named = svg.document().with_ids();
        let shown = (named != svg.document().text()).then(|| SvgArtwork::read(named.as_bytes(), file, &options, None));
        let artwork = EditedArtwork {
            svg,
            shown: shown.transpose()?,
            captioned: None,
            light: None,
            sketch: None,
            registry: Arc::clone(&self.registry),
            given,
            options,
            flags: Arc::clone(&self.flags),
            names: Arc::clone(&self.names),
            plugins: self.plugins.clone(),
            file: file.to_owned(),
            last_frame: None,
        };
        Ok(Opened { artwork: Box::new(artwork), recipe, is_result })
    }

    /// Turns a failure into a sentence in the page's terms.
    fn explained<T>(&self, result: Result<T, Failure>) -> Result<T, String> {
        result.map_err(|f| self.names.without_options(&f.message(&self.flags)))
    }
}

impl Host for EngineHost {
    fn registry(&self) -> &Registry {
        &self.registry
    }

    fn first(&self) -> &[Info] {
        // The page does not offer the last edit, `outline`.
        &EDITS[..EDITS.len() - 1]
    }

    fn foreign_words(&self) -> Vec<(&str, &str)> {
        let named = coming_from::all().filter_map(|w| Some((w.subcommand()?, w.words)));
        named.flat_map(|(name, words)| words.into_iter().map(move |w| (w, name))).collect()
    }

    fn families(&self) -> Result<Vec<String>, String> {
        self.explained(self.given.read().map(|o| families(&o.reading.read_options())))
    }

    fn set_words(&self, words: &Words) -> Result<(String, Vec<char>), String> {
        let letter_spacing = 0.01 * words.spacing * words.size;
        let style = TextStyle { size: words.size, letter_spacing, ..TextStyle::default() };
        let set = |options: CommonOptions| set_plainly(&words.text, words.font.as_deref(), &style, &options.reading);
        self.explained(self.given.read().and_then(set))
    }

    fn open(&self, file: &Path, bytes: &[u8]) -> Result<Opened, String> {
        self.explained(self.open_drawing(file, bytes))
    }

    fn reference(&self, file: &Path) -> String {
        recipe_file::from_here(file)
    }

    fn write(&self, to: &Path, bytes: &[u8]) -> Result<(), String> {
        self.explained(PendingFile::new(to, bytes).and_then(|file| PendingFile::commit_all(vec![file])))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Files of earlier versions have options for edits, and a step that moves nothing beside edits alone.
    #[test]
    fn edits_saved_as_options_become_steps() {
        let opened = |step: &str| {
            let text = format!(
                "pathwarp = 1\n[options]\noutset = \"-1%\"\nsimplify = \"0.2mm\"\n[[step]]\n{step}\nexclude = [\"#a\"]"
            );
            let mut saved = recipe_file::from_text(&Registry::builtin(), &text, Path::new(""), false).unwrap();
            edits_to_steps(&mut saved).unwrap();
            assert!(saved.options.read().unwrap().edits.is_empty());
            assert!(saved.recipe.steps.iter().all(|s| s.exclude == ["#a"]));
            let all = saved.recipe.steps.into_iter().map(|s| (s.deformation, s.args));
            all.map(|(name, args)| format!("{name} {:?}", args.iter().collect::<Vec<_>>())).collect::<Vec<_>>()
        };
        let edits = [r#"simplify [("within", ["0.2mm"])]"#, r#"offset [("by", ["1%"]), ("side", ["inside"])]"#];
        assert_eq!(opened("deformation = \"affine\""), edits);
        let bent = opened("deformation = \"affine\"\nrotate = 9");
        assert!(bent.len() == 3 && bent[..2] == edits && bent[2].starts_with("affine"));
    }
}
