//! Plug-ins that are separate programs, in the user's folder or in given files.

use crate::errors::usage;
use pathwarp::deform::{Deformation, Registry};
use pathwarp_engine::reserved_names;
use pathwarp_plugin::{Broken, Reserved};
use pyo3::prelude::*;
use std::path::PathBuf;
use std::sync::Arc;

/// Returns the deformations with the plug-ins in `files`, and those of the user's folder if one of `names` is not built in.
pub(crate) fn registry(py: Python<'_>, files: &[PathBuf], names: &[&str]) -> PyResult<Registry> {
    let mut registry = Registry::builtin();
    let is_known = |registry: &Registry, name: &str| {
        registry.get(&name.to_ascii_lowercase()).is_some() || pathwarp_engine::preset(registry, name).is_some()
    };
    if files.is_empty() && names.iter().all(|name| is_known(&registry, name)) {
        return Ok(registry);
    }
    let built_in = registry.clone();
    let own: Vec<&str> = built_in.entries().iter().map(|e| e.info().name).collect();
    let parameters: Vec<&str> = reserved_names().collect();
    let reserved = Reserved { names: &own, parameters: &parameters };
    for file in files {
        let started = py.detach(|| pathwarp_plugin::by_file(file, reserved));
        registry = registry.with(started.map_err(|fault| usage(py, &fault.of(file).to_string()))?);
    }
    if names.iter().any(|name| !is_known(&registry, name)) {
        let found = py.detach(|| pathwarp_plugin::installed(reserved, None));
        let is_wanted = |b: &&Broken| names.contains(&b.name.as_str());
        if let Some(broken) = found.broken.iter().find(is_wanted) {
            return Err(usage(py, &broken.fault.of(&broken.path).to_string()));
        }
        let installed = found.plugins.into_iter().map(|p| Arc::new(p) as Arc<dyn Deformation>);
        registry = registry.joined(&Registry::new(installed.collect()));
    }
    Ok(registry)
}
