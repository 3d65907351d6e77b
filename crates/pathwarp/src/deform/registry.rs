//! The registry of deformations, by name.

use super::entry::Deformation;
use std::fmt;
use std::sync::Arc;

/// The deformations that a program offers, in menu order.
#[derive(Clone)]
pub struct Registry {
    entries: Vec<Arc<dyn Deformation>>,
}

impl fmt::Debug for Registry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.entries.iter().map(|e| e.info().name)).finish()
    }
}

impl Registry {
    /// Returns a registry of these entries, in menu order.
    #[must_use]
    pub fn new(entries: Vec<Arc<dyn Deformation>>) -> Self {
        Self { entries }
    }

    /// Returns the deformations of this crate.
    #[must_use]
    pub fn builtin() -> Self {
        Self::new(super::builtin())
    }

    /// Adds an entry, replacing any of the same name.
    #[must_use]
    pub fn with(mut self, entry: impl Deformation + 'static) -> Self {
        self.entries.retain(|e| e.info().name != entry.info().name);
        self.entries.push(Arc::new(entry));
        self
    }

    /// Returns this registry followed by those entries of `other` whose names are new to it.
    #[must_use]
    pub fn joined(&self, other: &Self) -> Self {
        let lacks = |e: &&Arc<dyn Deformation>| self.get(e.info().name).is_none();
        Self::new(self.entries.iter().chain(other.entries.iter().filter(lacks)).cloned().collect())
    }

    /// Returns all entries, in menu order.
    #[must_use]
    pub fn entries(&self) -> &[Arc<dyn Deformation>] {
        &self.entries
    }

    /// Returns the entry called `name`.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&Arc<dyn Deformation>> {
        self.entries.iter().find(|e| e.info().name == name)
    }
}

#[cfg(test)]
mod tests {
    use super::Registry;
    use std::path::Path;

    /// Files of `src/deform/` that are not entries.
    const SHARED: [&str; 3] = ["mod", "entry", "registry"];

    #[test]
    fn every_file_is_registered() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/deform");
        let list = std::fs::read_to_string(folder.join("mod.rs")).unwrap();
        for file in std::fs::read_dir(&folder).unwrap() {
            let stem = file.unwrap().path().file_stem().unwrap().to_string_lossy().into_owned();
            if SHARED.contains(&stem.as_str()) {
                continue;
            }
            assert!(list.contains(&format!("mod {stem};")), "deform/{stem}.rs is no module of deform/mod.rs");
            assert!(list.contains(&format!("Arc::new({stem}::")), "deform/{stem}.rs is not in builtin()");
            let name = stem.replace('_', "-");
            assert!(
                Registry::builtin().get(&name).is_some(),
                "deform/{stem}.rs does not hold an entry called `{name}`"
            );
        }
    }

    #[test]
    fn names_are_unique() {
        let mut names: Vec<_> = Registry::builtin().entries().iter().map(|e| e.info().name).collect();
        let all = names.len();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), all);
    }

    /// The menu that `pathwarp list` prints: every heading appears once, in the expected order, and all titles differ.
    #[test]
    fn the_list_reads_like_a_menu() {
        let registry = Registry::builtin();
        let infos: Vec<_> = registry.entries().iter().map(|e| e.info()).collect();
        let mut headings: Vec<&str> = Vec::new();
        for i in &infos {
            if !headings.contains(&i.group) {
                headings.push(i.group);
            }
        }
        let expected = [
            "Envelopes",
            "Bends",
            "Lattices and nets",
            "Points",
            "Perspective and anamorphosis",
            "Classics",
            "Formulas",
            "Basics",
        ];
        // Other headings come after these.
        assert_eq!(headings[..expected.len()], expected);
        let mut titles: Vec<&str> = infos.iter().map(|i| i.title).collect();
        titles.sort_unstable();
        titles.dedup();
        assert_eq!(titles.len(), infos.len());
        for i in &infos {
            assert!(
                i.title.starts_with(|c: char| c.is_lowercase()) && !i.title.ends_with('.'),
                "{}: {}",
                i.name,
                i.title
            );
            assert!(i.title.chars().count() <= 80, "{}: {}", i.name, i.title);
            assert!(i.examples.len() >= 2, "{}", i.name);
            let mut commands: Vec<&str> = i.examples.iter().map(|e| e.command).collect();
            commands.sort_unstable();
            commands.dedup();
            assert_eq!(commands.len(), i.examples.len(), "{}", i.name);
            assert!(i.examples.iter().all(|e| e.command.starts_with(i.name)), "{}", i.name);
        }
    }
}
