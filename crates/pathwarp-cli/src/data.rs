//! `--data` executes a command for each row of a table, whose cells replace `{column}` in its words and in the output's name.

use crate::ending::Status;
use crate::pipeline::Folders;
use crate::sources::Files;
use crate::{interruption, terminal, watch};
use clap::{Arg, ArgMatches, value_parser};
use encoding_rs::{Encoding, UTF_8};
use pathwarp::deform::Registry;
use pathwarp_engine::advice::Flags;
use pathwarp_engine::failure::Failure;
use pathwarp_engine::input;
use pathwarp_engine::readable::listed;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use unicode_normalization::UnicodeNormalization as _;

const DATA: &str = "data";
/// Most faults of each kind in the list.
const SHOWN: usize = 8;

pub(crate) fn arg() -> Arg {
    Arg::new(DATA).long(DATA).value_name("TABLE.csv").value_parser(value_parser!(PathBuf)).requires("out").help(
        "Make one drawing for each row of a table: {column} in the words and in -o stands for its cell. Columns are separated by \
         commas, semicolons or tabs, and their names are in the first row",
    )
}

/// Returns `true` if a table is given.
pub(crate) fn is_given(m: &ArgMatches) -> bool {
    m.contains_id(DATA)
}

/// A row of a table.
pub(crate) struct Row<'a> {
    /// The columns' names, as in the table.
    names: &'a [String],
    cells: &'a [String],
}

impl Row<'_> {
    /// Replaces each `{column}` in a text by its cell.
    pub(crate) fn filled(&self, text: &str) -> String {
        let cell = |name| self.names.iter().position(|n| are_same(n, name)).and_then(|i| self.cells.get(i));
        let filled = pieces(text).map(|piece| match piece {
            Piece::Column(name) => cell(name).map_or("", String::as_str),
            Piece::Plain(text) => text,
        });
        filled.collect()
    }

    /// Replaces each `{column}` in lines of text by its cell, trims the lines, and drops those that cells make empty.
    pub(crate) fn filled_lines(&self, text: &str) -> String {
        let lines = text.split('\n').filter_map(|line| match columns(line).next() {
            Some(_) => Some(self.filled(line).trim().to_owned()).filter(|filled| !filled.is_empty()),
            None => Some(line.to_owned()),
        });
        lines.collect::<Vec<_>>().join("\n")
    }
}

