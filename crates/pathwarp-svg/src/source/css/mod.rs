//! Style as browsers read it. usvg knows the selectors of CSS 2.1 and takes geometry and transforms from attributes only. Where a
//! drawing asks for more, its style is computed here (CSS Cascade 5, Selectors 4, Media Queries 4, CSS Values 4, CSS Transforms 1
//! and 2, SVG 2's geometry properties), and written into attributes that usvg and the rest of this crate read. The writer puts the
//! original attributes back where it does not change them.

mod cascade;
mod color;
mod computed;
mod element;
mod letters;
mod media;
mod names;
mod needed;
mod resolved;
mod shapes;
mod sheet;
mod text;
mod transform;
mod tree;
mod value;

pub(crate) use resolved::{Original, Resolved, resolved};
