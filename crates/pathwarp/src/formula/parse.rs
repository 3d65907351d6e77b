//! Text to a program: a Pratt parser (V. Pratt, *Top down operator precedence*, POPL 1973) that emits as it reads.

use super::error::{Problem, SyntaxError};
use super::program::{Binary, Program, Unary};

/// Length limit, far above any real formula.
const MAX_BYTES: usize = 10_000;
/// Nesting limit for brackets, signs and powers, so that the recursion cannot exhaust the stack.
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

/// Returns `true` if `name` has the form of a name.
pub(crate) fn is_name(name: &str) -> bool {
    let mut c = name.chars();
    c.next().is_some_and(|c| c.is_ascii_alphabetic() || c == '_') && c.all(|c| c.is_ascii_alphanumeric() || c == '_')
}

/// Returns `true` if there is a function called `name`.
pub(crate) fn is_function(name: &str) -> bool {
    function(name).is_some()
}

enum Function {
    One(Unary),
    Two(Binary),
}

const FUNCTIONS: &str = "sin cos tan asin acos atan atan2 sqrt exp ln abs min max pow hypot";

fn function(name: &str) -> Option<Function> {
    use Function::{One, Two};
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
    let mut p = Parser { text, at: 0, names, program, depth: 0 };
    let value = p.expression(0)?;
    match p.peek() {
        None => Ok(value),
        Some(')') => Err(SyntaxError::new(p.at, Problem::NeverOpened)),
        Some(c) if c.is_alphanumeric() || c == '_' || c == '(' || c == '.' => {
            Err(SyntaxError::new(p.at, Problem::MissingOperator))
        }
        Some(c) => Err(SyntaxError::new(p.at, Problem::Meaningless(c))),
    }
}

struct Parser<'a> {
    text: &'a str,
    at: usize,
    names: &'a Names<'a>,
    program: &'a mut Program,
    depth: usize,
}

/// Binding powers: sums, products, signs, powers.
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
        let there = self.rest().starts_with(token);
        if there {
            self.at += token.len();
        }
        there
    }

    /// An expression whose operators bind at least as tightly as `least`.
    fn expression(&mut self, least: u8) -> Result<u32, SyntaxError> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return Err(SyntaxError::new(self.at, Problem::TooDeep(MAX_DEPTH)));
        }
        let mut left = self.operand()?;
        while let Some(c) = self.peek() {
            let power = c == '^' || self.rest().starts_with("**");
            let (binds, right, op) = match c {
                _ if power => (POWER, POWER, Binary::Pow), // right-associative: 2^3^2 = 2^(3^2)
                '+' => (SUM, SUM + 1, Binary::Add),
                '-' => (SUM, SUM + 1, Binary::Sub),
                '*' => (PRODUCT, PRODUCT + 1, Binary::Mul),
                '/' => (PRODUCT, PRODUCT + 1, Binary::Div),
                _ => break,
            };
            if binds < least {
                break;
            }
            let at = self.at;
            self.at += if power && c == '*' { 2 } else { 1 };
            let r = self.expression(right)?;
            left = self.emit(at, |p| p.binary(op, left, r))?;
        }
        self.depth -= 1;
        Ok(left)
    }

    fn operand(&mut self) -> Result<u32, SyntaxError> {
        let at = match self.peek() {
            None => return Err(SyntaxError::new(self.at, Problem::EndsEarly)),
            Some(_) => self.at,
        };
        let c = self.peek().unwrap_or(' ');
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
        let (at, b) = (self.at, self.rest().as_bytes());
        let digits = |mut i: usize| {
            while b.get(i).is_some_and(u8::is_ascii_digit) {
                i += 1;
            }
            i
        };
        let mut end = digits(0);
        if b.get(end) == Some(&b'.') {
            end = digits(end + 1);
        }
        // Without digits after it, `e` is the constant, and an operator is missing.
        if matches!(b.get(end), Some(b'e' | b'E')) {
            let sign = usize::from(matches!(b.get(end + 1), Some(b'+' | b'-')));
            let all = digits(end + 1 + sign);
            if all > end + 1 + sign {
                end = all;
            }
        }
        let value: f64 = self.rest()[..end].parse().map_err(|_| SyntaxError::new(at, Problem::NotANumber))?;
        if !value.is_finite() {
            return Err(SyntaxError::new(at, Problem::TooLarge));
        }
        self.at += end;
        self.emit(at, |p| p.constant(value))
    }

    fn word(&mut self) -> Result<u32, SyntaxError> {
        let at = self.at;
        let len = self.rest().chars().take_while(|c| c.is_ascii_alphanumeric() || *c == '_').count();
        let word = &self.rest()[..len];
        if let Some(v) = self.names.get(word) {
            self.at += len;
            return Ok(v);
        }
        let word = word.to_owned();
        self.at += len;
        let Some(f) = function(&word) else {
            let known: Vec<&str> = self.names.0.iter().map(|(n, _)| *n).collect();
            let problem = Problem::Unknown { word, names: known.join(" "), functions: FUNCTIONS };
            return Err(SyntaxError::new(at, problem));
        };
        let opened = self.at;
        if !self.eat("(") {
            return Err(SyntaxError::new(self.at, Problem::NoArguments(word)));
        }
        let first = self.expression(0)?;
        match f {
            Function::One(op) => {
                self.close(opened)?;
                self.emit(at, |p| p.unary(op, first))
            }
            Function::Two(op) => {
                if !self.eat(",") {
                    return Err(SyntaxError::new(self.at, Problem::OneArgument(word)));
                }
                let second = self.expression(0)?;
                self.close(opened)?;
                self.emit(at, |p| p.binary(op, first, second))
            }
        }
    }

    fn emit(&mut self, at: usize, f: impl FnOnce(&mut Program) -> Option<u32>) -> Result<u32, SyntaxError> {
        f(self.program).ok_or_else(|| SyntaxError::new(at, Problem::TooManyOperations))
    }
}
