//! Embeds the origin of a drawing, the recipe and the source file, in its `<metadata>`.

use crate::source::edit::splice;
use crate::source::elements::{PATHWARP as NAMESPACE, tag_end};
use crate::source::read::{self, packed, unpacked_text};
use pathwarp::Error;
use pathwarp::budget::{Budget, Limits};
use pathwarp_reader::xml::{self, escape_content};
use usvg::roxmltree;

/// The origin of a drawing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Origin {
    /// Text of the recipe.
    pub recipe: String,
    /// Content of the source file.
    pub source: Vec<u8>,
}

impl Origin {
    /// Embeds the origin in a drawing's `<metadata>`. It replaces an existing one.
    ///
    /// # Errors
    /// Returns [`Error::Input`] if `svg` is not XML, or has an empty root.
    pub fn embed(&self, svg: &str) -> Result<String, Error> {
        let packed = packed(&self.source)?;
        let element = format!(
            "<pathwarp xmlns=\"{NAMESPACE}\"><recipe>{}</recipe><source encoding=\"gzip base64\">{packed}</source></pathwarp>",
            escape_content(&self.recipe)
        );
        let doc = parse(svg)?;
        // Other metadata, such as a licence, stays.
        if let Some(old) = embedded(&doc) {
            return Ok(splice(svg, [(old.range(), element)]));
        }
        let root = doc.root_element().range();
        let end =
            tag_end(svg, root.start, root.end).ok_or_else(|| Error::input("the drawing", "its root has no end"))?;
        if svg[..end].ends_with("/>") {
            return Err(Error::input("the drawing", "is empty; there is nothing to embed"));
        }
        Ok(splice(svg, [(end..end, format!("\n<metadata>{element}</metadata>"))]))
    }

    /// Reads the origin embedded in `svg`, if any.
    ///
    /// # Errors
    /// Returns [`Error::Input`] if `svg` is not XML, or the origin is damaged.
    pub fn read(svg: &str) -> Result<Option<Self>, Error> {
        Self::read_within(svg, &Limits::default().for_input(svg.len()))
    }

    /// Reads the origin embedded in a file, which may be compressed or in another encoding. `name` identifies it in errors.
    ///
    /// # Errors
    /// [`Error::Input`] if the file cannot be decoded, is not XML or exceeds the limits, or the origin is damaged.
    pub fn of_file(data: &[u8], name: &str, limits: &Limits) -> Result<Option<Self>, Error> {
        Self::read_within(&read::text(data, name, &Budget::new(*limits))?, limits)
    }

    /// Reads the origin embedded in `svg`, if any, within limits.
    ///
    /// # Errors
    /// [`Error::Input`] if `svg` is not XML, or the origin is damaged or unpacks to more than the limit.
    pub fn read_within(svg: &str, limits: &Limits) -> Result<Option<Self>, Error> {
        let budget = Budget::new(*limits);
        xml::check(svg, "the drawing", &budget)?;
        let doc = parse(svg)?;
        let Some(origin) = embedded(&doc) else { return Ok(None) };
        let text = |name: &str| {
            let node = origin.descendants().find(|n| n.has_tag_name((NAMESPACE, name)));
            node.map(|n| n.children().filter_map(|c| c.text()).collect::<String>()).unwrap_or_default()
        };
        let source = unpacked_text(&text("source"), "the embedded source", &budget)?;
        Ok(Some(Self { recipe: text("recipe"), source }))
    }
}

fn parse(svg: &str) -> Result<roxmltree::Document<'_>, Error> {
    xml::document(svg).map_err(|e| Error::input("the drawing", e.to_string()))
}

/// Finds the embedded origin, in a `<metadata>`.
fn embedded<'a>(doc: &'a roxmltree::Document<'a>) -> Option<roxmltree::Node<'a, 'a>> {
    let origin = doc.root_element().descendants().find(|n| n.has_tag_name((NAMESPACE, "pathwarp")))?;
    origin.parent().is_some_and(|p| p.tag_name().name() == "metadata").then_some(origin)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_embedded_comes_back_to_the_byte() {
        let origin = Origin { recipe: "a = '<&>'\n".into(), source: b"\x00\xffsource".to_vec() };
        let svg = "<?xml version='1.0'?><svg xmlns='http://www.w3.org/2000/svg' a='>'><path d='M0,0'/></svg>";
        let with = origin.embed(svg).unwrap();
        assert_eq!(Origin::read(&with).unwrap().as_ref(), Some(&origin));
        assert_eq!(Origin::read(svg).unwrap(), None);
        let newer = Origin { recipe: "b".into(), ..origin.clone() };
        let again = newer.embed(&with).unwrap();
        assert_eq!(Origin::read(&again).unwrap(), Some(newer));
        assert_eq!(again.matches("<metadata>").count(), 1);
        let licensed = with.replace("</metadata>", "<licence/></metadata>");
        assert!(origin.embed(&licensed).unwrap().contains("<licence/></metadata>"));
        assert!(Origin::read(&with.replace("gzip base64\">", "gzip base64\">!")).is_err());
    }
}
