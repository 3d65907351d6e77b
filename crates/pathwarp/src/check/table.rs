//! The description of a deformation: its names, texts, and the defaults of its parameters.

use super::frame::frame;
use super::outcome::Check;
use crate::deform::Deformation;
use crate::param::{Args, Kind, Settings};

fn is_kebab(name: &str) -> bool {
    !name.is_empty()
        && name.split('-').all(|w| !w.is_empty() && w.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit()))
}

/// The texts for people.
pub(super) fn help(entry: &dyn Deformation) -> Check {
    let info = entry.info();
    let mut faults = Check::new("help");
    faults.detail = format!("title, group, about, source, {} examples", info.examples.len());
    if !is_kebab(info.name) {
        faults.fault("its name is not kebab-case");
    }
    if info.title.is_empty() || info.about.is_empty() || info.source.is_empty() || info.group.is_empty() {
        faults.fault("has an empty title, group, about or source");
    }
    if info.examples.len() < 2 {
        faults.fault("has fewer than two examples");
    }
    let is_path = |name: &&'static str| info.params.iter().any(|p| p.name == *name && p.kind == Kind::Path);
    if !info.guides.params.iter().all(is_path) || info.guides.usual > info.guides.params.len() {
        faults.fault("its guides are not path parameters, or fewer than is usual");
    }
    faults
}

/// The parameters and their defaults.
pub(super) fn parameters(entry: &dyn Deformation) -> Check {
    let info = entry.info();
    let mut faults = Check::new("parameters");
    faults.detail = info.params.iter().map(|p| p.name).collect::<Vec<_>>().join(", ");
    let mut names = Vec::new();
    for p in info.params {
        if !is_kebab(p.name) || names.contains(&p.name) {
            faults.fault(format!("{} is not a new kebab-case name", p.name));
        }
        names.push(p.name);
        if !p.help.ends_with('.') {
            faults.fault(format!("{}: its help does not end with a full stop", p.name));
        }
        if p.needed && p.default.is_some() {
            faults.fault(format!("{} is needed and has a default", p.name));
        }
        let (least, most) = p.range;
        if p.ui.0 < least || p.ui.1 > most || p.ui.0 >= p.ui.1 {
            faults.fault(format!("{}: its slider is outside its range", p.name));
        }
        if p.default.is_some() {
            let (args, frame) = (Args::new(), frame());
            // Only the getters are used, so that required parameters may be missing.
            let s = Settings::new(std::slice::from_ref(p), &args, &frame);
            let got = s.and_then(|s| match p.kind {
                Kind::Flag => s.flag(p.name).map(|_| ()),
                Kind::Numbers(_) => s.numbers_if(p.name).map(|_| ()),
                Kind::Point => s.point(p.name).map(|_| ()),
                Kind::Path => s.path_if(p.name).map(|_| ()),
                Kind::Choice(_) => s.choice(p.name).map(|_| ()),
                Kind::Text(_) | Kind::Save => Ok(()),
                Kind::File | Kind::NameOrFile(_) => s.file_if(p.name).map(|_| ()),
                Kind::Number | Kind::Length(_) | Kind::Angle | Kind::Count => s.number(p.name).map(|_| ()),
            });
            if let Err(e) = got {
                faults.fault(format!("{}: its default is not valid: {e}", p.name));
            }
        }
    }
    faults
}
