//! Imports between the files of one crate, read from its source.
//!
//! Every path in the code is resolved to the file that *defines* the item, through re-exports and `use` aliases. Modules compiled only
//! for tests are ignored. Re-exports themselves (`pub use`) are not imports: a `mod.rs` may re-export definitions of its
//! children.

use proc_macro2::{TokenStream, TokenTree};
use std::collections::{BTreeMap, BTreeSet};
use syn::visit::{self, Visit};
use syn::{Attribute, Item, UseTree, Visibility};

/// Arrows between files: `arrows["a.rs"]` names the files that `a.rs` imports from, with one imported path each.
pub type Arrows = BTreeMap<String, BTreeMap<String, String>>;

type ModulePath = Vec<String>;

/// A module: a file, or a block within one.
#[derive(Default)]
struct Module {
    file: String,
    /// Names defined here.
    items: BTreeSet<String>,
    /// Names imported or re-exported here, and the path each comes from.
    aliases: BTreeMap<String, ModulePath>,
    /// Modules whose names are all visible here.
    globs: Vec<ModulePath>,
    /// Paths used here.
    used: Vec<ModulePath>,
}

/// The crate's modules by their path.
#[derive(Default)]
pub struct Crate {
    modules: BTreeMap<ModulePath, Module>,
}

impl Crate {
    /// Reads a crate from its files: paths relative to `src`, and their text.
    ///
    /// # Panics
    /// On source that does not parse.
    pub fn read(files: &BTreeMap<String, String>) -> Self {
        let mut out = Self::default();
        let root = if files.contains_key("lib.rs") { "lib.rs" } else { "main.rs" };
        out.file(files, root, Vec::new());
        out
    }

    fn file(&mut self, files: &BTreeMap<String, String>, name: &str, at: ModulePath) {
        let parsed = syn::parse_file(&files[name]).unwrap_or_else(|e| panic!("{name}: {e}"));
        self.module(files, name, at, &parsed.items);
    }

    fn module(&mut self, files: &BTreeMap<String, String>, file: &str, at: ModulePath, items: &[Item]) {
        let mut module = Module { file: file.to_owned(), ..Module::default() };
        for item in items.iter().filter(|i| !is_test(attributes(i))) {
            if let Some(name) = defined(item) {
                module.items.insert(name);
            }
            match item {
                Item::Use(u) => {
                    let public = !matches!(u.vis, Visibility::Inherited);
                    flatten(&u.tree, &mut Vec::new(), &mut module, public);
                }
                Item::Mod(m) => {
                    let mut path = at.clone();
                    path.push(m.ident.to_string());
                    if let Some((_, items)) = &m.content {
                        self.module(files, file, path, items);
                    } else {
                        let base = path.join("/");
                        let child = [format!("{base}.rs"), format!("{base}/mod.rs")];
                        let child = child.iter().find(|f| files.contains_key(*f));
                        self.file(files, child.unwrap_or_else(|| panic!("{file}: no file of mod {base}")), path);
                    }
                }
                _ => Paths(&mut module.used).visit_item(item),
            }
        }
        self.modules.insert(at, module);
    }

    /// The imports between files.
    pub fn arrows(&self) -> Arrows {
        let mut arrows = Arrows::new();
        for (at, module) in &self.modules {
            for path in &module.used {
                if let Some(file) = self.resolve(at, path, 0)
                    && file != module.file
                {
                    let shown = path.join("::");
                    arrows.entry(module.file.clone()).or_default().entry(file).or_insert(shown);
                }
            }
        }
        arrows
    }

    /// Returns the file that defines the item of `path`, as written in module `at`; `None` for other crates' items and for modules.
    fn resolve(&self, at: &ModulePath, path: &[String], depth: usize) -> Option<String> {
        /// Depth beyond any ordinary chain of re-exports.
        const DEEPEST: usize = 32;
        if depth > DEEPEST {
            return None;
        }
        let mut here = at.clone();
        let mut rest = path;
        match path.first()?.as_str() {
            "crate" => {
                here.clear();
                rest = &rest[1..];
            }
            "self" => rest = &rest[1..],
            "super" => {
                while rest.first().is_some_and(|s| s == "super") {
                    here.pop();
                    rest = &rest[1..];
                }
            }
            _ => {}
        }
        while let Some(name) = rest.first() {
            let module = self.modules.get(&here)?;
            let mut child = here.clone();
            child.push(name.clone());
            if self.modules.contains_key(&child) {
                here = child;
                rest = &rest[1..];
                continue;
            }
            if let Some(target) = module.aliases.get(name) {
                let whole: Vec<String> = target.iter().chain(&rest[1..]).cloned().collect();
                // In `use rayon::…` and the like, the first name is another crate's.
                return if whole == path && here == *at { None } else { self.resolve(&here, &whole, depth + 1) };
            }
            if module.items.contains(name) {
                return Some(module.file.clone());
            }
            return module.globs.iter().find_map(|glob| {
                let whole: Vec<String> = glob.iter().chain(rest).cloned().collect();
                self.resolve(&here, &whole, depth + 1)
            });
        }
        None
    }
}

