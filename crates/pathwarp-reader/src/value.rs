//! Computes values that usvg does not read: `var()` (CSS Custom Properties 1), `calc()`, `min()`, `max()`, `clamp()` and units
//! relative to fonts and windows (CSS Values 4), `light-dark()` (CSS Color 5).

use cssparser::{Parser, Token};
use std::borrow::Cow;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::rc::Rc;

/// Longest chain of variables to follow.
const MAX_CHAIN: usize = 16;

/// Length of the longest value after substitution. A few variables can multiply to any length.
const MAX_LEN: usize = 1 << 14;

/// Functions that need computing.
const FUNCTIONS: [&str; 6] = ["var(", "calc(", "min(", "max(", "clamp(", "light-dark("];

/// The initial font size, in px.
pub(super) const MEDIUM: f64 = 16.0;

/// Custom properties with their values after substitution.
pub(super) type Custom = BTreeMap<String, Rc<str>>;

/// The bases of relative units, in user units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Units {
    /// Font size of the element.
    pub(super) font: f64,
    /// Font size of the root element.
    pub(super) root_font: f64,
    /// The window: the size of the drawing.
    pub(super) window: (f64, f64),
    /// The nearest viewport.
    pub(super) viewport: (f64, f64),
}

impl Units {
    /// The length that 100 % of a property stands for.
    pub(super) fn percentage_base(&self, name: &str) -> f64 {
        let (w, h) = self.viewport;
        match name {
            "x" | "width" | "cx" | "rx" | "x1" | "x2" | "dx" | "fx" | "refX" | "markerWidth" => w,
            "y" | "height" | "cy" | "ry" | "y1" | "y2" | "dy" | "fy" | "refY" | "markerHeight" => h,
            _ => w.hypot(h) / std::f64::consts::SQRT_2,
        }
    }

    /// Reads a length or percentage of a property, in user units.
    pub(super) fn length(&self, name: &str, value: &str) -> Option<f64> {
        length(value, self, self.percentage_base(name))
    }
}

/// Returns `true` if a value has no variables, expressions or units for [`substituted`] and [`computed`] to replace.
pub(super) fn is_plain(value: &str) -> bool {
    let bytes = value.as_bytes();
    let precedes_unit = |(i, b): (usize, &u8)| {
        (b.is_ascii_digit() || *b == b'.') && bytes.get(i + 1).is_some_and(u8::is_ascii_alphabetic) && {
            let unit = value[i + 1..].split(|c: char| !c.is_ascii_alphanumeric()).next();
            unit.is_some_and(is_relative)
        }
    };
    !has_functions(value) && !bytes.iter().enumerate().any(precedes_unit)
}

/// Returns `true` if a value has variables or expressions.
pub(super) fn has_functions(value: &str) -> bool {
    calls(value).any(|before| FUNCTIONS.iter().any(|f| ends_in(before, f)))
}

/// The beginnings of a value up to each opening parenthesis, which is included.
fn calls(value: &str) -> impl Iterator<Item = &[u8]> {
    memchr::memchr_iter(b'(', value.as_bytes()).map(|i| &value.as_bytes()[..=i])
}

/// Returns `true` if a text ends in a function's name, in upper or lower case.
fn ends_in(text: &[u8], function: &str) -> bool {
    let start = text.len().checked_sub(function.len());
    start.is_some_and(|start| text[start..].eq_ignore_ascii_case(function.as_bytes()))
}

/// Finds the first occurrence of a function's name, which ends in a parenthesis, in upper or lower case.
fn find(value: &str, function: &str) -> Option<usize> {
    calls(value).find(|before| ends_in(before, function)).map(|before| before.len() - function.len())
}

/// Returns `true` if usvg doesn't know a unit.
fn is_relative(unit: &str) -> bool {
    let unit = unit.to_ascii_lowercase();
    matches!(unit.as_str(), "em" | "ex" | "rem" | "ch" | "ic" | "cap" | "lh" | "rlh" | "q")
        || unit
            .strip_prefix(['s', 'l', 'd'])
            .unwrap_or(&unit)
            .strip_prefix('v')
            .is_some_and(|v| matches!(v, "w" | "h" | "i" | "b" | "min" | "max"))
}

