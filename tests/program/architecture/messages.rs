//! The messages of all crates, found in their source.

use super::graph::is_test;
use proc_macro2::{TokenStream, TokenTree};
use std::collections::BTreeSet;
use syn::visit::{self, Visit};
use syn::{Attribute, ExprMethodCall, ImplItemFn, Item, ItemFn, ItemMod, Lit, LitStr, Macro, Meta};

/// Calls and macros whose texts are help, documents, or about bugs.
const NO_MESSAGES: [&str; 22] = [
    "about",
    "after_help",
    "assert",
    "assert_eq",
    "choice",
    "debug_assert",
    "debug_assert_eq",
    "expect",
    "heading",
    "help",
    "long_help",
    "names",
    "options",
    "panic",
    "parameters",
    "params",
    "setters",
    "source",
    "title",
    "unreachable",
    "value_name",
    "values",
];

/// Returns the messages in the source of a file: texts of at least three words, with the names of their values in braces.
pub fn of_source(text: &str) -> BTreeSet<String> {
    let mut found = Messages::default();
    found.visit_file(&syn::parse_file(text).unwrap());
    found.0
}

#[derive(Default)]
struct Messages(BTreeSet<String>);

impl Messages {
    fn add(&mut self, text: &str) {
        let words = text.split_whitespace().filter(|w| w.chars().any(char::is_alphabetic)).count();
        if words > 2 && !text.contains(['<', '\\', '\n']) {
            self.0.insert(text.split_whitespace().collect::<Vec<_>>().join(" "));
        }
    }

    fn add_tokens(&mut self, tokens: TokenStream) {
        for token in tokens {
            match token {
                TokenTree::Literal(l) => {
                    if let Lit::Str(s) = Lit::new(l) {
                        self.add(&s.value());
                    }
                }
                TokenTree::Group(g) => self.add_tokens(g.stream()),
                _ => {}
            }
        }
    }
}

impl<'a> Visit<'a> for Messages {
    fn visit_item(&mut self, item: &'a Item) {
        // Tables describe what help and pages show.
        if !matches!(item, Item::Static(_) | Item::Const(_)) {
            visit::visit_item(self, item);
        }
    }

    fn visit_item_mod(&mut self, m: &'a ItemMod) {
        if !is_test(&m.attrs) {
            visit::visit_item_mod(self, m);
        }
    }

    fn visit_item_fn(&mut self, f: &'a ItemFn) {
        if !is_test(&f.attrs) {
            visit::visit_item_fn(self, f);
        }
    }

    fn visit_impl_item_fn(&mut self, f: &'a ImplItemFn) {
        if !is_test(&f.attrs) {
            visit::visit_impl_item_fn(self, f);
        }
    }

    fn visit_attribute(&mut self, a: &'a Attribute) {
        if let Meta::List(list) = &a.meta
            && list.path.is_ident("error")
        {
            self.add_tokens(list.tokens.clone());
        }
    }

    fn visit_expr_method_call(&mut self, call: &'a ExprMethodCall) {
        if NO_MESSAGES.contains(&call.method.to_string().as_str()) {
            self.visit_expr(&call.receiver);
        } else {
            visit::visit_expr_method_call(self, call);
        }
    }

    fn visit_macro(&mut self, m: &'a Macro) {
        let name = m.path.segments.last().map(|s| s.ident.to_string()).unwrap_or_default();
        if !NO_MESSAGES.contains(&name.as_str()) {
            self.add_tokens(m.tokens.clone());
        }
    }

    fn visit_lit_str(&mut self, s: &'a LitStr) {
        self.add(&s.value());
    }
}
