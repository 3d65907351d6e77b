//! Formulas as text: `expr` maps the plane by them; warp styles and text shapes compute their numbers with them.

use crate::decimal::trimmed;
use crate::map::{Dual, Real};
use std::array::from_fn;
use std::borrow::Cow;
use std::f64::consts::{LN_2, PI, TAU};
use thiserror::Error;

// From text to a program: a Pratt parser (V. Pratt, *Top down operator precedence*, POPL 1973) that emits as it reads.

/// The limit on the length, far above any real formula.
const MAX_BYTES: usize = 10_000;
/// The limit on nested brackets, signs and powers, so that the recursion cannot exhaust the stack.
const MAX_DEPTH: usize = 100;

/// The names that a formula may use, each with the index of its value in the program.
pub(crate) struct Names<'a>(Vec<(&'a str, u32)>);

impl<'a> Names<'a> {
    pub(crate) fn new() -> Self {
        Self(Vec::with_capacity(16))
    }

    pub(crate) fn set(&mut self, name: &'a str, value: u32) {
        self.0.push((name, value));
    }

    pub(crate) fn get(&self, name: &str) -> Option<u32> {
        self.0.iter().find(|(n, _)| *n == name).map(|(_, v)| *v)
    }
}

/// Returns `true` if `name` consists of letters, digits and _, and starts with no digit.
pub(crate) fn is_name(name: &str) -> bool {
    let mut c = name.chars();
    c.next().is_some_and(|c| c.is_ascii_alphabetic() || c == '_') && c.all(|c| c.is_ascii_alphanumeric() || c == '_')
}

/// Returns `true` if there is a function called `name`.
pub(crate) fn is_function(name: &str) -> bool {
    function(name).is_some()
}

/// The meaning of a function's name.
enum Function {
    One(Unary),
    Two(Binary),
    /// A formula of this many arguments, called a, b, c.
    Formula(usize, Cow<'static, str>),
}

const FUNCTIONS: &str = "sin cos tan asin acos atan atan2 sinh cosh tanh asinh sqrt exp ln abs sign floor ceil round mod min max pow \
hypot smoothstep noise";

fn function(name: &str) -> Option<Function> {
    use Function::{One, Two};
    let formula = |count: usize, text: &'static str| Function::Formula(count, Cow::Borrowed(text));
    Some(match name {
        "sin" => One(Unary::Sin),
        "cos" => One(Unary::Cos),
        "tan" => One(Unary::Tan),
        "asin" => One(Unary::Asin),
        "acos" => One(Unary::Acos),
        "atan" => One(Unary::Atan),
        "sqrt" => One(Unary::Sqrt),
        "exp" => One(Unary::Exp),
        "ln" => One(Unary::Ln),
        "abs" => One(Unary::Abs),
        "sinh" => formula(1, "(exp(a) - exp(-a))/2"),
        "cosh" => formula(1, "(exp(a) + exp(-a))/2"),
        "tanh" => One(Unary::Tanh),
        "asinh" => One(Unary::Asinh),
        "sign" => One(Unary::Sign),
        "floor" => One(Unary::Floor),
        "ceil" => formula(1, "-floor(-a)"),
        "round" => formula(1, "floor(a + 0.5)"),
        "mod" => formula(2, "a - b*floor(a/b)"),
        "smoothstep" => formula(3, "max(0, min(1, (c - a)/(b - a)))^2 * (3 - 2*max(0, min(1, (c - a)/(b - a))))"),
        "noise" => Function::Formula(2, Cow::Owned(noise())),
        "atan2" => Two(Binary::Atan2),
        "min" => Two(Binary::Min),
        "max" => Two(Binary::Max),
        "pow" => Two(Binary::Pow),
        "hypot" => Two(Binary::Hypot),
        _ => return None,
    })
}

/// Appends the formula `text` to `program` and returns the index of its value.
pub(crate) fn parse(text: &str, names: &Names<'_>, program: &mut Program) -> Result<u32, SyntaxError> {
    if text.len() > MAX_BYTES {
        return Err(SyntaxError::new(0, Problem::TooLong(MAX_BYTES)));
    }
    let mut parser = Parser { text, at: 0, names, program, depth: 0 };
    let value = parser.expression(0)?;
    let problem = match parser.peek() {
        None => return Ok(value),
        Some(')') => Problem::NeverOpened,
        Some(c) if c.is_alphanumeric() || c == '_' || c == '(' || c == '.' => Problem::MissingOperator,
        Some(c) => Problem::Meaningless(c),
    };
    Err(SyntaxError::new(parser.at, problem))
}

/// A sum of plane waves with lengths from 1 to 2, mostly between −1 and 1. Their directions, lengths and phases are evenly spread without
/// a pattern: the spectral representation of a random field (M. Shinozuka, G. Deodatis, *Simulation of stochastic processes by spectral
/// representation*, Applied Mechanics Reviews 44, 1991).
fn noise() -> String {
    // Powers of 1/g, where g is the golden ratio or, for two numbers at once, the root of g³ = g + 1.
    const IRRATIONALS: [f64; 3] = [0.618_033_988_749_895, 0.754_877_666_246_693, 0.569_840_290_998_053];
    let wave = |i: u32| {
        let [direction, frequency, phase] = IRRATIONALS.map(|g| (f64::from(i) * g).fract());
        let ((sin, cos), wave_number) = ((PI * direction).sin_cos(), PI * (1.0 + frequency));
        format!("+ sin({} * a + {} * b + {})", wave_number * cos, wave_number * sin, TAU * phase)
    };
    format!("({})/8", (1..=16).map(wave).collect::<String>())
}

struct Parser<'a> {
    text: &'a str,
    /// The byte at which the unread rest of the text begins.
    at: usize,
    names: &'a Names<'a>,
    program: &'a mut Program,
    depth: usize,
}

