//! Reads the entry of a program, which is JSON with the schema of `pathwarp list --json`, as a description for the registry.

use crate::fault::Fault;
use crate::session::Protocol;
use pathwarp::Error;
use pathwarp::deform::{Case, Example, Info, Law, Pairs};
use pathwarp::engine::Abilities;
use pathwarp::param::{Args, Axis, Kind, NamedPath, Param, Settings};
use serde::Deserialize;
use serde_json::{Map, Value};
use std::slice;

/// The version of the protocol.
pub(crate) const VERSION: u32 = 2;
/// The oldest version that programs may speak. They get only the last value of a repeated number, length, angle, count, point or choice.
pub(crate) const FIRST_VERSION: u32 = 1;

/// Names that a program may not use.
#[derive(Debug, Clone, Copy, Default)]
pub struct Reserved<'a> {
    /// Names of commands and of other deformations.
    pub names: &'a [&'a str],
    /// Names of options that every command has.
    pub parameters: &'a [&'a str],
}

/// A checked entry.
pub(crate) struct Entry {
    pub(crate) info: &'static Info,
    pub(crate) version: u32,
    pub(crate) protocol: Protocol,
    pub(crate) abilities: Abilities,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    #[serde(rename = "pathwarp-plugin")]
    version: u32,
    name: String,
    title: String,
    #[serde(default)]
    group: Option<String>,
    about: String,
    #[serde(default)]
    source: Option<String>,
    #[serde(default)]
    protocol: Protocol,
    #[serde(default)]
    jacobian: bool,
    #[serde(default)]
    inverse: bool,
    #[serde(default)]
    domain: Domain,
    #[serde(default)]
    parameters: Vec<WrittenParam>,
    #[serde(default)]
    demo: Map<String, Value>,
    #[serde(default)]
    examples: Vec<WrittenExample>,
    #[serde(default)]
    laws: Vec<WrittenLaw>,
    #[serde(default)]
    cases: Vec<WrittenCase>,
}

/// The domain of the map.
#[derive(Deserialize, Default, PartialEq)]
#[serde(rename_all = "lowercase")]
enum Domain {
    /// Everywhere within the edges that the map declares.
    #[default]
    Plane,
    /// All points except those for which the map answers NaN.
    Partial,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct WrittenParam {
    name: String,
    help: String,
    kind: String,
    #[serde(default)]
    axis: Option<String>,
    #[serde(default)]
    default: Option<Value>,
    #[serde(default)]
    needed: bool,
    #[serde(default)]
    repeat: bool,
    #[serde(default)]
    range: Option<[Option<f64>; 2]>,
    #[serde(default)]
    slider: Option<[f64; 2]>,
    #[serde(default)]
    choices: Vec<String>,
    #[serde(default)]
    names: Vec<String>,
    #[serde(default)]
    count: Option<usize>,
    #[serde(default)]
    value: Option<String>,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum WrittenExample {
    Command(String),
    Captioned { what: String, command: String },
}

type Values = Map<String, Value>;

#[derive(Deserialize)]
#[serde(rename_all = "kebab-case")]
enum WrittenLaw {
    Identity(Values),
    Same(Values, Values),
    KeepsLines(Values),
    KeepsLinesAlong(Values, (f64, f64)),
    FixedOutside(Values, [f64; 4]),
    Area(Values, f64),
    KeepsAngles(Values),
    Undoes(Values, Values),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct WrittenCase {
    #[serde(default)]
    args: Values,
    at: (f64, f64),
    to: (f64, f64),
    tolerance: f64,
}

/// Reads an entry. Its texts are kept until the process ends, like those of built-in deformations.
pub(crate) fn read(bytes: &[u8], reserved: Reserved<'_>) -> Result<Entry, Fault> {
    let wrong = Fault::Entry;
    let json: Value = serde_json::from_slice(bytes).map_err(|e| wrong(format!("it is not JSON: {e}")))?;
    match json.get("pathwarp-plugin") {
        Some(v) if v.as_u64().is_some_and(|v| (FIRST_VERSION.into()..=VERSION.into()).contains(&v)) => {}
        Some(v) => return Err(Fault::Version { found: v.to_string(), known: VERSION }),
        None => return Err(wrong(format!("it lacks \"pathwarp-plugin\": {VERSION}"))),
    }
    if let Some(text) = with_controls(&json) {
        return Err(wrong(format!("`{}` holds control characters", text.escape_debug())));
    }
    // Read from the text again, so that errors name the line.
    let written: Written = serde_json::from_slice(bytes).map_err(|e| wrong(e.to_string()))?;
    if !is_kebab(&written.name) {
        return Err(wrong(format!("its name `{}` is not lower-case words joined by hyphens", written.name)));
    }
    if reserved.names.contains(&written.name.as_str()) {
        return Err(Fault::NameTaken(written.name));
    }
    let params: Vec<Param> = written.parameters.into_iter().map(param).collect::<Result<_, _>>().map_err(wrong)?;
    for (i, p) in params.iter().enumerate() {
        if params[..i].iter().any(|q| q.name == p.name) || !is_kebab(p.name) {
            return Err(wrong(format!("the parameter `{}` is not a new name of lower-case words", p.name)));
        }
        if reserved.parameters.contains(&p.name) {
            return Err(wrong(format!(
                "the parameter `{}` has the name of an option of every command; rename it",
                p.name
            )));
        }
    }
    let source = written.source.unwrap_or_else(|| "a plug-in".to_owned());
    let info = Info::new(kept(written.name), kept(written.title))
        .group(written.group.map_or("Plug-ins", kept))
        .about(kept(written.about))
        .source(kept(source))
        .params(params.leak())
        .demo(pairs(&written.demo))
        .examples(written.examples.into_iter().map(example).collect::<Vec<_>>().leak())
        .laws(written.laws.iter().map(law).collect::<Vec<_>>().leak())
        .cases(written.cases.iter().map(case).collect::<Vec<_>>().leak());
    let partial = written.domain == Domain::Partial;
    let abilities = Abilities { jacobian: written.jacobian, inverse: written.inverse, partial, ..Abilities::default() };
    let (version, protocol) = (written.version, written.protocol);
    Ok(Entry { info: Box::leak(Box::new(info)), version, protocol, abilities })
}

/// Finds the first text that could control a terminal.
fn with_controls(json: &Value) -> Option<&str> {
    match json {
        Value::String(text) => text.contains(|c: char| c.is_control() && c != '\n').then_some(text),
        Value::Array(all) => all.iter().find_map(with_controls),
        Value::Object(all) => all.values().find_map(with_controls),
        _ => None,
    }
}

/// Keeps a text until the process ends.
fn kept(text: String) -> &'static str {
    text.leak()
}

fn kept_all(words: Vec<String>) -> &'static [&'static str] {
    words.into_iter().map(kept).collect::<Vec<_>>().leak()
}

fn is_kebab(name: &str) -> bool {
    let is_word = |w: &str| !w.is_empty() && w.bytes().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit());
    name.len() <= 64 && name.split('-').all(is_word)
}

