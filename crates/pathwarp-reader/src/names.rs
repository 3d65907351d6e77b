//! The types that the crate `selectors` requires: names, pseudo-classes, pseudo-elements, and their parser.

use cssparser::{ParseError, Parser, ToCss, serialize_identifier};
use precomputed_hash::PrecomputedHash;
use selectors::parser::{NonTSPseudoClass, PseudoElement, SelectorImpl, SelectorParseErrorKind};
use std::borrow::Borrow;
use std::collections::HashMap;
use std::fmt;
use std::hash::{DefaultHasher, Hash as _, Hasher as _};

/// The selectors of SVG drawings.
#[derive(Debug, Clone)]
pub(super) struct Svg;

/// A name or a value in a selector.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct Name(String);

impl From<&str> for Name {
    fn from(name: &str) -> Self {
        Self(name.to_owned())
    }
}

impl AsRef<str> for Name {
    fn as_ref(&self) -> &str {
        &self.0
    }
}

impl Borrow<str> for Name {
    fn borrow(&self) -> &str {
        &self.0
    }
}

impl ToCss for Name {
    fn to_css<W: fmt::Write>(&self, out: &mut W) -> fmt::Result {
        serialize_identifier(&self.0, out)
    }
}

impl PrecomputedHash for Name {
    #[expect(clippy::cast_possible_truncation, reason = "any bits of a hash do")]
    fn precomputed_hash(&self) -> u32 {
        let mut hasher = DefaultHasher::new();
        self.0.hash(&mut hasher);
        hasher.finish() as u32
    }
}

/// A pseudo-class that does not depend on the tree.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PseudoClass {
    /// `:link` and `:any-link`.
    Link,
    /// Depends on interaction, such as `:hover`, so it never matches.
    Never,
}

impl ToCss for PseudoClass {
    fn to_css<W: fmt::Write>(&self, out: &mut W) -> fmt::Result {
        out.write_str(match self {
            Self::Link => ":link",
            Self::Never => ":hover",
        })
    }
}

impl NonTSPseudoClass for PseudoClass {
    fn is_active_or_hover(&self) -> bool {
        *self == Self::Never
    }

    fn is_user_action_state(&self) -> bool {
        *self == Self::Never
    }
}

/// A pseudo-element, such as `::before`. It never matches.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct AnyPseudoElement;

impl ToCss for AnyPseudoElement {
    fn to_css<W: fmt::Write>(&self, out: &mut W) -> fmt::Result {
        out.write_str("::before")
    }
}

impl PseudoElement for AnyPseudoElement {}

impl SelectorImpl for Svg {
    type ExtraMatchingData<'a> = ();
    type AttrValue = Name;
    type Identifier = Name;
    type LocalName = Name;
    type NamespaceUrl = Name;
    type NamespacePrefix = Name;
    type BorrowedNamespaceUrl = str;
    type BorrowedLocalName = str;
    type NonTSPseudoClass = PseudoClass;
    type PseudoElement = AnyPseudoElement;
}

/// The namespaces that a sheet declares.
#[derive(Default)]
pub(super) struct Namespaces {
    default: Option<Name>,
    by_prefix: HashMap<String, Name>,
}

impl Namespaces {
    /// Records the namespace of an `@namespace` rule.
    pub(super) fn declare(&mut self, rule: &str) {
        let mut input = Parser::new(rule);
        let prefix = input.try_parse(Parser::expect_ident_cloned).ok();
        let Ok(uri) = input.expect_url_or_string() else { return };
        let uri = Name(uri.as_ref().to_owned());
        match prefix {
            Some(prefix) => drop(self.by_prefix.insert(prefix.as_ref().to_owned(), uri)),
            None => self.default = Some(uri),
        }
    }
}

/// Parses selectors as browsers do: an unknown one makes the whole list invalid.
pub(super) struct Dialect<'a>(pub(super) &'a Namespaces);

impl<'i> selectors::parser::Parser<'i> for Dialect<'_> {
    type Impl = Svg;
    type Error = SelectorParseErrorKind;

    fn parse_is_and_where(&self) -> bool {
        true
    }

    fn parse_non_ts_pseudo_class(&self, name: &str) -> Result<PseudoClass, ParseError<SelectorParseErrorKind>> {
        match name.to_ascii_lowercase().as_str() {
            "link" | "any-link" => Ok(PseudoClass::Link),
            "active" | "focus" | "focus-visible" | "focus-within" | "hover" | "target" | "visited" => {
                Ok(PseudoClass::Never)
            }
            _ => Err(ParseError::custom(SelectorParseErrorKind::UnsupportedPseudoClassOrElement)),
        }
    }

    fn default_namespace(&self) -> Option<Name> {
        self.0.default.clone()
    }

    fn namespace_for_prefix(&self, prefix: &Name) -> Option<Name> {
        self.0.by_prefix.get(prefix.as_ref()).cloned()
    }

    fn parse_pseudo_element(&self, _: &str) -> Result<AnyPseudoElement, ParseError<SelectorParseErrorKind>> {
        Ok(AnyPseudoElement)
    }
}
