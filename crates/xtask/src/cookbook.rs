//! Pages of jobs: each one command on a sample, with its picture. Here is `docs/cookbook.md`.

use crate::Fault;
use crate::docs;
use crate::lettering;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// A page of jobs.
pub(crate) struct Page {
    /// Where it lies.
    pub(crate) file: &'static str,
    /// Where its pictures lie, as the page sees them.
    pub(crate) pictures: &'static str,
    /// Title and what stands before the jobs.
    pub(crate) intro: &'static str,
    pub(crate) jobs: &'static [Job],
}

/// All of them.
const PAGES: [&Page; 2] = [&COOKBOOK, &lettering::PAGE];

const COOKBOOK: Page = Page {
    file: "docs/cookbook.md",
    pictures: "images/cookbook",
    intro: "# Cookbook\n\nReal jobs, each one line, on words or on a drawing of [samples](../samples). The pictures show the artwork, and the result \
with its guides. `--fit grow` makes room on the page where the result needs it, `--fit page` makes the page the result's box. [Lettering on paths](lettering-on-paths.md) has a page of its own. Made by `cargo xtask docs`.\n",
    jobs: JOBS,
};

/// A job: one more is one more entry of [`JOBS`].
pub(crate) struct Job {
    /// The picture's file name, kebab-case.
    pub(crate) name: &'static str,
    pub(crate) title: &'static str,
    /// One paragraph.
    pub(crate) text: &'static str,
    /// The words after `pathwarp`, run from the project's root, `-o out.svg` included.
    pub(crate) command: &'static str,
}

const JOBS: &[Job] = &[
    Job {
        name: "badge",
        title: "Lettering round a badge",
        text: "Words set in a font stand with their baseline on an arc, scaled to its length. `--fit page` makes the page theirs.",
        command: "text 'HARBOUR COFFEE' --letter-spacing 6% --fill '#5d3a1a' | pathwarp bend - --along 'M10,250 A330,330 0 0 1 526,250' --stretch scale --fit page -o out.svg",
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
        text: "Flat below, arched above. `--frame` is the box from the baseline to the capitals' height, so that the baseline becomes the flat side and \
tails hang below it. With `--keep verticals` uprights stay upright and letters keep their even widths.",
        command: "text 'Rugby Club' --fill '#1b5e20' | pathwarp envelope - --frame baseline-capheight --bottom 'M20,180 H516' --top 'M20,110 Q268,-80 516,110' --keep verticals --fit page -o out.svg",
    },
    Job {
        name: "wine-label",
        title: "A label as it looks on the bottle",
        text: "Seen a little from above, level lines on a bottle are arcs of ellipses: one below, the same above. Uprights stay upright.",
        command: "envelope samples/logo.svg --bottom 'M60,170 A310,60 0 0 0 604,170' --height 150 --keep verticals --fit grow -o out.svg",
    },
    Job {
        name: "bucket",
        title: "Artwork for a tapered bucket",
        text: "Laid flat, a band round a bucket or a paper cup is part of a ring. The eye is a metre in front of it, and the result is \
true to size.",
        command: "anamorph samples/logo.svg --distance 1m --onto cone:top=120mm,bottom=85mm,height=160mm --fit page -o out.svg",
    },
    Job {
        name: "mug",
        title: "A badge that looks flat on a mug",
        text: "The print for a mug of 42 mm radius which, seen from half a metre, shows the badge undistorted.",
        command: "anamorph samples/badge.svg --distance 50cm --onto cylinder:radius=42mm --fit grow -o out.svg",
    },
    Job {
        name: "road-marking",
        title: "A word painted on the road",
        text: "Thrown onto the floor, letters grow long towards the top; from the eye's place they look as drawn. The result is what to \
paint, true to size. Lengths may have units: `--eye-height 1.2m --distance 20m --length 10m` is a driver's view.",
        command: "anamorph samples/lettering.svg --eye-height 300 --distance 500 --onto plane:floor --fit page -o out.svg",
    },
    Job {
        name: "sign",
        title: "A sign in perspective",
        text: "Four corners to four places of a photograph or a sketch. Straight lines stay straight, and keep their two nodes.",
        command: "projective samples/logo.svg --target '0%,120% 100%,90% 100%,10% 0%,-40%' --fit grow -o out.svg",
    },
    Job {
        name: "nameplate",
        title: "A drawing on a nameplate for the laser",
        text: "Line art fills a rounded plate; `--strokes keep` leaves the lines what they are, centre lines with their width, as \
laser cutters and engravers want them. A rounded box has no corners by angle: they are taken in the middle of its roundings.",
        command: "envelope samples/lineart.svg --envelope 'M34,40 H326 A34,34 0 0 1 360,74 V204 A34,34 0 0 1 326,238 H34 A34,34 0 0 1 0,204 V74 A34,34 0 0 1 34,40 Z' --strokes keep --fit grow -o out.svg",
    },
    Job {
        name: "oval",
        title: "A word in an oval",
        text: "An ellipse has no corners: they are taken where it comes nearest to the corners of its box, on the diagonals.",
        command: "envelope samples/lettering.svg --envelope 'M526,95 A258,130 0 1 1 10,95 A258,130 0 1 1 526,95 Z' --fit grow -o out.svg",
    },
    Job {
        name: "valentine",
        title: "A word in a heart",
        text: "The heart's two tips are no corners of the word: it fills the lobes above and narrows to the tip below.",
        command: "envelope samples/lettering.svg --envelope 'M268,60 C310,-50 500,-40 520,90 C536,200 360,260 268,330 C176,260 0,200 16,90 C36,-40 226,-50 268,60 Z' --fit grow -o out.svg",
    },
    Job {
        name: "headline",
        title: "A rising headline",
        text: "One curve and a height: the same curve is the top. The word climbs and its uprights stay upright.",
        command: "envelope samples/lettering.svg --bottom 'M10,240 C160,240 200,150 290,140 S420,170 526,60' --height 130 --keep verticals --fit grow -o out.svg",
    },
    Job {
        name: "wreath",
        title: "A wreath of monograms",
        text: "Copies of the artwork all round a circle, as many as it has room for, spread evenly.",
        command: "bend samples/monogram.svg --along 'M-230,130 A360,360 0 1 1 490,130 A360,360 0 1 1 -230,130 Z' --stretch repeat --gap 12% --fit page -o out.svg",
    },
    Job {
        name: "ball",
        title: "A badge on a ball",
        text: "A bulge blows up the middle and leaves what is around it.",
        command: "bulge samples/badge.svg --amount 0.8 --fit grow -o out.svg",
    },
];

