//! pathwarp inside other programs and languages: everything is given as text, as on the command line, drawings stay in memory, and the
//! code is that of the command line, so the numbers are equal.

mod error;
mod function;
mod warper;

pub use error::{Details, Error, ErrorKind};
pub use warper::{Drawing, Path, Warper};

use crate::advice;
use crate::catalogue::Catalogue;
use crate::lettering::set_plainly;
use crate::options::{CommonOption, OPTIONS, Reading};
use crate::steps::INVERSE;
use error::guarded;
use pathwarp::deform::{Info, Registry};
use pathwarp::kurbo::{Point, Vec2};
use pathwarp::map::{Chain, Creases, Jet, Map};
use pathwarp::param::Kind;
use pathwarp::recipe::BuiltRecipe;
use pathwarp_text::TextStyle;

/// A parameter with the value that a preset's name gives it.
type Setting = (&'static str, &'static str);

/// Returns the deformation that a name means, with the parameter and value if the name is a preset's: `arc` is `warp` with the style `arc`.
/// Deformations come first, then the presets in the order of the registry.
pub(super) fn meaning<'a>(registry: &'a Registry, name: &str) -> Result<(&'a Info, Option<Setting>), String> {
    let lower = name.to_ascii_lowercase();
    if let Some(e) = registry.get(&lower) {
        return Ok((e.info(), None));
    }
    if let Some((info, param, preset)) = preset(registry, &lower) {
        return Ok((info, Some((param, preset))));
    }
    let presets = registry.entries().iter().flat_map(|e| presets(e.info()).1);
    let known = registry.entries().iter().map(|e| e.info().name).chain(presets);
    Err(advice::unknown("deformation", &lower, known))
}

/// Returns the deformation that has a preset called `name`, the parameter that takes it, and the preset's name.
#[must_use]
pub fn preset<'a>(catalogue: &'a dyn Catalogue, name: &str) -> Option<(&'a Info, &'static str, &'static str)> {
    catalogue.infos().into_iter().find_map(|info| {
        let (param, names) = presets(info);
        names.into_iter().find(|n| *n == name).map(|n| (info, param, n))
    })
}

/// Returns the parameter of a deformation that takes presets, and their names.
fn presets(info: &Info) -> (&'static str, Vec<&'static str>) {
    let param = info.gallery.and_then(|g| info.params.iter().find(|p| p.name == g.presets));
    match param.map(|p| (p.name, p.kind)) {
        Some((name, Kind::NameOrFile(names) | Kind::Choice(names))) => (name, names.to_vec()),
        _ => ("", Vec::new()),
    }
}

/// Common options that name outputs or change what the program prints.
const OF_THE_PROGRAM: [&str; 12] = [
    "out",
    "out-dir",
    "in-place",
    "recursive",
    "dry-run",
    "into",
    "report",
    "write-recipe",
    "preview",
    "show-polygons",
    "jobs",
    "quiet",
];

/// Returns the common options that work in memory, with their help.
pub fn option_names() -> impl Iterator<Item = (&'static str, String)> {
    OPTIONS.iter().filter(|o| !OF_THE_PROGRAM.contains(&o.name)).map(|o| (o.name, o.help()))
}

/// Returns the names that a plug-in's parameter cannot have, as they are options or arguments of the program, of Python or of C.
pub fn reserved_names() -> impl Iterator<Item = &'static str> {
    const ARGUMENTS: [&str; 9] =
        [INVERSE, "plugin", "plugins", "help", "version", "points", "jacobian", "INPUT", "size"];
    OPTIONS.iter().map(|o| o.name).chain(ARGUMENTS)
}

/// Returns the words that an option may have as its value; none if it is no choice.
#[must_use]
pub fn option_words(name: &str) -> Vec<&'static str> {
    OPTIONS.iter().find(|o| o.name == name).map(CommonOption::words).unwrap_or_default()
}

/// Checks that an option works in memory.
pub(super) fn check_option(name: &str) -> Result<(), String> {
    if OF_THE_PROGRAM.contains(&name) {
        return Err(format!("{name} is an option of the program: in memory, results are returned"));
    }
    match CommonOption::named(name) {
        Some(_) => Ok(()),
        None => Err(advice::unknown("option", name, option_names().map(|(name, _)| name))),
    }
}

