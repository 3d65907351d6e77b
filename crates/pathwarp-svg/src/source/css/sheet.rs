//! Style sheets and style attributes, parsed into rules and declarations.

use super::media;
use super::names::{Svg, selectors};
use cssparser::{
    AtRuleParser, CowRcStr, DeclarationParser, ParseError, Parser, ParserState, QualifiedRuleParser,
    RuleBodyItemParser, RuleBodyParser, StyleSheetParser,
};
use selectors::parser::{SelectorList, SelectorParseErrorKind};
use std::collections::{BTreeSet, HashMap};

type Failure = ParseError<SelectorParseErrorKind>;

/// Rank of what is in no layer.
const UNLAYERED: usize = usize::MAX;

/// A declaration.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Declaration {
    /// In lower case, unless it is a custom property.
    pub(super) name: String,
    pub(super) value: String,
    pub(super) important: bool,
}

/// A rule.
pub(super) struct Rule {
    pub(super) selectors: SelectorList<Svg>,
    pub(super) declarations: Vec<Declaration>,
    /// Rank of its cascade layer; later layers are stronger.
    pub(super) layer: usize,
}

/// The rules of a drawing.
#[derive(Default)]
pub(super) struct Rules {
    pub(super) rules: Vec<Rule>,
    /// Ranks of layers by name.
    layers: HashMap<String, usize>,
    /// What is not supported, in words.
    pub(super) unsupported: BTreeSet<String>,
}

impl Rules {
    /// Adds a sheet.
    pub(super) fn add(&mut self, css: &str) {
        let mut input = Parser::new(css);
        let mut top = Sheet { out: self, layer: UNLAYERED };
        StyleSheetParser::new(&mut input, &mut top).for_each(drop);
    }

    fn layer(&mut self, name: &str) -> usize {
        let next = self.layers.len();
        *self.layers.entry(name.to_owned()).or_insert(next)
    }
}

/// The declarations of a style attribute.
pub(super) fn declarations(style: &str) -> Vec<Declaration> {
    let mut input = Parser::new(style);
    let mut body = Body::default();
    RuleBodyParser::new(&mut input, &mut body).flatten().collect()
}

/// What stands before the block of an at-rule.
enum Prelude {
    /// Its rules count, in this layer.
    Inside(usize),
    Ignored,
}

/// Reads rules.
struct Sheet<'a> {
    out: &'a mut Rules,
    layer: usize,
}

/// The rest of the input, which the parser wants to see used up.
fn rest<'i>(input: &mut Parser<'i>) -> &'i str {
    let start = input.position();
    while input.next_including_whitespace().is_ok() {}
    input.slice_from(start).trim()
}

impl<'i> AtRuleParser<'i> for Sheet<'_> {
    type Prelude = Prelude;
    type AtRule = ();
    type Error = SelectorParseErrorKind;

    fn parse_prelude(&mut self, name: CowRcStr<'i>, input: &mut Parser<'i>) -> Result<Prelude, Failure> {
        let text = rest(input);
        Ok(match name.to_ascii_lowercase().as_str() {
            "media" => match media::applies(text) {
                Some(true) => Prelude::Inside(self.layer),
                Some(false) => Prelude::Ignored,
                None => {
                    self.out.unsupported.insert(format!("the rules of “@media {text}” are ignored"));
                    Prelude::Ignored
                }
            },
            "supports" => Prelude::Inside(self.layer),
            "layer" => {
                let layers = text.split(',').map(|name| self.out.layer(name.trim()));
                Prelude::Inside(layers.last().unwrap_or(self.layer))
            }
            known @ ("import" | "container" | "scope") => {
                self.out.unsupported.insert(format!("“@{known} {text}” is ignored"));
                Prelude::Ignored
            }
            _ => Prelude::Ignored,
        })
    }

    fn rule_without_block(&mut self, _: Prelude, _: &ParserState) -> Result<(), ()> {
        Ok(())
    }

    fn parse_block(&mut self, prelude: Prelude, _: &ParserState, input: &mut Parser<'i>) -> Result<(), Failure> {
        match prelude {
            Prelude::Inside(layer) => {
                let mut inner = Sheet { out: self.out, layer };
                StyleSheetParser::new(input, &mut inner).for_each(drop);
            }
            Prelude::Ignored => drop(rest(input)),
        }
        Ok(())
    }
}

