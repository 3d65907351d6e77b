//! The class `Warper`: [`pathwarp_engine::Warper`] for Python. Work is done without the interpreter's lock;
//! after Ctrl-C, `on_threads` awaits its end, `on_threads_abandonable` does not.

use crate::errors::{exception, usage};
use crate::function::Function;
use crate::plugins;
use crate::threads::{on_threads, on_threads_abandonable};
use crate::{arrays, outline};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray1, PyUntypedArrayMethods};
use pathwarp::Outline;
use pathwarp::deform::Registry;
use pathwarp::engine::{Abilities, Callee};
use pathwarp::recipe::Step;
use pathwarp::refit::Assurance;
use pathwarp_engine::input::hatching;
use pathwarp_engine::{Error, PointMap};
use pyo3::IntoPyObjectExt;
use pyo3::exceptions::PyException;
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use pyo3::types::{PyBytes, PyDict};
use rayon::iter::{IntoParallelRefIterator as _, ParallelIterator as _};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Deformations one after another, with options.
#[pyclass(frozen, module = "pathwarp._native")]
pub(crate) struct Warper {
    engine: pathwarp_engine::Warper,
    /// The functions of Python among the deformations.
    functions: Vec<Arc<Function>>,
}

/// An array of points, of shape (n, 2).
type Points<'py> = Bound<'py, PyArray2<f64>>;

/// Verbs, coordinates and report of a path.
type VerbsOut<'py> = (String, Bound<'py, PyArray1<f64>>, Bound<'py, PyDict>);

/// The name of a deformation, its parameters with their values, and `true` if it is inverted.
type TypedStep = (String, Vec<(String, Vec<String>)>, bool);

#[pymethods]
impl Warper {
    /// A deformation by its name. Plug-ins are those in the files `plugins`, and those of the user's folder.
    #[new]
    fn new(py: Python<'_>, name: &str, values: Vec<(String, String)>, plugins: Vec<PathBuf>) -> PyResult<Self> {
        let registry = plugins::registry(py, &plugins, &[name])?;
        done(py, py.detach(|| pathwarp_engine::Warper::new(&registry, name, &values))).map(Self::from_engine)
    }

    /// A function of Python as a deformation; `call` answers as [`Function`] asks.
    #[staticmethod]
    fn function(
        py: Python<'_>,
        call: Py<PyAny>,
        gives: (bool, bool),
        creases: Vec<String>,
        detail: Option<f64>,
    ) -> PyResult<Self> {
        let creases = pathwarp_plugin::creases(creases.iter().map(String::as_str));
        let creases = creases.map_err(|fault| usage(py, &format!("creases: {fault}")))?;
        // A function may return NaN where it is undefined.
        let abilities = Abilities { jacobian: gives.0, inverse: gives.1, partial: true, creases, detail };
        let function = Arc::new(Function::new(call));
        let callee = Arc::clone(&function) as Arc<dyn Callee>;
        let engine = pathwarp_engine::Warper::from_function(&Registry::builtin(), callee, abilities);
        Ok(Self { engine, functions: vec![function] })
    }

    /// An edit of shapes, such as `simplify`.
    #[staticmethod]
    fn edit(py: Python<'_>, name: &str, values: Vec<(String, String)>) -> PyResult<Self> {
        done(py, pathwarp_engine::Warper::edit(&Registry::builtin(), name, &values)).map(Self::from_engine)
    }

    /// The recipe in the text of a recipe file.
    #[staticmethod]
    fn from_recipe(py: Python<'_>, text: &str, folder: PathBuf, external: bool) -> PyResult<Self> {
        let read = |registry: &Registry| pathwarp_engine::Warper::from_recipe(registry, text, &folder, external);
        // A name that is not built in may be that of an installed plug-in. "" is not built in, so all are sought.
        let built_in = py.detach(|| read(&Registry::builtin()));
        let engine = match built_in {
            Ok(engine) => engine,
            Err(_) => {
                let registry = plugins::registry(py, &[], &[""])?;
                done(py, py.detach(|| read(&registry)))?
            }
        };
        Ok(Self::from_engine(engine))
    }

    /// A copy with more options.
    fn with_options(&self, py: Python<'_>, options: Vec<(String, String)>) -> PyResult<Self> {
        let mut engine = self.engine.clone();
        for (name, value) in &options {
            done(py, engine.set_option(name, value))?;
        }
        Ok(Self { engine, functions: self.functions.clone() })
    }

    fn then(&self, later: &Self) -> Self {
        let functions = [&self.functions[..], &later.functions].concat();
        Self { engine: self.engine.then(&later.engine), functions }
    }

    fn inverted(&self) -> Self {
        Self { engine: self.engine.inverted(), functions: self.functions.clone() }
    }

    #[getter]
    fn steps(&self) -> Vec<String> {
        self.engine.steps().map(str::to_owned).collect()
    }