/// Binding powers. A left-associative operator takes a right operand that binds more tightly by 1.
const SUM: u8 = 1;
const PRODUCT: u8 = 3;
const SIGN: u8 = 5;
const POWER: u8 = 7;

impl Parser<'_> {
    fn rest(&self) -> &str {
        self.text.get(self.at..).unwrap_or("")
    }

    /// Skips whitespace and returns the next character.
    fn peek(&mut self) -> Option<char> {
        let skipped = self.rest().len() - self.rest().trim_start().len();
        self.at += skipped;
        self.rest().chars().next()
    }

    fn eat(&mut self, token: &str) -> bool {
        self.peek();
        let is_next = self.rest().starts_with(token);
        self.at += if is_next { token.len() } else { 0 };
        is_next
    }

    /// Parses an expression whose operators bind at least as tightly as `min`.
    fn expression(&mut self, min: u8) -> Result<u32, SyntaxError> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return Err(SyntaxError::new(self.at, Problem::TooDeep(MAX_DEPTH)));
        }
        let mut left = self.operand()?;
        while let Some(c) = self.peek() {
            let is_power = c == '^' || self.rest().starts_with("**");
            let (binding, min_right, op) = match c {
                _ if is_power => (POWER, POWER, Binary::Pow), // right-associative: 2^3^2 = 2^(3^2)
                '+' => (SUM, SUM + 1, Binary::Add),
                '-' => (SUM, SUM + 1, Binary::Sub),
                '*' => (PRODUCT, PRODUCT + 1, Binary::Mul),
                '/' => (PRODUCT, PRODUCT + 1, Binary::Div),
                _ => break,
            };
            if binding < min {
                break;
            }
            let at = self.at;
            self.at += if is_power && c == '*' { 2 } else { 1 };
            let right = self.expression(min_right)?;
            left = self.emit(at, |p| p.binary(op, left, right))?;
        }
        self.depth -= 1;
        Ok(left)
    }

    fn operand(&mut self) -> Result<u32, SyntaxError> {
        let Some(c) = self.peek() else { return Err(SyntaxError::new(self.at, Problem::EndsEarly)) };
        let at = self.at;
        match c {
            '+' => {
                self.at += 1;
                self.expression(SIGN)
            }
            '-' => {
                self.at += 1;
                let v = self.expression(SIGN)?;
                self.emit(at, |p| p.unary(Unary::Neg, v))
            }
            '(' => {
                self.at += 1;
                let v = self.expression(0)?;
                self.close(at)?;
                Ok(v)
            }
            '0'..='9' | '.' => self.number(),
            c if c.is_ascii_alphabetic() || c == '_' => self.word(),
            c => Err(SyntaxError::new(at, Problem::NoValue(c))),
        }
    }

    /// Reads the bracket that closes the one at `opened`.
    fn close(&mut self, opened: usize) -> Result<(), SyntaxError> {
        if self.eat(")") {
            return Ok(());
        }
        Err(match self.peek() {
            None => SyntaxError::new(opened, Problem::NeverClosed),
            Some(',') => SyntaxError::new(self.at, Problem::StrayComma),
            Some(_) => SyntaxError::new(self.at, Problem::MissingOperatorOrBracket),
        })
    }

    fn number(&mut self) -> Result<u32, SyntaxError> {
        let (at, bytes) = (self.at, self.rest().as_bytes());
        let end_of_digits = |from: usize| from + bytes[from..].iter().take_while(|b| b.is_ascii_digit()).count();
        let mut end = end_of_digits(0);
        if bytes.get(end) == Some(&b'.') {
            end = end_of_digits(end + 1);
        }
        // Without digits after it, `e` is the constant, and an operator is missing.
        if matches!(bytes.get(end), Some(b'e' | b'E')) {
            let exponent = end + 1 + usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
            if bytes.get(exponent).is_some_and(u8::is_ascii_digit) {
                end = end_of_digits(exponent);
            }
        }
        let value: f64 = self.rest()[..end].parse().map_err(|_| SyntaxError::new(at, Problem::NotANumber))?;
        if !value.is_finite() {
            return Err(SyntaxError::new(at, Problem::TooLarge));
        }
        self.at += end;
        self.emit(at, |p| p.constant(value))
    }

    /// Reads a name, or a function with its arguments.
    fn word(&mut self) -> Result<u32, SyntaxError> {
        let at = self.at;
        let len = self.rest().chars().take_while(|c| c.is_ascii_alphanumeric() || *c == '_').count();
        let word = self.rest()[..len].to_owned();
        self.at += len;
        if let Some(v) = self.names.get(&word) {
            return Ok(v);
        }
        let Some(function) = function(&word) else {
            let known: Vec<&str> = self.names.0.iter().map(|(n, _)| *n).collect();
            let problem = Problem::Unknown { word, names: known.join(" "), functions: FUNCTIONS };
            return Err(SyntaxError::new(at, problem));
        };
        let opened = self.at;
        if !self.eat("(") {
            return Err(SyntaxError::new(self.at, Problem::NoArguments(word)));
        }
        let count = match function {
            Function::One(_) => 1,
            Function::Two(_) => 2,
            Function::Formula(count, _) => count,
        };
        let mut arguments = vec![self.expression(0)?];
        while arguments.len() < count {
            if !self.eat(",") {
                let count = if count == 2 { "two" } else { "three" };
                return Err(SyntaxError::new(self.at, Problem::MoreArguments { word, count }));
            }
            arguments.push(self.expression(0)?);
        }
        self.close(opened)?;
        self.emit(at, |p| match function {
            Function::One(op) => p.unary(op, arguments[0]),
            Function::Two(op) => p.binary(op, arguments[0], arguments[1]),
            Function::Formula(_, text) => {
                let names = Names(["a", "b", "c"].into_iter().zip(arguments).collect());
                parse(&text, &names, p).ok()
            }
        })
    }

    /// Appends operations to the program; an error points at `at`.
    fn emit(&mut self, at: usize, f: impl FnOnce(&mut Program) -> Option<u32>) -> Result<u32, SyntaxError> {
        f(self.program).ok_or_else(|| SyntaxError::new(at, Problem::TooManyOperations))
    }
}

