//! `pathwarp.h` against the functions of `pathwarp-c`: equal names, parameters and types, in one order.

use crate::support::root;
use std::collections::BTreeMap;
use syn::{FnArg, GenericParam, Item, Pat, ReturnType, Type};

/// A function as C declares it, in one line without needless spaces.
fn declaration(f: &syn::ItemFn) -> String {
    let returned = match &f.sig.output {
        ReturnType::Default => "void ".to_owned(),
        ReturnType::Type(_, t) => c_type(t, true),
    };
    let parameters: Vec<String> = f
        .sig
        .inputs
        .iter()
        .map(|p| {
            let FnArg::Typed(p) = p else { panic!("a method") };
            let Pat::Ident(name) = &*p.pat else { panic!("a pattern") };
            format!("{}{}", c_type(&p.ty, false), name.ident)
        })
        .collect();
    let parameters = if parameters.is_empty() { "void".to_owned() } else { parameters.join(", ") };
    format!("{returned}{}({parameters});", f.sig.ident)
}

/// A type as C writes it before a name.
fn c_type(t: &Type, returned: bool) -> String {
    match t {
        Type::Ptr(p) => {
            let inner = c_type(&p.elem, false);
            let constant = matches!(p.mutability, syn::PointerMutability::Const(_));
            match (inner.strip_suffix('*'), constant) {
                (Some(_), true) => format!("{inner}const *"),
                (None, true) => format!("const {inner}*"),
                (_, false) => format!("{inner}*"),
            }
        }
        Type::Path(p) => {
            let name = p.path.segments.last().unwrap().ident.to_string();
            let c = match name.as_str() {
                "c_char" => "char",
                "f64" => "double",
                "u8" => "uint8_t",
                "usize" => "size_t",
                "i32" if returned => "pathwarp_status",
                "PathwarpWarper" => "pathwarp_warper",
                "PathwarpFunction" => "pathwarp_function",
                other => panic!("{other} has no counterpart in the header"),
            };
            format!("{c} ")
        }
        _ => panic!("a type without counterpart in C"),
    }
}

fn read(file: &str) -> String {
    std::fs::read_to_string(root().join("crates/pathwarp-c").join(file)).unwrap()
}

#[test]
fn the_header_declares_what_the_library_exports() {
    let source = syn::parse_file(&read("src/exports.rs")).unwrap();
    let mut exported = Vec::new();
    for item in &source.items {
        let Item::Fn(f) = item else { continue };
        if f.sig.abi.is_none() {
            continue;
        }
        assert!(f.attrs.iter().any(|a| quoted(a).contains("no_mangle")), "{} is not exported", f.sig.ident);
        assert!(!f.sig.generics.params.iter().any(|p| matches!(p, GenericParam::Type(_))));
        exported.push(declaration(f));
    }
    // Comments and line breaks of the header do not count.
    let mut header = read("include/pathwarp.h");
    while let Some(start) = header.find("/*") {
        let end = start + header[start..].find("*/").unwrap() + 2;
        header.replace_range(start..end, " ");
    }
    let lines: Vec<&str> = header.lines().filter(|l| !l.trim_start().starts_with('#')).collect();
    let text = lines.join(" ").split_whitespace().collect::<Vec<_>>().join(" ");
    let declared: Vec<String> = text
        .split_inclusive(';')
        .map(str::trim)
        .filter(|d| d.contains('(') && !d.starts_with("typedef"))
        .map(|d| d.trim_start_matches("extern \"C\" {").trim().to_owned())
        .collect();
    assert!(exported.len() > 8);
    assert_eq!(declared, exported);
}

/// The statuses are equal to those of `raw.rs`.
#[test]
fn the_header_has_the_librarys_statuses() {
    let header = read("include/pathwarp.h");
    let defined = header.lines().filter_map(|l| {
        let mut words = l.strip_prefix("#define PATHWARP_")?.split_whitespace();
        Some((words.next()?.to_owned(), words.next()?.parse::<i32>().ok()?))
    });
    let defined: BTreeMap<String, i32> = defined.collect();
    let raw = read("src/raw.rs");
    let constants = raw.lines().filter_map(|l| {
        let (name, value) = l.trim_start_matches("pub(crate) ").strip_prefix("const ")?.split_once(": i32 = ")?;
        Some((name.to_owned(), value.trim_end_matches(';').parse().ok()?))
    });
    assert_eq!(defined, constants.collect::<BTreeMap<String, i32>>());
    assert_eq!(defined.len(), 6);
}

fn quoted(a: &syn::Attribute) -> String {
    match &a.meta {
        syn::Meta::List(l) => l.tokens.to_string(),
        _ => String::new(),
    }
}