    /// The deformations with their values, and whether each is inverted.
    #[getter]
    fn typed(&self) -> Vec<TypedStep> {
        let step = |s: &Step| {
            let values = s.args.iter().map(|(name, values)| (name.to_owned(), values.to_vec()));
            (s.deformation.clone(), values.collect(), s.inverse)
        };
        self.engine.typed_steps().map(step).collect()
    }

    #[getter]
    fn frame(&self) -> Option<String> {
        self.engine.frame()
    }

    fn to_recipe(&self, py: Python<'_>, folder: PathBuf) -> PyResult<String> {
        done(py, self.engine.to_recipe(&folder))
    }

    /// Maps points, to `out` if it is given, which may be the same array.
    #[pyo3(signature = (points, out=None))]
    fn map<'py>(&self, py: Python<'py>, points: &Points<'py>, out: Option<Points<'py>>) -> PyResult<Points<'py>> {
        check_shape(points)?;
        let borrowed = |e: &dyn std::fmt::Display| usage(py, &format!("out: {e}; give another array"));
        if let Some(out) = out.as_ref().filter(|o| o.is(points)) {
            let mut target = out.try_readwrite().map_err(|e| borrowed(&e))?;
            let mut target = target.as_array_mut();
            on_threads(py, |stop| {
                let map = self.point_map(target.view(), stop)?;
                arrays::map(&map, None, target.view_mut(), stop);
                map.check()
            })
            .and_then(|mapped| self.done(py, mapped))?;
            return Ok(out.clone());
        }
        let out = out.unwrap_or_else(|| PyArray2::zeros(py, points.dims(), false));
        if out.dims() != points.dims() {
            let message = format!("out: has shape {:?}, not {:?} as the points", out.shape(), points.shape());
            return Err(usage(py, &message));
        }
        let source = points.try_readonly().map_err(|e| borrowed(&e))?;
        let mut target = out.try_readwrite().map_err(|e| borrowed(&e))?;
        let (source, mut target) = (source.as_array(), target.as_array_mut());
        on_threads(py, |stop| {
            let map = self.point_map(source, stop)?;
            arrays::map(&map, Some(source), target.view_mut(), stop);
            map.check()
        })
        .and_then(|mapped| self.done(py, mapped))?;
        Ok(out)
    }

    /// The Jacobians at points.
    fn jacobian<'py>(&self, py: Python<'py>, points: &Points<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        check_shape(points)?;
        let out = PyArray3::zeros(py, [points.dims()[0], 2, 2], false);
        let source = points.try_readonly()?;
        let mut target = out.try_readwrite()?;
        let (source, mut target) = (source.as_array(), target.as_array_mut());
        on_threads(py, |stop| {
            let map = self.point_map(source, stop)?;
            arrays::jacobian(&map, source, target.view_mut(), stop);
            map.check()
        })
        .and_then(|mapped| self.done(py, mapped))?;
        Ok(out)
    }

    /// Checks the map: for each check its name, what was checked, and what is wrong.
    fn check(&self, py: Python<'_>) -> PyResult<Vec<(&'static str, String, Vec<String>)>> {
        let warper = self.engine.clone();
        let checked = on_threads_abandonable(py, || Ok(()), move |stop| warper.stopped_by(stop).check())?;
        Ok(self.done(py, checked)?.into_iter().map(|c| (c.name, c.detail, c.faults)).collect())
    }

    /// Bends a path: its data and report.
    fn warp_path<'py>(&self, py: Python<'py>, data: &str) -> PyResult<(String, Bound<'py, PyDict>)> {
        let (warper, data) = (self.engine.clone(), data.to_owned());
        let warped = on_threads_abandonable(py, || Ok(()), move |stop| warper.stopped_by(stop).warp_path(&data))?;
        let warped = self.done(py, warped)?;
        let report = report(py, &warped)?;
        Ok((warped.path.data, report))
    }

    /// Bends a path of verbs and coordinates, to lines and cubics or quadratics.
    fn warp_verbs<'py>(
        &self,
        py: Python<'py>,
        verbs: &str,
        coordinates: PyReadonlyArray1<'py, f64>,
        quadratic: bool,
    ) -> PyResult<VerbsOut<'py>> {
        let path = outline::path(verbs, coordinates.as_slice()?).map_err(|e| usage(py, &e))?;
        let outline = Outline::from(&path);
        let warper = self.engine.clone();
        let work = move |stop| {
            let warper = warper.stopped_by(stop);
            if quadratic { warper.warp_outline_to_quadratics(&outline) } else { warper.warp_outline(&outline) }
        };
        let warped = self.done(py, on_threads_abandonable(py, || Ok(()), work)?)?;
        let (verbs, coordinates) = outline::verbs(&warped.path.path);
        Ok((verbs, coordinates.into_pyarray(py), report(py, &warped)?))
    }

    /// Warps drawings: for each its bytes, the report as JSON, its warnings, and the notes that `explain` asks for; or the exception.
    /// `progress` is called with the number of those that are done.
    fn warp_drawings<'py>(
        &self,
        py: Python<'py>,
        drawings: Vec<(PyBackedBytes, Option<PathBuf>)>,
        progress: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Vec<Bound<'py, PyAny>>> {
        let (warper, finished) = (self.engine.clone(), Arc::new(AtomicUsize::new(0)));
        let counted = Arc::clone(&finished);
        let mut told = 0;
        let mut tell = || {
            let now = finished.load(Ordering::Relaxed);
            let news = progress.as_ref().filter(|_| now > told);
            told = now;
            news.map_or(Ok(()), |p| p.call1((now,)).map(drop))
        };
        let warped: Vec<_> = on_threads_abandonable(py, &mut tell, move |stop| {
            let warper = warper.stopped_by(stop);
            // Drawings left after a stop are dropped; the exception behind it is then returned instead of the list.
            let warp = |(data, name): &(PyBackedBytes, Option<PathBuf>)| {
                let warped = (!stop.load(Ordering::Relaxed)).then(|| warper.warp_drawing(data, name.as_deref()));
                counted.fetch_add(1, Ordering::Relaxed);
                warped
            };
            drawings.par_iter().filter_map(warp).collect()
        })?;
        tell()?;
        let result = |warped: Result<pathwarp_engine::Drawing, Error>| match warped {
            Ok(d) => (PyBytes::new(py, &d.bytes), d.report, d.warnings, d.notes).into_bound_py_any(py),
            Err(e) => match self.exception(py, &e) {
                e if e.is_instance_of::<PyException>(py) => e.into_bound_py_any(py),
                // Ctrl-C came while the exception was made.
                e => Err(e),
            },
        };
        warped.into_iter().map(result).collect()
    }
}

