//! Elements that show something else: `use` and `image`.

use super::animations;
use super::keeper::Keeper;
use crate::bend::bitmap::EmbeddedImage;
use crate::bend::options::Clones;
use crate::bend::outcome::Skipped;
use crate::scene::model::{Group, Node};
use crate::source::live::is_live;
use crate::source::tags::{ElementId, Namespace};
use crate::write::input::WriteInput;
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

/// Returns `false` if the original of a `use` may have been warped.
fn is_original_unchanged(k: &Keeper<'_, '_>, e: ElementId) -> bool {
    let WriteInput { source, scene, outcomes, options, .. } = k.input;
    if options.selection.is_everything() {
        return true;
    }
    let originals: Vec<ElementId> =
        source.href(e).and_then(|id| source.by_id().get(&id)).into_iter().flatten().copied().collect();
    // One that shows others is taken to have changed with anything.
    let shows_others = |o: &ElementId| k.tag(*o) == "use" || source.descendants(*o).any(|d| k.tag(d) == "use");
    let ranges: Vec<_> = originals.iter().map(|&o| &source.elements[o].range).collect();
    let inside = |o: ElementId| ranges.iter().any(|r| r.contains(&source.elements[o].range.start));
    let anywhere = originals.is_empty() || originals.iter().any(shows_others);
    let warped = scene.parts.iter().zip(outcomes).filter(|(_, o)| o.warped().is_some());
    !warped.map(|(p, _)| p.element()).any(|o| anywhere || o.is_none_or(inside))
}

/// Replaces a `use` by a group with the resolved content, if that is no longer a copy of the original.
pub(super) fn copy(k: &mut Keeper<'_, '_>, e: ElementId, g: &Group) {
    if !g.children.iter().any(|n| k.changed(n))
        && (k.input.options.clones == Clones::Follow || is_original_unchanged(k, e))
    {
        return;
    }
    let source = k.source;
    let text = &source.text;
    let is_kept =
        |name: &str| name == "id" || name == "class" || name.starts_with("data-") || name.starts_with("aria-");
    let el = &source.elements[e];
    let head: String = el
        .attrs
        .iter()
        .filter(|a| is_kept(a.name(text)) || matches!(a.namespace, Namespace::Inkscape | Namespace::Sodipodi))
        .filter(|a| !is_live(a, text))
        .map(|a| format!(" {}", &text[a.range.clone()]))
        .collect();
    let title = el.title.as_ref().map_or(String::new(), |t| k.writer.markup.title(t));
    k.fragments.insert(e);
    let lead = title + &animations::kept(source, e);
    let text = k.writer.group_with(g, &head, &lead);
    k.edits.replace(e, text);
}
