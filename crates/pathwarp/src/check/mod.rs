//! Checks of any deformation: its table, derivatives, exact images, laws and known values.
//!
//! Authors of plug-ins call [`entry`] in a test:
//!
//! ```
//! let registry = pathwarp::deform::Registry::builtin();
//! let faults = pathwarp::check::entry(registry.get("projective").unwrap().as_ref());
//! assert!(faults.is_empty(), "{faults:#?}");
//! ```
//!
//! [`report`] gives the same check by check, for people.

mod frame;
mod laws;
mod maps;
mod outcome;
mod table;
#[cfg(test)]
mod tests;

pub use frame::frame;
pub use outcome::Check;

use crate::deform::Deformation;
use crate::param::Args;

/// Returns a message for every fault of `entry`; none if it is sound.
#[must_use]
pub fn entry(entry: &dyn Deformation) -> Vec<String> {
    let name = entry.info().name;
    report(entry).into_iter().flat_map(|c| c.faults).map(|fault| format!("{name}: {fault}")).collect()
}

/// Runs every check of `entry`.
#[must_use]
pub fn report(entry: &dyn Deformation) -> Vec<Check> {
    let mut checks = vec![table::help(entry), table::parameters(entry)];
    let mut build = Check::new("build");
    match entry.build_from(&Args::from_pairs(entry.info().demo), &frame()) {
        Ok(built) => {
            build.detail = "from the defaults and the demo".into();
            checks.push(build);
            checks.extend(maps::all(&built));
            if checks.last().is_some_and(|c| !c.faults.is_empty() && c.name == "values") {
                return checks;
            }
        }
        Err(e) => {
            build.fault(format!("does not build from its defaults and demo: {e}"));
            checks.push(build);
        }
    }
    checks.extend([laws::laws(entry), laws::cases(entry)]);
    checks
}
