//! A program as an entry of the registry.

use crate::entry::{Entry, Reserved, lines, read};
use crate::fault::Fault;
use crate::map::{Abilities, ProgramMap};
use crate::session::{Instance, Program, Protocol, Session};
use crate::{answer, binary, text};
use pathwarp::Error;
use pathwarp::deform::{Built, Deformation, Info};
use pathwarp::map::{CreaseKind, Map as _};
use pathwarp::param::{Axis, Settings};
use std::fmt;
use std::path::Path;
use std::sync::{Arc, OnceLock};

/// A program as a deformation.
#[derive(Clone)]
pub struct Plugin {
    info: &'static Info,
    version: u32,
    abilities: Abilities,
    program: Arc<Program>,
}

impl fmt::Debug for Plugin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Plugin").field("name", &self.info.name).field("version", &self.version).finish_non_exhaustive()
    }
}

impl Plugin {
    /// Starts the program at `path` and reads its entry. Also returns the entry's text.
    ///
    /// # Errors
    /// The program cannot be started, or its entry violates the protocol.
    pub fn start(path: &Path, reserved: Reserved<'_>) -> Result<(Self, String), Fault> {
        // The system would search PATH for a name without a folder.
        let path = path.canonicalize().map_err(|_| Fault::NoFile)?;
        let (session, text) = Session::start(&path)?;
        let entry = read(&text, reserved)?;
        Ok((Self::new(&path, &entry, Some(session)), String::from_utf8_lossy(&text).into_owned()))
    }

    /// Makes a plug-in of the program at `path` from its known entry, without starting it.
    ///
    /// # Errors
    /// The entry violates the protocol.
    pub(crate) fn known(path: &Path, text: &str, reserved: Reserved<'_>) -> Result<Self, Fault> {
        Ok(Self::new(path, &read(text.as_bytes(), reserved)?, None))
    }

    fn new(path: &Path, entry: &Entry, running: Option<Session>) -> Self {
        let program = Arc::new(Program::new(path.to_owned(), entry.protocol, running));
        Self { info: entry.info, version: entry.version, abilities: entry.abilities, program }
    }

    /// The file of the program.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.program.path
    }

    /// The end of what the running program has written to standard error, on one line.
    #[must_use]
    pub fn said(&self) -> Option<String> {
        self.program.said()
    }

    /// Whether the program gives derivatives itself.
    #[must_use]
    pub fn gives_jacobian(&self) -> bool {
        self.abilities.jacobian
    }

    /// Whether the program gives the inverse itself.
    #[must_use]
    pub fn gives_inverse(&self) -> bool {
        self.abilities.inverse
    }
}

impl Deformation for Plugin {
    fn info(&self) -> &Info {
        self.info
    }

    fn build(&self, settings: &Settings<'_>) -> Result<Built, Error> {
        let frame = settings.frame();
        let lines = lines(self.info.params, settings, self.version)?;
        let request = match self.program.protocol {
            Protocol::Text => text::build(&lines),
            Protocol::Binary => binary::build(&lines).map_err(|fault| fault.of(&self.program.path))?,
        };
        let instance = Arc::new(Instance::new(request));
        let refused = |fault: Fault| match fault {
            Fault::Refused(why) => Error::input(self.info.name, why),
            fault => fault.of(&self.program.path),
        };
        let answer = self.program.build(&instance).map_err(refused)?;
        let creases = answer::creases(&answer.creases).map_err(refused)?;
        if creases.items().iter().any(|c| c.kind == CreaseKind::Kink) && !self.abilities.jacobian {
            let why = "it declares creases but no derivatives (\"jacobian\": true), and differences would cross them";
            return Err(Fault::Entry(why.to_owned()).of(&self.program.path));
        }
        let (program, abilities) = (Arc::clone(&self.program), self.abilities);
        let failed = Arc::new(OnceLock::new());
        let size = frame.extent(Axis::Diagonal).max(f64::MIN_POSITIVE);
        let (detail, failed_here) = (answer.detail, Arc::clone(&failed));
        let map = ProgramMap { program, instance, abilities, creases, detail, size, failed: failed_here };
        let mut built = Built::new(Arc::new(map.clone()));
        if abilities.partial {
            let unknown = move |p| (!map.point(p).is_finite()).then(|| "the plug-in gives no numbers there".to_owned());
            built.undefined = Some(Arc::new(unknown));
        }
        answer.notes.into_iter().for_each(|n| built.note(n));
        answer.warnings.into_iter().for_each(|w| built.warn(w));
        let path = self.program.path.clone();
        built.failure = Some(Arc::new(move || failed.get().map(|fault: &Fault| fault.of(&path))));
        Ok(built)
    }
}
