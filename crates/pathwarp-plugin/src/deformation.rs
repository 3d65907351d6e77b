//! A program as an entry of the registry.

use crate::entry::{Entry, Reserved, lines, read};
use crate::fault::Fault;
use crate::session::{Instance, Program, Protocol, Session};
use crate::{binary, text};
use pathwarp::Error;
use pathwarp::deform::{Built, Deformation, Info};
use pathwarp::engine::{Abilities, Ask, Called, Callee};
use pathwarp::kurbo::Point;
use pathwarp::param::{Axis, Settings};
use std::fmt;
use std::path::Path;
use std::sync::Arc;

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
    /// A [`Fault`], such as [`Fault::NotStarted`], when the program cannot be started; [`Fault::Entry`] when its entry breaks the protocol.
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
    /// [`Fault::Entry`] or another [`Fault`] when the entry breaks the protocol.
    pub(crate) fn known(path: &Path, text: &str, reserved: Reserved<'_>) -> Result<Self, Fault> {
        Ok(Self::new(path, &read(text.as_bytes(), reserved)?, None))
    }

    fn new(path: &Path, entry: &Entry, running: Option<Session>) -> Self {
        let program = Arc::new(Program::new(path.to_owned(), entry.protocol, running));
        Self { info: entry.info, version: entry.version, abilities: entry.abilities.clone(), program }
    }

    /// Returns the file of the program.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.program.path
    }

    /// Returns the end of the running program's standard error, on one line.
    #[must_use]
    pub fn said(&self) -> Option<String> {
        self.program.said()
    }

    /// Returns `true` if the program computes derivatives.
    #[must_use]
    pub fn gives_jacobian(&self) -> bool {
        self.abilities.jacobian
    }

    /// Returns `true` if the program computes the inverse.
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
        let lines = lines(self.info.params, settings, self.version)?;
        let request = match self.program.protocol {
            Protocol::Text => text::build(&lines),
            Protocol::Binary => binary::build(&lines).map_err(|fault| fault.of(&self.program.path))?,
        };
        let instance = Instance::new(request);
        let refused = |fault: Fault| match fault {
            Fault::Refused(why) => Error::input(self.info.name, why),
            fault => fault.of(&self.program.path),
        };
        let answer = self.program.build(&instance).map_err(refused)?;
        let abilities = Abilities { creases: answer.creases, detail: answer.detail, ..self.abilities.clone() };
        let callee = Arc::new(ProgramMap { program: Arc::clone(&self.program), instance });
        let map = Called::new(callee, abilities, settings.frame().extent(Axis::Diagonal));
        let mut built = Built::called(map, "the plug-in gives no numbers there");
        answer.notes.into_iter().for_each(|n| built.note(n));
        answer.warnings.into_iter().for_each(|w| built.warn(w));
        Ok(built)
    }
}

/// A map that a program has built.
struct ProgramMap {
    program: Arc<Program>,
    instance: Instance,
}

impl Callee for ProgramMap {
    fn ask(&self, ask: Ask, points: &[Point]) -> Result<Vec<f64>, Error> {
        self.program.ask(&self.instance, ask, points).map_err(|fault| fault.of(&self.program.path))
    }

    fn ask_both(&self, points: &[Point], others: &[Point]) -> Result<[Vec<f64>; 2], Error> {
        self.program.ask_both(&self.instance, [points, others]).map_err(|fault| fault.of(&self.program.path))
    }

    fn not_finite(&self, at: Point) -> Error {
        Fault::NotFinite(at.x, at.y).of(&self.program.path)
    }

    fn work(&self) -> f64 {
        self.program.work()
    }
}
