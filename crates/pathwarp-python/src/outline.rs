//! Paths as verbs and coordinates, for pens: `M`, `L`, `Q`, `C` and `Z`, with one, one, two, three and no points.

use pathwarp::kurbo::{BezPath, PathEl, Point};

/// Returns the path of verbs and coordinates, or the problem with them.
pub(crate) fn path(verbs: &str, coordinates: &[f64]) -> Result<BezPath, String> {
    let mut numbers = coordinates.chunks_exact(2).map(|p| Point::new(p[0], p[1]));
    let mut next = || numbers.next().ok_or_else(|| "there are fewer coordinates than the verbs take".to_owned());
    let mut path = BezPath::new();
    for verb in verbs.chars() {
        if path.elements().is_empty() && verb != 'M' {
            return Err(format!("the path begins with `{verb}`; begin it with `M`"));
        }
        path.push(match verb {
            'M' => PathEl::MoveTo(next()?),
            'L' => PathEl::LineTo(next()?),
            'Q' => PathEl::QuadTo(next()?, next()?),
            'C' => PathEl::CurveTo(next()?, next()?, next()?),
            'Z' => PathEl::ClosePath,
            _ => return Err(format!("`{verb}` is not one of the verbs M, L, Q, C and Z")),
        });
    }
    if numbers.next().is_some() || !coordinates.len().is_multiple_of(2) {
        return Err("there are more coordinates than the verbs take".into());
    }
    Ok(path)
}

/// Returns the verbs and coordinates of a path.
pub(crate) fn verbs(path: &BezPath) -> (String, Vec<f64>) {
    let (mut verbs, mut coordinates) = (String::new(), Vec::new());
    let mut add = |verb, points: &[Point]| {
        verbs.push(verb);
        coordinates.extend(points.iter().flat_map(|p| [p.x, p.y]));
    };
    for el in path.elements() {
        match *el {
            PathEl::MoveTo(p) => add('M', &[p]),
            PathEl::LineTo(p) => add('L', &[p]),
            PathEl::QuadTo(a, p) => add('Q', &[a, p]),
            PathEl::CurveTo(a, b, p) => add('C', &[a, b, p]),
            PathEl::ClosePath => add('Z', &[]),
        }
    }
    (verbs, coordinates)
}
