//! Properties of text that usvg reads differently, or not at all (CSS Fonts 4, Text 3 and 4, Writing Modes 3).

use crate::geometry::factor;
use crate::ids::attribute;
use cssparser::{Parser, Token};
use roxmltree::{Node, NodeId};
use std::collections::{BTreeMap, HashMap};
use std::ops::Range;
use std::rc::Rc;

/// The longhands that `font` sets, with their initial values. [`font`] refers to them by their indices.
const FONT: [(&str, &str); 7] = [
    ("font-style", "normal"),
    ("font-variant", "normal"),
    ("font-weight", "normal"),
    ("font-stretch", "normal"),
    ("font-size", "medium"),
    ("font-family", "serif"),
    ("font-kerning", "auto"),
];

/// Widths in percent, with their keywords.
#[rustfmt::skip]
const WIDTHS: [(f64, &str); 9] = [
    (50.0, "ultra-condensed"), (62.5, "extra-condensed"), (75.0, "condensed"), (87.5, "semi-condensed"), (100.0, "normal"),
    (112.5, "semi-expanded"), (125.0, "expanded"), (150.0, "extra-expanded"), (200.0, "ultra-expanded"),
];

/// Sizes by keyword, in px, as in browsers (CSS Fonts 4, section 2.5.1).
#[rustfmt::skip]
const SIZES: [(&str, f64); 8] = [
    ("xx-small", 9.0), ("x-small", 10.0), ("small", 13.0), ("medium", 16.0), ("large", 18.0), ("x-large", 24.0), ("xx-large", 32.0),
    ("xxx-large", 48.0),
];

/// Properties that usvg ignores, with the words that ask for nothing special. A value with any other word is reported.
const WITHOUT_EFFECT: [(&str, &[&str]); 13] = [
    ("font-variant", &["normal", "none", "common-ligatures", "contextual", "small-caps"]),
    ("font-variant-caps", &["normal", "small-caps", "all-small-caps"]),
    ("font-variant-ligatures", &["normal", "common-ligatures", "contextual"]),
    ("font-variant-numeric", &["normal"]),
    ("font-variant-position", &["normal"]),
    ("font-variant-east-asian", &["normal"]),
    ("font-feature-settings", &["normal"]),
    ("font-size-adjust", &["none"]),
    ("text-shadow", &["none"]),
    ("text-orientation", &["mixed", "auto", "sideways", "sideways-right"]),
    ("text-decoration", &["none", "underline", "overline", "line-through", "solid", "auto", "blink"]),
    ("text-decoration-style", &["solid", "auto"]),
    ("text-decoration-thickness", &["auto", "from-font"]),
];

// Differences from browsers, as notes.
const OVERLINE: &str = "overlines are a little nearer to the letters than in browsers";
const SPACES: &str = "spaces where parts of a text keep them and others do not are not those of browsers";
const LINES: &str = "a tspan with y and without x begins where the words before end, which centred or right-aligned lines of browsers do not";
const ON_PATHS: &str =
    "letters on a path turn about their middle, which in browsers is that of the letter with its spacing";
const AFTER_PATHS: &str = "words after a textPath begin elsewhere than in browsers";
const VERTICAL: &str = "punctuation, lines and turned letters of vertical text are placed otherwise than in browsers";

/// The case that `text-transform` or `font-variant-caps` asks for.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) enum Case {
    #[default]
    AsTyped,
    Upper,
    Lower,
    /// Every word begins with a capital.
    Capitalized,
}

/// Inherited style of text.
#[derive(Debug, Clone)]
pub(super) struct TextStyle {
    weight: u16,
    /// `true` if white space is kept, `false` if it is collapsed; `None` leaves it to `xml:space`.
    keeps_space: Option<bool>,
    rtl: bool,
    /// The value of `text-anchor`: `start`, `middle` or `end`.
    anchor: &'static str,
    /// Opacities of the fill and the stroke.
    opacities: [f64; 2],
    /// Product of the opacities of the elements from below the text to this one. `None` outside of texts.
    part_opacity: Option<f64>,
    case: Case,
    /// `true` if `letter-spacing` is not zero.
    spaced: bool,
    /// Declarations without effect, by property.
    without_effect: Rc<BTreeMap<&'static str, String>>,
}

