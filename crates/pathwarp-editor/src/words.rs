//! Words that a drawing was set from: it carries them in an attribute of its root, so that they can be changed when it is opened again.

use serde::{Deserialize, Serialize};

/// The attribute.
const WORDS: &str = "data-words";

/// Words that a drawing consists of.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Words {
    /// The text, with line breaks.
    pub text: String,
    /// The family; `None` for the bundled font.
    pub font: Option<String>,
    /// The size of the letters' em, in mm.
    pub size: f64,
    /// Space between letters, in per cent of the size.
    pub spacing: f64,
}

impl Words {
    /// The drawing `svg` of these words, with the words.
    pub(crate) fn written(&self, svg: &str) -> String {
        #[expect(clippy::expect_used, reason = "structures without maps become text in any case")]
        let json = serde_json::to_string(self).expect("there is no map");
        // JSON has no line breaks and tabs of its own.
        let value = json.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;");
        svg.replacen("<svg ", &format!("<svg {WORDS}=\"{value}\" "), 1)
    }

    /// The words that a drawing was set from.
    pub(crate) fn of(svg: &str) -> Option<Self> {
        // Most drawings need not be parsed for this.
        let document = svg.contains(WORDS).then(|| usvg::roxmltree::Document::parse(svg).ok()).flatten()?;
        serde_json::from_str(document.root_element().attribute(WORDS)?).ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_survive_the_drawing() {
        let words =
            Words { text: "“A & B” <\n\"C\"".into(), font: Some("Fraktur's".into()), size: 20.0, spacing: -2.5 };
        let svg = words.written("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"9\"><path/></svg>");
        assert_eq!(Words::of(&svg), Some(words));
        assert_eq!(Words::of("<svg xmlns=\"http://www.w3.org/2000/svg\"/>"), None);
    }
}
