//! The output file of each input.

use crate::failure::Failure;
use crate::input::svg_name;
use crate::options::CommonOptions;
use std::collections::HashSet;
use std::path::PathBuf;

/// The target of each input; `None` is standard output, or the copy that `--into` names. Creates the folder of `--out-dir`.
pub(super) fn targets(options: &CommonOptions, inputs: &[PathBuf]) -> Result<Vec<Option<PathBuf>>, Failure> {
    let Some(dir) = &options.out_dir else { return Ok(vec![options.out.clone(); inputs.len()]) };
    let mut out: Vec<Option<PathBuf>> = Vec::with_capacity(inputs.len());
    let mut taken = HashSet::with_capacity(inputs.len());
    for i in inputs {
        let name = i.file_name().filter(|n| *n != "-");
        let mut to = dir.join(name.ok_or_else(|| Failure::usage("--out-dir needs named inputs"))?);
        if let Some(name) = svg_name(i) {
            to.set_file_name(name);
        }
        if !taken.insert(to.clone()) {
            return Err(Failure::usage(format!("two inputs would both be written to {}", to.display())));
        }
        out.push(Some(to));
    }
    std::fs::create_dir_all(dir).map_err(|e| Failure::file(dir, format!("cannot be created: {e}")))?;
    Ok(out)
}
