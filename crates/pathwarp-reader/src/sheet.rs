//! Parses style sheets and style attributes into rules and declarations.

use crate::names::{Dialect, Namespaces, Svg};
use cssparser::{
    AtRuleParser, CowRcStr, DeclarationParser, ParseError, Parser, ParserState, QualifiedRuleParser,
    RuleBodyItemParser, RuleBodyParser, StyleSheetParser,
};
use selectors::parser::{Component, ParseRelative, Selector, SelectorList, SelectorParseErrorKind};
use std::borrow::Cow;
use std::collections::{BTreeSet, HashMap};

type Failure = ParseError<SelectorParseErrorKind>;

/// Rank of rules outside any layer.
const UNLAYERED: usize = usize::MAX;

/// A declaration of a style sheet or a style attribute.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Declaration<'a> {
    /// In lower case, unless it is a custom property.
    pub(super) name: Cow<'a, str>,
    pub(super) value: Cow<'a, str>,
    pub(super) important: bool,
    /// `true` if lengths of fonts need units. So it is in style sheets; browsers read style attributes of SVG in quirks mode.
    pub(super) strict: bool,
}

/// The declarations of a rule.
pub(super) struct Block<'a> {
    pub(super) declarations: Vec<Declaration<'a>>,
    /// Rank of its cascade layer; later layers are stronger.
    pub(super) layer: usize,
}

/// The rules of a drawing.
#[derive(Default)]
pub(super) struct Rules<'a> {
    pub(super) blocks: Vec<Block<'a>>,
    /// Selectors with the indices of their blocks.
    pub(super) selectors: Vec<(Selector<Svg>, usize)>,
    /// Indices of selectors that require an id, a class or an element's name, and of those that require none of these.
    by_id: HashMap<String, Vec<usize>>,
    by_class: HashMap<String, Vec<usize>>,
    by_tag: HashMap<String, Vec<usize>>,
    others: Vec<usize>,
    /// Ranks of layers by name.
    layers: HashMap<String, usize>,
    /// Unsupported features, worded for people.
    pub(super) unsupported: BTreeSet<String>,
    /// Names of the animations that move elements or change their geometry.
    pub(super) moving: BTreeSet<String>,
}

/// Properties that move an element, or change its geometry.
#[rustfmt::skip]
const MOVING: [&str; 16] = [
    "transform", "translate", "rotate", "scale", "offset-path", "offset-distance", "d", "x", "y", "width", "height", "cx", "cy", "r",
    "rx", "ry",
];

impl<'a> Rules<'a> {
    /// Adds the rules of a sheet.
    pub(super) fn add(&mut self, css: &'a str) {
        let mut input = Parser::new(css);
        let mut names = Namespaces::default();
        let mut top = Sheet { out: self, layer: UNLAYERED, names: &mut names };
        StyleSheetParser::new(&mut input, &mut top).for_each(drop);
    }

    fn add_rule(&mut self, list: &SelectorList<Svg>, block: Block<'a>) {
        for selector in list.slice() {
            // The most selective requirement on the element itself decides the index.
            let (mut id, mut class, mut tag) = (None, None, None);
            for part in selector.iter() {
                match part {
                    Component::ID(name) => id = Some(name),
                    Component::Class(name) => class = Some(name),
                    Component::LocalName(name) => tag = Some(&name.name),
                    _ => {}
                }
            }
            let entry = match (id, class, tag) {
                (Some(id), ..) => self.by_id.entry(id.as_ref().to_owned()).or_default(),
                (_, Some(class), _) => self.by_class.entry(class.as_ref().to_owned()).or_default(),
                (.., Some(tag)) => self.by_tag.entry(tag.as_ref().to_owned()).or_default(),
                _ => &mut self.others,
            };
            entry.push(self.selectors.len());
            self.selectors.push((selector.clone(), self.blocks.len()));
        }
        self.blocks.push(block);
    }

    /// The selectors that an element may match.
    pub(super) fn candidates<'s>(
        &'s self,
        tag: &str,
        id: Option<&str>,
        classes: Option<&'s str>,
    ) -> impl Iterator<Item = usize> {
        let classes = classes.into_iter().flat_map(str::split_ascii_whitespace).filter_map(|c| self.by_class.get(c));
        let by_name = self.by_id.get(id.unwrap_or_default()).into_iter().chain(self.by_tag.get(tag));
        by_name.chain(classes).chain([&self.others]).flatten().copied()
    }

    pub(super) fn is_empty(&self) -> bool {
        self.selectors.is_empty()
    }

    /// The rank of a cascade layer.
    fn layer(&mut self, name: &str) -> usize {
        let next = self.layers.len();
        *self.layers.entry(name.to_owned()).or_insert(next)
    }
}

