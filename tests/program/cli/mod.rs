//! The program from outside: exit codes, files, streams, messages.

mod badges;
mod batches;
mod chains;
mod circles;
mod commands;
mod common;
mod contour;
mod documentation;
mod edits_first;
mod encodings;
mod exit_codes;
mod explain;
mod faults;
mod first_words;
mod fonts;
mod overwriting;
mod page;
mod parts;
mod readme;
mod report;
mod selection;
mod shapes;
mod streams;
mod united;
mod units;
mod words;
