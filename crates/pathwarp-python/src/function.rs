//! Functions of Python as maps.

use numpy::{PyArray2, PyArrayMethods, PyReadonlyArray1};
use pathwarp::Error;
use pathwarp::engine::{Ask, Callee};
use pathwarp::kurbo::Point;
use pyo3::prelude::*;
use std::sync::{Mutex, PoisonError};

/// A function of Python, and the exceptions that it raised.
pub(crate) struct Function {
    /// Takes the kind of a question (`points`, `jets` or `inverse`) and an array of shape (n, 2), and returns the numbers of the answer.
    call: Py<PyAny>,
    raised: Mutex<Raised>,
}

/// Exceptions that were raised and not yet passed on, with their numbers.
#[derive(Default)]
struct Raised {
    last: usize,
    exceptions: Vec<(String, PyErr)>,
}

/// Limit on the exceptions kept. Most are never passed on, because another came first.
const KEPT: usize = 64;

impl Function {
    pub(crate) fn new(call: Py<PyAny>) -> Self {
        Self { call, raised: Mutex::default() }
    }

    /// Returns the exception for which the message of an error stands.
    pub(crate) fn raised(&self, py: Python<'_>, message: &str) -> Option<PyErr> {
        let raised = self.raised.lock().unwrap_or_else(PoisonError::into_inner);
        raised.exceptions.iter().find(|(text, _)| message.contains(text)).map(|(_, e)| e.clone_ref(py))
    }

    /// Keeps an exception, and returns the error that represents it until it reaches Python.
    fn keep(&self, exception: PyErr) -> Error {
        let mut raised = self.raised.lock().unwrap_or_else(PoisonError::into_inner);
        raised.last += 1;
        let text = format!("exception {} of {:p};", raised.last, std::ptr::from_ref(self));
        if raised.exceptions.len() == KEPT {
            raised.exceptions.remove(0);
        }
        raised.exceptions.push((text.clone(), exception));
        Error::input("function", text)
    }
}

impl Callee for Function {
    fn ask(&self, ask: Ask, points: &[Point]) -> Result<Vec<f64>, Error> {
        let kind = match ask {
            Ask::Points => "points",
            Ask::Jets => "jets",
            Ask::Inverse => "inverse",
        };
        let called = Python::attach(|py| {
            let array = PyArray2::zeros(py, [points.len(), 2], false);
            for (mut row, p) in array.try_readwrite()?.as_array_mut().rows_mut().into_iter().zip(points) {
                (row[0], row[1]) = (p.x, p.y);
            }
            let numbers: PyReadonlyArray1<'_, f64> = self.call.bind(py).call1((kind, array))?.extract()?;
            Ok(numbers.as_slice()?.to_vec())
        });
        called.map_err(|exception| self.keep(exception))
    }

    fn not_finite(&self, at: Point) -> Error {
        Error::input("function", format!("gives no numbers at {},{}", at.x, at.y))
    }

    /// Returns a small number, since the cost of a call depends little on the number of points.
    fn work(&self) -> f64 {
        4.0
    }
}