impl Default for TextStyle {
    fn default() -> Self {
        Self {
            weight: 400,
            keeps_space: None,
            rtl: false,
            anchor: "start",
            opacities: [1.0; 2],
            part_opacity: None,
            case: Case::AsTyped,
            spaced: false,
            without_effect: Rc::default(),
        }
    }
}

/// Changes to an element for usvg.
#[derive(Debug, Default)]
pub(super) struct TextChanges {
    pub(super) style: Vec<(String, String)>,
    pub(super) attributes: Vec<(&'static str, String)>,
    pub(super) unsupported: Vec<String>,
    /// Small differences from what browsers show.
    pub(super) notes: Vec<&'static str>,
}

/// Changes to the letters of an element.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Letters {
    pub(super) case: Case,
    /// `true` to break up ligatures, which usvg forms even between letters with spacing (CSS Text 3, section 8.2).
    pub(super) separate: bool,
    /// A control character to set the direction of the text (Unicode Standard Annex 9, section 2), since usvg always starts from
    /// left to right.
    pub(super) direction: Option<char>,
    /// `true` to collapse white space before usvg reads the text, since usvg would lose spaces.
    pub(super) collapses: bool,
}

impl TextStyle {
    /// Returns `true` if an element is a text or a part of one.
    pub(super) fn concerns(&self, tag: &str) -> bool {
        tag == "text" || self.part_opacity.is_some()
    }