/// Replaces variables. Returns `None` if one has no value, which makes the declaration invalid.
pub(super) fn substituted(value: &str, variable: &dyn Fn(&str) -> Option<String>) -> Option<String> {
    substituted_to_depth(value, variable, MAX_CHAIN)
}

/// Replaces variables. Fallbacks may be nested to a depth.
fn substituted_to_depth(value: &str, variable: &dyn Fn(&str) -> Option<String>, depth: usize) -> Option<String> {
    let mut out = String::new();
    let mut left = value;
    while let Some(start) = find(left, "var(") {
        out.push_str(&left[..start]);
        let inside = &left[start + "var(".len()..];
        let end = block_end(&mut Parser::new(inside));
        let arguments = &inside[..end];
        let (name, fallback) = arguments.split_once(',').map_or((arguments, None), |(n, f)| (n, Some(f)));
        let fallback = || substituted_to_depth(fallback?, variable, depth.checked_sub(1)?);
        out.push_str(variable(name.trim()).or_else(fallback)?.trim());
        if out.len() > MAX_LEN {
            return None;
        }
        left = inside.get(end + 1..).unwrap_or_default();
    }
    out.push_str(left);
    (out.len() <= MAX_LEN).then(|| out.trim().to_owned())
}

/// The position of the parenthesis that closes the current block.
fn block_end(input: &mut Parser<'_>) -> usize {
    loop {
        let position = input.position().byte_index();
        match input.next_including_whitespace_and_comments() {
            Err(_) | Ok(Token::CloseParenthesis) => return position,
            Ok(Token::Function(_) | Token::ParenthesisBlock | Token::SquareBracketBlock | Token::CurlyBracketBlock) => {
                nested(input);
            }
            Ok(_) => {}
        }
    }
}

/// The custom properties of an element, declared and inherited.
pub(super) fn custom(declared: &[(String, String)], inherited: &Custom) -> Custom {
    let declared = declared.iter().map(|(n, v)| (n.as_str(), v.as_str())).collect();
    let variables = Variables { declared, inherited, known: RefCell::default() };
    let mut out = inherited.clone();
    for name in variables.declared.keys() {
        match variables.value(name, MAX_CHAIN) {
            Some(v) => out.insert((*name).to_owned(), v),
            None => out.remove(*name),
        };
    }
    out
}

/// Resolves variables that may refer to each other.
struct Variables<'a> {
    /// The last declaration of each.
    declared: BTreeMap<&'a str, &'a str>,
    inherited: &'a Custom,
    /// Values found so far; `None` for variables without a value, and for those being resolved.
    known: RefCell<BTreeMap<String, Option<Rc<str>>>>,
}

impl Variables<'_> {
    fn value(&self, name: &str, depth: usize) -> Option<Rc<str>> {
        let Some(raw) = self.declared.get(name) else { return self.inherited.get(name).cloned() };
        if let Some(known) = self.known.borrow().get(name) {
            return known.clone();
        }
        self.known.borrow_mut().insert(name.to_owned(), None);
        let value = if find(raw, "var(").is_some() {
            depth.checked_sub(1).and_then(|depth| substituted(raw, &|n| self.value(n, depth).map(|v| v.to_string())))
        } else {
            (raw.len() <= MAX_LEN).then(|| (*raw).to_owned())
        };
        let value: Option<Rc<str>> = value.map(Into::into);
        self.known.borrow_mut().insert(name.to_owned(), value.clone());
        value
    }
}

/// Replaces expressions and relative units by px, but not inside other functions, such as `rgb()`. `percent` is the value of 100 %. Returns
/// `None` for values that are invalid or cannot be computed.
pub(super) fn computed(value: &str, units: &Units, percent: Option<f64>) -> Option<String> {
    let mut out = String::new();
    let mut input = Parser::new(value);
    let math = Math { units, percent };
    loop {
        let start = input.position();
        let Ok(token) = input.next_including_whitespace_and_comments().cloned() else { return Some(out) };
        match &token {
            Token::Function(name) if is_math(name) => {
                let quantity = math.function(&name.to_ascii_lowercase(), &mut input)?;
                out.push_str(&quantity.text());
            }
            Token::Function(name) if name.eq_ignore_ascii_case("light-dark") => {
                let inside = nested(&mut input);
                out.push_str(&computed(arguments(inside).next()?, units, percent)?);
            }
            Token::Dimension { unit, .. } if is_relative(unit) => {
                out.push_str(&math.dimension(input.slice_from(start), unit)?.text());
            }
            Token::Function(_) | Token::ParenthesisBlock | Token::SquareBracketBlock | Token::CurlyBracketBlock => {
                nested(&mut input);
                out.push_str(input.slice_from(start));
            }
            _ => out.push_str(input.slice_from(start)),
        }
    }
}

