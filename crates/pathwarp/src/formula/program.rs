//! A formula as a list of operations on earlier values. Several points are evaluated at a time, so that decoding the list
//! costs little.
//!
//! Equal operations are stored once, constants are folded.

use crate::decimal::trimmed;
use crate::map::{Dual, Real};
use std::array::from_fn;

/// Size limit, so that no formula makes a single point expensive.
const MAX_OPS: usize = 2000;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Unary {
    Neg,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sqrt,
    Exp,
    Ln,
    Abs,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Binary {
    Add,
    Sub,
    Mul,
    Div,
    Pow,
    Atan2,
    Hypot,
    Min,
    Max,
}

/// One operation; operands are indices of earlier values.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Op {
    Const(f64),
    X,
    Y,
    One(Unary, u32),
    Two(Binary, u32, u32),
    Powi(u32, i32),
    Powf(u32, f64),
    /// An earlier value unchanged: |a|, min or max on a branch where the side is known.
    Same(u32),
}

/// A list of operations.
#[derive(Debug, Clone, Default)]
pub(crate) struct Program {
    ops: Vec<Op>,
}

impl Program {
    /// Returns the index of the value of `op`; `None` at the size limit.
    fn push(&mut self, op: Op) -> Option<u32> {
        if let Some(i) = self.ops.iter().position(|o| *o == op) {
            return u32::try_from(i).ok();
        }
        if self.ops.len() >= MAX_OPS {
            return None;
        }
        self.ops.push(op);
        u32::try_from(self.ops.len() - 1).ok()
    }

    fn value_of(&self, i: u32) -> Option<f64> {
        if let Some(Op::Const(c)) = self.ops.get(i as usize) { Some(*c) } else { None }
    }

    /// The number of operations.
    pub(crate) fn len(&self) -> usize {
        self.ops.len()
    }

    pub(crate) fn constant(&mut self, c: f64) -> Option<u32> {
        self.push(Op::Const(c))
    }

    pub(crate) fn x(&mut self) -> Option<u32> {
        self.push(Op::X)
    }

    pub(crate) fn y(&mut self) -> Option<u32> {
        self.push(Op::Y)
    }

    pub(crate) fn unary(&mut self, op: Unary, a: u32) -> Option<u32> {
        match self.value_of(a) {
            Some(v) => self.constant(one(op, v)),
            None => self.push(Op::One(op, a)),
        }
    }

    pub(crate) fn binary(&mut self, op: Binary, a: u32, b: u32) -> Option<u32> {
        /// Integer powers below this are accurate enough by repeated squaring.
        const WHOLE: f64 = 1e4;
        match (self.value_of(a), self.value_of(b)) {
            (Some(u), Some(v)) if op == Binary::Pow => self.constant(u.powf(v)),
            (Some(u), Some(v)) => self.constant(two(op, u, v)),
            (None, Some(n)) if op == Binary::Pow && n.fract() == 0.0 && n.abs() < WHOLE => {
                self.push(Op::Powi(a, n as i32))
            }
            (None, Some(n)) if op == Binary::Pow => self.push(Op::Powf(a, n)),
            _ => self.push(Op::Two(op, a, b)),
        }
    }

    /// Evaluates all values at N points.
    pub(crate) fn run<S: Real, const N: usize>(&self, x: [S; N], y: [S; N]) -> Vec<[S; N]> {
        let mut out: Vec<[S; N]> = Vec::with_capacity(self.ops.len());
        for op in &self.ops {
            let at = |i: u32| &out[i as usize];
            let value = match *op {
                Op::Const(c) => [S::from(c); N],
                Op::X => x,
                Op::Y => y,
                // The most frequent operations, with the dispatch outside the loop.
                Op::Two(Binary::Add, a, b) => from_fn(|i| at(a)[i] + at(b)[i]),
                Op::Two(Binary::Sub, a, b) => from_fn(|i| at(a)[i] - at(b)[i]),
                Op::Two(Binary::Mul, a, b) => from_fn(|i| at(a)[i] * at(b)[i]),
                Op::Two(f, a, b) => from_fn(|i| two(f, at(a)[i], at(b)[i])),
                Op::One(f, a) => at(a).map(|v| one(f, v)),
                Op::Powi(a, n) => at(a).map(|v| v.powi(n)),
                Op::Powf(a, n) => at(a).map(|v| v.powf(n)),
                Op::Same(a) => *at(a),
            };
            out.push(value);
        }
        out
    }

    /// Describes the first operation that has no finite value at a point, or no derivative: `sqrt(-300)`.
    pub(crate) fn undefined_at(&self, x: f64, y: f64) -> Option<String> {
        let values = self.run([Dual { v: x, x: 1.0, y: 0.0 }], [Dual { v: y, x: 0.0, y: 1.0 }]);
        let i = values.iter().position(|[d]| !(d.v.is_finite() && d.x.is_finite() && d.y.is_finite()))?;
        let at = |i: u32| trimmed(values[i as usize][0].v, 6);
        let operation = match self.ops[i] {
            Op::One(f, a) => format!("{}({})", format!("{f:?}").to_lowercase(), at(a)),
            Op::Two(Binary::Div, a, b) => format!("{} / {}", at(a), at(b)),
            Op::Two(f, a, b) => format!("{}({}, {})", format!("{f:?}").to_lowercase(), at(a), at(b)),
            Op::Powi(a, n) => format!("({})^{n}", at(a)),
            Op::Powf(a, n) => format!("({})^{n}", at(a)),
            Op::Const(_) | Op::X | Op::Y | Op::Same(_) => return None,
        };
        let what = if values[i][0].v.is_finite() { "has no finite derivative" } else { "has no finite value" };
        Some(format!("{operation} {what}"))
    }

