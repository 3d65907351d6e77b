//! The parameters' values as a program gets them: numbers in user units and degrees, whatever units were typed.

use crate::entry::FIRST_VERSION;
use pathwarp::Error;
use pathwarp::param::{Args, Kind, NamedPath, Param, Settings};
use std::slice;

/// Largest error of the cubics for arcs in paths that a program gets, user units.
const PATH_ACCURACY: f64 = 1e-6;

/// The frame, and the values that are given or have a default, for a program that speaks this version of the protocol: a line
/// `NAME VALUE` for each, several for repeated ones.
pub(crate) fn lines(params: &[Param], s: &Settings<'_>, version: u32) -> Result<Vec<String>, Error> {
    let frame = s.frame().rect;
    let mut out = vec![format!("frame {} {} {} {}\n", frame.x0, frame.y0, frame.x1, frame.y1)];
    for p in params {
        let all = if p.repeat && version > FIRST_VERSION { each(p, s)? } else { values(p, s)? };
        out.extend(all.iter().map(|v| format!("{} {v}\n", p.name)));
    }
    Ok(out)
}

/// The values of a parameter that may be given several times.
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

/// Text on one line: `\` and line breaks are escaped.
fn escaped(text: &str) -> String {
    text.replace('\\', "\\\\").replace('\n', "\\n").replace('\r', "\\r")
}
