//! Media queries (Media Queries 4), answered for a screen with a light background. What depends on the window cannot be known.

/// Whether any query of a list applies. `None` if that depends on something unknown.
pub(super) fn applies(queries: &str) -> Option<bool> {
    if queries.trim().is_empty() {
        return Some(true);
    }
    let answers = queries.split(',').map(query);
    decided(answers, true)
}

/// `decisive` if any answer is, else its opposite if all are known.
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
    let (negated, words) = match words.strip_prefix("not ") {
        Some(rest) => (true, rest.trim()),
        None => (false, words),
    };
    // `or` and nested conditions are rare.
    if words.contains(" or ") || words.contains("((") || words.contains("(not") {
        return None;
    }
    let answers = words.split(" and ").map(|w| condition(w.trim()));
    let all = decided(answers, false)?;
    Some(all != negated)
}

fn condition(word: &str) -> Option<bool> {
    let Some(feature) = word.strip_prefix('(').and_then(|w| w.strip_suffix(')')) else {
        return Some(matches!(word, "all" | "screen"));
    };
    let (name, value) = feature.split_once(':').map_or((feature, ""), |(n, v)| (n, v));
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
    use super::applies;

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
