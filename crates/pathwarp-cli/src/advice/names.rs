//! Likely names for unknown ones.

/// Returns the message that there is no `what` called `name`, with the known name that is most like it.
pub(crate) fn unknown<'a>(what: &str, name: &str, known: impl Iterator<Item = &'a str>) -> String {
    match likely(name, known) {
        Some(likely) => format!("there is no {what} `{name}`; did you mean `{likely}`?"),
        None => format!("there is no {what} `{name}`"),
    }
}

/// Returns the known name that is most like `name`, if any is like it.
pub(super) fn likely<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    /// Names below this similarity are not suggested.
    const LIKELY: f64 = 0.8;
    let likeness = known.map(|k| (strsim::jaro_winkler(name, k), k)).filter(|(l, _)| *l >= LIKELY);
    likeness.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, likely)| likely)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn likely_names_are_suggested_and_others_are_not() {
        let known = ["tolerance", "strokes", "select"];
        let message = |name: &str| unknown("option", name, known.into_iter());
        assert!(message("tolerence").ends_with("did you mean `tolerance`?"), "{}", message("tolerence"));
        assert_eq!(message("xyz"), "there is no option `xyz`");
    }
}
