//! The memory of a batch does not grow with the number of inputs, except by their names.

use crate::{MEMORY, alone};
use pathwarp::deform::Registry;
use std::ffi::OsString;
use std::fs;
use std::path::Path;

/// Bytes that an input may add: its names and those of its outputs, in a few tables.
const PER_INPUT: usize = 2000;

/// A drawing that is quick to warp and larger than [`PER_INPUT`].
fn drawing() -> String {
    let comment = "x".repeat(4 * PER_INPUT);
    format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 9 9'><!-- {comment} --><path d='M1,1H8V8Z'/></svg>")
}

/// Warps `count` copies of a drawing, with a report, and returns the most bytes in use at any time.
fn peak(folder: &Path, count: usize) -> usize {
    let art = folder.join(format!("art{count}"));
    fs::create_dir(&art).unwrap();
    for i in 0..count {
        fs::write(art.join(format!("{i:05}.svg")), drawing()).unwrap();
    }
    let (out, report) = (folder.join(format!("out{count}")), folder.join(format!("{count}.json")));
    let mut args: Vec<OsString> =
        ["pathwarp", "warp", "--style", "flag", "-q", "-j", "2", "-r"].iter().map(OsString::from).collect();
    args.extend([art.into(), "--out-dir".into(), out.clone().into(), "--report".into(), report.into()]);
    MEMORY.reset_peak_usage();
    let _ = pathwarp_cli::run(&Registry::builtin(), args);
    assert_eq!(fs::read_dir(out).unwrap().count(), count);
    MEMORY.peak_usage()
}

#[test]
fn a_batch_is_not_held_in_memory() {
    let _alone = alone();
    let folder = tempfile::tempdir().unwrap();
    // A few hundred fill the buffers.
    let (few, many) = (peak(folder.path(), 300), peak(folder.path(), 3000));
    assert!(many < few + 2700 * PER_INPUT, "{few} bytes for 300 inputs, {many} for 3000");
}