    /// Applies the properties of an element, which `value` looks up.
    pub(super) fn declare<'a>(
        &mut self,
        node: Node<'_, '_>,
        value: impl Fn(&str) -> Option<&'a str>,
    ) -> (TextChanges, Letters) {
        let tag = node.tag_name().name();
        let value = |name: &str| value(name).map(str::trim).filter(|v| !v.eq_ignore_ascii_case("inherit"));
        let mut out = TextChanges::default();
        let mut set = |name: &str, v: String| out.style.push((name.to_owned(), v));
        if let Some((raw, weight)) = value("font-weight").and_then(|v| Some((v, weight(v, self.weight)?))) {
            self.weight = weight;
            if !matches!(raw, "normal" | "bold") && raw != weight.to_string() {
                set("font-weight", weight.to_string());
            }
        }
        if let Some(keyword) = value("font-stretch").and_then(width) {
            set("font-stretch", keyword.to_owned());
        }
        self.anchor = value("text-anchor").map_or(self.anchor, |v| match v {
            "middle" => "middle",
            "end" => "end",
            _ => "start",
        });
        self.rtl = value("direction").map_or(self.rtl, |v| v == "rtl");
        self.case = value("text-transform").map_or(self.case, |v| match v.to_ascii_lowercase().as_str() {
            "uppercase" => Case::Upper,
            "lowercase" => Case::Lower,
            "capitalize" => Case::Capitalized,
            _ => Case::AsTyped,
        });
        self.spaced = value("letter-spacing").map_or(self.spaced, |v| {
            let end = v.find(|c: char| !c.is_ascii_digit() && !matches!(c, '.' | '-' | '+')).unwrap_or(v.len());
            v[..end].parse().is_ok_and(|n: f64| n != 0.0)
        });
        let parent_keeps_space = self.keeps_space;
        self.keeps_space = value("white-space")
            .map_or(self.keeps_space, |v| Some(matches!(v, "pre" | "pre-wrap" | "break-spaces" | "-moz-pre-space")));
        let is_part = self.part_opacity.is_some() && is_part(node);
        let is_content = tag == "text" || is_part;
        if is_content && self.rtl {
            // CSS starts at the right, usvg at the left.
            let anchor = match self.anchor {
                "start" => "end",
                "end" => "start",
                middle => middle,
            };
            set("text-anchor", anchor.to_owned());
        }
        self.capitals(&value, &mut set);
        let collapses = tag == "text" && self.keeps_space.is_none() && loses_spaces(node);
        if collapses {
            out.attributes.push(("xml:space", "preserve".to_owned()));
        }
        self.multiply_opacities(tag, &value, &mut set);
        if let Some(keeps) = self.keeps_space.filter(|_| is_content) {
            out.attributes.push(("xml:space", if keeps { "preserve" } else { "default" }.to_owned()));
        }
        out.unsupported = self.without_effect(tag, is_content, &value);
        let shift = value("baseline-shift").filter(|v| tag == "text" && !matches!(*v, "baseline" | "0" | "initial"));
        out.unsupported.extend(shift.map(|v| format!("baseline-shift: {}", excerpt(v))));
        let has_overline = value("text-decoration").is_some_and(|v| v.contains("overline"));
        let changes_spaces =
            is_part && keeps_space(self.keeps_space, Some(node)) != keeps_space(parent_keeps_space, node.parent());
        let begins_lower = is_part && self.anchor != "start" && begins_lower(node);
        let is_path = tag == "textPath" && is_part;
        let has_words = |n: Node<'_, '_>| n.text().is_some_and(|t| !t.trim().is_empty()) || n.has_tag_name("tspan");
        let is_vertical = value("writing-mode").is_some_and(|v| v.starts_with("tb") || v.starts_with("vertical"));
        let notes = [
            (has_overline, OVERLINE),
            (changes_spaces, SPACES),
            (begins_lower, LINES),
            (is_path && self.spaced, ON_PATHS),
            (is_path && node.next_siblings().skip(1).any(has_words), AFTER_PATHS),
            (is_vertical, VERTICAL),
        ];
        out.notes = notes.into_iter().filter(|(applies, _)| *applies).map(|(_, note)| note).collect();
        let overrides = matches!(value("unicode-bidi"), Some("bidi-override" | "isolate-override"));
        let direction = direction_control(self.rtl, overrides);
        (out, Letters { case: self.case, separate: self.spaced, direction, collapses })
    }

    /// Declares small capitals as usvg reads them.
    fn capitals<'a>(&mut self, value: &impl Fn(&str) -> Option<&'a str>, set: &mut impl FnMut(&str, String)) {
        let Some(caps) = value("font-variant-caps").or_else(|| value("font-variant")) else { return };
        let small = caps.split_whitespace().any(|w| w.ends_with("small-caps"));
        let known = if small { "small-caps" } else { "normal" };
        if value("font-variant").unwrap_or("normal") != known {
            set("font-variant", known.to_owned());
        }
        self.case = if caps == "all-small-caps" { Case::Lower } else { self.case };
    }

    /// Multiplies the opacities of the fill and stroke of a part of a text by its opacity, which usvg ignores.
    fn multiply_opacities<'a>(
        &mut self,
        tag: &str,
        value: &impl Fn(&str) -> Option<&'a str>,
        set: &mut impl FnMut(&str, String),
    ) {
        const NAMES: [&str; 2] = ["fill-opacity", "stroke-opacity"];
        let declared = NAMES.map(|name| value(name).and_then(opacity));
        for (inherited, declared) in self.opacities.iter_mut().zip(declared) {
            *inherited = declared.unwrap_or(*inherited);
        }
        let Some(of_parent) = self.part_opacity else {
            self.part_opacity = (tag == "text").then_some(1.0);
            return;
        };
        let product = of_parent * value("opacity").and_then(opacity).unwrap_or(1.0);
        self.part_opacity = Some(product);
        for ((name, opacity), declared) in NAMES.iter().zip(self.opacities).zip(declared) {
            if product != of_parent || (declared.is_some() && product != 1.0) {
                set(name, (opacity * product).to_string());
            }
        }
    }

    /// Lists the declarations that usvg ignores on a text or a part of one.
    fn without_effect<'a>(
        &mut self,
        tag: &str,
        is_content: bool,
        value: &impl Fn(&str) -> Option<&'a str>,
    ) -> Vec<String> {
        let mut changed = false;
        for (name, plain) in WITHOUT_EFFECT {
            let Some(v) = value(name) else { continue };
            let is_plain = v.to_ascii_lowercase().split_ascii_whitespace().all(|word| plain.contains(&word));
            let all = Rc::make_mut(&mut self.without_effect);
            changed |= if is_plain {
                all.remove(name).is_some()
            } else {
                let v = excerpt(v);
                all.insert(name, v.to_owned()).is_none_or(|old| old != v)
            };
        }
        if tag == "text" || (is_content && changed) {
            self.without_effect.iter().map(|(name, v)| format!("{name}: {v}")).collect()
        } else {
            Vec::new()
        }
    }
}