// A program is a list of operations on earlier values. Equal operations are stored once, constants are folded. Several points are evaluated
// at a time, so that decoding the list costs little.

/// The limit on the size, so that no formula makes a single point expensive.
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
    Tanh,
    Asinh,
    Sign,
    Floor,
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

    /// Returns value `i` if it is a constant.
    fn constant_at(&self, i: u32) -> Option<f64> {
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
        match self.constant_at(a) {
            Some(v) => self.constant(apply_unary(op, v)),
            None => self.push(Op::One(op, a)),
        }
    }

    pub(crate) fn binary(&mut self, op: Binary, a: u32, b: u32) -> Option<u32> {
        /// Integer powers below this are accurate enough by repeated squaring.
        const WHOLE: f64 = 1e4;
        match (self.constant_at(a), self.constant_at(b)) {
            (Some(u), Some(v)) if op == Binary::Pow => self.constant(u.powf(v)),
            (Some(u), Some(v)) => self.constant(apply_binary(op, u, v)),
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
            let operand = |i: u32| &out[i as usize];
            let value = match *op {
                Op::Const(c) => [S::from(c); N],
                Op::X => x,
                Op::Y => y,
                // The most frequent operations have the dispatch outside the loop.
                Op::Two(Binary::Add, a, b) => from_fn(|i| operand(a)[i] + operand(b)[i]),
                Op::Two(Binary::Sub, a, b) => from_fn(|i| operand(a)[i] - operand(b)[i]),
                Op::Two(Binary::Mul, a, b) => from_fn(|i| operand(a)[i] * operand(b)[i]),
                Op::Two(f, a, b) => from_fn(|i| apply_binary(f, operand(a)[i], operand(b)[i])),
                Op::One(f, a) => operand(a).map(|v| apply_unary(f, v)),
                Op::Powi(a, n) => operand(a).map(|v| v.powi(n)),
                Op::Powf(a, n) => operand(a).map(|v| v.powf(n)),
                Op::Same(a) => *operand(a),
            };
            out.push(value);
        }
        out
    }

    /// Describes the first operation that has no finite value at a point, or no derivative: `sqrt(-300)`.
    pub(crate) fn undefined_at(&self, x: f64, y: f64) -> Option<String> {
        let values = self.run([Dual { v: x, x: 1.0, y: 0.0 }], [Dual { v: y, x: 0.0, y: 1.0 }]);
        let i = values.iter().position(|[d]| !(d.v.is_finite() && d.x.is_finite() && d.y.is_finite()))?;
        let shown = |i: u32| trimmed(values[i as usize][0].v, 6);
        let operation = match self.ops[i] {
            Op::One(f, a) => format!("{}({})", format!("{f:?}").to_lowercase(), shown(a)),
            Op::Two(Binary::Div, a, b) => format!("{} / {}", shown(a), shown(b)),
            Op::Two(f, a, b) => format!("{}({}, {})", format!("{f:?}").to_lowercase(), shown(a), shown(b)),
            Op::Powi(a, n) => format!("({})^{n}", shown(a)),
            Op::Powf(a, n) => format!("({})^{n}", shown(a)),
            Op::Const(_) | Op::X | Op::Y | Op::Same(_) => return None,
        };
        let what = if values[i][0].v.is_finite() { "has no finite derivative" } else { "has no finite value" };
        Some(format!("{operation} {what}"))
    }

    /// Returns the kinks of two results and of everything they depend on. Jumps of `atan2` are not among them.
    pub(crate) fn kinks(&self, results: [u32; 2]) -> Vec<Kink> {
        let needed = self.needed(results);
        let ops = self.ops.iter().enumerate().filter(|(i, _)| needed[*i]);
        ops.filter_map(|(_, op)| match *op {
            Op::One(Unary::Abs | Unary::Sign, a) => Some(Kink::Zero(a)),
            Op::One(Unary::Floor, a) => Some(Kink::Integer(a)),
            Op::Two(Binary::Min | Binary::Max, a, b) => Some(Kink::Equal(a, b)),
            _ => None,
        })
        .collect()
    }

    /// Returns `true` for every value that the results depend on.
    fn needed(&self, results: [u32; 2]) -> Vec<bool> {
        let mut needed = vec![false; self.ops.len()];
        results.iter().for_each(|i| needed[*i as usize] = true);
        // Operands precede their users, so one pass from the end reaches everything.
        for i in (0..self.ops.len()).rev() {
            match self.ops[i] {
                _ if !needed[i] => {}
                Op::One(_, a) | Op::Powi(a, _) | Op::Powf(a, _) | Op::Same(a) => needed[a as usize] = true,
                Op::Two(_, a, b) => {
                    needed[a as usize] = true;
                    needed[b as usize] = true;
                }
                Op::Const(_) | Op::X | Op::Y => {}
            }
        }
        needed
    }

    /// Replaces every |a|, min and max by the side it takes at (x, y), and every sign and floor by the value there.
    pub(crate) fn branch(&self, x: f64, y: f64) -> Self {
        let v: Vec<f64> = self.run([x], [y]).into_iter().map(|[v]| v).collect();
        let ops = self.ops.iter().map(|op| match *op {
            Op::One(Unary::Abs, a) if v[a as usize] < 0.0 => Op::One(Unary::Neg, a),
            Op::One(Unary::Abs, a) => Op::Same(a),
            Op::One(f @ (Unary::Sign | Unary::Floor), a) => Op::Const(apply_unary(f, v[a as usize])),
            Op::Two(f @ (Binary::Min | Binary::Max), a, b) => {
                let takes_a = (v[a as usize] <= v[b as usize]) == (f == Binary::Min);
                Op::Same(if takes_a { a } else { b })
            }
            other => other,
        });
        Self { ops: ops.collect() }
    }

    /// Returns the coefficients of x, y and 1 if value `i` is an affine expression.
    pub(crate) fn affine(&self, i: u32) -> Option<[f64; 3]> {
        let mut forms: Vec<Option<[f64; 3]>> = Vec::with_capacity(self.ops.len());
        for op in &self.ops {
            let form = |i: u32| forms[i as usize];
            let constant = |i: u32| form(i).filter(|f| f[0] == 0.0 && f[1] == 0.0).map(|f| f[2]);
            let scaled = |i: u32, k: f64| form(i).map(|f| f.map(|c| c * k));
            forms.push(match *op {
                Op::Const(c) => Some([0.0, 0.0, c]),
                Op::X => Some([1.0, 0.0, 0.0]),
                Op::Y => Some([0.0, 1.0, 0.0]),
                Op::Same(a) => form(a),
                Op::One(Unary::Neg, a) => scaled(a, -1.0),
                Op::Two(Binary::Add, a, b) => form(a).zip(form(b)).map(|(a, b)| from_fn(|i| a[i] + b[i])),
                Op::Two(Binary::Sub, a, b) => form(a).zip(form(b)).map(|(a, b)| from_fn(|i| a[i] - b[i])),
                Op::Two(Binary::Mul, a, b) => match (constant(a), constant(b)) {
                    (_, Some(k)) => scaled(a, k),
                    (Some(k), _) => scaled(b, k),
                    _ => None,
                },
                Op::Two(Binary::Div, a, b) => constant(b).and_then(|k| form(a).map(|f| f.map(|c| c / k))),
                _ => None,
            });
        }
        forms[i as usize].filter(|f| f.iter().all(|c| c.is_finite()))
    }
}