/// The text inside a block.
pub(super) fn nested<'i>(input: &mut Parser<'i>) -> &'i str {
    let inside = input.parse_nested_block(|input| {
        let start = input.position();
        while input.next().is_ok() {}
        Ok::<_, cssparser::ParseError<()>>(input.slice_from(start))
    });
    inside.unwrap_or_default()
}

/// Splits at the commas outside parentheses.
pub(super) fn arguments(text: &str) -> impl Iterator<Item = &str> {
    split_outside(text, |c| c == ',').map(str::trim)
}

/// Splits at the separators outside parentheses.
pub(super) fn split_outside(text: &str, is_separator: impl Fn(char) -> bool) -> impl Iterator<Item = &str> {
    let mut depth = 0_usize;
    text.split(move |c| {
        match c {
            '(' => depth += 1,
            ')' => depth = depth.saturating_sub(1),
            _ => {}
        }
        depth == 0 && is_separator(c)
    })
}

/// Reads a single length or percentage, in user units.
pub(super) fn length(value: &str, units: &Units, percent: f64) -> Option<f64> {
    let mut input = Parser::new(value);
    let quantity = Math { units, percent: Some(percent) }.atom(&mut input)?;
    (input.is_exhausted() && quantity.value.is_finite()).then_some(quantity.value)
}

/// Rewrites a length for usvg. `percent` is the length of 100 % if percentages are to be replaced, too. Returns `None` for anything that is
/// not a length, for negative ones if `non_negative`, and for numbers other than zero without a unit if `strict`.
pub(super) fn known_length<'v>(
    text: &'v str,
    units: &Units,
    percent: Option<f64>,
    non_negative: bool,
    strict: bool,
) -> Option<Cow<'v, str>> {
    let bytes = text.as_bytes();
    let digits = |from: usize| from + bytes[from..].iter().take_while(|b| b.is_ascii_digit()).count();
    let sign = usize::from(matches!(bytes.first(), Some(b'+' | b'-')));
    let mut end = digits(sign);
    if bytes.get(end) == Some(&b'.') && bytes.get(end + 1).is_some_and(u8::is_ascii_digit) {
        end = digits(end + 1);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let exponent = end + 1 + usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        if bytes.get(exponent).is_some_and(u8::is_ascii_digit) {
            end = digits(exponent);
        }
    }
    let (number, unit) = text.split_at(end);
    let value: f64 = number.parse().ok()?;
    if non_negative && value < 0.0 {
        return None;
    }
    let lower = unit.to_ascii_lowercase();
    match lower.as_str() {
        "" if strict && value != 0.0 => None,
        "" => Some(Cow::Borrowed(text)),
        "px" | "in" | "cm" | "mm" | "pt" | "pc" if lower == unit => Some(Cow::Borrowed(text)),
        "px" | "in" | "cm" | "mm" | "pt" | "pc" => Some(format!("{number}{lower}").into()),
        "%" => Some(percent.map_or(Cow::Borrowed(text), |full| format!("{}px", (value / 100.0) * full).into())),
        _ => Some(format!("{}px", length(text, units, 0.0)?).into()),
    }
}

/// A parsed `url()`.
#[derive(Debug, PartialEq)]
pub(super) struct Reference<'v> {
    /// The id of an element in the same file; `None` for a link to another file.
    pub(super) id: Option<String>,
    /// The text that follows.
    pub(super) rest: &'v str,
}

impl Reference<'_> {
    /// Rewrites the reference for usvg.
    pub(super) fn text<'t>(&self, old: &'t str) -> Cow<'t, str> {
        let Some(id) = self.id.as_deref().map(safe_id) else { return Cow::Borrowed(old) };
        let is_plain = old.strip_prefix("url(#").and_then(|o| o.strip_prefix(&*id)).is_some_and(|o| o.starts_with(')'));
        if is_plain { Cow::Borrowed(old) } else { format!("url(#{id}){}", self.rest).into() }
    }
}

