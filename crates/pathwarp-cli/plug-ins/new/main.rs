//! @NAME@: a deformation for pathwarp. Change `ENTRY` and `Map`; `pathwarp check FILE` checks the result.
//!
//! docs/plugin-protocol.md describes what pathwarp and this program say to each other.

use std::collections::HashMap;
use std::fs::File;
use std::io::{self, BufReader, Read, Write};

const ENTRY: &str = r#"{
  "pathwarp-plugin": 2,
  "protocol": "binary",
  "jacobian": true,
  "inverse": true,
  "name": "@NAME@",
  "title": "waves that run across the artwork",
  "about": "Moves every point up and down along a sine wave.",
  "source": "the plug-in pathwarp-@NAME@",
  "parameters": [
    {"name": "height", "kind": "length", "axis": "y", "default": "10%", "slider": [-100, 100],
     "help": "Height of a wave above the middle."},
    {"name": "wavelength", "kind": "length", "axis": "x", "default": "50%", "range": [0.001, 1e9],
     "slider": [1, 1000], "help": "Distance from wave to wave."}
  ],
  "examples": [
    {"what": "As it comes", "command": "@NAME@ samples/logo.svg -o out.svg"},
    {"what": "Short waves", "command": "@NAME@ samples/logo.svg --wavelength 10% --height 2% -o out.svg"}
  ],
  "laws": [
    {"identity": {"height": 0}},
    {"area": [{}, 1]},
    {"undoes": [{"height": "7"}, {"height": "-7"}]}
  ],
  "cases": [
    {"args": {"height": "4", "wavelength": "40"}, "at": [10, 5], "to": [10, 9], "tolerance": 1e-12}
  ]
}
"#;

/// The map for one set of values. Lengths are in user units, angles in degrees, y points down.
struct Map {
    height: f64,
    waves: f64,
}

impl Map {
    /// `values` has the values of every parameter as text, several of a repeated one, and the box that percentages refer to as `frame`: x0 y0 x1 y1.
    fn new(values: &HashMap<String, Vec<String>>) -> Result<Self, String> {
        let number = |name: &str| -> Result<f64, String> {
            values.get(name).and_then(|all| all.last()?.parse().ok()).ok_or_else(|| format!("{name} is not a number"))
        };
        Ok(Self { height: number("height")?, waves: std::f64::consts::TAU / number("wavelength")? })
    }

    fn point(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [x, y + self.height * (self.waves * x).sin()]
    }

    /// The image, and its partial derivatives by x and by y. Without `"jacobian": true` nobody asks for it.
    fn jet(&self, [x, y]: [f64; 2]) -> [f64; 6] {
        let [u, v] = self.point([x, y]);
        [u, v, 1.0, self.height * self.waves * (self.waves * x).cos(), 0.0, 1.0]
    }

    /// The point with this image. Without `"inverse": true` nobody asks for it.
    fn inverse(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [x, y - self.height * (self.waves * x).sin()]
    }
}

/// Kinds of requests, and of answers.
const BUILD: u8 = 1;
const POINTS: u8 = 2;
const JETS: u8 = 3;
const INVERSE: u8 = 4;
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
            (&INVERSE, Some(map)) => Ok(each(body, |p| map.inverse(p))),
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
