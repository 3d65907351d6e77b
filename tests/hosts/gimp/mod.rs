//! GIMP's view of the files written for it, and its plug-in at work, where it is installed.

mod gimp_2;
mod gimp_3;
mod installed;
mod plug_in;
