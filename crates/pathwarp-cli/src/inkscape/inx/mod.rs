//! Inkscape's descriptions of extensions (`.inx`), from the registry and the table of common options.

mod deformation;
mod labels;
mod others;
mod program;
mod widgets;

use pathwarp::deform::Registry;

pub(crate) use labels::labelled;
pub(crate) use program::Program;

/// All descriptions: file name and content.
pub(crate) fn files(registry: &Registry, program: &Program) -> Vec<(String, String)> {
    let effects = registry.entries().iter().map(|e| {
        let info = e.info();
        (format!("pathwarp-{}.inx", info.name), deformation::inx(info, program))
    });
    effects.chain(others::all(program)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every description is well-formed, has its own id, and passes only parameters that are understood.
    #[test]
    fn descriptions_are_sound() {
        let registry = Registry::builtin();
        let program = Program { location: "inx", name: "pathwarp".into() };
        let all = files(&registry, &program);
        assert!(all.len() > registry.entries().len() + 2);
        let mut ids = std::collections::HashSet::new();
        for (name, text) in &all {
            let objects = pathwarp_svg::objects::objects(text, &pathwarp::budget::Limits::default());
            assert!(objects.is_ok(), "{name}: {objects:?}");
            let id = text.split("<id>").nth(1).and_then(|t| t.split("</id>").next()).unwrap();
            assert!(
                ids.insert(id) && id.chars().all(|c| c.is_ascii_alphanumeric() || ".-".contains(c)),
                "{name}: {id}"
            );
            let mut names: Vec<&str> =
                text.split("<param name=\"").skip(1).map(|t| t.split('"').next().unwrap()).collect();
            let count = names.len();
            names.sort_unstable();
            names.dedup();
            assert_eq!(names.len(), count, "{name}: a name occurs twice");
        }
        // Inkscape 1.2 takes the first option of a choice.
        let bend = &all.iter().find(|(name, _)| name == "pathwarp-bend.inx").unwrap().1;
        for (choice, first) in [("align", "middle"), ("clones", "follow"), ("fit", "none"), ("offset_unit", "user")] {
            let options = bend.split(&format!("name=\"{choice}\"")).nth(1).unwrap();
            assert!(options.split("<option value=\"").nth(1).unwrap().starts_with(first), "{choice}");
        }
    }
}