impl<'i> QualifiedRuleParser<'i> for Sheet<'_> {
    type Prelude = SelectorList<Svg>;
    type QualifiedRule = ();
    type Error = SelectorParseErrorKind;

    fn parse_prelude(&mut self, input: &mut Parser<'i>) -> Result<SelectorList<Svg>, Failure> {
        let state = input.state();
        selectors(input).inspect_err(|_| {
            input.reset(&state);
            self.out.unsupported.insert(format!("rules for “{}” are ignored", rest(input)));
        })
    }

    fn parse_block(&mut self, list: SelectorList<Svg>, _: &ParserState, input: &mut Parser<'i>) -> Result<(), Failure> {
        let mut body = Body::default();
        let declarations = RuleBodyParser::new(input, &mut body).flatten().collect();
        if body.nested {
            self.out.unsupported.insert("rules inside of rules are ignored".to_owned());
        }
        self.out.rules.push(Rule { selectors: list, declarations, layer: self.layer });
        Ok(())
    }
}

/// Reads declarations.
#[derive(Default)]
struct Body {
    /// Rules were nested in it, or at-rules.
    nested: bool,
}

impl<'i> DeclarationParser<'i> for Body {
    type Declaration = Declaration;
    type Error = SelectorParseErrorKind;

    fn parse_value(
        &mut self,
        name: CowRcStr<'i>,
        input: &mut Parser<'i>,
        _: &ParserState,
    ) -> Result<Declaration, Failure> {
        let value = without_comments(rest(input));
        let (value, important) = match value.rsplit_once('!') {
            Some((v, word)) if word.trim().eq_ignore_ascii_case("important") => (v.trim(), true),
            _ => (value.trim(), false),
        };
        let name = if name.starts_with("--") { name.as_ref().to_owned() } else { name.to_ascii_lowercase() };
        Ok(Declaration { name, value: value.to_owned(), important })
    }
}

impl<'i> AtRuleParser<'i> for Body {
    type Prelude = ();
    type AtRule = Declaration;
    type Error = SelectorParseErrorKind;

    fn parse_prelude(&mut self, _: CowRcStr<'i>, _: &mut Parser<'i>) -> Result<(), Failure> {
        self.nested = true;
        Err(ParseError::unexpected_token())
    }
}

impl<'i> QualifiedRuleParser<'i> for Body {
    type Prelude = ();
    type QualifiedRule = Declaration;
    type Error = SelectorParseErrorKind;

    fn parse_prelude(&mut self, input: &mut Parser<'i>) -> Result<(), Failure> {
        rest(input);
        self.nested = true;
        Err(ParseError::unexpected_token())
    }
}

impl RuleBodyItemParser<'_, Declaration, SelectorParseErrorKind> for Body {
    fn parse_declarations(&self) -> bool {
        true
    }

    fn parse_qualified(&self) -> bool {
        true
    }
}

/// Replaces comments by spaces.
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

#[cfg(test)]
mod tests {
    use super::*;

    fn names(css: &str) -> Vec<String> {
        let mut rules = Rules::default();
        rules.add(css);
        rules.rules.iter().flat_map(|r| r.declarations.iter().map(|d| format!("{}={}", d.name, d.value))).collect()
    }

    #[test]
    fn rules_that_count() {
        let css = "@media print{a{x:1}} @media screen{b{x:2}} @supports (x:y){c{x:3}} @font-face{x:4} ::before{x:5} e:foo{x:6} \
                   f{X:7;Y:/* ; */ 8 ! important;z} @layer l{g{x:9}} @import 'x'; h{x:url(a;b)}";
        assert_eq!(names(css), ["x=2", "x=3", "x=5", "X=7".to_lowercase().as_str(), "y=8", "x=9", "x=url(a;b)"]);
    }

    #[test]
    fn what_is_ignored_is_said() {
        let mut rules = Rules::default();
        rules.add("a:foo(1){x:1} @media (min-width:3px){a{x:2}} a{x:3; b{x:4}} @import 'x';");
        let said: Vec<&str> = rules.unsupported.iter().map(String::as_str).collect();
        assert_eq!(
            said,
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
        let all: Vec<_> = all.iter().map(|d| (d.name.as_str(), d.value.as_str(), d.important)).collect();
        assert_eq!(all, [("fill", "red", false), ("--A", "b", false), ("stroke", "url(x;y)", true)]);
    }
}