/// Parses a style attribute.
pub(super) fn declarations(style: &str) -> Vec<Declaration<'_>> {
    if let Some(all) = simple(style) {
        let has_upper = |name: &str| !name.starts_with("--") && name.bytes().any(|b| b.is_ascii_uppercase());
        let pairs = all.into_iter().map(|(n, value)| {
            let name = if has_upper(n) { Cow::Owned(n.to_ascii_lowercase()) } else { Cow::Borrowed(n) };
            Declaration { name, value: value.into(), important: false, strict: false }
        });
        return pairs.collect();
    }
    RuleBodyParser::new(&mut Parser::new(style), &mut Body::default()).flatten().collect()
}

/// The meaning of an at-rule's block.
enum Prelude {
    /// Rules that apply, in this layer.
    Rules(usize),
    /// An animation of this name.
    Keyframes(String),
    Ignored,
}

/// Parses rules.
struct Sheet<'a, 'i> {
    out: &'a mut Rules<'i>,
    layer: usize,
    names: &'a mut Namespaces,
}

/// Consumes the rest of the input, as the parser demands, and returns it.
fn rest<'i>(input: &mut Parser<'i>) -> &'i str {
    let start = input.position();
    while input.next_including_whitespace().is_ok() {}
    input.slice_from(start).trim()
}

impl<'i> AtRuleParser<'i> for Sheet<'_, 'i> {
    type Prelude = Prelude;
    type AtRule = ();
    type Error = SelectorParseErrorKind;

    fn parse_prelude(&mut self, name: CowRcStr<'i>, input: &mut Parser<'i>) -> Result<Prelude, Failure> {
        let text = rest(input);
        Ok(match name.to_ascii_lowercase().as_str() {
            "media" => match applies(text) {
                Some(true) => Prelude::Rules(self.layer),
                Some(false) => Prelude::Ignored,
                None => {
                    self.out.unsupported.insert(format!("the rules of “@media {text}” are ignored"));
                    Prelude::Ignored
                }
            },
            "supports" => Prelude::Rules(self.layer),
            "layer" => {
                let layers = text.split(',').map(|name| self.out.layer(name.trim()));
                Prelude::Rules(layers.last().unwrap_or(self.layer))
            }
            "namespace" => {
                self.names.declare(text);
                Prelude::Ignored
            }
            "keyframes" | "-webkit-keyframes" => Prelude::Keyframes(text.to_owned()),
            known @ ("import" | "container" | "scope") => {
                self.out.unsupported.insert(format!("“@{known} {text}” is ignored"));
                Prelude::Ignored
            }
            _ => Prelude::Ignored,
        })
    }

    fn parse_block(&mut self, prelude: Prelude, _: &ParserState, input: &mut Parser<'i>) -> Result<(), Failure> {
        match prelude {
            Prelude::Rules(layer) => {
                let mut nested = Sheet { out: self.out, layer, names: self.names };
                StyleSheetParser::new(input, &mut nested).for_each(drop);
            }
            Prelude::Keyframes(name) => {
                let names = rest(input).split(['{', '}', ';']).filter_map(|d| Some(d.split_once(':')?.0.trim()));
                if { names }.any(|name| MOVING.iter().any(|m| m.eq_ignore_ascii_case(name))) {
                    self.out.moving.insert(name);
                }
            }
            Prelude::Ignored => drop(rest(input)),
        }
        Ok(())
    }
}

impl<'i> QualifiedRuleParser<'i> for Sheet<'_, 'i> {
    type Prelude = SelectorList<Svg>;
    type QualifiedRule = ();
    type Error = SelectorParseErrorKind;

    fn parse_prelude(&mut self, input: &mut Parser<'i>) -> Result<SelectorList<Svg>, Failure> {
        let state = input.state();
        SelectorList::parse(&Dialect(self.names), input, ParseRelative::No).inspect_err(|_| {
            input.reset(&state);
            let text = rest(input);
            // Browsers reject all other selectors, too.
            if text.contains([':', '&']) {
                self.out.unsupported.insert(format!("rules for “{text}” are ignored"));
            }
        })
    }