impl Warper {
    fn from_engine(engine: pathwarp_engine::Warper) -> Self {
        Self { engine, functions: Vec::new() }
    }

    /// Turns an error into its exception, which may come from a function.
    fn done<T>(&self, py: Python<'_>, result: Result<T, Error>) -> PyResult<T> {
        result.map_err(|e| self.exception(py, &e))
    }

    /// Returns the exception for an error: the one that a function raised, if the error's message contains its key; else a new one.
    fn exception(&self, py: Python<'_>, error: &Error) -> PyErr {
        let raised = self.functions.iter().find_map(|f| f.raised(py, &error.message));
        raised.unwrap_or_else(|| exception(py, error))
    }

    /// The map for these points. Deformations that examine artwork examine lines all over the points' box (`hatching`).
    fn point_map(&self, points: arrays::View<'_>, stop: &'static AtomicBool) -> Result<PointMap, Error> {
        self.engine.stopped_by(stop).point_map(|| arrays::bounds(points), hatching)
    }
}

/// The box of path data: x, y, width, height. `None` if it is empty or malformed.
#[pyfunction]
pub(crate) fn path_box(data: &str) -> Option<[f64; 4]> {
    let b = Outline::from_svg(data).ok()?.bounding_box()?;
    Some([b.x0, b.y0, b.width(), b.height()])
}

/// The verbs and coordinates of path data, arcs as cubics within a millionth of its size. Empty if it is malformed.
#[pyfunction]
pub(crate) fn path_verbs<'py>(py: Python<'py>, data: &str) -> (String, Bound<'py, PyArray1<f64>>) {
    let outline = Outline::from_svg(data).unwrap_or_default();
    let size = outline.bounding_box().map_or(1.0, |b| b.width().hypot(b.height()));
    let (verbs, coordinates) = outline::verbs(&outline.to_bez_path(1e-6 * size));
    (verbs, coordinates.into_pyarray(py))
}

/// Checks that an array holds points.
fn check_shape(points: &Points<'_>) -> PyResult<()> {
    match points.dims()[1] {
        2 => Ok(()),
        _ => Err(usage(points.py(), &format!("points: has shape {:?}; it must be (n, 2)", points.shape()))),
    }
}

/// Turns an error into its exception.
fn done<T>(py: Python<'_>, result: Result<T, Error>) -> PyResult<T> {
    result.map_err(|e| exception(py, &e))
}

/// Returns the report of a path.
fn report<'py>(py: Python<'py>, warped: &pathwarp_engine::Path) -> PyResult<Bound<'py, PyDict>> {
    let r = &warped.path.report;
    let out = PyDict::new(py);
    out.set_item("segments_in", r.segments_in)?;
    out.set_item("segments_out", r.segments_out)?;
    out.set_item("max_error", r.max_error)?;
    let assurance = match r.assurance {
        Assurance::Exact => "exact",
        Assurance::Certified => "certified",
        Assurance::Checked => "checked",
        Assurance::Sampled => "sampled",
    };
    out.set_item("assurance", assurance)?;
    out.set_item("unresolved", r.unresolved.iter().map(|p| (p.x, p.y)).collect::<Vec<_>>())?;
    out.set_item("resolution", r.resolution)?;
    out.set_item("folds", warped.folds)?;
    out.set_item("warnings", &warped.warnings)?;
    Ok(out)
}