/// Returns `true` if an element keeps its white space, by its style, or else by `xml:space` on it or around it.
fn keeps_space(style: Option<bool>, node: Option<Node<'_, '_>>) -> bool {
    let declared = |n: Node<'_, '_>| n.ancestors().find_map(|a| attribute(a, "xml:space").map(|v| v == "preserve"));
    style.or_else(|| declared(node?)).unwrap_or(false)
}

/// The control character that sets a direction; `None` for ordinary left-to-right text.
fn direction_control(rtl: bool, overrides: bool) -> Option<char> {
    match (rtl, overrides) {
        (true, true) => Some('\u{202e}'),
        (true, false) => Some('\u{202b}'),
        (false, true) => Some('\u{202d}'),
        (false, false) => None,
    }
}

/// Returns `true` if usvg loses a space of this text: one at the beginning of a part.
fn loses_spaces(text: Node<'_, '_>) -> bool {
    let keeps = |n: Node<'_, '_>| {
        attribute(n, "xml:space").is_some() || n.attribute("style").is_some_and(|s| s.contains("white-space"))
    };
    let parts = text.descendants().filter(Node::is_element);
    if keeps_space(None, Some(text)) || parts.skip(1).any(keeps) {
        return false;
    }
    let mut before = None;
    text.descendants().filter(Node::is_text).any(|n| {
        let words = n.text().unwrap_or_default();
        let is_in_part = n.parent().is_some_and(|p| p != text);
        let is_lost =
            is_in_part && words.starts_with(char::is_whitespace) && before.is_some_and(|c: char| !c.is_whitespace());
        before = words.chars().next_back().or(before);
        is_lost
    })
}

/// Returns `true` if a part of a text sets only its y, so that it begins below the end of the words before it.
fn begins_lower(part: Node<'_, '_>) -> bool {
    /// Siblings to search for words; some may be white space or comments.
    const SIBLINGS: usize = 4;
    let has_words = |n: Node<'_, '_>| n.descendants().filter_map(|d| d.text()).any(|t| !t.trim().is_empty());
    part.has_attribute("y") && !part.has_attribute("x") && part.prev_siblings().skip(1).take(SIBLINGS).any(has_words)
}

/// Returns `true` if [`TextStyle`] follows a property.
pub(super) fn concerns(name: &str) -> bool {
    #[rustfmt::skip]
    const FOLLOWED: [&str; 11] = [
        "font-weight", "font-stretch", "text-anchor", "direction", "text-transform", "letter-spacing", "white-space", "unicode-bidi",
        "fill-opacity", "stroke-opacity", "opacity",
    ];
    FOLLOWED.contains(&name) || WITHOUT_EFFECT.iter().any(|(n, _)| *n == name)
}

/// Shortens a value for messages, of which there may be many, since texts inherit it.
pub(super) fn excerpt(value: &str) -> &str {
    const MAX_CHARS: usize = 80;
    &value[..value.char_indices().nth(MAX_CHARS).map_or(value.len(), |(end, _)| end)]
}