/// Removes the dashes of options and parameters in a message.
pub(super) fn without_dashes(message: &str, registry: &Registry) -> String {
    let params = || registry.entries().iter().flat_map(|e| e.info().params);
    let is_known =
        |name: &str| name == INVERSE || OPTIONS.iter().any(|o| o.name == name) || params().any(|p| p.name == name);
    let mut out = String::with_capacity(message.len());
    let mut rest = message;
    while let Some((before, after)) = rest.split_once("--") {
        let (name, behind) = after.split_at(after.find(|c: char| !matches!(c, 'a'..='z' | '-')).unwrap_or(after.len()));
        let starts = before.chars().next_back().map_or(out.is_empty(), |c| c.is_whitespace() || "(`“".contains(c));
        let dashes = if starts && is_known(name) { "" } else { "--" };
        out.extend([before, dashes, name]);
        rest = behind;
    }
    out + rest
}

/// Sets words as a drawing in mm of outlined letters, in `font` (a family or a file) or the bundled Noto Sans, with an em of `size` mm.
///
/// # Errors
/// [`ErrorKind::Usage`] if there is no such font or the size is out of range, [`ErrorKind::Input`] if the words exceed the limits.
pub fn lettering_drawing(words: &str, font: Option<&str>, size: f64) -> Result<String, Error> {
    let style = TextStyle { size, ..TextStyle::default() };
    guarded(&Registry::builtin(), || set_plainly(words, font, &style, &Reading::default()).map(|(drawing, _)| drawing))
}

/// A recipe built for points: the map, without a limit on its searches, and its creases, some of which bound its domain.
#[derive(Debug, Clone)]
pub struct PointMap {
    built: BuiltRecipe,
    map: Chain,
    creases: Creases,
    registry: Registry,
}

impl PointMap {
    pub(super) fn new(built: BuiltRecipe, registry: &Registry) -> Self {
        let (map, mut creases) = (built.unlimited(), Creases::default());
        map.creases(&mut creases);
        Self { built, map, creases, registry: registry.clone() }
    }

    /// Returns `true` if calls are expensive and points cheap, so that many should be mapped at once.
    #[must_use]
    pub fn prefers_batches(&self) -> bool {
        self.map.cost().batches.is_some()
    }

    /// Checks the points mapped so far.
    ///
    /// # Errors
    /// [`ErrorKind::Input`] if a plug-in or function has failed, so that points became NaN.
    pub fn check(&self) -> Result<(), Error> {
        guarded(&self.registry, || self.built.failure().map_or(Ok(()), |e| Err(e.into())))
    }

    /// Maps `from` to `to`, which has the same length. Points outside of the map's domain become NaN.
    pub fn points(&self, from: &[Point], to: &mut [Point]) {
        self.map.points(from, to);
        if self.creases.items().is_empty() {
            return;
        }
        for (p, image) in from.iter().zip(to) {
            if !self.creases.defined_at(*p) {
                *image = Jet::UNDEFINED.p;
            }
        }
    }

    /// Computes the two columns of the Jacobian at each point: the derivatives by x and by y.
    pub fn jacobians(&self, points: &[Point], out: &mut [[Vec2; 2]]) {
        let mut jets = vec![Jet::default(); points.len()];
        self.map.jets(points, &mut jets);
        for ((p, jet), columns) in points.iter().zip(&jets).zip(out) {
            let jet = if self.creases.defined_at(*p) { jet } else { &Jet::UNDEFINED };
            *columns = [jet.dx, jet.dy];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flags_lose_their_dashes_and_other_text_does_not() {
        let registry = Registry::builtin();
        let plain = |m: &str| without_dashes(m, &registry);
        assert_eq!(plain("--bottom: too small (--on-error skip)"), "bottom: too small (on-error skip)");
        assert_eq!(plain("a--bottom.svg --wobble -- "), "a--bottom.svg --wobble -- ");
    }

    #[test]
    fn presets_stand_for_their_deformation() {
        let registry = Registry::builtin();
        let (info, preset) = meaning(&registry, "Arc").unwrap();
        assert_eq!((info.name, preset), ("warp", Some(("style", "arc"))));
        assert_eq!(meaning(&registry, "wave").unwrap().0.name, "wave");
        assert!(meaning(&registry, "shapre").unwrap_err().contains("did you mean `shaper`"));
    }

    #[test]
    fn options_of_the_program_exist_and_are_refused() {
        assert!(OF_THE_PROGRAM.iter().all(|n| OPTIONS.iter().any(|o| o.name == *n)));
        assert!(check_option("out").is_err() && check_option("wobble").is_err() && check_option("tolerance").is_ok());
    }
}