/// Calls `draw` with each row of the table that `--data` names, and the row's output. All rows, which may fill `texts` and the name of the
/// output, are checked first. A row that fails is reported, and the others continue. `reads` lists other files that the command reads.
pub(crate) fn for_each_row(
    registry: &Registry,
    m: &ArgMatches,
    texts: &[&str],
    reads: &[&Path],
    draw: impl Fn(&Row<'_>, &Path) -> Result<Status, Failure>,
) -> Result<Status, Failure> {
    let [file, out] = [DATA, "out"].map(|name| m.get_one::<PathBuf>(name).map_or(Path::new("-"), PathBuf::as_path));
    let name = input::display(file);
    let table = Table::read(&decoded(&input::bytes(file)?, &name)?);
    let table = table.map_err(|e| Failure::Input(format!("{name}{e}")))?;
    table.check_columns(texts, out).map_err(|e| Failure::usage(format!("{name} {e}")))?;
    let targets = table.targets(out).map_err(|e| Failure::Input(format!("{name}: {e}")))?;
    let mut files = Files::default();
    reads.iter().chain([&file]).for_each(|f| files.add_source(f));
    // Refuses outputs that are also read, or given twice. No option of their own names them.
    targets.iter().try_for_each(|t| files.add_output(t, ""))?;
    let _empty_ones_removed_at_the_end = Folders::of(targets.iter().map(PathBuf::as_path))?;
    let (mut failures, mut partial) = (Vec::new(), false);
    for ((number, cells), target) in table.rows.iter().zip(&targets) {
        let _own_allowance = watch::InBatch::begin();
        match draw(&Row { names: &table.names, cells }, target) {
            Ok(status) => {
                partial |= status == Status::Partial;
                interruption::count_finished();
            }
            Err(failure) => failures.push((number, failure)),
        }
    }
    let (all, failed) = (table.rows.len(), failures.len());
    // If all rows fail, it is probably for the same reason.
    if failed == all {
        return failures.pop().map_or(Ok(Status::Complete), |(_, failure)| Err(failure));
    }
    for (number, failure) in failures.iter().take(SHOWN) {
        terminal::error(&format!("{name}, row {number}: {}", failure.message(&Flags::of(registry))));
    }
    if failed > 0 {
        terminal::error(&format!("{failed} of {all} rows failed; the drawings of the others are written"));
    }
    Ok(Status::partial_if(partial || failed > 0))
}

/// Decodes a file in UTF-8, or in UTF-16 with a byte order mark, and drops the mark.
pub(crate) fn decoded(bytes: &[u8], name: &str) -> Result<String, Failure> {
    let (encoding, mark) = Encoding::for_bom(bytes).unwrap_or((UTF_8, 0));
    let text = encoding.decode_without_bom_handling_and_without_replacement(&bytes[mark..]);
    text.map(Into::into).ok_or_else(|| {
        let valid = std::str::from_utf8(bytes).map_or_else(|e| e.valid_up_to(), |_| 0);
        Failure::Input(format!("{name}: is not UTF-8 text (byte {valid}); of a table, save it as CSV UTF-8"))
    })
}

struct Table {
    names: Vec<String>,
    /// The rows below the names, numbered as in a spreadsheet.
    rows: Vec<(usize, Vec<String>)>,
}

impl Table {
    /// Parses a table. Cells are trimmed, and rows without content are dropped.
    fn read(text: &str) -> Result<Self, String> {
        // Excel can write the separator in a line before the names.
        let declared =
            text.strip_prefix("sep=").and_then(|rest| Some((*rest.as_bytes().first()?, rest.split_once('\n')?.1)));
        let (separator, text) = declared.unwrap_or_else(|| (separator(text), text));
        let text = text.trim_end_matches(['\r', '\n']).to_owned() + "\n";
        let mut reader = csv::ReaderBuilder::new();
        let mut reader = reader.delimiter(separator).has_headers(false).flexible(true).from_reader(text.as_bytes());
        let (mut record, mut all) = (csv::StringRecord::new(), Vec::new());
        let (mut line, mut number) = (1, usize::from(declared.is_some()));
        while reader.read_record(&mut record).map_err(|e| format!(": {e}"))? {
            // Empty rows, which the reader skips, count; line ends within cells do not.
            let line_ends_in_cells: usize = record.iter().map(|cell| cell.matches('\n').count()).sum();
            let next = reader.position().line() as usize;
            number += (next - line).saturating_sub(line_ends_in_cells).max(1);
            line = next;
            let cells: Vec<String> = record.iter().map(|cell| cell.trim().to_owned()).collect();
            all.extend(cells.iter().any(|cell| !cell.is_empty()).then_some((number, cells)));
        }
        let mut rows = all.into_iter();
        let (_, names) = rows.next().ok_or(": is empty; the first row names the columns")?;
        let rows: Vec<_> = rows.collect();
        match rows.iter().find(|(_, cells)| cells.iter().skip(names.len()).any(|c| !c.is_empty())) {
            Some((number, _)) => Err(format!(", row {number}: has more cells than the first row has columns")),
            None if rows.is_empty() => Err(": has no row below the names of the columns".to_owned()),
            None => Ok(Self { names, rows }),
        }
    }

    /// Checks that every column in use exists, and exists only once.
    fn check_columns(&self, texts: &[&str], out: &Path) -> Result<(), String> {
        for wanted in texts.iter().copied().chain([&*out.to_string_lossy()]).flat_map(columns) {
            match self.names.iter().filter(|name| are_same(name, wanted)).count() {
                0 => return Err(format!("has no column {wanted}; it has {}", listed(&self.names, SHOWN))),
                1 => {}
                n => return Err(format!("has {n} columns {wanted}; rename all but one")),
            }
        }
        Ok(())
    }

    /// Returns the output of each row, if all are different and valid names for file systems.
    fn targets(&self, out: &Path) -> Result<Vec<PathBuf>, String> {
        let (mut targets, mut faults) = (Vec::with_capacity(self.rows.len()), Vec::new());
        let mut known: HashMap<String, (usize, String)> = HashMap::new();
        for (number, cells) in &self.rows {
            let row = Row { names: &self.names, cells };
            let parts = out.components().map(|part| {
                let pattern = part.as_os_str().to_string_lossy();
                faults.extend(name_fault(&row, &pattern).map(|fault| format!("row {number}, {fault}")));
                row.filled(&pattern)
            });
            let target: PathBuf = parts.collect();
            let shown = target.display().to_string();
            // Names that differ in capitals or in the encoding of accents are equal on some systems.
            let folded: String = shown.nfd().collect::<String>().to_uppercase().to_lowercase().nfc().collect();
            if let Some((first, other)) = known.get(&folded) {
                faults.push(match *other == shown {
                    true => format!("rows {first} and {number} give the same file, {shown}"),
                    false => format!(
                        "rows {first} and {number} give {other} and {shown}, which some systems take for one file"
                    ),
                });
            }
            known.entry(folded).or_insert((*number, shown));
            targets.push(target);
        }
        let more = faults.len().saturating_sub(SHOWN);
        faults.truncate(SHOWN);
        faults.extend((more > 0).then(|| format!("and {more} more")));
        if faults.is_empty() { Ok(targets) } else { Err(format!("{}; nothing was written", faults.join("\n  "))) }
    }
}

/// Explains why cells do not form a name of a file or folder, with their columns.
fn name_fault(row: &Row<'_>, pattern: &str) -> Option<String> {
    /// Characters that Windows reserves, and names that it reserves with any ending (Win32, Naming Files, Paths, and Namespaces).
    const RESERVED: &str = "/\\<>:\"|?*";
    const DEVICES: [&str; 6] = ["CON", "PRN", "AUX", "NUL", "CONIN$", "CONOUT$"];
    const PORTS: [&str; 2] = ["COM", "LPT"];
    /// Most bytes in a name (ext4; others take as many characters).
    const LONGEST: usize = 255;
    for column in columns(pattern) {
        let cell = row.filled(&format!("{{{column}}}"));
        if cell.is_empty() {
            return Some(format!("column {column} is empty, but has to name a file"));
        }
        if let Some(c) = cell.chars().find(|c| RESERVED.contains(*c) || c.is_control()) {
            let c = if c.is_control() { format!("U+{:04X}, a control character", u32::from(c)) } else { c.to_string() };
            return Some(format!("column {column}: “{cell}” has {c}, which is not allowed in the name of a file"));
        }
    }
    let columns: Vec<&str> = columns(pattern).collect();
    let name = row.filled(pattern);
    let stem = name.split('.').next().unwrap_or_default().trim_end().to_uppercase();
    let port_number = PORTS.iter().find_map(|port| stem.strip_prefix(port)).unwrap_or_default();
    let is_port = port_number.chars().count() == 1 && port_number.contains(char::is_numeric);
    let problem = if name.ends_with(['.', ' ']) || name.starts_with(' ') {
        "begins with a space, or ends with a space or a dot, which file systems drop"
    } else if DEVICES.contains(&stem.as_str()) || is_port {
        "is the name of a device on Windows"
    } else if name.len() > LONGEST {
        "is longer than file systems take"
    } else {
        return None;
    };
    (!columns.is_empty()).then(|| format!("column {}: “{name}” {problem}", columns.join(", ")))
}

/// Returns `true` if two names of columns are equal but for capitals and spaces around them.
fn are_same(a: &str, b: &str) -> bool {
    a.trim().to_lowercase() == b.trim().to_lowercase()
}

/// A part of a text: the name of a column in braces, or the text between such names.
enum Piece<'a> {
    Column(&'a str),
    Plain(&'a str),
}

/// Returns the columns that a text names.
fn columns(text: &str) -> impl Iterator<Item = &str> {
    pieces(text).filter_map(|p| if let Piece::Column(name) = p { Some(name) } else { None })
}

/// Splits a text at the names of columns.
fn pieces(text: &str) -> impl Iterator<Item = Piece<'_>> {
    let mut rest = text;
    std::iter::from_fn(move || {
        if rest.is_empty() {
            return None;
        }
        let column = rest.strip_prefix('{').and_then(|inner| inner.split_once('}'));
        if let Some((name, after)) = column.filter(|(name, _)| !name.contains(['{', '\n'])) {
            rest = after;
            return Some(Piece::Column(name.trim()));
        }
        let end = rest.char_indices().skip(1).find(|(_, c)| *c == '{').map_or(rest.len(), |(i, _)| i);
        let (plain, after) = rest.split_at(end);
        rest = after;
        Some(Piece::Plain(plain))
    })
}

/// Returns the most frequent separator in the first row, outside of quotes.
fn separator(text: &str) -> u8 {
    let mut quoted = false;
    let first = text.bytes().take_while(|b| {
        quoted ^= *b == b'"';
        quoted || *b != b'\n'
    });
    let unquoted: Vec<u8> = first.collect::<Vec<_>>().split(|b| *b == b'"').step_by(2).flatten().copied().collect();
    let count = |separator: &u8| unquoted.iter().filter(|b| *b == separator).count();
    // Of equals, the last one is taken.
    [b'\t', b';', b','].into_iter().max_by_key(count).unwrap_or(b',')
}
