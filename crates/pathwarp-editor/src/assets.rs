//! The files of the page, built from `web/` and embedded.

/// A file of the page.
pub(crate) struct Asset {
    pub(crate) path: &'static str,
    pub(crate) kind: &'static str,
    pub(crate) text: &'static str,
}

/// All files of the page.
pub(crate) static ASSETS: [Asset; 3] = [
    Asset { path: "/", kind: "text/html; charset=utf-8", text: include_str!("../assets/index.html") },
    Asset { path: "/editor.js", kind: "text/javascript; charset=utf-8", text: include_str!("../assets/editor.js") },
    Asset { path: "/editor.css", kind: "text/css; charset=utf-8", text: include_str!("../assets/editor.css") },
];
