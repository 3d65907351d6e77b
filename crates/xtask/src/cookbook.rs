//! `docs/cookbook.md`: real jobs, each one command on a sample, with its picture.

use crate::Fault;
use crate::docs;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// The page.
const PAGE: &str = "docs/cookbook.md";
/// Where its pictures lie.
const PICTURES: &str = "docs/images/cookbook";

/// A job: one more is one more entry of [`JOBS`].
struct Job {
    /// The picture's file name, kebab-case.
    name: &'static str,
    title: &'static str,
    /// One paragraph.
    text: &'static str,
    /// The words after `pathwarp`, run from the project's root, `-o out.svg` included.
    command: &'static str,
}

const JOBS: &[Job] = &[
    Job {
        name: "badge",
        title: "Lettering round a badge",
        text: "The word stands on an arc, scaled to its length. `--baseline` says which height of the artwork lies on the arc: the \
letters stand at 25 %, above the tail of the g.",
        command: "bend samples/lettering.svg --along 'M10,250 A330,330 0 0 1 526,250' --stretch scale --baseline 25% -o out.svg",
    },
    Job {
        name: "flag",
        title: "A logo on a flag",
        text: "The flag is one closed path of four sides, drawn in any drawing program. Colours and gradients follow.",
        command: "shaper samples/logo.svg --shaper samples/banner.svg -o out.svg",
    },
    Job {
        name: "pennant",
        title: "A logo in a pennant",
        text: "A closed shape with any number of nodes is an envelope: its four corners and its bottom are found, the notch is not \
taken for a corner. `--explain` tells what was chosen.",
        command: "envelope samples/logo.svg --envelope 'samples/envelopes.svg#pennant' -o out.svg",
    },
    Job {
        name: "t-shirt",
        title: "Arched lettering for a T-shirt",
        text: "Flat below, arched above. `--frame` is the box from baseline to ascenders, so that the baseline becomes the flat side and \
the g hangs below it. With `--keep verticals` uprights stay upright and letters keep their even widths.",
        command: "envelope samples/lettering.svg --frame 20,20,496,112.5 --bottom 'M20,180 H516' --top 'M20,110 Q268,-80 516,110' --keep verticals -o out.svg",
    },
    Job {
        name: "wine-label",
        title: "A label as it looks on the bottle",
        text: "Seen a little from above, level lines on a bottle are arcs of ellipses: one below, the same above. Uprights stay upright.",
        command: "envelope samples/logo.svg --bottom 'M60,170 A310,60 0 0 0 604,170' --height 150 --keep verticals -o out.svg",
    },
    Job {
        name: "bucket",
        title: "Artwork for a tapered bucket",
        text: "Laid flat, a band round a bucket or a paper cup is part of a ring. The eye is a metre in front of it, and the result is \
true to size.",
        command: "anamorph samples/logo.svg --distance 1m --onto cone:top=120mm,bottom=85mm,height=160mm -o out.svg",
    },
    Job {
        name: "mug",
        title: "A badge that looks flat on a mug",
        text: "The print for a mug of 42 mm radius which, seen from half a metre, shows the badge undistorted.",
        command: "anamorph samples/badge.svg --distance 50cm --onto cylinder:radius=42mm -o out.svg",
    },
    Job {
        name: "road-marking",
        title: "A word painted on the road",
        text: "Thrown onto the floor, letters grow long towards the top; from the eye's place they look as drawn. The result is what to \
paint, true to size. Lengths may have units: `--eye-height 1.2m --distance 20m --length 10m` is a driver's view.",
        command: "anamorph samples/lettering.svg --eye-height 300 --distance 500 --onto plane:floor -o out.svg",
    },
    Job {
        name: "sign",
        title: "A sign in perspective",
        text: "Four corners to four places of a photograph or a sketch. Straight lines stay straight, and keep their two nodes.",
        command: "projective samples/logo.svg --target '0%,120% 100%,90% 100%,10% 0%,-40%' -o out.svg",
    },
    Job {
        name: "nameplate",
        title: "A drawing on a nameplate for the laser",
        text: "Line art fills a rounded plate; `--strokes keep` leaves the lines what they are, centre lines with their width, as \
laser cutters and engravers want them. A rounded box has no corners by angle: they are taken in the middle of its roundings.",
        command: "envelope samples/lineart.svg --envelope 'M34,40 H326 A34,34 0 0 1 360,74 V204 A34,34 0 0 1 326,238 H34 A34,34 0 0 1 0,204 V74 A34,34 0 0 1 34,40 Z' --strokes keep -o out.svg",
    },
    Job {
        name: "oval",
        title: "A word in an oval",
        text: "An ellipse has no corners: they are taken where it comes nearest to the corners of its box, on the diagonals.",
        command: "envelope samples/lettering.svg --envelope 'M526,95 A258,130 0 1 1 10,95 A258,130 0 1 1 526,95 Z' -o out.svg",
    },
    Job {
        name: "valentine",
        title: "A word in a heart",
        text: "The heart's two tips are no corners of the word: it fills the lobes above and narrows to the tip below.",
        command: "envelope samples/lettering.svg --envelope 'M268,60 C310,-50 500,-40 520,90 C536,200 360,260 268,330 C176,260 0,200 16,90 C36,-40 226,-50 268,60 Z' -o out.svg",
    },
    Job {
        name: "headline",
        title: "A rising headline",
        text: "One curve and a height: the same curve is the top. The word climbs and its uprights stay upright.",
        command: "envelope samples/lettering.svg --bottom 'M10,240 C160,240 200,150 290,140 S420,170 526,60' --height 130 --keep verticals -o out.svg",
    },
    Job {
        name: "wreath",
        title: "A wreath of monograms",
        text: "Copies of the artwork all round a circle, as many as it has room for, spread evenly.",
        command: "bend samples/monogram.svg --along 'M-230,130 A360,360 0 1 1 490,130 A360,360 0 1 1 -230,130 Z' --stretch repeat --gap 12% -o out.svg",
    },
    Job {
        name: "ball",
        title: "A badge on a ball",
        text: "A bulge blows up the middle and leaves what is around it.",
        command: "bulge samples/badge.svg --amount 0.8 -o out.svg",
    },
];

