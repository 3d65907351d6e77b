//! The parameters' values as a program gets them: numbers in user units and degrees, whatever units were typed.

use pathwarp::Error;
use pathwarp::param::{Kind, NamedPath, Param, Settings};

/// Largest error of the cubics for arcs in paths that a program gets, user units.
const PATH_ACCURACY: f64 = 1e-6;

/// The frame, and the values that are given or have a default: a line `NAME VALUE` for each, several for repeated ones.
pub(crate) fn lines(params: &[Param], s: &Settings<'_>) -> Result<Vec<String>, Error> {
    let frame = s.frame().rect;
    let mut out = vec![format!("frame {} {} {} {}\n", frame.x0, frame.y0, frame.x1, frame.y1)];
    for p in params {
        out.extend(values(p, s)?.iter().map(|v| format!("{} {v}\n", p.name)));
    }
    Ok(out)
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
