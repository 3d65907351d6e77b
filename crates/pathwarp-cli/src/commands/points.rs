//! Lists of plain points, one per line, for `map` and `solid map`.

/// Characters of a wrong line that a message shows.
const SHOWN: usize = 60;

/// Parses points of N coordinates, separated by spaces, commas or tabs. Empty lines and those that begin with `#` are skipped. The
/// error starts with the line's number and says that the line is not `wanted`.
pub(super) fn parse<const N: usize>(text: &str, wanted: &str) -> Result<Vec<[f64; N]>, String> {
    let mut out = Vec::new();
    for (i, line) in text.lines().enumerate() {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let numbers: Result<Vec<f64>, _> =
            line.split([' ', ',', '\t']).filter(|w| !w.is_empty()).map(str::parse::<f64>).collect();
        match numbers.map(<[f64; N]>::try_from) {
            Ok(Ok(point)) if point.iter().all(|c| c.is_finite()) => out.push(point),
            _ => {
                let shown: String = line.chars().take(SHOWN).collect();
                return Err(format!("{}: `{shown}` is not {wanted}", i + 1));
            }
        }
    }
    Ok(out)
}
