//! Parameters in messages, as flags: the libraries call a parameter `bottom`, the command line calls it `--bottom`.

use pathwarp::deform::Registry;
use std::collections::BTreeSet;
use std::sync::OnceLock;

/// The names of all parameters that this program knows.
static NAMES: OnceLock<BTreeSet<&'static str>> = OnceLock::new();

/// Sets the parameters that [`dashed`] recognises.
pub(crate) fn know(registry: &Registry) {
    // A second call would only repeat the first.
    let _ = NAMES.set(registry.entries().iter().flat_map(|e| e.info().params).map(|p| p.name).collect());
}

/// Writes a message that begins with a path's parameter (`base: …`, `base file.svg has …`) with `--` before it.
pub(crate) fn led(message: &str) -> String {
    let name = message.split([' ', ':']).next().unwrap_or_default();
    let known = NAMES.get().is_some_and(|n| n.contains(name));
    if known { format!("--{message}") } else { message.to_owned() }
}

/// Writes `` `name` `` and `` `name value` `` as `--name` and `--name value` where `name` is a parameter.
pub(crate) fn dashed(message: &str) -> String {
    let is_param = |span: &str| {
        let mut words = span.split(' ');
        let known = words.next().is_some_and(|w| w.len() > 1 && NAMES.get().is_some_and(|n| n.contains(w)));
        known && words.clone().count() < 2 && !span.ends_with(' ')
    };
    let parts: Vec<&str> = message.split('`').collect();
    let mut out = String::with_capacity(message.len() + 2);
    for (i, part) in parts.iter().enumerate() {
        let closed = i + 1 < parts.len();
        match i % 2 {
            1 if closed && is_param(part) => out += &format!("--{part}"),
            1 if closed => out += &format!("`{part}`"),
            1 => out += &format!("`{part}"),
            _ => out += part,
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_become_flags() {
        know(&Registry::builtin());
        assert_eq!(dashed("use `by length`; see `stretch`"), "use --by length; see --stretch");
        assert_eq!(led("base: anchors 1 and 2 coincide"), "--base: anchors 1 and 2 coincide");
        assert_eq!(led("#based has 3 anchors"), "#based has 3 anchors");
        assert_eq!(
            dashed("there is no `wobble`, `along the way` or `by"),
            "there is no `wobble`, `along the way` or `by"
        );
    }
}
