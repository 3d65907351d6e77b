//! GIMP files from outside: listed, converted, warped, and written back.

mod files;
mod plug_in;