/// A set on which an operation has a kink, or jumps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kink {
    /// The set where a value is zero.
    Zero(u32),
    /// The set where a value is an integer.
    Integer(u32),
    /// The set where two values are equal.
    Equal(u32, u32),
}

impl Kink {
    /// Evaluates a function that is zero at the kink.
    pub(crate) fn level<S: Real>(self, values: &[[S; 1]]) -> S {
        let value = |i: u32| values[i as usize][0];
        match self {
            Self::Zero(a) => value(a),
            Self::Integer(a) => (value(a) * PI).sin(),
            Self::Equal(a, b) => value(a) - value(b),
        }
    }
}

fn apply_unary<S: Real>(op: Unary, a: S) -> S {
    let cosine_of_asin = |a: S| (-(a * a) + 1.0).sqrt();
    // tanh and asinh are odd. For |a|, the exponential does not overflow, and the terms of the logarithm do not cancel.
    let sign = if a.value() < 0.0 { -1.0 } else { 1.0 };
    match op {
        Unary::Neg => -a,
        Unary::Sin => a.sin(),
        Unary::Cos => a.cos(),
        Unary::Tan => a.sin() / a.cos(),
        Unary::Asin => a.atan2(cosine_of_asin(a)),
        Unary::Acos => cosine_of_asin(a).atan2(a),
        Unary::Atan => a.atan2(S::from(1.0)),
        Unary::Sqrt => a.sqrt(),
        Unary::Exp => a.exp(),
        Unary::Ln => a.ln(),
        Unary::Abs => a.abs(),
        Unary::Tanh => {
            let e = (a * (-2.0 * sign)).exp();
            (S::from(2.0) / (e + 1.0) - 1.0) * sign
        }
        // Its square overflows.
        Unary::Asinh if a.value().abs() > 1e154 => ((a * sign).ln() + LN_2) * sign,
        Unary::Asinh => (a * sign + (a.powi(2) + 1.0).sqrt()).ln() * sign,
        Unary::Sign => a.sign(),
        Unary::Floor => a.floor(),
    }
}

