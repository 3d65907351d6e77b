//! Any path under any deformation: no panic, a finite and deterministic result, and the tolerance kept where nothing else is
//! reported.

#![no_main]

use pathwarp::refit::Nodes;
use arbitrary::{Arbitrary, Result, Unstructured};
use libfuzzer_sys::fuzz_target;
use pathwarp::Outline;
use pathwarp::deform::Registry;
use pathwarp::kurbo::Rect;
use pathwarp::param::{Args, Frame, Kind, Param};
use pathwarp::recipe::{Recipe, Step};
use pathwarp::refit::Options;
use pathwarp_fuzz::{bounded, check_built};
use std::fmt::Write as _;
use std::sync::LazyLock;

static REGISTRY: LazyLock<Registry> = LazyLock::new(Registry::builtin);

/// Most segments of a path.
const SEGMENTS: usize = 12;
/// Numbers at which formulas change their behaviour.
const SPECIAL: [f64; 12] = [0.0, 1.0, -1.0, 0.5, 100.0, 50.0, 1e-9, -1e-300, 1e6, 1e15, 1e99, 1e308];

/// Pieces of formulas, for parameters of text.
const WORDS: [&str; 24] = [
    "x", "y", "+", "-", "*", "/", "sin(", "abs(", "sqrt(", "pow(", ",", ")", "min(", "if(", "<", "3", "0.1", "1e3",
    ":", " ", "w", "^", "frac(", "atan2(",
];

/// What is fuzzed.
#[derive(Debug)]
struct Case {
    path: String,
    recipe: Recipe,
    frame: Rect,
    options: Options,
}

impl<'a> Arbitrary<'a> for Case {
    fn arbitrary(u: &mut Unstructured<'a>) -> Result<Self> {
        let tolerance = *u.choose(&[1.0, 0.1, 0.01, 1e-4])?;
        let options = Options::new(tolerance).with_certify(u.arbitrary()?).with_nodes(if u.arbitrary()? { Nodes::Fewest } else { Nodes::Source });
        let frame = if u.ratio(3, 4)? {
            Rect::new(0.0, 0.0, 100.0, 100.0)
        } else {
            Rect::new(number(u)?, number(u)?, number(u)?, number(u)?)
        };
        let mut steps = vec![step(u)?];
        if u.ratio(1, 4)? {
            steps.push(step(u)?);
        }
        Ok(Self { path: path(u)?, recipe: Recipe { steps }, frame, options })
    }
}

/// Numbers on a page mostly, some of them special.
fn number(u: &mut Unstructured<'_>) -> Result<f64> {
    Ok(match u.int_in_range(0..=15u8)? {
        0 => *u.choose(&SPECIAL)?,
        1 => f64::from(f32::from_bits(u.arbitrary()?)),
        2..=7 => f64::from(u.int_in_range(0..=20u8)?) * 5.0,
        _ => f64::from(u.arbitrary::<i16>()?) / 256.0,
    })
}

/// Path data of a few commands.
fn path(u: &mut Unstructured<'_>) -> Result<String> {
    let mut out = format!("M{} {}", number(u)?, number(u)?);
    for _ in 0..u.int_in_range(1..=SEGMENTS)? {
        let (letter, numbers) =
            *u.choose(&[('L', 2), ('C', 6), ('Q', 4), ('c', 6), ('l', 2), ('A', 5), ('Z', 0), ('M', 2), ('S', 4)])?;
        if letter == 'A' {
            let (large, sweep): (bool, bool) = u.arbitrary()?;
            let _ = write!(out, "A{} {} {} ", number(u)?, number(u)?, number(u)?);
            let _ = write!(out, "{} {} {} {}", u8::from(large), u8::from(sweep), number(u)?, number(u)?);
            continue;
        }
        out.push(letter);
        for _ in 0..numbers {
            let _ = write!(out, "{} ", number(u)?);
        }
    }
    Ok(out)
}

/// A deformation with its demonstration's parameters, some of them changed.
fn step(u: &mut Unstructured<'_>) -> Result<Step> {
    let info = u.choose(REGISTRY.entries())?.info();
    let mut args = Args::from_pairs(info.demo);
    let changes = if info.params.is_empty() { 0 } else { u.int_in_range(0..=4)? };
    for _ in 0..changes {
        let p = u.choose(info.params)?;
        let value = value(u, p)?;
        if p.repeat { args.push(p.name, value) } else { args.set(p.name, vec![value]) }
    }
    let mut step = Step::new(info.name, args);
    step.inverse = u.ratio(1, 5)?;
    Ok(step)
}

/// A value as a user would type it, within the legal range half of the time.
fn value(u: &mut Unstructured<'_>, p: &Param) -> Result<String> {
    let plain = |u: &mut Unstructured<'_>| {
        let v = number(u)?;
        let (least, most) = if u.arbitrary()? { p.ui } else { p.range };
        Ok(if least.is_finite() && most.is_finite() { least + (most - least) * (v / 100.0).clamp(0.0, 1.0) } else { v })
    };
    Ok(match p.kind {
        Kind::Flag => "true".into(),
        Kind::Number => plain(u)?.to_string(),
        Kind::Count => plain(u)?.round().to_string(),
        Kind::Length(_) | Kind::Angle => format!("{}{}", plain(u)?, u.choose(&["", "%", "mm", "rad"])?),
        Kind::Numbers(n) => {
            let all: Result<Vec<String>> = (0..n).map(|_| Ok(number(u)?.to_string())).collect();
            all?.join(",")
        }
        Kind::Point => format!("{},{}", number(u)?, number(u)?),
        Kind::Path => match u.int_in_range(0..=2u8)? {
            0 => path(u)?,
            1 => format!("circle:r={}", number(u)?),
            _ => {
                let n = *u.choose(&[2, 3, 4, 4, 4, 6])?;
                let all: Result<Vec<String>> = (0..n).map(|_| Ok(format!("{},{}", number(u)?, number(u)?))).collect();
                all?.join(" ")
            }
        },
        Kind::Choice(words) | Kind::NameOrFile(words) => (*u.choose(words)?).into(),
        Kind::Text(notation) if notation.contains(':') => {
            let mut out = String::new();
            for c in notation.split(':') {
                let all: Result<Vec<String>> = c.split(',').map(|_| Ok(number(u)?.to_string())).collect();
                out += &all?.join(",");
                out.push(':');
            }
            out.pop();
            out
        }
        Kind::Text(_) => {
            let n = u.int_in_range(1..=12)?;
            (0..n).map(|_| u.choose(&WORDS).copied()).collect::<Result<_>>()?
        }
        Kind::File | Kind::Save => "none".into(),
        _ => String::new(),
    })
}

fn run(case: &Case) {
    let path = Outline::from_svg_lossy(&case.path);
    if let Ok(built) = case.recipe.build(&REGISTRY, Frame::new(case.frame), &std::iter::once(&path)) {
        check_built(&path, &built, &case.options);
    }
}

fuzz_target!(|case: Case| bounded(|| run(&case)));