/// Parses the reference that a value begins with.
pub(super) fn reference(value: &str) -> Option<Reference<'_>> {
    if !value.as_bytes().get(..4)?.eq_ignore_ascii_case(b"url(") {
        return None;
    }
    let mut input = Parser::new(value);
    let target = match input.next().ok()?.clone() {
        Token::UnquotedUrl(target) => target.as_ref().to_owned(),
        Token::Function(_) => {
            let inside = input.parse_nested_block(|i| i.expect_string_cloned().map_err(|_| unexpected()));
            inside.ok()?.as_ref().to_owned()
        }
        _ => return None,
    };
    let id = target.trim().strip_prefix('#').map(|id| percent_decoded(id).into_owned());
    Some(Reference { id, rest: value.get(input.position().byte_index()..)? })
}

/// Decodes the percent escapes in a part of a URL (RFC 3986, 2.1). A part whose bytes are not UTF-8 then stays as it is.
#[must_use]
pub fn percent_decoded(part: &str) -> Cow<'_, str> {
    if !part.contains('%') {
        return Cow::Borrowed(part);
    }
    let (mut out, mut i) = (Vec::with_capacity(part.len()), 0);
    while let Some(&b) = part.as_bytes().get(i) {
        let digits = part.get(i + 1..i + 3).filter(|d| b == b'%' && d.bytes().all(|d| d.is_ascii_hexdigit()));
        let code = digits.and_then(|d| u8::from_str_radix(d, 16).ok());
        out.push(code.unwrap_or(b));
        i += if code.is_some() { 3 } else { 1 };
    }
    String::from_utf8(out).map_or(Cow::Borrowed(part), Cow::Owned)
}

/// Replaces characters of an id that would end references by their codes.
pub(super) fn safe_id(id: &str) -> Cow<'_, str> {
    let is_bad = |c: char| c.is_whitespace() || matches!(c, '(' | ')' | '"' | '\'' | '\\');
    if !id.contains(is_bad) {
        return Cow::Borrowed(id);
    }
    id.chars().map(|c| if is_bad(c) { format!("_{:x}_", u32::from(c)) } else { c.to_string() }).collect()
}

/// Reads the path data of `path("…")`.
pub(super) fn path_data(value: &str) -> Option<String> {
    let mut input = Parser::new(value);
    input.expect_function_matching("path").ok()?;
    let data = input.parse_nested_block(|i| {
        // A fill rule may precede the data; it has no effect.
        let _ = i.try_parse(|i| i.expect_ident_cloned().and_then(|_| i.expect_comma()));
        i.expect_string_cloned().map_err(|_| unexpected())
    });
    data.ok().map(|d| d.as_ref().to_owned())
}

/// A number, or a length in px. Percentages count as lengths.
#[derive(Debug, Clone, Copy)]
struct Quantity {
    value: f64,
    is_length: bool,
}

impl Quantity {
    fn text(self) -> String {
        format!("{}{}", self.value, if self.is_length { "px" } else { "" })
    }
}

fn is_math(name: &str) -> bool {
    ["calc", "min", "max", "clamp", "-webkit-calc"].iter().any(|f| name.eq_ignore_ascii_case(f))
}

/// Evaluates math expressions (CSS Values 4, section 10).
struct Math<'a> {
    units: &'a Units,
    /// The value of 100 %; `None` makes percentages invalid.
    percent: Option<f64>,
}

