//! `--in` puts the lines into a shape by the deformation `envelope`.

use super::on_path::{self, SetLines, as_letters, bend_letters, text_arg};
use super::style::Em;
use clap::{Arg, ArgMatches};
use pathwarp::deform::Registry;
use pathwarp::param::{Args, Frame};
use pathwarp_engine::failure::Failure;
use pathwarp_engine::options::CommonOptions;
use pathwarp_text::OutlinedText;

/// The deformation, and its parameter for the shape.
const ENVELOPE: &str = "envelope";
const IN: &str = "in";

pub(super) fn arg() -> Arg {
    text_arg(IN, "PATHREF").conflicts_with("on").help(
        "Put the text into this shape, as `pathwarp envelope` does: heart, shield, star, circle or another name, heart,ratio=1.2 (width to \
         height), heart,width=80mm, FILE#NAME or path data; each line is as wide as the shape at its height",
    )
}

/// Returns `true` if the text is put into a shape.
pub(super) fn is_asked_for(m: &ArgMatches) -> bool {
    m.contains_id(IN)
}

/// Puts a text into the shape given by `--in`.
pub(super) fn set(
    registry: &Registry,
    m: &ArgMatches,
    text: &OutlinedText,
    em: &Em,
    options: &CommonOptions,
) -> Result<SetLines, Failure> {
    let reference = m.get_one::<String>(IN).map_or("", String::as_str);
    let mut args = Args::new();
    args.push(ENVELOPE, reference);
    let params = registry.get(ENVELOPE).map_or(&[][..], |e| e.info().params);
    args.resolve_paths(params, |r| on_path::on_page(r, em, options)).map_err(Failure::of_recipe)?;
    let frame = Frame::new(text.ink().unwrap_or_default()).with_units_per_px(em.units_per_px());
    let frame = frame.with_letters(as_letters(text));
    let (line, warnings) = bend_letters(registry, ENVELOPE, &text.text, frame, args, options)?;
    Ok(SetLines { lines: vec![line], warnings })
}
