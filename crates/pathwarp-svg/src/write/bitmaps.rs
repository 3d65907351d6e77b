//! Bitmaps as `<image>` elements.

use super::input::WriteInput;
use super::markup::{Markup, Properties};
use super::values::{bent_attributes, bent_url, data_url};
use crate::bend::bitmap::EmbeddedImage;
use crate::bend::outcome::Skipped;
use crate::bend::picture::BentImage;
use crate::source::number::short;
use pathwarp::kurbo::Affine;
use usvg::{ImageKind, ImageRendering};

/// Writes a bent bitmap.
pub(super) fn bent(markup: &Markup<'_>, bent: &BentImage, to: Affine) -> String {
    let mut all = bent_attributes(bent, to).to_vec();
    all.push((markup.link(), bent_url(bent)));
    let all: String = all.iter().map(|(n, v)| format!(" {n}=\"{v}\"")).collect();
    format!("<{}{all}/>", markup.tag("image"))
}

/// Writes bitmap `i`, bent or not.
pub(super) fn image(input: &WriteInput<'_>, markup: &Markup<'_>, skipped: &mut Vec<Skipped>, i: usize) -> String {
    let bitmap = &input.scene.bitmaps[i];
    let image = &bitmap.image;
    if !image.is_visible() || bitmap.is_unread() {
        return String::new();
    }
    match &input.images[i] {
        EmbeddedImage::Placed => {}
        EmbeddedImage::Approximate(why) => {
            let id = bitmap.owner.map_or_else(|| "an image".into(), |e| input.source.display_name(e));
            skipped.push(Skipped { id, why: why.clone() });
        }
        EmbeddedImage::Bent(image) => {
            // Back to the group's coordinates, the bitmap's pixels. The placing has no rotation.
            return bent(markup, image, bitmap.placing.inverse());
        }
    }
    let url = match image.kind() {
        ImageKind::JPEG(d) => data_url("image/jpeg", d),
        ImageKind::PNG(d) => data_url("image/png", d),
        ImageKind::GIF(d) => data_url("image/gif", d),
        ImageKind::WEBP(d) => data_url("image/webp", d),
        ImageKind::SVG(t) => data_url("image/svg+xml", t.to_string(&usvg::WriteOptions::default()).as_bytes()),
    };
    let mut properties = Properties::new();
    match image.rendering_mode() {
        ImageRendering::OptimizeQuality => {}
        ImageRendering::OptimizeSpeed => properties.push(("image-rendering", "optimizeSpeed".into())),
        ImageRendering::Smooth => properties.push(("image-rendering", "smooth".into())),
        ImageRendering::HighQuality => properties.push(("image-rendering", "high-quality".into())),
        ImageRendering::CrispEdges => properties.push(("image-rendering", "crisp-edges".into())),
        ImageRendering::Pixelated => properties.push(("image-rendering", "pixelated".into())),
    }
    let style = properties.iter().map(|(n, v)| format!(" style=\"{n}:{v}\"")).collect::<String>();
    let link = markup.link();
    format!(
        "<{} width=\"{}\" height=\"{}\"{style} {link}=\"{url}\"/>",
        markup.tag("image"),
        short(image.size().width().into()),
        short(image.size().height().into()),
    )
}
