//! GIMP files from outside: listed, converted, warped, written back, and read by GIMP itself where it is installed.

mod files;
mod gimp_2;
mod gimp_3;
mod installed;
mod paths;
mod plug_in;
