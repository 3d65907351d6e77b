//! Files that deformations read. The core takes JSON; TOML and Photoshop files are converted here.

use super::foreign::unreadable;
use pathwarp::Error;
use std::path::Path;

/// The text of a file for a parameter of kind `File` or `NameOrFile`: TOML as JSON, a Photoshop file as its warps in JSON,
/// any other text unchanged.
pub(crate) fn read_data_file(file: &str) -> Result<String, Error> {
    let wrong = |what: String| Error::input(file, what);
    let bytes = std::fs::read(file).map_err(|e| wrong(unreadable(Path::new(file), &e)))?;
    let extension = Path::new(file).extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase);
    if matches!(extension.as_deref(), Some("psd" | "psb")) {
        let warps = pathwarp_psd::warps(&bytes).map_err(|e| wrong(e.to_string()))?;
        return serde_json::to_string(&warps).map_err(|e| wrong(e.to_string()));
    }
    let text = String::from_utf8(bytes)
        .map_err(|e| wrong(format!("is not UTF-8 text (byte {})", e.utf8_error().valid_up_to())))?;
    if extension.as_deref() == Some("toml") {
        let table: toml::Table = toml::from_str(&text).map_err(|e| wrong(format!("is not valid TOML: {e}")))?;
        return serde_json::to_string(&table).map_err(|e| wrong(e.to_string()));
    }
    Ok(text)
}