/// Expands a `font` declaration into its longhands. Returns `None` if it is invalid, or names a system font.
pub(super) fn font(value: &str) -> Option<Vec<(&'static str, String)>> {
    let is_any = |text: &str, words: &[&str]| words.iter().any(|w| text.eq_ignore_ascii_case(w));
    if is_any(value, &["inherit", "initial", "unset"]) {
        let is_initial = value.eq_ignore_ascii_case("initial");
        let longhand = |(name, initial)| (name, if is_initial { initial } else { "inherit" }.to_owned());
        return Some(FONT.map(longhand).into());
    }
    let mut input = Parser::new(value);
    let mut found = FONT.map(|(_, initial)| initial.to_owned());
    let size = loop {
        input.skip_whitespace();
        let start = input.position();
        let token = input.next().ok()?.clone();
        let text = input.slice_from(start).trim();
        match &token {
            Token::Ident(word) => {
                let word = word.to_ascii_lowercase();
                let slot = match word.as_str() {
                    "normal" => continue,
                    "italic" | "oblique" => 0,
                    "small-caps" => 1,
                    "bold" | "bolder" | "lighter" => 2,
                    w if WIDTHS.iter().any(|(_, k)| *k == w) => 3,
                    "larger" | "smaller" => break word,
                    w if SIZES.iter().any(|(k, _)| *k == w) => break word,
                    _ => return None,
                };
                found[slot] = word;
            }
            Token::Number { .. } => text.clone_into(&mut found[2]),
            // The angle of oblique letters.
            Token::Dimension { unit, .. } if found[0] == "oblique" && is_any(unit, &["deg", "rad", "grad", "turn"]) => {
            }
            Token::Dimension { .. } | Token::Percentage { .. } => break text.to_owned(),
            _ => return None,
        }
    };
    found[4] = size;
    if input.try_parse(|i| i.expect_delim('/')).is_ok() {
        input.next().ok()?;
    }
    input.skip_whitespace();
    let family = value.get(input.position().byte_index()..)?.trim();
    family.clone_into(&mut found[5]);
    (!family.is_empty()).then(|| FONT.iter().map(|(name, _)| *name).zip(found).collect())
}

/// Converts a keyword for a font size to px. `parent` is the font size of the parent.
pub(super) fn size(value: &str, parent: f64) -> Option<f64> {
    /// Ratio of adjacent sizes.
    const STEP: f64 = 1.2;
    match value.trim().to_ascii_lowercase().as_str() {
        "larger" => Some(parent * STEP),
        "smaller" => Some(parent / STEP),
        keyword => SIZES.iter().find(|(k, _)| *k == keyword).map(|(_, px)| *px),
    }
}

/// Rounds a weight to hundreds, as usvg requires. `parent` is the inherited weight. Returns `None` for invalid values.
pub(super) fn weight(value: &str, parent: u16) -> Option<u16> {
    Some(match value.to_ascii_lowercase().as_str() {
        "normal" => 400,
        "bold" => 700,
        "bolder" => match parent {
            0..350 => 400,
            350..550 => 700,
            _ => parent.max(900),
        },
        "lighter" => match parent {
            0..100 => parent,
            100..550 => 100,
            550..750 => 400,
            _ => 700,
        },
        number => {
            let number: f64 = number.parse().ok().filter(|n| (1.0..=1000.0).contains(n))?;
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "1 to 9")]
            let hundreds = (number / 100.0).round().clamp(1.0, 9.0) as u16;
            100 * hundreds
        }
    })
}

/// Finds the keyword nearest to a width in percent.
fn width(value: &str) -> Option<&'static str> {
    let percent: f64 = value.strip_suffix('%')?.parse().ok()?;
    let distance = |w: f64| (w - percent).abs();
    WIDTHS.iter().min_by(|a, b| distance(a.0).total_cmp(&distance(b.0))).map(|w| w.1)
}

fn opacity(value: &str) -> Option<f64> {
    Some(factor(value)?.clamp(0.0, 1.0))
}

/// Breaks up the ligatures of a text.
fn separated(text: &str) -> String {
    /// An invisible character that prevents ligatures and kerning. Unlike U+200C, usvg adds no letter spacing after it.
    const SEPARATOR: char = '\u{180b}';
    let mut out = String::with_capacity(text.len());
    let mut last = ' ';
    for c in text.chars() {
        if matches!(last, 'f' | 'T') && c.is_ascii_lowercase() {
            out.push(SEPARATOR);
        }
        out.push(c);
        last = c;
    }
    out
}