/// Writes a value as a user would type it.
fn typed(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Array(list) => list.iter().map(typed).collect::<Vec<_>>().join(","),
        other => other.to_string(),
    }
}

fn pairs(values: &Values) -> Pairs {
    let pair = |(name, value): (&String, &Value)| (kept(name.clone()), kept(typed(value)));
    values.iter().map(pair).collect::<Vec<_>>().leak()
}

fn param(w: WrittenParam) -> Result<Param, String> {
    let name = w.name.clone();
    let lacks = |what: &str| format!("the parameter `{name}` of kind `{}` lacks \"{what}\"", w.kind);
    let kind = match w.kind.as_str() {
        "flag" => Kind::Flag,
        "number" => Kind::Number,
        "numbers" => Kind::Numbers(w.count.filter(|n| (1..=64).contains(n)).ok_or_else(|| lacks("count"))?),
        "length" => Kind::Length(match w.axis.as_deref() {
            Some("x") => Axis::X,
            Some("y") => Axis::Y,
            None | Some("diagonal") => Axis::Diagonal,
            Some(other) => return Err(format!("the parameter `{name}` has the axis `{other}`, not x, y or diagonal")),
        }),
        "angle" => Kind::Angle,
        "count" => Kind::Count,
        "point" => Kind::Point,
        "path" => Kind::Path,
        "choice" if w.choices.is_empty() => return Err(lacks("choices")),
        "choice" => Kind::Choice(kept_all(w.choices)),
        "text" => Kind::Text(kept(w.value.unwrap_or_else(|| "TEXT".to_owned()))),
        "name-or-file" => Kind::NameOrFile(kept_all(w.names)),
        "file" => Kind::File,
        other => {
            return Err(format!(
                "the parameter `{name}` has the kind `{other}`; kinds are flag, number, numbers, length, angle, count, point, \
                 path, choice, text, name-or-file and file"
            ));
        }
    };
    let mut out = Param::new(kept(w.name), kind, kept(w.help));
    if kind == Kind::Angle {
        out = out.slider(-180.0, 180.0);
    }
    if let Some([min, max]) = w.range {
        let (min, max) = (min.unwrap_or(f64::NEG_INFINITY), max.unwrap_or(f64::INFINITY));
        if min.is_nan() || min > max {
            return Err(format!("the parameter `{}` has a range that ends before it begins", out.name));
        }
        let ui = if min.is_finite() && max.is_finite() { (min, max) } else { out.ui };
        out = Param { range: (min, max), ui, ..out };
    }
    if let Some([from, to]) = w.slider {
        out = out.slider(from, to);
    }
    if let Some(default) = w.default.filter(|d| !d.is_null()) {
        out = out.default(kept(typed(&default)));
    }
    Ok(Param { needed: w.needed, repeat: w.repeat, ..out })
}