impl Math<'_> {
    fn function(&self, name: &str, input: &mut Parser<'_>) -> Option<Quantity> {
        let arguments = input.parse_nested_block(|input| {
            let mut all = vec![self.sum(input).ok_or_else(unexpected)?];
            while input.try_parse(Parser::expect_comma).is_ok() {
                all.push(self.sum(input).ok_or_else(unexpected)?);
            }
            input.expect_exhausted()?;
            Ok(all)
        });
        let all = arguments.ok()?;
        let folded =
            |f: fn(f64, f64) -> f64| all.iter().copied().reduce(|a, b| Quantity { value: f(a.value, b.value), ..a });
        let out = match (name, all.as_slice()) {
            ("min", _) => folded(f64::min),
            ("max", _) => folded(f64::max),
            ("clamp", [low, value, high]) => {
                Some(Quantity { value: value.value.min(high.value).max(low.value), ..*value })
            }
            ("calc" | "-webkit-calc", [one]) => Some(*one),
            _ => None,
        };
        out.filter(|q| q.value.is_finite() && all.iter().all(|a| a.is_length == q.is_length))
    }

    fn sum(&self, input: &mut Parser<'_>) -> Option<Quantity> {
        let mut out = self.product(input)?;
        loop {
            let state = input.state();
            let sign = match input.next() {
                Ok(Token::Delim('+')) => 1.0,
                Ok(Token::Delim('-')) => -1.0,
                _ => {
                    input.reset(&state);
                    return Some(out);
                }
            };
            let term = self.product(input).filter(|t| t.is_length == out.is_length)?;
            out.value += sign * term.value;
        }
    }

    fn product(&self, input: &mut Parser<'_>) -> Option<Quantity> {
        let mut out = self.atom(input)?;
        loop {
            let state = input.state();
            match input.next() {
                Ok(Token::Delim('*')) => {
                    let factor = self.atom(input).filter(|f| !(f.is_length && out.is_length))?;
                    out = Quantity { value: out.value * factor.value, is_length: out.is_length || factor.is_length };
                }
                Ok(Token::Delim('/')) => {
                    out.value /= self.atom(input).filter(|divisor| !divisor.is_length && divisor.value != 0.0)?.value;
                }
                _ => {
                    input.reset(&state);
                    return Some(out);
                }
            }
        }
    }

    fn atom(&self, input: &mut Parser<'_>) -> Option<Quantity> {
        input.skip_whitespace();
        let start = input.position();
        let token = input.next().ok()?.clone();
        let text = input.slice_from(start).trim();
        match &token {
            Token::Number { .. } => Some(Quantity { value: text.parse().ok()?, is_length: false }),
            Token::Percentage { .. } => {
                let share: f64 = text.strip_suffix('%')?.parse().ok()?;
                Some(Quantity { value: (share / 100.0) * self.percent?, is_length: true })
            }
            Token::Dimension { unit, .. } => self.dimension(text, unit),
            Token::ParenthesisBlock => {
                let inside = input.parse_nested_block(|input| {
                    let sum = self.sum(input).ok_or_else(unexpected)?;
                    input.expect_exhausted()?;
                    Ok(sum)
                });
                inside.ok()
            }
            Token::Function(name) if is_math(name) => self.function(&name.to_ascii_lowercase(), input),
            _ => None,
        }
    }

    fn dimension(&self, text: &str, unit: &str) -> Option<Quantity> {
        /// Pixels of CSS per inch.
        const INCH: f64 = 96.0;
        let number: f64 = text.get(..text.len().checked_sub(unit.len())?)?.parse().ok()?;
        let &Units { font, root_font, window: (w, h), .. } = self.units;
        let unit = unit.to_ascii_lowercase();
        let window = |side: &str| {
            Some(match side {
                "w" | "i" => w,
                "h" | "b" => h,
                "min" => w.min(h),
                "max" => w.max(h),
                _ => return None,
            })
        };
        let one = match unit.as_str() {
            "px" => 1.0,
            "em" | "ic" => font,
            "rem" => root_font,
            // CSS assumes half an em for fonts without these metrics. The height of capitals and lines is that of ordinary fonts.
            "ex" | "ch" => 0.5 * font,
            "cap" => 0.7 * font,
            "lh" => 1.2 * font,
            "rlh" => 1.2 * root_font,
            "in" => INCH,
            "cm" => INCH / 2.54,
            "mm" => INCH / 25.4,
            "q" => INCH / 101.6,
            "pt" => INCH / 72.0,
            "pc" => INCH / 6.0,
            other => window(other.strip_prefix(['s', 'l', 'd']).unwrap_or(other).strip_prefix('v')?)? / 100.0,
        };
        Some(Quantity { value: number * one, is_length: true })
    }
}

fn unexpected() -> cssparser::ParseError<()> {
    cssparser::ParseError::unexpected_token()
}

#[cfg(test)]
mod tests;
