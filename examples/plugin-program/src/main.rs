//! ripple: rings on water, as a plug-in in Rust, with derivatives of its own.
//!
//! docs/plugin-protocol.md describes what pathwarp and this program say to each other.

use std::collections::HashMap;
use std::fs::File;
use std::io::{self, BufReader, Read, Write};

const ENTRY: &str = r#"{
  "pathwarp-plugin": 2,
  "protocol": "binary",
  "jacobian": true,
  "name": "ripple",
  "title": "rings on water, spreading from a centre",
  "about": "Pushes every point along its ray from the centre, outwards and inwards in turn.",
  "source": "the plug-in pathwarp-ripple",
  "parameters": [
    {"name": "center", "kind": "point", "default": "50%,50%", "help": "Where the rings start."},
    {"name": "wavelength", "kind": "length", "default": "20%", "range": [0.001, 1e9], "slider": [1, 1000],
     "help": "Distance from ring to ring."},
    {"name": "height", "kind": "length", "default": "1%", "slider": [-100, 100],
     "help": "How far a point is pushed at most."}
  ],
  "examples": [
    {"what": "As it comes", "command": "ripple samples/grid.svg -o out.svg"},
    {"what": "From a corner", "command": "ripple samples/logo.svg --center 0%,0% --height 2% -o out.svg"}
  ],
  "laws": [{"identity": {"height": 0}}],
  "cases": [
    {"args": {"center": "50,50", "wavelength": "40", "height": "3"}, "at": [60, 50], "to": [63, 50], "tolerance": 1e-12}
  ]
}
"#;

/// The map for one set of values. Lengths are in user units, angles in degrees, y points down.
struct Map {
    center: [f64; 2],
    height: f64,
    waves: f64,
}

impl Map {
    fn new(values: &HashMap<String, Vec<String>>) -> Result<Self, String> {
        let numbers = |name: &str| -> Vec<f64> {
            values.get(name).into_iter().flatten().flat_map(|v| v.split(' ')).filter_map(|v| v.parse().ok()).collect()
        };
        match (numbers("center").as_slice(), numbers("height").as_slice(), numbers("wavelength").as_slice()) {
            (&[x, y], &[height], &[length]) => {
                Ok(Self { center: [x, y], height, waves: std::f64::consts::TAU / length })
            }
            _ => Err("center, height and wavelength are needed".to_owned()),
        }
    }

    fn point(&self, p: [f64; 2]) -> [f64; 2] {
        let [u, v, ..] = self.jet(p);
        [u, v]
    }

    /// The image of a point, and its partial derivatives by x and by y.
    fn jet(&self, [x, y]: [f64; 2]) -> [f64; 6] {
        let [dx, dy] = [x - self.center[0], y - self.center[1]];
        let r = dx.hypot(dy);
        // F = p + d·g(r) with g(r) = a·sin(k·r)/r, and g' = (a·k·cos(k·r) − g)/r, which tends to 0 at the centre.
        let (g, slope) = if r > 1e-9 / self.waves {
            let (sin, cos) = (self.waves * r).sin_cos();
            let g = self.height * sin / r;
            (g, (self.height * self.waves * cos - g) / (r * r))
        } else {
            (self.height * self.waves, 0.0)
        };
        let mixed = dx * dy * slope;
        [x + dx * g, y + dy * g, 1.0 + g + dx * dx * slope, mixed, mixed, 1.0 + g + dy * dy * slope]
    }
}

/// Kinds of requests, and of answers.
const BUILD: u8 = 1;
const POINTS: u8 = 2;
const JETS: u8 = 3;
const DONE: u8 = 0;
const REFUSED: u8 = 1;

fn main() -> io::Result<()> {
    let (mut input, mut output) = (BufReader::with_capacity(1 << 16, io::stdin().lock()), unbuffered()?);
    output.write_all(ENTRY.as_bytes())?;
    let mut map = None;
    let (mut body, mut answers) = (Vec::new(), Vec::new());
    // A request is the length of what follows, its kind, and its body. Without a further one, the program ends.
    let mut length = [0; 4];
    while input.read_exact(&mut length).is_ok() {
        body.resize(u32::from_le_bytes(length) as usize, 0);
        input.read_exact(&mut body)?;
        let Some((kind, body)) = body.split_first() else { break };
        let answer = match (kind, &map) {
            (&BUILD, _) => match Map::new(&values(&String::from_utf8_lossy(body))) {
                Ok(built) => {
                    map = Some(built);
                    Ok(Vec::new())
                }
                Err(problem) => Err(problem),
            },
            (&POINTS, Some(map)) => Ok(each(body, |p| map.point(p))),
            (&JETS, Some(map)) => Ok(each(body, |p| map.jet(p))),
            _ => Err(format!("unknown request {kind}")),
        };
        let (kind, body) = match answer {
            Ok(numbers) => (DONE, numbers),
            Err(problem) => (REFUSED, problem.into_bytes()),
        };
        answers.extend_from_slice(&(body.len() as u32 + 1).to_le_bytes());
        answers.push(kind);
        answers.extend_from_slice(&body);
        // Another request may have come with this one; then both answers go together.
        if input.buffer().is_empty() {
            output.write_all(&answers)?;
            answers.clear();
        }
    }
    Ok(())
}

/// Standard output without the buffer that cuts an answer in two wherever it has a byte like a line break.
fn unbuffered() -> io::Result<File> {
    #[cfg(unix)]
    let output = std::os::fd::AsFd::as_fd(&io::stdout()).try_clone_to_owned()?;
    #[cfg(windows)]
    let output = std::os::windows::io::AsHandle::as_handle(&io::stdout()).try_clone_to_owned()?;
    Ok(output.into())
}

/// The values of a request to build, by name: lines `NAME VALUE`, several for a repeated parameter.
fn values(text: &str) -> HashMap<String, Vec<String>> {
    let mut out: HashMap<String, Vec<String>> = HashMap::new();
    for (name, value) in text.lines().filter_map(|line| line.split_once(' ')) {
        out.entry(name.to_owned()).or_default().push(unescaped(value));
    }
    out
}

/// A text whose `\\`, `\n` and `\r` stand for a backslash and line breaks.
fn unescaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut letters = text.chars();
    while let Some(c) = letters.next() {
        out.push(match c {
            '\\' => match letters.next() {
                Some('n') => '\n',
                Some('r') => '\r',
                other => other.unwrap_or('\\'),
            },
            c => c,
        });
    }
    out
}

/// The numbers of `f` at every point of a batch.
fn each<const N: usize>(body: &[u8], f: impl Fn([f64; 2]) -> [f64; N]) -> Vec<u8> {
    let mut out = Vec::with_capacity(body.len() / 2 * N);
    for point in body.chunks_exact(16) {
        let number = |i: usize| f64::from_le_bytes(std::array::from_fn(|k| point[i + k]));
        for value in f([number(0), number(8)]) {
            out.extend_from_slice(&value.to_le_bytes());
        }
    }
    out
}
