//! Text to a program: a Pratt parser (V. Pratt, *Top down operator precedence*, POPL 1973) that emits as it reads.

use super::program::{Binary, Program, Unary};

/// A formula longer than this is not a formula.
const MOST_BYTES: usize = 10_000;
/// Brackets, signs and powers within one another.
const MOST_DEPTH: usize = 100;

/// What is wrong, and the byte at which it was noticed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Fault {
    pub(super) at: usize,
    pub(super) what: String,
}

impl Fault {
    fn new(at: usize, what: impl Into<String>) -> Self {
        Self { at, what: what.into() }
    }

    /// The message with the formula and a caret below the fault.
    pub(super) fn show(&self, text: &str) -> String {
        let column = text.get(..self.at).unwrap_or(text).chars().count();
        // The caret's place must not depend on how wide a tab is drawn.
        let line: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
        format!("cannot be understood: {}\n  {line}\n  {}^", self.what, " ".repeat(column))
    }
}

/// What the names in a formula stand for: values in the program.
pub(super) struct Names(Vec<(String, u32)>);

impl Names {
    pub(super) fn new() -> Self {
        Self(Vec::new())
    }

    pub(super) fn set(&mut self, name: &str, value: u32) {
        self.0.push((name.to_owned(), value));
    }

    pub(super) fn get(&self, name: &str) -> Option<u32> {
        self.0.iter().find(|(n, _)| n == name).map(|(_, v)| *v)
    }
}

/// Whether `name` can be given to a value.
pub(super) fn is_name(name: &str) -> bool {
    let mut c = name.chars();
    c.next().is_some_and(|c| c.is_ascii_alphabetic() || c == '_') && c.all(|c| c.is_ascii_alphanumeric() || c == '_')
}

/// Whether a function is called that.
pub(super) fn is_function(name: &str) -> bool {
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

/// Reads `text` into `program` and returns the value it stands for.
pub(super) fn parse(text: &str, names: &Names, program: &mut Program) -> Result<u32, Fault> {
    if text.len() > MOST_BYTES {
        return Err(Fault::new(0, format!("it is longer than {MOST_BYTES} bytes")));
    }
    let mut p = Parser { text, at: 0, names, program, depth: 0 };
    let value = p.expression(0)?;
    match p.peek() {
        None => Ok(value),
        Some(')') => Err(Fault::new(p.at, "this bracket was never opened")),
        Some(c) if c.is_alphanumeric() || c == '_' || c == '(' || c == '.' => {
            Err(Fault::new(p.at, "an operator is missing here (a product is written with *)"))
        }
        Some(c) => Err(Fault::new(p.at, format!("`{c}` has no meaning here"))),
    }
}

struct Parser<'a> {
    text: &'a str,
    at: usize,
    names: &'a Names,
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

    /// The next character that is no space.
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
    fn expression(&mut self, least: u8) -> Result<u32, Fault> {
        self.depth += 1;
        if self.depth > MOST_DEPTH {
            return Err(Fault::new(self.at, format!("it is nested more than {MOST_DEPTH} deep")));
        }
        let mut left = self.operand()?;
        while let Some(c) = self.peek() {
            let power = c == '^' || self.rest().starts_with("**");
            let (binds, right, op) = match c {
                _ if power => (POWER, POWER, Binary::Pow), // to the right: 2^3^2 = 2^(3^2)
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

    fn operand(&mut self) -> Result<u32, Fault> {
        let at = match self.peek() {
            None => return Err(Fault::new(self.at, "it ends where a value should stand")),
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
            c => Err(Fault::new(at, format!("a value should stand here, not `{c}`"))),
        }
    }

    fn close(&mut self, opened: usize) -> Result<(), Fault> {
        if self.eat(")") {
            return Ok(());
        }
        Err(match self.peek() {
            None => Fault::new(opened, "this bracket is never closed"),
            Some(',') => {
                Fault::new(self.at, "this comma has no function to belong to, or one argument too many before it")
            }
            Some(_) => Fault::new(self.at, "an operator or a closing bracket is missing here"),
        })
    }

    fn number(&mut self) -> Result<u32, Fault> {
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
        // An exponent only if digits follow; else it is the number e, and an operator is missing.
        if matches!(b.get(end), Some(b'e' | b'E')) {
            let sign = usize::from(matches!(b.get(end + 1), Some(b'+' | b'-')));
            let all = digits(end + 1 + sign);
            if all > end + 1 + sign {
                end = all;
            }
        }
        let value: f64 = self.rest()[..end].parse().map_err(|_| Fault::new(at, "this is no number"))?;
        if !value.is_finite() {
            return Err(Fault::new(at, "this number is too large"));
        }
        self.at += end;
        self.emit(at, |p| p.constant(value))
    }

    fn word(&mut self) -> Result<u32, Fault> {
        let at = self.at;
        let len = self.rest().chars().take_while(|c| c.is_ascii_alphanumeric() || *c == '_').count();
        let word = self.rest()[..len].to_owned();
        self.at += len;
        if let Some(v) = self.names.get(&word) {
            return Ok(v);
        }
        let Some(f) = function(&word) else {
            let known: Vec<&str> = self.names.0.iter().map(|(n, _)| n.as_str()).collect();
            let what = format!("there is no `{word}`; names are {}; functions are {FUNCTIONS}", known.join(" "));
            return Err(Fault::new(at, what));
        };
        let opened = self.at;
        if !self.eat("(") {
            return Err(Fault::new(self.at, format!("`{word}` is a function: its argument goes in brackets")));
        }
        let first = self.expression(0)?;
        match f {
            Function::One(op) => {
                self.close(opened)?;
                self.emit(at, |p| p.unary(op, first))
            }
            Function::Two(op) => {
                if !self.eat(",") {
                    return Err(Fault::new(
                        self.at,
                        format!("`{word}` takes two arguments, with a comma between them"),
                    ));
                }
                let second = self.expression(0)?;
                self.close(opened)?;
                self.emit(at, |p| p.binary(op, first, second))
            }
        }
    }

    fn emit(&mut self, at: usize, f: impl FnOnce(&mut Program) -> Option<u32>) -> Result<u32, Fault> {
        f(self.program).ok_or_else(|| Fault::new(at, "it has too many operations"))
    }
}
