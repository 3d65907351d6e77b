//! Functions of the host program as deformations.

use pathwarp::Error;
use pathwarp::deform::{Built, Deformation, Info};
use pathwarp::engine::{Abilities, Called, Callee};
use pathwarp::param::{Axis, Settings};
use std::sync::{Arc, Mutex, PoisonError};

/// A function, registered as a deformation without parameters. Its name cannot be typed.
pub(super) struct Function {
    info: Info,
    callee: Arc<dyn Callee>,
    abilities: Abilities,
}

/// The count of names made so far, and those free for reuse. Names are leaked, since descriptions hold static texts.
static UNUSED: Mutex<(usize, Vec<&'static str>)> = Mutex::new((0, Vec::new()));

/// Prefix of the names of functions.
const PREFIX: &str = "function #";

impl Function {
    pub(super) fn new(callee: Arc<dyn Callee>, abilities: Abilities) -> Self {
        let mut unused = UNUSED.lock().unwrap_or_else(PoisonError::into_inner);
        let name = unused.1.pop().unwrap_or_else(|| {
            unused.0 += 1;
            format!("{PREFIX}{}", unused.0).leak()
        });
        Self { info: Info::new(name, "a function of this program"), callee, abilities }
    }
}

impl Drop for Function {
    fn drop(&mut self) {
        UNUSED.lock().unwrap_or_else(PoisonError::into_inner).1.push(self.info.name);
    }
}

impl Deformation for Function {
    fn info(&self) -> &Info {
        &self.info
    }

    fn build(&self, settings: &Settings<'_>) -> Result<Built, Error> {
        let size = settings.frame().extent(Axis::Diagonal);
        let map = Called::new(Arc::clone(&self.callee), self.abilities.clone(), size);
        Ok(Built::called(map, "the function gives no numbers there"))
    }
}

/// Returns `true` for the name of a function, which no file can describe.
pub(super) fn is_function(name: &str) -> bool {
    name.starts_with(PREFIX)
}
