//! Elements that show something else: `use` and `image`.

use super::animations;
use super::keeper::{Keeper, NO_EFFECTS};
use crate::bend::bitmap::EmbeddedImage;
use crate::bend::options::Clones;
use crate::bend::outcome::Skipped;
use crate::scene::model::{Group, Node};
use crate::source::live::is_live;
use crate::source::tags::{ElementId, Namespace};
use crate::write::values::{bent_attributes, bent_url};
use pathwarp::kurbo::Affine;

/// Patches the element of bitmap `i`, in group `g`.
pub(super) fn bitmap(k: &mut Keeper<'_, '_>, g: &Group, i: usize) {
    let bitmap = &k.input.scene.bitmaps[i];
    let e = g.source.or(bitmap.owner).filter(|&e| k.tag(e) == "image");
    let why = match (&k.input.images[i], e) {
        (EmbeddedImage::Placed, _) => return,
        (EmbeddedImage::Bent(bent), Some(e)) => {
            for (name, value) in bent_attributes(bent, Affine::IDENTITY) {
                k.edits.set_attr(e, name, value);
            }
            k.edits.set_attr(e, "href", bent_url(bent));
            let text = &k.source.text;
            // Inkscape's path to the file that the image was linked to.
            k.edits.remove_attrs(e, |a| a.namespace == Namespace::Sodipodi && a.name(text) == "absref");
            return;
        }
        (EmbeddedImage::Bent(_), None) => "its element was not found; it is placed by the best affine fit".to_owned(),
        (EmbeddedImage::Approximate(why), _) => why.clone(),
    };
    let id = e.map_or_else(|| "an image".to_owned(), |e| k.source.display_name(e));
    k.writer.skipped.push(Skipped { id, why });
}

/// Replaces an image that is a drawing by a group with the drawing's content.
pub(super) fn drawing(k: &mut Keeper<'_, '_>, e: ElementId, n: &Node, g: &Group) {
    if k.changed(n) {
        let content = k.writer.group(g, "");
        for name in ["href", "preserveAspectRatio"] {
            k.edits.remove_attr(e, name);
        }
        k.make_group(e, content);
    }
}

/// Replaces a `use` by a group with the resolved content, if that is no longer a copy of the original.
pub(super) fn copy(k: &mut Keeper<'_, '_>, e: ElementId, g: &Group) {
    // The original may have been warped.
    let original_unchanged = || {
        k.input.options.clones == Clones::Follow
            || k.input.options.selection.is_everything()
            || k.input.outcomes.iter().all(|o| o.warped().is_none())
    };
    if !g.children.iter().any(|n| k.changed(n)) && original_unchanged() {
        return;
    }
    let source = k.source;
    let text = &source.text;
    let is_kept =
        |name: &str| name == "id" || name == "class" || name.starts_with("data-") || name.starts_with("aria-");
    let el = &source.elements[e];
    let mut head: String = el
        .attrs
        .iter()
        .filter(|a| is_kept(a.name(text)) || matches!(a.namespace, Namespace::Inkscape | Namespace::Sodipodi))
        .filter(|a| !is_live(a, text))
        .map(|a| format!(" {}", &text[a.range.clone()]))
        .collect();
    let title = el.title.as_ref().map_or(String::new(), |t| k.writer.markup.title(t));
    k.fragments.insert(e);
    let lead = title + &animations::kept(source, e);
    let has_rules = source.has_css() && source.attr(e, "class").or(source.attr(e, "id")).is_some();
    let text = if has_rules {
        // The resolved group contains the effects of the class, which must not apply twice.
        head.push_str(NO_EFFECTS);
        let inner = k.writer.group(g, "");
        format!("<{0}{head}>{lead}{inner}</{0}>", k.writer.markup.tag("g"))
    } else {
        k.writer.group_with(g, &head, &lead)
    };
    k.edits.replace(e, text);
}
