//! The native half of the Python package `pathwarp`. The other half, in `python/pathwarp`, converts Python's values to the text
//! that [`pathwarp_engine`] reads, so that values have one meaning in Python and on the command line.

mod arrays;
mod catalog;
mod errors;
mod function;
mod outline;
mod plugins;
mod threads;
mod warper;

use pyo3::prelude::*;

#[pymodule]
mod _native {
    #[pymodule_export]
    use super::catalog::{catalog, option_help};
    #[pymodule_export]
    use super::threads::use_threads;
    #[pymodule_export]
    use super::warper::{Warper, path_box, path_verbs};
    use super::{Bound, PyModule, PyModuleMethods as _, PyResult};

    #[pymodule_init]
    fn init(m: &Bound<'_, PyModule>) -> PyResult<()> {
        // NumPy's functions are looked up with the first array, which panics if Ctrl-C comes meanwhile. Create one now.
        drop(numpy::PyArray1::<f64>::zeros(m.py(), 0, false));
        m.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
