//! Images in a drawing: embedded and linked ones, bitmaps and drawings. All of them share the budget of the drawing, and links
//! are followed only where the user allows it.

use super::fonts::Missing;
use super::read::{self, ReadOptions};
use super::{check, range, xml};
use pathwarp::Error;
use pathwarp::budget::Limit;
use std::fs::File;
use std::io::Read as _;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

/// Scheme of embedded data.
pub(crate) const DATA: &str = "data:";

/// Media type of data whose format is detected from its content.
const ANY: &str = "text/plain";

/// The error of the first image that exceeds the limits.
pub(super) type Rejected = Arc<Mutex<Option<Error>>>;

/// Resolves images, within the limits of the drawing itself.
pub(super) fn resolver<'a>(
    name: &'a str,
    options: &'a ReadOptions,
    rejected: &Rejected,
    unread: &Missing,
) -> usvg::ImageHrefResolver<'a> {
    let [unread_data, unread_files] = [unread.clone(), unread.clone()];
    let record = |unread: &Missing, link: String| {
        if let Ok(mut u) = unread.lock() {
            u.insert(link);
        }
    };
    let rejected = rejected.clone();
    let decode = usvg::ImageHrefResolver::default_data_resolver();
    let load = Arc::new(move |mime: &str, data: Arc<Vec<u8>>, what: &str, usvg: &usvg::Options<'_>| {
        match checked(mime, data, &format!("{name}: {what}"), options) {
            Ok(data) => decode(mime, data, usvg),
            Err(e) => {
                if let Ok(mut r) = rejected.lock() {
                    r.get_or_insert(e);
                }
                None
            }
        }
    });
    let load_file = load.clone();
    usvg::ImageHrefResolver {
        resolve_data: Box::new(move |mime, data, usvg| {
            let image = load(mime, data, "the picture in an image", usvg);
            // The type identifies the link, so one that several images share must not be recorded.
            if image.is_none() && !matches!(mime, SVG | ANY) {
                record(&unread_data, format!("{DATA}{mime}"));
            }
            image
        }),
        resolve_string: Box::new(move |link, usvg| {
            let image = linked(link, options).and_then(|data| load_file(ANY, Arc::new(data), link, usvg));
            if image.is_none() {
                record(&unread_files, link.to_owned());
            }
            image
        }),
    }
}

/// Media type of drawings.
const SVG: &str = "image/svg+xml";

/// Counts an image in the budget. A drawing among them is returned as usvg may read it: unpacked, with numbers in range.
fn checked(mime: &str, data: Arc<Vec<u8>>, place: &str, options: &ReadOptions) -> Result<Arc<Vec<u8>>, Error> {
    let budget = &options.budget;
    let counted = budget.spend(Limit::ImageBytes, data.len() as u64);
    counted.map_err(|e| Error::limit(place, "with the images before it, it takes", e))?;
    if !matches!(mime, SVG | ANY) {
        return Ok(data);
    }
    let text = match read::text(&data, place, budget) {
        Ok(text) => text,
        Err(e @ Error::Limit { .. }) => return Err(e),
        // Not a drawing; leave the rest to usvg.
        Err(_) => return Ok(data),
    };
    match xml::parse(&text, place, budget) {
        Ok(xml) => {
            check::drawing(&xml, place, budget)?;
            let text = range::replaced(&xml, place)?.unwrap_or(text);
            Ok(Arc::new(text.into_bytes()))
        }
        Err(e @ Error::Limit { .. }) => Err(e),
        Err(_) => Ok(data),
    }
}

/// Reads a linked image. A link may name anything in the file system, so only plain files in allowed places and up to a limit
/// are read.
fn linked(link: &str, options: &ReadOptions) -> Option<Vec<u8>> {
    let file = allowed(Path::new(link), options)?;
    let size = std::fs::metadata(&file).ok().filter(std::fs::Metadata::is_file)?.len();
    // Larger files are recorded as unread.
    options.budget.check(Limit::ImageBytes, size as f64).ok()?;
    let mut data = Vec::new();
    File::open(file).ok()?.take(size).read_to_end(&mut data).ok()?;
    Some(data)
}

/// The file that a link names, if it may be read: one in the base folder or below it, symbolic links followed. Without a base
/// folder, links are not followed at all.
fn allowed(link: &Path, options: &ReadOptions) -> Option<PathBuf> {
    let base = options.base_dir.as_ref()?;
    let file = base.join(link);
    if options.external {
        return Some(file);
    }
    if link.has_root() || link.is_absolute() {
        return None;
    }
    let (file, base) = (file.canonicalize().ok()?, base.canonicalize().ok()?);
    file.starts_with(base).then_some(file)
}