fn apply_binary<S: Real>(op: Binary, a: S, b: S) -> S {
    match op {
        Binary::Add => a + b,
        Binary::Sub => a - b,
        Binary::Mul => a * b,
        Binary::Div => a / b,
        Binary::Pow => (a.ln() * b).exp(),
        Binary::Atan2 => a.atan2(b),
        Binary::Hypot => a.hypot(b),
        Binary::Min => a.smaller(b),
        // b at a tie, as in `branch`.
        Binary::Max => -(-b).smaller(-a),
    }
}

/// Named values, and formulas over them for single numbers, as in presets.
#[derive(Debug, Clone, Default)]
pub(crate) struct Calculator {
    values: Vec<(String, f64)>,
}

impl Calculator {
    /// Creates a calculator with these names.
    pub(crate) fn new(values: &[(&str, f64)]) -> Self {
        Self { values: values.iter().map(|(n, v)| ((*n).to_owned(), *v)).collect() }
    }

    /// Sets the value of `name`.
    pub(crate) fn set(&mut self, name: &str, value: f64) {
        match self.values.iter_mut().find(|(n, _)| n == name) {
            Some((_, v)) => *v = value,
            None => self.values.push((name.to_owned(), value)),
        }
    }

    /// Defines a name by `NAME = FORMULA` or `NAME = TEST ? FORMULA : FORMULA`, which takes the first formula if the test is
    /// positive.
    pub(crate) fn define(&mut self, text: &str) -> Result<(), FormulaError> {
        let (name, formula) = text.split_once('=').ok_or(FormulaError::NoDefinition)?;
        let name = name.trim();
        if !is_name(name) || is_function(name) {
            return Err(FormulaError::BadName(name.to_owned()));
        }
        let value = match formula.split_once('?').map(|(test, rest)| (test, rest.split_once(':'))) {
            None => self.value(formula)?,
            Some((test, Some((yes, no)))) => self.value(if self.value(test)? > 0.0 { yes } else { no })?,
            Some((_, None)) => return Err(FormulaError::OneOutcome),
        };
        self.set(name, value);
        Ok(())
    }

