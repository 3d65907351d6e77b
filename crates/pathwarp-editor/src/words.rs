//! Words that a drawing was set from. An attribute of its root stores them, so that they can be edited when it is opened again.

use serde::{Deserialize, Serialize};

/// The attribute's name.
const WORDS: &str = "data-words";

/// The words that make up a drawing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Words {
    /// The text, with line breaks.
    pub text: String,
    /// The family; `None` for the bundled font.
    pub font: Option<String>,
    /// The size of the em, in mm.
    pub size: f64,
    /// Space between letters, in per cent of the size.
    pub spacing: f64,
}

impl Words {
    /// Stores the words in the drawing `svg` made from them.
    pub(crate) fn written(&self, svg: &str) -> String {
        #[expect(clippy::expect_used, reason = "structures without maps become text in any case")]
        let json = serde_json::to_string(self).expect("there is no map");
        // JSON escapes line breaks and tabs, which attributes would turn into spaces.
        let value = json.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;");
        svg.replacen("<svg ", &format!("<svg {WORDS}=\"{value}\" "), 1)
    }

    /// Reads the words that a drawing was set from.
    pub(crate) fn of(svg: &str) -> Option<Self> {
        // Most drawings need no parsing here.
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
