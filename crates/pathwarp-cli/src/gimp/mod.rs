//! GIMP's files as inputs and as places that path references lead to.

mod warp;

pub(crate) use warp::warp;

use crate::failure::Failure;
use crate::reference;
use pathwarp::Error;
use pathwarp_gimp::{GimpPath, sniff};
use std::fs::File;
use std::path::{Path, PathBuf};

/// A file of GIMP's, and which of its paths are meant.
pub(crate) struct Input {
    pub(crate) path: PathBuf,
    pub(crate) file: pathwarp_gimp::File,
    /// The one path that the input's `#NAME` means; `None`: all.
    pub(crate) only: Option<String>,
    /// What is wrong behind the paths that were salvaged.
    pub(crate) damage: Option<String>,
}

impl Input {
    /// The file behind an input `FILE` or `FILE#NAME`, if it is one of GIMP's.
    pub(crate) fn open(input: &Path, salvage: bool) -> Result<Option<Self>, Failure> {
        let text = input.to_string_lossy();
        let (file, name) = match text.as_ref() {
            "-" => return Ok(None),
            _ if input.is_file() => (input.to_owned(), None),
            text => reference::split(text),
        };
        let Some(mut found) = Self::at(&file, salvage)? else { return Ok(None) };
        if let Some(name) = name {
            found.named(name)?;
            found.only = Some(name.to_owned());
        }
        Ok(Some(found))
    }

    /// The file `path`, if it is one of GIMP's. Only what is needed of it is read.
    pub(crate) fn at(path: &Path, salvage: bool) -> Result<Option<Self>, Error> {
        // Pipes cannot be looked into twice.
        if !path.is_file() {
            return Ok(None);
        }
        let name = path.display().to_string();
        let open = || File::open(path).map_err(|e| Error::input(name.clone(), format!("cannot be read: {e}")));
        // Something else under the name of an XCF gets that reader's error.
        if !sniff(open()?) && !is_called_xcf(path) {
            return Ok(None);
        }
        let place =
            |e: pathwarp_gimp::Error, hint: &str| Error::input(format!("{name}, byte {}", e.offset), e.problem + hint);
        let found = pathwarp_gimp::salvage(open()?).map_err(|e| place(e, ""))?;
        let damage = match found.damage {
            Some(e) if !salvage => {
                let hint = match found.file.paths.len() {
                    0 => "; no path stands before the damage".to_owned(),
                    1 => "; --salvage takes the path before the damage".to_owned(),
                    n => format!("; --salvage takes the {n} paths before the damage"),
                };
                return Err(place(e, &hint));
            }
            other => other.map(|e| format!("damaged, and read only so far: {e}")),
        };
        Ok(Some(Self { path: path.to_owned(), file: found.file, only: None, damage }))
    }

    /// The path of this name.
    pub(crate) fn named(&self, name: &str) -> Result<&GimpPath, Error> {
        let found = self.file.paths.iter().find(|p| p.name == name);
        found.ok_or_else(|| {
            let place = format!("{}#{name}", self.path.display());
            Error::input(place, format!("there is no path of this name; {}", self.names()))
        })
    }

    /// The only path of the file.
    pub(crate) fn only(&self) -> Result<&GimpPath, Error> {
        match self.file.paths.as_slice() {
            [only] => Ok(only),
            paths => {
                let file = self.path.display();
                let problem = format!("holds {} paths; say which: {file}#NAME; {}", paths.len(), self.names());
                Err(Error::input(file.to_string(), problem))
            }
        }
    }

    fn names(&self) -> String {
        /// As many names as fit a line or two.
        const SHOWN: usize = 12;
        let names: Vec<&str> = self.file.paths.iter().map(|p| p.name.as_str()).take(SHOWN).collect();
        match self.file.paths.len() {
            0 => "the file has no paths".to_owned(),
            n if n > SHOWN => format!("among the {n} paths are {}", names.join(", ")),
            _ => format!("the paths are {}", names.join(", ")),
        }
    }

    /// The paths that are meant.
    pub(crate) fn meant(&self) -> impl Iterator<Item = &GimpPath> {
        self.file.paths.iter().filter(|p| self.only.as_ref().is_none_or(|name| *name == p.name))
    }

    /// The canvas, or what holds all paths where the file does not tell.
    pub(crate) fn canvas(&self) -> [f64; 2] {
        self.file.size.unwrap_or_else(|| {
            let boxes = self.file.paths.iter().filter_map(GimpPath::bounds);
            boxes.fold([1.0, 1.0], |[w, h], b| [w.max(b[2].ceil()), h.max(b[3].ceil())])
        })
    }
}

fn is_called_xcf(path: &Path) -> bool {
    let name = path.to_string_lossy().to_ascii_lowercase();
    [".xcf", ".xcf.gz", ".xcf.bz2", ".xcf.xz"].iter().any(|e| name.ends_with(e))
}

/// Whether these are the bytes of an XCF.
pub(crate) fn is_xcf(bytes: &[u8]) -> bool {
    bytes.starts_with(b"gimp xcf ")
}

/// Whether a result of this name is to be a point list or an XCF.
pub(crate) fn is_form_of_gimps(path: &Path) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case("json") || e.eq_ignore_ascii_case("xcf"))
}

/// What the SVG made from an input of GIMP's is called: `art.xcf.gz#Cage` gives `art-Cage.svg`.
pub(crate) fn svg_name(input: &Path) -> Option<String> {
    const ENDINGS: [&str; 6] = [".xcf", ".xcf.gz", ".xcf.bz2", ".xcf.xz", ".json", ".txt"];
    let text = input.to_string_lossy();
    let (file, name) = if input.is_file() { (input.to_owned(), None) } else { reference::split(&text) };
    let file = file.file_name()?.to_string_lossy().into_owned();
    let stem = ENDINGS.iter().rev().find_map(|e| file.strip_suffix(e))?;
    Some(match name {
        Some(name) => format!("{stem}-{}.svg", file_name(name)),
        None => format!("{stem}.svg"),
    })
}

/// A path's name as a part of a file's: letters and digits of any script, the rest as hyphens.
pub(crate) fn file_name(name: &str) -> String {
    let plain = name.chars().map(|c| if c.is_alphanumeric() || matches!(c, '_' | '.' | '-') { c } else { '-' });
    plain.collect::<String>().trim_matches(['-', '.']).to_owned()
}