impl Case {
    /// Changes the case of letters. `before` is the letter before them.
    fn apply(self, text: &str, before: Option<char>) -> String {
        match self {
            Self::AsTyped => text.to_owned(),
            Self::Upper => text.to_uppercase(),
            Self::Lower => text.to_lowercase(),
            Self::Capitalized => {
                let mut out = String::with_capacity(text.len());
                let mut last = before;
                for c in text.chars() {
                    // Apostrophes do not end a word.
                    let begins = last.is_none_or(|l| !l.is_alphanumeric() && !matches!(l, '\'' | '’'));
                    if begins {
                        out.extend(c.to_uppercase());
                    } else {
                        out.push(c);
                    }
                    last = Some(c);
                }
                out
            }
        }
    }
}

/// New content for a run of characters.
pub(super) struct Rewritten {
    /// Number of elements within the text that begin before the run.
    pub(super) elements: usize,
    pub(super) range: Range<usize>,
    pub(super) text: String,
}

/// A run of characters with its old and new content.
struct Run<'a> {
    new: Rewritten,
    old: &'a str,
    style: Letters,
}

/// Rewrites a text. `letters` has the changes for the text and its elements. Returns `None` if its direction cannot be set because
/// single letters have positions: the control characters would count as letters.
pub(super) fn rewritten(text: Node<'_, '_>, letters: &[Letters]) -> Option<Vec<Rewritten>> {
    let mut styles: HashMap<NodeId, Letters> = HashMap::new();
    let mut lines: Vec<Vec<Run<'_>>> = vec![Vec::new()];
    let mut elements = 0;
    let mut before = None;
    let (mut has_direction, mut is_positioned) = (false, false);
    for node in text.descendants() {
        if node.is_element() {
            let style = letters.get(elements).copied().unwrap_or_default();
            elements += 1;
            if node == text || (is_part(node) && node.parent().is_some_and(|p| styles.contains_key(&p.id()))) {
                styles.insert(node.id(), style);
                if begins_line(node) {
                    lines.push(Vec::new());
                }
                has_direction |= style.direction.is_some();
                is_positioned |= has_letter_positions(node);
            }
            continue;
        }
        let style = node.parent().and_then(|p| styles.get(&p.id())).filter(|_| node.is_text());
        let (Some(&style), Some(old), Some(line)) = (style, node.text(), lines.last_mut()) else { continue };
        let new = Rewritten { elements: elements - 1, range: node.range(), text: style.case.apply(old, before) };
        before = old.chars().next_back().or(before);
        line.push(Run { new, old, style });
    }
    if letters.first().is_some_and(|l| l.collapses) {
        collapse(lines.iter_mut().flatten());
    }
    if has_direction && is_positioned {
        return None;
    }
    if !is_positioned {
        lines.iter_mut().for_each(|line| insert_controls(line));
    }
    Some(lines.into_iter().flatten().filter(|r| r.new.text != r.old).map(|r| r.new).collect())
}

/// Collapses white space as browsers do: to one space between words, and to none before the first and after the last word.
fn collapse<'a, 'b: 'a>(runs: impl Iterator<Item = &'a mut Run<'b>>) {
    let is_space = |c: char| matches!(c, ' ' | '\t' | '\n' | '\r');
    let mut after_space = true;
    let mut last: Option<&mut Run<'_>> = None;
    for run in runs {
        let mut text = String::with_capacity(run.new.text.len());
        for c in run.new.text.chars() {
            if !is_space(c) {
                text.push(c);
            } else if !after_space {
                text.push(' ');
            }
            after_space = is_space(c);
        }
        let is_empty = text.is_empty();
        run.new.text = text;
        last = if is_empty { last } else { Some(run) };
    }
    if let Some(run) = last.filter(|_| after_space) {
        run.new.text.truncate(run.new.text.trim_end_matches(' ').len());
    }
}