    /// Evaluates a formula. The result is finite.
    pub(crate) fn value(&self, formula: &str) -> Result<f64, FormulaError> {
        let mut program = Program::default();
        let mut names = Names::new();
        for (name, v) in self.values.iter().map(|(n, v)| (n.as_str(), *v)).chain([("pi", PI)]) {
            names.set(name, program.constant(v).ok_or(FormulaError::TooLong)?);
        }
        let result = parse(formula, &names, &mut program).map_err(|e| FormulaError::Syntax(formula.to_owned(), e))?;
        let value = program.run([0.0], [0.0]).get(result as usize).map_or(f64::NAN, |v| v[0]);
        if value.is_finite() { Ok(value) } else { Err(FormulaError::NotFinite(formula.to_owned())) }
    }
}

/// A definition or formula of a [`Calculator`] that has no value. Messages continue a sentence about the formula or the file it is in.
#[derive(Debug, Clone, PartialEq, Error)]
pub(crate) enum FormulaError {
    #[error("is not NAME = FORMULA")]
    NoDefinition,
    #[error("defines `{0}`, which is not a valid name: use letters, digits and _, starting with a letter")]
    BadName(String),
    #[error("has a test with only one outcome: write TEST ? FORMULA : FORMULA")]
    OneOutcome,
    #[error("has too many operations; simplify it")]
    TooLong,
    #[error("has a formula that is not finite here: `{0}`")]
    NotFinite(String),
    #[error("{}", .1.show(.0))]
    Syntax(String, SyntaxError),
}

