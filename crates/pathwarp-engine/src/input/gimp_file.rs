//! GIMP files (XCF, plain or packed; exported SVG, GIMP 1 text, point lists in JSON), read for their paths: as artwork, and for references.

use super::files::{is_named_xcf, split_reference};
use crate::failure::Failure;
use pathwarp::Error;
use pathwarp::budget::Limits;
use pathwarp_gimp::{GimpPath, sniff};
use std::fs::File;
use std::path::{Path, PathBuf};

/// A GIMP file, or one path of it.
pub struct GimpFile {
    pub(crate) path: PathBuf,
    pub(crate) file: pathwarp_gimp::PathFile,
    /// The name of the only path to take, from `FILE#NAME`; `None` selects all paths.
    pub(crate) only: Option<String>,
    /// A warning of the damage before which reading stopped.
    pub damage: Option<String>,
}

impl GimpFile {
    /// Opens the input `FILE` or `FILE#NAME`. Returns `None` if it is not a GIMP file.
    pub fn open(input: &Path, salvage: bool, limits: &Limits) -> Result<Option<Self>, Failure> {
        let text = input.to_string_lossy();
        let (file, name) = match text.as_ref() {
            "-" => return Ok(None),
            _ if input.is_file() => (input.to_owned(), None),
            text => split_reference(text),
        };
        let Some(mut found) = Self::read(&file, salvage, limits)? else { return Ok(None) };
        if let Some(name) = name {
            found.path_named(name)?;
            found.only = Some(name.to_owned());
        }
        Ok(Some(found))
    }

    /// Reads the paths of the file `path`, and little else. Returns `None` if it is not a GIMP file.
    pub fn read(path: &Path, salvage: bool, limits: &Limits) -> Result<Option<Self>, Error> {
        // A pipe can be read only once, so it is not probed.
        if !path.is_file() {
            return Ok(None);
        }
        let name = path.display().to_string();
        let open = || File::open(path).map_err(|e| Error::input(name.clone(), format!("cannot be read: {e}")));
        // A file that is only named like an XCF gets the XCF reader's error.
        if !sniff(open()?) && !is_named_xcf(path) {
            return Ok(None);
        }
        let at_byte = |e: pathwarp_gimp::Error, advice: &str| Error::Input {
            place: format!("{name}, byte {}", e.offset),
            problem: e.problem + advice,
            limit: e.limit,
        };
        let found = pathwarp_gimp::salvage_within(open()?, limits).map_err(|e| at_byte(e, ""))?;
        let damage = match found.damage {
            Some(e) if !salvage => {
                let advice = match found.file.paths.len() {
                    0 => "; there is no path before the damage".to_owned(),
                    1 => "; --salvage reads the path before the damage".to_owned(),
                    n => format!("; --salvage reads the {n} paths before the damage"),
                };
                return Err(at_byte(e, &advice));
            }
            damage => damage.map(|e| format!("damaged; only the paths before the damage were read: {e}")),
        };
        Ok(Some(Self { path: path.to_owned(), file: found.file, only: None, damage }))
    }

    /// Returns the path called `name`.
    pub(crate) fn path_named(&self, name: &str) -> Result<&GimpPath, Error> {
        let found = self.file.paths.iter().find(|p| p.name == name);
        found.ok_or_else(|| {
            let place = format!("{}#{name}", self.path.display());
            Error::input(place, format!("there is no path of this name; {}", self.names()))
        })
    }

    /// Returns the only path of the file.
    pub(crate) fn only_path(&self) -> Result<&GimpPath, Error> {
        match self.file.paths.as_slice() {
            [only] => Ok(only),
            paths => {
                let file = self.path.display();
                let problem = format!("holds {} paths; name one of them: {file}#NAME; {}", paths.len(), self.names());
                Err(Error::input(file.to_string(), problem))
            }
        }
    }

    /// Lists the names of the paths.
    fn names(&self) -> String {
        /// Number of names that fit in two lines.
        const SHOWN: usize = 12;
        let names: Vec<&str> = self.file.paths.iter().map(|p| p.name.as_str()).take(SHOWN).collect();
        match self.file.paths.len() {
            0 => "the file has no paths".to_owned(),
            n if n > SHOWN => format!("among the {n} paths are {}", names.join(", ")),
            _ => format!("the paths are {}", names.join(", ")),
        }
    }

    /// Returns the path that `FILE#NAME` names, or all paths.
    pub fn paths(&self) -> impl Iterator<Item = &GimpPath> {
        self.file.paths.iter().filter(|p| self.only.as_ref().is_none_or(|name| *name == p.name))
    }

    /// Returns width and height of the canvas. If the file does not store them, they are those of a box from the origin around all paths.
    pub fn canvas(&self) -> [f64; 2] {
        self.file.size.unwrap_or_else(|| {
            let boxes = self.file.paths.iter().filter_map(GimpPath::bounds);
            boxes.fold([1.0, 1.0], |[w, h], b| [w.max(b[2].ceil()), h.max(b[3].ceil())])
        })
    }
}
