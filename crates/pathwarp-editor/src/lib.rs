//! Bends artwork by hand: a page in the browser, and a server on this computer that computes every picture.
//!
//! The page (`assets/`) draws and drags; it computes nothing. The server listens on the loopback interface only, and answers only a browser
//! that knows the token in its address. A program implements [`Host`] for files and formats, and calls [`serve`]:
//!
//! * `http`, `guard`: the requests of a page, and the conditions for answering them;
//! * `socket`: one connection of a page, with messages in JSON (`protocol`);
//! * `session`: the document, its steps, undo, and the `draft` on disk, in one of the user's folders;
//! * `picture`: the drawing as the page shows it, through usvg, so that nothing in a file can run or load anything;
//! * `catalogue`, `grips`: the deformations, their first values, and the geometry that handles show;
//! * `names`: the engine's messages in the words of the page;
//! * `nets`: conversion between nets with different numbers of control points.

mod catalogue;
mod command_line;
mod draft;
mod editing;
mod grips;
mod guard;
mod host;
mod http;
mod names;
mod nets;
mod picture;
mod presets;
mod protocol;
mod saving;
mod server;
mod session;
mod socket;
mod stretch;
mod words;

pub use command_line::selectors;
pub use editing::EngineHost;
pub use host::{Artwork, Bent, Fineness, Host, Opened, PictureOptions, Purpose, Summary};
pub use server::{News, Options, serve};
pub use words::Words;