/// Sets the direction of a line, breaks up its ligatures, and ends it so that its last letter keeps its spacing.
fn insert_controls(line: &mut [Run<'_>]) {
    /// Word joiner: an invisible character that takes the place of the last letter, which usvg gives no spacing.
    const END: char = '\u{2060}';
    let is_letter = |c: char| !c.is_whitespace();
    for run in line.iter_mut().filter(|r| r.style.separate) {
        run.new.text = separated(&run.new.text);
    }
    if let Some(last) = line.iter_mut().rfind(|r| r.old.contains(is_letter)).filter(|r| r.style.separate) {
        last.new.text.insert(last.new.text.trim_end().len(), END);
    }
    if let Some(first) = line.iter_mut().find(|r| r.old.contains(is_letter))
        && let (Some(start), Some(direction)) = (first.new.text.find(is_letter), first.style.direction)
    {
        first.new.text.insert(start, direction);
    }
}

fn is_part(node: Node<'_, '_>) -> bool {
    matches!(node.tag_name().name(), "tspan" | "textPath" | "a" | "tref")
}

/// Returns `true` if letters of different elements touch. usvg kerns them; browsers don't.
pub(super) fn elements_touch(text: Node<'_, '_>) -> bool {
    let mut ends = false;
    text.descendants().skip(1).any(|node| {
        if node.is_element() {
            ends &= is_part(node) && !begins_line(node);
            return false;
        }
        let letters = node.text().filter(|_| node.is_text()).unwrap_or_default();
        let joins = ends && letters.starts_with(char::is_alphanumeric);
        ends = letters.ends_with(char::is_alphanumeric);
        joins
    })
}

/// Returns `true` if usvg starts a new line of text at an element: one with a position, or on a path.
fn begins_line(node: Node<'_, '_>) -> bool {
    ["x", "y"].iter().any(|a| node.has_attribute(*a)) || node.tag_name().name() == "textPath"
}

/// Returns `true` if single letters have positions or rotations, or `textLength` spreads them.
fn has_letter_positions(node: Node<'_, '_>) -> bool {
    let is_list = |v: &str| v.split([',', ' ', '\n', '\t', '\r']).filter(|n| !n.is_empty()).nth(1).is_some();
    node.has_attribute("textLength")
        || ["x", "y", "dx", "dy", "rotate"].iter().any(|a| node.attribute(*a).is_some_and(is_list))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fonts() {
        let of = |v: &str| font(v).map(|all| all.into_iter().map(|(_, v)| v).collect::<Vec<_>>().join("|"));
        for (from, to) in [
            ("12px/1.5 Arial", "normal|normal|normal|normal|12px|Arial|auto"),
            (
                "italic small-caps bold condensed 1.5em / 2 'A b', serif",
                "italic|small-caps|bold|condensed|1.5em|'A b', serif|auto",
            ),
            ("oblique 10deg 350 larger x", "oblique|normal|350|normal|larger|x|auto"),
            ("120% \"Lucida Grande\"", "normal|normal|normal|normal|120%|\"Lucida Grande\"|auto"),
            ("inherit", "inherit|inherit|inherit|inherit|inherit|inherit|inherit"),
        ] {
            assert_eq!(of(from).as_deref(), Some(to), "{from}");
        }
        for bad in ["caption", "12px", "bold Arial", "", "12px/", "red 12px Arial"] {
            assert_eq!(of(bad), None, "{bad}");
        }
    }

    #[test]
    fn weights_and_widths() {
        let of = |v: &str, parent| weight(v, parent).unwrap();
        assert_eq!([of("bolder", 100), of("bolder", 400), of("bolder", 700), of("bolder", 900)], [400, 700, 900, 900]);
        assert_eq!([of("lighter", 300), of("lighter", 600), of("lighter", 900)], [100, 400, 700]);
        assert_eq!([of("350", 400), of("1000", 400), of("bold", 100)], [400, 900, 700]);
        assert_eq!(weight("0", 400), None);
        assert_eq!(
            [width("75%"), width("95%"), width("300%"), width("wide")],
            [Some("condensed"), Some("normal"), Some("ultra-expanded"), None]
        );
    }

    #[test]
    fn cases() {
        assert_eq!(Case::Upper.apply("straße é", None), "STRASSE É");
        assert_eq!(Case::Capitalized.apply("it's a d-day ünder", Some('x')), "it's A D-Day Ünder");
        assert_eq!(Case::Capitalized.apply("ab", None), "Ab");
        assert_eq!(separated("office fit Th"), "of\u{180b}f\u{180b}ice f\u{180b}it T\u{180b}h");
    }
}
