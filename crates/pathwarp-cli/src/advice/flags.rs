//! Parameters in messages as flags: the libraries write `bottom`, the command line `--bottom`.

use super::names::likely;
use crate::catalogue::Catalogue;
use pathwarp::param::Kind;
use std::collections::{BTreeMap, BTreeSet};

/// The parameters that messages may name.
pub(crate) struct Flags {
    params: BTreeSet<&'static str>,
    /// The names that a parameter's value may have.
    names: BTreeMap<&'static str, Vec<&'static str>>,
}

impl Flags {
    /// The parameters of all deformations.
    pub(crate) fn of(catalogue: &dyn Catalogue) -> Self {
        let params = || catalogue.infos().into_iter().flat_map(|i| i.params);
        let mut names: BTreeMap<&'static str, Vec<&'static str>> = BTreeMap::new();
        for p in params() {
            if let Kind::NameOrFile(values) | Kind::Choice(values) = p.kind {
                names.entry(p.name).or_default().extend(values);
            }
        }
        Self { params: params().map(|p| p.name).collect(), names }
    }

    /// The parameters of both.
    pub(crate) fn and(mut self, other: Self) -> Self {
        self.params.extend(other.params);
        for (name, values) in other.names {
            self.names.entry(name).or_default().extend(values);
        }
        self
    }

    /// The name that a wrong value of the parameter `param` most likely means.
    pub(super) fn likely(&self, param: &str, value: &str) -> Option<&'static str> {
        likely(&value.to_lowercase(), self.names.get(param)?.iter().copied())
    }

    /// Puts dashes before a message that begins with a parameter: `base: …`, `base file.svg has …`.
    pub(super) fn in_front(&self, message: &str) -> String {
        let name = message.split([' ', ':']).next().unwrap_or_default();
        if self.params.contains(name) { format!("--{message}") } else { message.to_owned() }
    }

    /// Replaces `` `name` `` and `` `name value` `` by `--name` and `--name value` where `name` is a parameter.
    pub(crate) fn in_text(&self, message: &str) -> String {
        let is_param = |span: &str| {
            let mut words = span.split(' ');
            let known = words.next().is_some_and(|w| w.len() > 1 && self.params.contains(w));
            known && words.count() < 2 && !span.ends_with(' ')
        };
        let parts: Vec<&str> = message.split('`').collect();
        let mut out = String::with_capacity(message.len() + 2);
        for (i, part) in parts.iter().enumerate() {
            // Every second part is quoted, except behind a last unpaired quote.
            let quoted = i % 2 == 1;
            let closed = i + 1 < parts.len();
            if quoted && closed && is_param(part) {
                out.push_str("--");
                out.push_str(part);
                continue;
            }
            if quoted {
                out.push('`');
            }
            out.push_str(part);
            if quoted && closed {
                out.push('`');
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pathwarp::deform::Registry;

    #[test]
    fn parameters_become_flags() {
        let flags = Flags::of(&Registry::builtin());
        assert_eq!(flags.in_text("use `by length`; see `stretch`"), "use --by length; see --stretch");
        assert_eq!(flags.in_front("base: anchors 1 and 2 coincide"), "--base: anchors 1 and 2 coincide");
        assert_eq!(flags.in_front("#based has 3 anchors"), "#based has 3 anchors");
        let unknown = "there is no `wobble`, `along the way` or `by";
        assert_eq!(flags.in_text(unknown), unknown);
    }
}
