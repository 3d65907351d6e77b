//! `cargo xtask shadows FOLDER`: drawings with shadows and blurs as Figma exports them. Deterministic.

use crate::chore::{Chore, ChoreError, at, count_option};
use clap::{Arg, ArgMatches, Command, value_parser};
use std::fmt::Write as _;
use std::fs;
use std::path::PathBuf;

pub(crate) const CHORE: Chore = Chore { command, run };

fn command() -> Command {
    Command::new("shadows")
        .about("Write drawings with shadows, inner shadows and blurs as Figma exports them")
        .arg(Arg::new("FOLDER").required(true).value_parser(value_parser!(PathBuf)))
        .arg(count_option("count", "200").help("How many"))
}

fn run(arguments: &ArgMatches) -> Result<String, ChoreError> {
    let folder: &PathBuf = arguments.get_one("FOLDER").ok_or("name a folder")?;
    let count: usize = arguments.get_one("count").copied().ok_or("say how many")?;
    fs::create_dir_all(folder).map_err(at(folder))?;
    for k in 0..count {
        let file = folder.join(format!("{k:03}.svg"));
        fs::write(&file, drawing(k as u64)).map_err(at(&file))?;
    }
    Ok(format!("wrote {count} drawings to {}", folder.display()))
}

/// Pseudorandom numbers, determined by a seed (SplitMix64).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A whole number from `from` to `to`.
    fn pick(&mut self, from: i64, to: i64) -> i64 {
        from + (self.next() % (to - from + 1) as u64) as i64
    }
}

/// The `k`th drawing: one to four shapes, each in a group with a filter.
fn drawing(k: u64) -> String {
    let mut n = Numbers(k);
    let (width, height) = (n.pick(120, 600), n.pick(80, 400));
    let (mut body, mut defs) = (String::new(), String::new());
    for id in 0..n.pick(1, 4) {
        let [w, h] = [width, height].map(|side| n.pick(side / 6, side / 2));
        let (x, y) = (n.pick(0, width - w), n.pick(0, height - h));
        let shape = match n.pick(0, 2) {
            0 => format!("<rect x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" rx=\"{}\"", n.pick(0, 16)),
            1 => format!("<rect x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" rx=\"{w}\" ry=\"{h}\""),
            _ => format!("<path d=\"M{x} {}L{} {y}L{} {}Z\"", y + h, x + w / 2, x + w, y + h),
        };
        let name = format!("filter{id}_{k}");
        let _ = write!(body, "<g filter=\"url(#{name})\">\n{shape} fill=\"#{:06X}\"/>\n</g>\n", n.pick(0, 0xff_ffff));
        defs += &filter(&mut n, &name, [x, y, w, h]);
    }
    format!(
        "<svg width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" fill=\"none\" \
         xmlns=\"http://www.w3.org/2000/svg\">\n{body}<defs>\n{defs}</defs>\n</svg>\n"
    )
}

/// A filter of one to three effects on a shape with this box: a blur, or up to two shadows beneath it and one inside.
fn filter(n: &mut Numbers, name: &str, [x, y, w, h]: [i64; 4]) -> String {
    let shape =
        |last: &str| format!("<feBlend mode=\"normal\" in=\"SourceGraphic\" in2=\"{last}\" result=\"shape\"/>\n");
    let (mut effects, mut last, mut margin) = (String::new(), "BackgroundImageFix".to_owned(), 0);
    // −1 stands for a blur.
    let drops = n.pick(-1, 2);
    if drops < 0 {
        let sigma = n.pick(2, 30);
        margin = 2 * sigma;
        effects =
            shape(&last) + &format!("<feGaussianBlur stdDeviation=\"{sigma}\" result=\"effect1_foregroundBlur\"/>\n");
    }
    let inner = n.pick(i64::from(drops == 0), 1);
    for k in 0..drops + inner.min(drops + 1) {
        if k == drops {
            effects += &shape(&last);
            last = "shape".to_owned();
        }
        let (dx, dy, radius) = (n.pick(-4, 4), n.pick(0, 12), n.pick(0, 20));
        margin = margin.max(2 * radius + dx.abs().max(dy));
        let (kind, cut) = match k < drops {
            true => ("dropShadow", "operator=\"out\""),
            false => ("innerShadow", "operator=\"arithmetic\" k2=\"-1\" k3=\"1\""),
        };
        let result = format!("effect{}_{kind}", k + 1);
        let [r, g, b, a] = [(); 4].map(|()| format!("0.{:02}", n.pick(10, 90)));
        let _ = write!(
            effects,
            "<feColorMatrix in=\"SourceAlpha\" type=\"matrix\" values=\"0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 127 0\" result=\"hardAlpha\"/>\n\
             <feOffset dx=\"{dx}\" dy=\"{dy}\"/>\n<feGaussianBlur stdDeviation=\"{}\"/>\n<feComposite in2=\"hardAlpha\" {cut}/>\n\
             <feColorMatrix type=\"matrix\" values=\"0 0 0 0 {r} 0 0 0 0 {g} 0 0 0 0 {b} 0 0 0 {a} 0\"/>\n\
             <feBlend mode=\"normal\" in2=\"{last}\" result=\"{result}\"/>\n",
            radius as f64 / 2.0
        );
        last = result;
    }
    if drops >= 0 && inner == 0 {
        effects += &shape(&last);
    }
    let [x, y, w, h] = [x - margin, y - margin, w + 2 * margin, h + 2 * margin];
    format!(
        "<filter id=\"{name}\" x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" filterUnits=\"userSpaceOnUse\" \
         color-interpolation-filters=\"sRGB\">\n<feFlood flood-opacity=\"0\" result=\"BackgroundImageFix\"/>\n{effects}</filter>\n"
    )
}