/// A syntax error, at a byte of the formula.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SyntaxError {
    pub(crate) at: usize,
    pub(crate) problem: Problem,
}

impl SyntaxError {
    fn new(at: usize, problem: Problem) -> Self {
        Self { at, problem }
    }

    /// Returns the message, the formula and a caret below the error.
    pub(crate) fn show(&self, text: &str) -> String {
        let column = text.get(..self.at).unwrap_or(text).chars().count();
        // Tabs would misalign the caret.
        let line: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
        format!("is not a valid formula: {}\n  {line}\n  {}^", self.problem, " ".repeat(column))
    }
}

#[derive(Debug, Clone, PartialEq, Error)]
pub(crate) enum Problem {
    #[error("it is longer than {0} bytes")]
    TooLong(usize),
    #[error("it is nested more than {0} deep")]
    TooDeep(usize),
    #[error("it has too many operations")]
    TooManyOperations,
    #[error("this bracket was never opened")]
    NeverOpened,
    #[error("this bracket is never closed")]
    NeverClosed,
    #[error("an operator is missing here (write products with *)")]
    MissingOperator,
    #[error("an operator or a closing bracket is missing here")]
    MissingOperatorOrBracket,
    #[error("`{0}` has no meaning here")]
    Meaningless(char),
    #[error("a value is missing at the end")]
    EndsEarly,
    #[error("expected a value, found `{0}`")]
    NoValue(char),
    #[error("this comma is outside a function's arguments, or one argument too many precedes it")]
    StrayComma,
    #[error("this is not a number")]
    NotANumber,
    #[error("this number is too large")]
    TooLarge,
    #[error("there is no `{word}`; names are {names}; functions are {functions}")]
    Unknown { word: String, names: String, functions: &'static str },
    #[error("`{0}` is a function: put its argument in brackets")]
    NoArguments(String),
    #[error("`{word}` takes {count} arguments, separated by commas")]
    MoreArguments { word: String, count: &'static str },
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_defined_one_after_another() {
        let mut c = Calculator::new(&[("w", 40.0), ("h", 8.0)]);
        c.define("d = w/h").unwrap();
        c.define("e = max(d, 2)^2 - pi/pi").unwrap();
        c.define("f = -d ? 1 : e").unwrap();
        assert_eq!(c.value("f"), c.value("e"));
        assert_eq!((c.value("e"), c.value("e + 1")), (Ok(24.0), Ok(25.0)));
        assert_eq!(c.value("asinh(-10^200)").map(|v| (v + 461.210165793).abs() < 1e-6), Ok(true));
        for (text, part) in [
            ("x", "NAME = FORMULA"),
            ("sin = 2", "not a valid name"),
            ("a = 1/0", "finite"),
            ("a = q", "q"),
            ("a = 1 ? 2", "only one outcome"),
        ] {
            assert!(c.define(text).unwrap_err().to_string().contains(part), "{text}");
        }
    }
}
