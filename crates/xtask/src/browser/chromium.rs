//! Headless Chromium, driven by playwright as in the tests of the editor's page.

use super::measure::Picture;
use crate::chore::workspace;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use pathwarp_raster::decode_png;
use resvg::tiny_skia::{IntSize, Pixmap};
use serde::Deserialize;
use std::io::{BufRead as _, BufReader, Write as _};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::{Mutex, PoisonError};

/// What Chromium shows of a drawing.
#[derive(Deserialize)]
pub(super) struct Shown {
    /// It is not well-formed XML.
    pub(super) broken: bool,
    /// The page's extent in px.
    pub(super) right: f64,
    pub(super) bottom: f64,
    /// From user units to px.
    pub(super) matrix: Option<[f64; 6]>,
    #[serde(default, rename = "png", deserialize_with = "decoded")]
    pub(super) picture: Option<Picture>,
}

fn decoded<'a, D: serde::Deserializer<'a>>(d: D) -> Result<Option<Picture>, D::Error> {
    let wrong = |e: String| serde::de::Error::custom(e);
    let bytes = STANDARD.decode(String::deserialize(d)?).map_err(|e| wrong(e.to_string()))?;
    Ok(Some(Picture::new(&decode_png(&bytes).map_err(|e| wrong(e.to_string()))?)))
}

impl Picture {
    pub(super) fn pixmap(&self) -> Result<Pixmap, String> {
        let size = IntSize::from_wh(self.width as u32, self.height as u32).ok_or("an empty picture")?;
        Pixmap::from_vec(self.data.clone(), size).ok_or_else(|| "a picture of a wrong size".to_owned())
    }
}

/// As many browsers as are used at the same time; the next drawing takes one that is free.
#[derive(Default)]
pub(super) struct Browsers(Mutex<Vec<Browser>>);

struct Browser {
    node: Child,
    requests: ChildStdin,
    answers: BufReader<ChildStdout>,
}

impl Browsers {
    /// Shows a file on a page of this size in px, each so many pixels wide; without one, only asks for its size.
    pub(super) fn show(&self, file: &Path, size: Option<([f64; 2], f64)>) -> Result<Shown, String> {
        let free = self.0.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let mut browser = free.map_or_else(Browser::start, Ok)?;
        let mut request = serde_json::json!({ "file": file });
        if let Some((size, scale)) = size {
            request["size"] = size.map(|c| c as u32).to_vec().into();
            request["scale"] = scale.into();
        }
        let answer = browser.ask(&request.to_string()).map_err(|e| format!("Chromium: {e}"))?;
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(browser);
        let answer: serde_json::Value =
            serde_json::from_str(&answer).map_err(|e| format!("Chromium: {e}: {answer}"))?;
        if let Some(error) = answer.get("error") {
            return Err(error.to_string());
        }
        serde_json::from_value(answer).map_err(|e| e.to_string())
    }
}

impl Browser {
    fn start() -> Result<Self, String> {
        let script = workspace().join("crates/xtask/src/browser/pages.mjs");
        let mut command = Command::new("node");
        let started = command.arg(script).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn();
        let mut node = started.map_err(|e| format!("node does not start: {e}"))?;
        let pipes = node.stdin.take().zip(node.stdout.take());
        let (requests, answers) = pipes.ok_or("node has no pipes")?;
        Ok(Self { node, requests, answers: BufReader::new(answers) })
    }

    fn ask(&mut self, request: &str) -> std::io::Result<String> {
        writeln!(self.requests, "{request}")?;
        let mut answer = String::new();
        self.answers.read_line(&mut answer)?;
        Ok(answer)
    }
}

impl Drop for Browser {
    /// Chromium ends with node.
    fn drop(&mut self) {
        let _ = self.node.kill();
        let _ = self.node.wait();
    }
}
