//! Counts the operations of a formula.

use crate::map::Real;
use std::cell::Cell;
use std::ops::{Add, Div, Mul, Neg, Sub};

thread_local! {
    static COUNT: Cell<[usize; 3]> = const { Cell::new([0; 3]) };
}

/// Returns the numbers of products (with quotients), sums and differences that `work` takes.
pub fn operations(work: impl FnOnce()) -> [usize; 3] {
    COUNT.with(|c| c.set([0; 3]));
    work();
    COUNT.with(Cell::get)
}

/// A number that counts the operations on it.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct Counted(pub f64);

/// Counts an operation: 0 for a product, 1 for a sum, 2 for a difference.
fn count(kind: usize) {
    COUNT.with(|counts| {
        let mut n = counts.get();
        n[kind] += 1;
        counts.set(n);
    });
}

macro_rules! counted {
    ($($trait:ident $method:ident $op:tt $kind:expr;)*) => {$(
        impl $trait for Counted {
            type Output = Self;
            fn $method(self, o: Self) -> Self { count($kind); Self(self.0 $op o.0) }
        }
        impl $trait<f64> for Counted {
            type Output = Self;
            fn $method(self, o: f64) -> Self { count($kind); Self(self.0 $op o) }
        }
    )*};
}
counted! { Mul mul * 0; Div div / 0; Add add + 1; Sub sub - 2; }

impl Neg for Counted {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl From<f64> for Counted {
    fn from(v: f64) -> Self {
        Self(v)
    }
}

macro_rules! uncounted {
    ($($method:ident)*) => {$(
        fn $method(self) -> Self { Self(self.0.$method()) }
    )*};
}

/// Only the operations of polynomials are counted.
impl Real for Counted {
    fn value(self) -> f64 {
        self.0
    }
    uncounted! { sqrt sin cos exp ln }
    fn atan2(self, x: Self) -> Self {
        Self(self.0.atan2(x.0))
    }
    fn powi(self, n: i32) -> Self {
        Self(self.0.powi(n))
    }
    fn powf(self, n: f64) -> Self {
        Self(self.0.powf(n))
    }
    fn hypot(self, y: Self) -> Self {
        Self(self.0.hypot(y.0))
    }
}
