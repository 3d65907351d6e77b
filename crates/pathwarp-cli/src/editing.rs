//! Drawings in the editor: what `pathwarp-editor` needs from the command line.

use crate::advice::Flags;
use crate::bitmap::{background, encode};
use crate::commands::text::set_plainly;
use crate::failure::Failure;
use crate::format::{Choice, DRAWINGS, Format, PICTURES};
use crate::input::{Artwork as _, FileArtwork as _, SvgArtwork, WarpRequest, WarpedResult, Which, read_options};
use crate::options::{CommonOptions, Given};
use crate::output::PendingFile;
use crate::pipeline::{Framed, Ready, Session};
use crate::report::ReportedShape;
use crate::{coming_from, export, recipe_file, references};
use pathwarp::Outline;
use pathwarp::deform::Registry;
use pathwarp::kurbo::Rect;
use pathwarp::recipe::{BuiltRecipe, Recipe};
use pathwarp_editor::{Artwork, Bent, Fineness, Host, Opened, PictureOptions, Summary, Words};
use pathwarp_raster::{RenderOptions, Size};
use pathwarp_svg::{Document, Origin, ReadOptions, families, usvg_tree};
use pathwarp_text::TextStyle;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A drawing in the editor.
struct EditedArtwork {
    svg: SvgArtwork,
    /// The drawing with an id for every element, so that the page can tell what is clicked; `None` where all have one.
    shown: Option<SvgArtwork>,
    registry: Arc<Registry>,
    given: Given,
    options: CommonOptions,
    flags: Arc<Flags>,
    /// The options that name plug-ins.
    plugins: Vec<(String, String)>,
    /// The folder of the drawing, where its results go.
    folder: PathBuf,
    /// The frame for the guides and the baseline of the last picture.
    framed: Option<Framed>,
}

impl EditedArtwork {
    fn new(
        svg: SvgArtwork,
        shown: Option<SvgArtwork>,
        registry: &Arc<Registry>,
        given: Given,
        options: CommonOptions,
        flags: &Arc<Flags>,
    ) -> Self {
        Self {
            svg,
            shown,
            registry: Arc::clone(registry),
            given,
            options,
            flags: Arc::clone(flags),
            plugins: Vec::new(),
            folder: PathBuf::new(),
            framed: None,
        }
    }

    fn with_plugins(self, options: &[(String, String)]) -> Self {
        Self { plugins: options.to_vec(), ..self }
    }

    fn in_folder(self, folder: &Path) -> Self {
        Self { folder: folder.to_owned(), ..self }
    }