/// Writes the pages and draws their pictures; gives the number of jobs.
pub(crate) fn run(root: &Path, program: &Path) -> Result<usize, Fault> {
    for p in PAGES {
        let pictures = p.folder(root);
        fs::create_dir_all(&pictures).map_err(|e| format!("{}: {e}", pictures.display()))?;
        fs::write(root.join(p.file), p.text()).map_err(|e| format!("{}: {e}", p.file))?;
        for job in p.jobs {
            docs::picture(root, program, job.command, &pictures.join(format!("{}.png", job.name)))?;
        }
    }
    Ok(PAGES.iter().map(|p| p.jobs.len()).sum())
}

/// The command of every job, without its `pathwarp`.
pub(crate) fn commands() -> impl Iterator<Item = &'static str> {
    PAGES.iter().flat_map(|p| p.jobs).map(|j| j.command)
}

impl Page {
    fn folder(&self, root: &Path) -> PathBuf {
        root.join("docs").join(self.pictures)
    }

    fn text(&self) -> String {
        let mut out = String::from(self.intro);
        for job in self.jobs {
            let Job { name, title, text, command } = job;
            let _ = write!(
                out,
                "\n## {title}\n\n![{title}]({}/{name}.png)\n\n{text}\n\n```sh\npathwarp {command}\n```\n",
                self.pictures
            );
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The pages in the repository are those that would be made now, with a picture for every job and none besides.
    #[test]
    fn the_pages_are_up_to_date() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        for p in PAGES {
            let there = fs::read_to_string(root.join(p.file)).unwrap_or_default();
            assert!(there == p.text(), "{} is out of date: run `cargo xtask docs`", p.file);
            let mut wanted: Vec<String> = p.jobs.iter().map(|j| format!("{}.png", j.name)).collect();
            let files = fs::read_dir(p.folder(&root)).unwrap();
            let mut found: Vec<String> = files.map(|f| f.unwrap().file_name().into_string().unwrap()).collect();
            wanted.sort();
            found.sort();
            assert_eq!(wanted, found);
        }
    }
}