    fn parse_block(&mut self, list: SelectorList<Svg>, _: &ParserState, input: &mut Parser<'i>) -> Result<(), Failure> {
        let mut body = Body::default();
        let mut declarations: Vec<Declaration<'i>> = RuleBodyParser::new(input, &mut body).flatten().collect();
        declarations.iter_mut().for_each(|d| d.strict = true);
        if body.nested {
            self.out.unsupported.insert("rules inside of rules are ignored".to_owned());
        }
        self.out.add_rule(&list, Block { declarations, layer: self.layer });
        Ok(())
    }
}

/// Parses declarations.
#[derive(Default)]
struct Body {
    /// `true` if rules or at-rules were nested in the block.
    nested: bool,
}

impl<'i> DeclarationParser<'i> for Body {
    type Declaration = Declaration<'i>;
    type Error = SelectorParseErrorKind;

    fn parse_value(
        &mut self,
        name: CowRcStr<'i>,
        input: &mut Parser<'i>,
        _: &ParserState,
    ) -> Result<Declaration<'i>, Failure> {
        let raw = rest(input);
        let raw = if raw.contains("/*") { Cow::Owned(without_comments(raw)) } else { Cow::Borrowed(raw) };
        let important = raw.rsplit_once('!').is_some_and(|(_, word)| word.trim().eq_ignore_ascii_case("important"));
        let end = if important { raw.rfind('!').unwrap_or(raw.len()) } else { raw.len() };
        let value = match raw {
            Cow::Borrowed(raw) => Cow::Borrowed(raw[..end].trim()),
            Cow::Owned(raw) => Cow::Owned(raw[..end].trim().to_owned()),
        };
        let name = if name.starts_with("--") { name.as_ref().to_owned() } else { name.to_ascii_lowercase() };
        Ok(Declaration { name: name.into(), value, important, strict: false })
    }
}

impl<'i> AtRuleParser<'i> for Body {
    type Prelude = ();
    type AtRule = Declaration<'i>;
    type Error = SelectorParseErrorKind;

    fn parse_prelude(&mut self, _: CowRcStr<'i>, _: &mut Parser<'i>) -> Result<(), Failure> {
        self.nested = true;
        Err(ParseError::unexpected_token())
    }
}

impl<'i> QualifiedRuleParser<'i> for Body {
    type Prelude = ();
    type QualifiedRule = Declaration<'i>;
    type Error = SelectorParseErrorKind;

    fn parse_prelude(&mut self, input: &mut Parser<'i>) -> Result<(), Failure> {
        rest(input);
        self.nested = true;
        Err(ParseError::unexpected_token())
    }
}

impl<'i> RuleBodyItemParser<'i, Declaration<'i>, SelectorParseErrorKind> for Body {
    fn parse_declarations(&self) -> bool {
        true
    }

    fn parse_qualified(&self) -> bool {
        true
    }
}

/// Parses a style attribute that is so simple that all parsers agree. Returns `None` for others.
pub(super) fn simple(style: &str) -> Option<Vec<(&str, &str)>> {
    if style.bytes().any(|b| matches!(b, b'{' | b'\\' | b'@' | b'<' | b'!')) || style.contains("/*") {
        return None;
    }
    let is_name = |name: &str| name.bytes().all(|b| b.is_ascii_alphabetic() || b == b'-') && !name.is_empty();
    let is_whole = |value: &str| {
        let count = |sign: u8| value.bytes().filter(|b| *b == sign).count();
        !value.is_empty() && count(b'(') == count(b')') && count(b'"') % 2 == 0 && count(b'\'') % 2 == 0
    };
    let parts = style.split(';').map(str::trim).filter(|part| !part.is_empty());
    let pairs = parts.map(|part| part.split_once(':').map(|(name, value)| (name.trim(), value.trim())));
    pairs.map(|pair| pair.filter(|(name, value)| is_name(name) && is_whole(value))).collect()
}

/// Replaces each comment by a space.
fn without_comments(value: &str) -> String {
    let mut out = String::with_capacity(value.len());
    let mut left = value;
    while let Some((before, after)) = left.split_once("/*") {
        out.push_str(before);
        out.push(' ');
        left = after.split_once("*/").map_or("", |(_, after)| after);
    }
    out.push_str(left);
    out
}

