//! Hostile files: every command ends with a documented exit code, within the promised time and memory, and reads and writes only files
//! that were named.

mod bounded;
mod crowded;
mod exports;
mod fonts;
mod formulas;
mod honest;
mod inverses;
mod lists;
mod markup;
mod numbers;
mod outputs;
mod packed;
mod pictures;
mod repeated;
mod served;
mod sheets;
mod trust;