    /// Looks up files, and applies `work` to the drawing, as a file or for the page, and the session with these steps.
    fn with_steps<T>(
        &mut self,
        recipe: &Recipe,
        is_file: bool,
        work: impl FnOnce(&Session<'_>, &mut SvgArtwork, Ready) -> Result<T, Failure>,
    ) -> Result<T, Failure> {
        let mut resolved = recipe.clone();
        references::resolve_files(&*self.registry, &mut resolved, &self.options.reading)?;
        let Self { svg, shown, registry, given, options, framed, .. } = self;
        let svg = shown.as_mut().filter(|_| !is_file).unwrap_or(svg);
        svg.renew_budget();
        svg.restore(options);
        let session = Session { registry, recipe: &resolved, options, given };
        let ready = session.ready(svg, Some(framed))?;
        work(&session, svg, ready)
    }

    fn bent(&mut self, recipe: &Recipe, fineness: Fineness) -> Result<Bent, Failure> {
        let folder = self.folder.clone();
        let is_file = matches!(fineness, Fineness::Finished { .. });
        self.with_steps(recipe, is_file, |session, svg, ready| bent(session, svg, ready, recipe, fineness, &folder))
    }

    fn said<T>(&self, result: Result<T, Failure>) -> Result<T, String> {
        result.map_err(|f| f.message(&self.flags))
    }
}

/// Bends the drawing by these steps; `given` are the same as the user wrote them.
fn bent(
    session: &Session<'_>,
    svg: &SvgArtwork,
    ready: Ready,
    given: &Recipe,
    fineness: Fineness,
    folder: &Path,
) -> Result<Bent, Failure> {
    let exact = session.tolerance(svg, &ready.frame)?;
    let is_draft = matches!(fineness, Fineness::Draft(_));
    let text = || recipe_file::write(session.registry, given, session.given, folder);
    let request = WarpRequest {
        recipe: given,
        built: &ready.built,
        options: session.options,
        tolerance: if let Fineness::Draft(draft) = fineness { draft.max(exact) } else { exact },
        suited: session.options.tolerance.is_none() && !is_draft,
        embedded_recipe: (fineness == Fineness::Finished { embedded: true }).then(text).transpose()?,
        same_view: !matches!(fineness, Fineness::Finished { .. }),
        edit: None,
    };
    if is_draft {
        let (svg, page) = ready.checked(svg.draft(&request))?;
        let Ready { recipe: resolved, built, .. } = ready;
        return Ok(Bent { svg, page, resolved, built: built.whole, summary: None, warnings: Vec::new() });
    }
    let tolerance = request.tolerance;
    let warped = ready.checked(svg.warp(&request))?;
    let WarpedResult::Bytes(bytes) = warped.result else {
        return Err(Failure::Input("the result is not a drawing".into()));
    };
    let svg = String::from_utf8(bytes).map_err(|e| Failure::Input(e.to_string()))?;
    let Ready { recipe: resolved, built, .. } = ready;
    let shapes = &warped.shapes;
    let fold = |s: &ReportedShape| s.fold.at.map(|at| (s.shape.id.clone(), at));
    let summary = Summary {
        segments_in: shapes.iter().map(|s| s.shape.path.segments_in).sum(),
        segments_out: shapes.iter().map(|s| s.shape.path.segments_out).sum(),
        max_error: shapes.iter().map(|s| s.shape.path.max_error).fold(0.0, f64::max),
        tolerance,
        folds: shapes.iter().filter_map(fold).collect(),
    };
    let own = built.whole.steps.iter().flat_map(|s| &s.explanation.warnings);
    let mut warnings: Vec<String> = own.cloned().chain(warped.warnings).collect();
    warnings.extend(warped.page.arrivals.iter().map(ToString::to_string));
    warnings.extend(warped.skipped.iter().map(|s| format!("{} is not bent: {}", s.id, s.why)));
    let page = warped.page.change.map(|[_, after]| after);
    Ok(Bent { svg, page, resolved, built: built.whole, summary: Some(summary), warnings })
}

impl Artwork for EditedArtwork {
    fn document(&self) -> &Document {
        self.svg.document()
    }

    fn frame(&self) -> Rect {
        let known = self.framed.as_ref().map(|f| f.frame.rect);
        known.or_else(|| self.svg.bounding_box(Which::All)).unwrap_or_else(|| self.document().view_box())
    }

    fn outlines(&self) -> Vec<&Outline> {
        self.svg.outlines(Which::All)
    }

    fn bend(&mut self, recipe: &Recipe, fineness: Fineness) -> Result<Bent, String> {
        let bent = self.bent(recipe, fineness);
        self.said(bent)
    }

    fn settle(&mut self, recipe: &Recipe) -> Result<(Recipe, BuiltRecipe), String> {
        let settled = self.with_steps(recipe, true, |_, _, ready| Ok((ready.recipe, ready.built.whole)));
        self.said(settled)
    }

    fn options(&self) -> Vec<(String, String)> {
        let all = self.given.stored();
        let stored = all.flat_map(|(name, values)| values.into_iter().map(move |v| (name.to_owned(), v)));
        stored.chain(self.plugins.iter().cloned()).collect()
    }

    fn recipe_text(&self, recipe: &Recipe) -> Result<String, String> {
        self.said(recipe_file::write(&*self.registry, recipe, &self.given, &self.folder))
    }
}

/// The command line around the editor.
pub(crate) struct EditorHost {
    registry: Arc<Registry>,
    /// Options where neither the user nor the drawing gives any.
    usual: Given,
    /// The options as given.
    given: Given,
    /// The options that name plug-ins.
    plugins: Vec<(String, String)>,
    flags: Arc<Flags>,
}

impl EditorHost {
    pub(crate) fn new(registry: Registry, usual: Given, given: Given) -> Self {
        let flags = Arc::new(Flags::of(&registry));
        Self { registry: Arc::new(registry), usual, given, plugins: Vec::new(), flags }
    }