/// Returns `true` if any media query of a list applies. `None` if that depends on something unknown.
pub(super) fn applies(queries: &str) -> Option<bool> {
    if queries.trim().is_empty() {
        return Some(true);
    }
    let answers = queries.split(',').map(query);
    decided(answers, true)
}

/// Combines answers: `decisive` if any answer is, its opposite if all are known, and `None` otherwise.
fn decided(answers: impl Iterator<Item = Option<bool>>, decisive: bool) -> Option<bool> {
    let mut out = Some(!decisive);
    for answer in answers {
        match answer {
            Some(a) if a == decisive => return Some(decisive),
            Some(_) => {}
            None => out = None,
        }
    }
    out
}

fn query(query: &str) -> Option<bool> {
    let query = query.trim().to_ascii_lowercase();
    let words = query.strip_prefix("only ").unwrap_or(&query).trim();
    let negated = words.strip_prefix("not ");
    let words = negated.unwrap_or(words).trim();
    // `or` and nested conditions are rare.
    if words.contains(" or ") || words.contains("((") || words.contains("(not") {
        return None;
    }
    let all = decided(words.split(" and ").map(|w| condition(w.trim())), false)?;
    Some(all != negated.is_some())
}

/// Returns `true` if a media type or feature holds for a screen with a light theme; `None` if that is not known.
fn condition(word: &str) -> Option<bool> {
    let Some(feature) = word.strip_prefix('(').and_then(|w| w.strip_suffix(')')) else {
        return Some(matches!(word, "all" | "screen"));
    };
    let (name, value) = feature.split_once(':').unwrap_or((feature, ""));
    Some(match (name.trim(), value.trim()) {
        ("prefers-color-scheme", value) => value == "light",
        ("prefers-reduced-motion" | "prefers-contrast" | "prefers-reduced-transparency", value) => {
            value == "no-preference"
        }
        ("forced-colors" | "inverted-colors", value) => value == "none",
        ("color" | "color-gamut" | "hover" | "pointer" | "any-hover" | "any-pointer", _) => true,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::{applies, *};

    fn names(css: &str) -> Vec<String> {
        let mut rules = Rules::default();
        rules.add(css);
        rules.blocks.iter().flat_map(|r| r.declarations.iter().map(|d| format!("{}={}", d.name, d.value))).collect()
    }

    #[test]
    fn rules_that_count() {
        let css = "@media print{a{x:1}} @media screen{b{x:2}} @supports (x:y){c{x:3}} @font-face{x:4} ::before{x:5} e:foo{x:6} \
               f{X:7;Y:/* ; */ 8 ! important;z} @layer l{g{x:9}} @import 'x'; h{x:url(a;b)}";
        assert_eq!(names(css), ["x=2", "x=3", "x=5", "X=7".to_lowercase().as_str(), "y=8", "x=9", "x=url(a;b)"]);
    }

    #[test]
    fn ignored_rules_are_reported() {
        let mut rules = Rules::default();
        rules.add("a:foo(1){x:1} {x:0} }{x:0} a..b{x:0} @media (min-width:3px){a{x:2}} a{x:3; b{x:4}} @import 'x';");
        let reported: Vec<&str> = rules.unsupported.iter().map(String::as_str).collect();
        assert_eq!(
            reported,
            [
                "rules for “a:foo(1)” are ignored",
                "rules inside of rules are ignored",
                "the rules of “@media (min-width:3px)” are ignored",
                "“@import 'x'” is ignored"
            ]
        );
    }

    #[test]
    fn style_attributes() {
        let all = declarations("fill:red;--A:b;;stroke : url(x;y) !important");
        let all: Vec<_> = all.iter().map(|d| (&*d.name, &*d.value, d.important)).collect();
        assert_eq!(all, [("fill", "red", false), ("--A", "b", false), ("stroke", "url(x;y)", true)]);
    }

    #[test]
    fn a_light_screen() {
        for yes in ["", "all", "screen", "print, screen", "not print", "only screen and (prefers-color-scheme: light)"]
        {
            assert_eq!(applies(yes), Some(true), "{yes}");
        }
        for no in ["print", "not screen", "(prefers-color-scheme:dark)", "print and (min-width: 1px)"] {
            assert_eq!(applies(no), Some(false), "{no}");
        }
        for unknown in ["(min-width: 600px)", "screen and (max-width: 3em)", "print, (width > 3px)"] {
            assert_eq!(applies(unknown), None, "{unknown}");
        }
    }
}
