//! Stands in for plug-ins in a program that is built without them.

use crate::failure::Failure;
use crate::left_out;
use clap::Arg;
use pathwarp::deform::Registry;
use std::ffi::OsString;

/// No plug-ins.
pub(crate) struct Plugins;

pub(crate) fn option() -> Option<Arg> {
    None
}

pub(crate) fn load(_: &Registry, args: &[OsString], _: &[&str]) -> Result<(Vec<OsString>, Plugins), Failure> {
    let mut options = args.iter().take_while(|a| *a != "--").filter_map(|a| a.to_str());
    match options.find(|a| *a == "--plugin" || a.starts_with("--plugin=")).and_then(|_| left_out::missing("--plugin")) {
        Some(said) => Err(Failure::Usage(said)),
        None => Ok((args.to_vec(), Plugins)),
    }
}

impl Plugins {
    pub(crate) fn added_to(&self, registry: &Registry) -> Registry {
        registry.clone()
    }

    pub(crate) fn tell(&self) {}

    pub(crate) fn file(&self, _name: &str) -> Option<String> {
        None
    }

    pub(crate) fn options(&self) -> Vec<(String, String)> {
        Vec::new()
    }

    pub(crate) fn broken(&self) -> impl Iterator<Item = [String; 3]> {
        std::iter::empty()
    }

    pub(crate) fn failure(&self, _name: &str) -> Option<Failure> {
        None
    }
}