/// Writes the page and draws its pictures.
pub(crate) fn run(root: &Path, program: &Path) -> Result<usize, Fault> {
    let write = |file: &str, text: &str| {
        let file = root.join(file);
        fs::write(&file, text).map_err(|e| format!("{}: {e}", file.display()))
    };
    fs::create_dir_all(root.join(PICTURES)).map_err(|e| format!("{PICTURES}: {e}"))?;
    write(PAGE, &page())?;
    for job in JOBS {
        docs::picture(root, program, job.command, &root.join(PICTURES).join(format!("{}.png", job.name)))?;
    }
    Ok(JOBS.len())
}

fn page() -> String {
    let mut out = String::from(
        "# Cookbook\n\nReal jobs, each one command on a drawing of [samples](../samples). The pictures show the artwork, and the result with \
its guides. Made by `cargo xtask docs`.\n",
    );
    for job in JOBS {
        let Job { name, title, text, command } = job;
        let _ = write!(
            out,
            "\n## {title}\n\n![{title}](images/cookbook/{name}.png)\n\n{text}\n\n```sh\npathwarp {command}\n```\n"
        );
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The page in the repository is the one that would be made now, with a picture for every job and none besides.
    #[test]
    fn the_page_is_up_to_date() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let there = fs::read_to_string(root.join(PAGE)).unwrap_or_default();
        assert!(there == page(), "{PAGE} is out of date: run `cargo xtask docs`");
        let mut wanted: Vec<String> = JOBS.iter().map(|j| format!("{}.png", j.name)).collect();
        let files = fs::read_dir(root.join(PICTURES)).unwrap();
        let mut found: Vec<String> = files.map(|f| f.unwrap().file_name().into_string().unwrap()).collect();
        wanted.sort();
        found.sort();
        assert_eq!(wanted, found);
    }
}