    /// Returns the kinks of the values `of` and of everything they depend on.
    pub(crate) fn kinks(&self, of: [u32; 2]) -> Vec<Kink> {
        let needed = self.needed(of);
        let ops = self.ops.iter().enumerate().filter(|(i, _)| needed[*i]);
        ops.filter_map(|(_, op)| match *op {
            Op::One(Unary::Abs, a) => Some(Kink(a, None)),
            Op::Two(Binary::Min | Binary::Max, a, b) => Some(Kink(a, Some(b))),
            _ => None,
        })
        .collect()
    }

    fn needed(&self, of: [u32; 2]) -> Vec<bool> {
        let mut needed = vec![false; self.ops.len()];
        for i in of {
            needed[i as usize] = true;
        }
        // Operands precede their users, so one pass from the end reaches everything.
        for i in (0..self.ops.len()).rev() {
            if needed[i] {
                self.mark(i, &mut needed);
            }
        }
        needed
    }

    fn mark(&self, i: usize, needed: &mut [bool]) {
        match self.ops[i] {
            Op::One(_, a) | Op::Powi(a, _) | Op::Powf(a, _) | Op::Same(a) => needed[a as usize] = true,
            Op::Two(_, a, b) => {
                needed[a as usize] = true;
                needed[b as usize] = true;
            }
            Op::Const(_) | Op::X | Op::Y => {}
        }
    }

    /// Replaces every |a|, min and max by the side it takes at (x, y).
    pub(crate) fn branch(&self, x: f64, y: f64) -> Self {
        let v: Vec<f64> = self.run([x], [y]).into_iter().map(|[v]| v).collect();
        let ops = self.ops.iter().map(|op| match *op {
            Op::One(Unary::Abs, a) if v[a as usize] < 0.0 => Op::One(Unary::Neg, a),
            Op::One(Unary::Abs, a) => Op::Same(a),
            Op::Two(f @ (Binary::Min | Binary::Max), a, b) => {
                let first = (v[a as usize] <= v[b as usize]) == (f == Binary::Min);
                Op::Same(if first { a } else { b })
            }
            other => other,
        });
        Self { ops: ops.collect() }
    }

    /// Returns the coefficients of x, y and 1 if value `i` is an affine expression.
    pub(crate) fn affine(&self, i: u32) -> Option<[f64; 3]> {
        let mut forms: Vec<Option<[f64; 3]>> = Vec::with_capacity(self.ops.len());
        for op in &self.ops {
            let at = |i: u32| forms[i as usize];
            let constant = |i: u32| at(i).filter(|f| f[0] == 0.0 && f[1] == 0.0).map(|f| f[2]);
            let scaled = |i: u32, k: f64| at(i).map(|f| f.map(|c| c * k));
            forms.push(match *op {
                Op::Const(c) => Some([0.0, 0.0, c]),
                Op::X => Some([1.0, 0.0, 0.0]),
                Op::Y => Some([0.0, 1.0, 0.0]),
                Op::Same(a) => at(a),
                Op::One(Unary::Neg, a) => scaled(a, -1.0),
                Op::Two(Binary::Add, a, b) => at(a).zip(at(b)).map(|(a, b)| from_fn(|i| a[i] + b[i])),
                Op::Two(Binary::Sub, a, b) => at(a).zip(at(b)).map(|(a, b)| from_fn(|i| a[i] - b[i])),
                Op::Two(Binary::Mul, a, b) => match (constant(a), constant(b)) {
                    (_, Some(k)) => scaled(a, k),
                    (Some(k), _) => scaled(b, k),
                    _ => None,
                },
                Op::Two(Binary::Div, a, b) => constant(b).and_then(|k| at(a).map(|f| f.map(|c| c / k))),
                _ => None,
            });
        }
        forms[i as usize].filter(|f| f.iter().all(|c| c.is_finite()))
    }
}

/// The set where two values are equal, or one is zero.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Kink(u32, Option<u32>);

impl Kink {
    /// Evaluates a function that is zero at the kink.
    pub(crate) fn level(self, values: &[[f64; 1]]) -> f64 {
        values[self.0 as usize][0] - self.1.map_or(0.0, |b| values[b as usize][0])
    }
}

fn one<S: Real>(op: Unary, a: S) -> S {
    let rest = |a: S| (-(a * a) + 1.0).sqrt();
    match op {
        Unary::Neg => -a,
        Unary::Sin => a.sin(),
        Unary::Cos => a.cos(),
        Unary::Tan => a.sin() / a.cos(),
        Unary::Asin => a.atan2(rest(a)),
        Unary::Acos => rest(a).atan2(a),
        Unary::Atan => a.atan2(S::from(1.0)),
        Unary::Sqrt => a.sqrt(),
        Unary::Exp => a.exp(),
        Unary::Ln => a.ln(),
        Unary::Abs => a.abs(),
    }
}

fn two<S: Real>(op: Binary, a: S, b: S) -> S {
    match op {
        Binary::Add => a + b,
        Binary::Sub => a - b,
        Binary::Mul => a * b,
        Binary::Div => a / b,
        Binary::Pow => (a.ln() * b).exp(),
        Binary::Atan2 => a.atan2(b),
        Binary::Hypot => a.hypot(b),
        Binary::Min => {
            if a.value() <= b.value() {
                a
            } else {
                b
            }
        }
        Binary::Max => {
            if a.value() <= b.value() {
                b
            } else {
                a
            }
        }
    }
}