/// The circles between folders: every set of files that import one another and are not all in one folder, each sorted.
pub fn circles(arrows: &Arrows) -> Vec<Vec<String>> {
    let reach: BTreeMap<&String, BTreeSet<&String>> = arrows
        .keys()
        .map(|from| {
            let mut seen = BTreeSet::new();
            let mut next = vec![from];
            while let Some(file) = next.pop() {
                next.extend(arrows.get(file).into_iter().flat_map(BTreeMap::keys).filter(|f| seen.insert(*f)));
            }
            (from, seen)
        })
        .collect();
    let together = |a: &String, b: &String| reach[a].contains(b) && reach.get(b).is_some_and(|r| r.contains(a));
    let mut out: BTreeSet<Vec<String>> = BTreeSet::new();
    for file in arrows.keys().filter(|f| reach[f].contains(f)) {
        out.insert(arrows.keys().filter(|other| together(file, other)).cloned().collect());
    }
    let folder = |file: &String| file.rsplit_once('/').map_or(String::new(), |(folder, _)| folder.to_owned());
    out.into_iter().filter(|files| files.iter().any(|f| folder(f) != folder(&files[0]))).collect()
}

/// Collects every path with a known start.
struct Paths<'a>(&'a mut Vec<ModulePath>);

impl<'ast> Visit<'ast> for Paths<'_> {
    fn visit_path(&mut self, path: &'ast syn::Path) {
        self.0.push(path.segments.iter().map(|s| s.ident.to_string()).collect());
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, call: &'ast syn::Macro) {
        self.tokens(call.tokens.clone());
        visit::visit_macro(self, call);
    }

    fn visit_attribute(&mut self, attribute: &'ast Attribute) {
        if let syn::Meta::List(list) = &attribute.meta {
            self.tokens(list.tokens.clone());
        }
    }

    fn visit_item_use(&mut self, _: &'ast syn::ItemUse) {}

    fn visit_item_mod(&mut self, _: &'ast syn::ItemMod) {}
}

impl Paths<'_> {
    /// The paths within a macro's arguments, which are only tokens: names joined by `::`.
    fn tokens(&mut self, tokens: TokenStream) {
        let mut path: ModulePath = Vec::new();
        let mut colons = 0;
        for token in tokens {
            match token {
                TokenTree::Punct(p) if p.as_char() == ':' => colons += 1,
                TokenTree::Ident(name) => {
                    if colons != 2 {
                        self.0.push(std::mem::take(&mut path));
                    }
                    path.push(name.to_string());
                    colons = 0;
                }
                other => {
                    self.0.push(std::mem::take(&mut path));
                    colons = 0;
                    if let TokenTree::Group(group) = other {
                        self.tokens(group.stream());
                    }
                }
            }
        }
        self.0.push(path);
    }
}

/// Takes a `use` tree apart. Names that are not re-exported count as used.
fn flatten(tree: &UseTree, front: &mut ModulePath, module: &mut Module, public: bool) {
    match tree {
        UseTree::Path(p) => {
            front.push(p.ident.to_string());
            flatten(&p.tree, front, module, public);
            front.pop();
        }
        UseTree::Group(g) => g.items.iter().for_each(|t| flatten(t, front, module, public)),
        UseTree::Glob(_) => module.globs.push(front.clone()),
        UseTree::Name(n) => alias(front, &n.ident.to_string(), &n.ident.to_string(), module, public),
        UseTree::Rename(r) => alias(front, &r.ident.to_string(), &r.rename.to_string(), module, public),
    }
}

fn alias(front: &[String], name: &str, shown: &str, module: &mut Module, public: bool) {
    let mut path = front.to_vec();
    let mut shown = shown;
    if name == "self" {
        if shown == "self" {
            shown = front.last().map_or("", String::as_str);
        }
    } else {
        path.push(name.to_owned());
    }
    if !public {
        module.used.push(path.clone());
    }
    module.aliases.insert(shown.to_owned(), path);
}

fn defined(item: &Item) -> Option<String> {
    Some(match item {
        Item::Const(i) => i.ident.to_string(),
        Item::Enum(i) => i.ident.to_string(),
        Item::Fn(i) => i.sig.ident.to_string(),
        Item::Static(i) => i.ident.to_string(),
        Item::Struct(i) => i.ident.to_string(),
        Item::Trait(i) => i.ident.to_string(),
        Item::Type(i) => i.ident.to_string(),
        Item::Union(i) => i.ident.to_string(),
        Item::Macro(i) => i.ident.as_ref()?.to_string(),
        _ => return None,
    })
}

fn attributes(item: &Item) -> &[Attribute] {
    match item {
        Item::Const(i) => &i.attrs,
        Item::Enum(i) => &i.attrs,
        Item::Fn(i) => &i.attrs,
        Item::Impl(i) => &i.attrs,
        Item::Macro(i) => &i.attrs,
        Item::Mod(i) => &i.attrs,
        Item::Static(i) => &i.attrs,
        Item::Struct(i) => &i.attrs,
        Item::Trait(i) => &i.attrs,
        Item::Type(i) => &i.attrs,
        Item::Use(i) => &i.attrs,
        _ => &[],
    }
}

/// `#[cfg(test)]`, `#[cfg(doctest)]`.
pub(super) fn is_test(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|a| {
        a.path().is_ident("cfg")
            && a.parse_args::<syn::Path>().is_ok_and(|p| p.is_ident("test") || p.is_ident("doctest"))
    })
}