    /// Names plug-ins in command lines by these options.
    pub(crate) fn with_plugins(self, options: Vec<(String, String)>) -> Self {
        Self { plugins: options, ..self }
    }

    fn open_drawing(&self, file: &Path, bytes: &[u8]) -> Result<Opened, Failure> {
        let reading = self.given.read()?.reading;
        reading.check()?;
        let limits = reading.limits.for_input(bytes.len());
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
            Some(saved) => (saved.recipe, self.usual.overridden_by(&saved.options).overridden_by(&self.given)),
            None => (Recipe::default(), self.usual.overridden_by(&self.given)),
        };
        let options = given.read()?;
        let svg = SvgArtwork::read(source, file, &options, None)?;
        let named = svg.document().with_ids();
        let shown = (named != svg.document().text()).then(|| SvgArtwork::read(named.as_bytes(), file, &options, None));
        let artwork = EditedArtwork::new(svg, shown.transpose()?, &self.registry, given, options, &self.flags);
        let artwork = artwork.with_plugins(&self.plugins).in_folder(folder);
        Ok(Opened { artwork: Box::new(artwork), recipe, is_result })
    }

    fn converted(&self, svg: String, to: &Path, picture: &PictureOptions) -> Result<(Vec<u8>, Vec<String>), Failure> {
        let options = self.given.read()?;
        let among: Vec<Format> = DRAWINGS.iter().chain(PICTURES).copied().collect();
        let format = Choice { what: "a drawing is", among: &among }.format(Some(to), None)?;
        let read = read_options(to, &options.reading);
        if format.of_picture(None).is_none() {
            let exported = export::drawing(svg, format, &read, &options, None)?;
            return Ok((exported.bytes, exported.warnings));
        }
        let tree = usvg_tree::parse_tree(svg.as_bytes(), "the result", &ReadOptions::default())?;
        let limits = options.reading.limits.for_input(svg.len());
        let size = picture.scale.map_or(Size::Width(picture.width), Size::Scale);
        let background = picture.background.as_deref().map(background).transpose().map_err(Failure::usage)?;
        let background = background.and_then(|b| b.0);
        let drawn = RenderOptions { size, background }.render_within(&tree, &limits)?;
        Ok((encode(drawn, format, None)?, Vec::new()))
    }

    fn said<T>(&self, result: Result<T, Failure>) -> Result<T, String> {
        result.map_err(|f| f.message(&self.flags))
    }
}

impl Host for EditorHost {
    fn registry(&self) -> &Registry {
        &self.registry
    }

    fn foreign_words(&self) -> Vec<(&str, &str)> {
        let named = coming_from::all().filter_map(|w| Some((w.subcommand()?, w.words)));
        named.flat_map(|(name, words)| words.into_iter().map(move |w| (w, name))).collect()
    }

    fn families(&self) -> Vec<String> {
        self.given.read().map(|o| families(&o.reading.read_options())).unwrap_or_default()
    }

    fn set_words(&self, words: &Words) -> Result<String, String> {
        let letter_spacing = 0.01 * words.spacing * words.size;
        let style = TextStyle { size: words.size, letter_spacing, ..TextStyle::default() };
        let set = |options: CommonOptions| set_plainly(&words.text, words.font.as_deref(), &style, &options.reading);
        self.said(self.given.read().and_then(set))
    }

    fn open(&self, file: &Path, bytes: &[u8]) -> Result<Opened, String> {
        self.said(self.open_drawing(file, bytes))
    }

    fn reference(&self, file: &Path) -> String {
        recipe_file::from_here(file)
    }

    fn export(&self, svg: String, to: &Path, picture: &PictureOptions) -> Result<(Vec<u8>, Vec<String>), String> {
        self.said(self.converted(svg, to, picture))
    }

    fn write(&self, to: &Path, bytes: &[u8]) -> Result<(), String> {
        self.said(PendingFile::new(to, bytes).and_then(|file| PendingFile::commit_all(vec![file])))
    }
}
