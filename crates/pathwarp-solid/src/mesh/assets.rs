//! The parts of a glTF file that a map leaves alone: materials, textures, samplers and pictures.

use serde_json::{Map, Value};

/// Materials with all they refer to.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Assets {
    /// The arrays `materials`, `textures`, `samplers`, `images` and `extensionsUsed`, as they were.
    pub(crate) json: Map<String, Value>,
    /// The names of the materials, made different.
    pub(crate) materials: Vec<String>,
    /// The bytes of pictures that were in a buffer, by the number of the picture.
    pub(crate) pictures: Vec<(usize, Vec<u8>)>,
}

/// The arrays that are kept.
pub(crate) const KEPT: [&str; 5] = ["materials", "textures", "samplers", "images", "extensionsUsed"];

impl Assets {
    /// Returns `true` if there are no materials.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.materials.is_empty()
    }

    /// Takes the assets from a file's JSON.
    pub(crate) fn of(root: &Value) -> Self {
        let mut out = Self::default();
        for key in KEPT {
            if let Some(v) = root.get(key) {
                out.json.insert(key.to_owned(), v.clone());
            }
        }
        let materials = root.get("materials").and_then(Value::as_array);
        for (i, m) in materials.into_iter().flatten().enumerate() {
            let name = m.get("name").and_then(Value::as_str).unwrap_or_default();
            let name = if name.is_empty() { format!("material {}", i + 1) } else { name.to_owned() };
            let taken = out.materials.contains(&name);
            out.materials.push(if taken { format!("{name} {}", i + 1) } else { name });
        }
        out
    }
}