fn example(e: WrittenExample) -> Example {
    match e {
        WrittenExample::Command(command) => Example { what: "Example", command: kept(command) },
        WrittenExample::Captioned { what, command } => Example { what: kept(what), command: kept(command) },
    }
}

fn law(law: &WrittenLaw) -> Law {
    match law {
        WrittenLaw::Identity(v) => Law::Identity(pairs(v)),
        WrittenLaw::Same(a, b) => Law::Same(pairs(a), pairs(b)),
        WrittenLaw::KeepsLines(v) => Law::KeepsLines(pairs(v)),
        WrittenLaw::KeepsLinesAlong(v, along) => Law::KeepsLinesAlong(pairs(v), *along),
        WrittenLaw::FixedOutside(v, area) => Law::FixedOutside(pairs(v), *area),
        WrittenLaw::Area(v, factor) => Law::Area(pairs(v), *factor),
        WrittenLaw::KeepsAngles(v) => Law::KeepsAngles(pairs(v)),
        WrittenLaw::Undoes(a, b) => Law::Undoes(pairs(a), pairs(b)),
    }
}

fn case(c: &WrittenCase) -> Case {
    Case { args: pairs(&c.args), at: c.at, to: c.to, tolerance: c.tolerance }
}

/// Largest error of the cubics that replace arcs in paths sent to a program, in user units.
const PATH_ACCURACY: f64 = 1e-6;

/// Writes the frame and the values that are given or have a default, for a program that speaks this version of the protocol: a line
/// `NAME VALUE` for each, and several for repeated ones.
pub(crate) fn lines(params: &[Param], s: &Settings<'_>, version: u32) -> Result<Vec<String>, Error> {
    let frame = s.frame().rect;
    let mut out = vec![format!("frame {} {} {} {}\n", frame.x0, frame.y0, frame.x1, frame.y1)];
    for p in params {
        let all = if p.repeat && version > FIRST_VERSION { each(p, s)? } else { values(p, s)? };
        out.extend(all.iter().map(|v| format!("{} {v}\n", p.name)));
    }
    Ok(out)
}

/// Writes all values of a parameter that may be repeated.
fn each(p: &Param, s: &Settings<'_>) -> Result<Vec<String>, Error> {
    let texts = s.texts(p.name);
    let is_single = matches!(p.kind, Kind::Flag | Kind::Path | Kind::File | Kind::NameOrFile(_));
    if is_single || texts.len() < 2 {
        return values(p, s);
    }
    let one = |text: &str| -> Result<Vec<String>, Error> {
        let args = Args::from_pairs(&[(p.name, text)]);
        values(p, &Settings::new(slice::from_ref(p), &args, s.frame())?)
    };
    texts.into_iter().map(one).collect::<Result<Vec<_>, _>>().map(|all| all.concat())
}

fn values(p: &Param, s: &Settings<'_>) -> Result<Vec<String>, Error> {
    if p.kind == Kind::Flag {
        return Ok(vec![s.flag(p.name)?.to_string()]);
    }
    if !s.given(p.name) && p.default.is_none() {
        return Ok(Vec::new());
    }
    let texts = || s.texts(p.name).into_iter().map(escaped).collect();
    Ok(match p.kind {
        Kind::Number | Kind::Length(_) | Kind::Angle | Kind::Count => vec![s.number(p.name)?.to_string()],
        Kind::Numbers(_) => vec![joined(&s.numbers_if(p.name)?.unwrap_or_default())],
        Kind::Point => {
            let at = s.point(p.name)?;
            vec![joined(&[at.x, at.y])]
        }
        Kind::Path => {
            let data = |path: NamedPath| path.outline.to_bez_path(PATH_ACCURACY).to_svg();
            s.paths(p.name)?.into_iter().map(data).collect()
        }
        Kind::Choice(_) => vec![s.choice(p.name)?.to_owned()],
        Kind::File | Kind::NameOrFile(_) => match s.file_if(p.name)? {
            Some(file) => vec![escaped(&file.text)],
            None => texts(),
        },
        _ => texts(),
    })
}

fn joined(numbers: &[f64]) -> String {
    numbers.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ")
}

/// Puts text on one line by escaping `\` and line breaks.
fn escaped(text: &str) -> String {
    text.replace('\\', "\\\\").replace('\n', "\\n").replace('\r', "\\r")
}
