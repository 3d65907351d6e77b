//! `--data`: a drawing for each row of a table.

use crate::support::{expect_code, root};
use pathwarp_oracle::Random;
use std::fs;
use std::path::Path;

/// The lines of text in a drawing, from its title's group.
fn text_of(file: &Path) -> String {
    let drawing = fs::read_to_string(file).unwrap();
    let label = drawing.split("<g aria-label=\"").nth(1).unwrap().split('"').next().unwrap().to_owned();
    [("&#10;", "\n"), ("&quot;", "\""), ("&lt;", "<"), ("&gt;", ">"), ("&amp;", "&")]
        .iter()
        .fold(label, |text, (written, c)| text.replace(written, c))
}

/// Runs `text` with a table in a separate folder. Returns the messages, and the drawings' names and texts.
fn set(table: &[u8], code: i32, args: &[&str]) -> (String, Vec<(String, String)>) {
    let dir = tempfile::tempdir().unwrap();
    let (csv, out) = (dir.path().join("t.csv"), dir.path().join("out"));
    fs::write(&csv, table).unwrap();
    let place = |a: &&str| a.replace("OUT", out.to_str().unwrap());
    let mut all: Vec<String> = ["text", "--data", csv.to_str().unwrap()].map(str::to_owned).to_vec();
    all.extend(args.iter().map(place));
    let (_, said) = expect_code(code, &all.iter().map(String::as_str).collect::<Vec<_>>());
    let files = fs::read_dir(&out).into_iter().flatten().map(|f| f.unwrap().path());
    let mut files: Vec<_> = files.map(|f| (f.file_name().unwrap().to_str().unwrap().to_owned(), text_of(&f))).collect();
    files.sort();
    (said, files)
}

/// Tables as spreadsheets write them: separators in cells, quotes, lines in cells, empty cells and rows, a byte order mark, UTF-16.
#[test]
fn a_table_gives_a_drawing_for_each_row() {
    let rows = "name;team;says\r\nAnna;Red;\"a;b, \"\"c\"\"\nd\"\r\n;;\r\n\r\n Bo ;;x\r\nCleo;Blue";
    let expected = [("Anna", "Anna\nRed a;b, \"c\"\nd"), ("Bo", "Bo\nx"), ("Cleo", "Cleo\nBlue")];
    let expected = expected.map(|(name, text)| (format!("{name}.svg"), text.to_owned()));
    let utf16: Vec<u8> = format!("\u{feff}{rows}").encode_utf16().flat_map(u16::to_le_bytes).collect();
    let unix = rows.replace("\r\n", "\n").replace(';', "\t").replace("a\tb", "a;b");
    let named = format!("sep=;\r\n{rows}");
    for table in [rows.as_bytes(), format!("\u{feff}{rows}").as_bytes(), &utf16, unix.as_bytes(), named.as_bytes()] {
        let (said, files) = set(table, 0, &["{name}", "{Team} { says }", "-o", "OUT/{name}.svg"]);
        assert_eq!((said.as_str(), &files[..]), ("", &expected[..]), "{}", String::from_utf8_lossy(table));
    }
}

/// Cells of any characters come back when written by the rules of RFC 4180.
#[test]
fn cells_come_back_as_they_were() {
    const LETTERS: [&str; 14] = ["a", "Ω", " ", ",", ";", "\"", "\n", "é", "'", "\t", "-", "{id}", "&", "\\n"];
    let mut random = Random::new(65);
    for (separator, end) in [(',', "\n"), (';', "\r\n"), ('\t', "\r\n")] {
        let cell = |random: &mut Random| (0..6).map(|_| random.one_of(&LETTERS)).collect::<String>();
        let cells: Vec<String> = (0..12).map(|_| format!("x{}x", cell(&mut random))).collect();
        let mut table = format!("id{separator}text{separator}other{end}");
        for (i, cell) in cells.iter().enumerate() {
            table += &format!("{i:02}{separator}\"{}\"{separator}{end}", cell.replace('"', "\"\""));
        }
        let (_, files) = set(table.as_bytes(), 0, &["{text}", "-o", "OUT/{id}.svg", "--no-system-fonts"]);
        let texts: Vec<String> = files.into_iter().map(|(_, text)| text).collect();
        assert_eq!(texts, cells.iter().map(|c| c.replace('\t', " ")).collect::<Vec<_>>());
    }
}

#[test]
fn rows_without_a_good_name_are_refused_before_anything_is_written() {
    for (cells, part) in [
        ("a\n../x", "row 3, column name: “../x” has /"),
        ("a\nb/c", "row 3, column name"),
        ("a\nb\\c", "row 3, column name: “b\\c” has \\"),
        ("a\n\"b\nc\"", "has U+000A, a control character"),
        ("a\nb\u{7f}", "U+007F"),
        ("a\nb\n\n../c", "row 5, column name"),
        ("con", "row 2, column name: “con.svg” is the name of a device"),
        ("a\nLpt¹.x", "row 3, column name: “Lpt¹.x.svg” is the name of a device"),
        ("a\nwhat?", "has ?"),
        ("a\n\"\",x", "row 3, column name is empty"),
        ("Anna\nb\nAnna", "rows 2 and 4 give the same file"),
        ("Anna\nANNA", "rows 2 and 3 give"),
        ("Zoë\nZoe\u{308}", "rows 2 and 3 give"),
        ("Straße\nSTRASSE", "rows 2 and 3 give"),
        ("a\nb,c,d", "row 3: has more cells"),
    ] {
        let table = format!("name,n\n{cells}\n");
        let (said, files) = set(table.as_bytes(), 3, &["x{name}", "-o", "OUT/{name}.svg"]);
        assert!(said.contains(part) && said.contains("t.csv") && files.is_empty(), "{cells}: {said}");
    }
    let long = format!("name\n{}\n", "ä".repeat(130));
    assert!(set(long.as_bytes(), 3, &["x", "-o", "OUT/{name}.svg"]).0.contains("longer"));
    // No part of the output's name can name a folder outside.
    assert!(set(b"a,b\n..,x\n", 3, &["x", "-o", "OUT/{a}/{b}.svg"]).0.contains("row 2, column a"));
    for (table, part) in [
        ("", "is empty"),
        ("name\n", "no row"),
        ("nom\nAnna\n", "has no column name; it has nom"),
        ("name,Name\na,b\n", "has 2 columns name"),
    ] {
        let code = if part.contains("column") && !part.contains("row") { 2 } else { 3 };
        assert!(set(table.as_bytes(), code, &["{name}", "-o", "OUT/{name}.svg"]).0.contains(part), "{table}");
    }
    assert!(set(b"name\nAnna\n", 2, &["{name} {team}", "-o", "OUT/{name}.svg"]).0.contains("no column team"));
    assert!(set(b"name\nJos\xe9\n", 3, &["{name}", "-o", "OUT/{name}.svg"]).0.contains("CSV UTF-8"));
    assert!(set(b"name\na\nb\n", 3, &["{name}", "-o", "OUT/x.svg"]).0.contains("rows 2 and 3 give the same file"));
}

/// A row that fails does not affect the others, and no source is overwritten.
#[test]
fn rows_that_fail_are_named() {
    let (said, files) =
        set(b"name,fill\na,red\nb,reddish\nc,#00f\n", 1, &["{name}", "--fill", "{fill}", "-o", "OUT/{name}.svg"]);
    assert!(
        said.contains("t.csv, row 3: ") && said.contains("reddish") && said.contains("1 of 3 rows failed"),
        "{said}"
    );
    assert_eq!(files.iter().map(|f| f.0.as_str()).collect::<Vec<_>>(), ["a.svg", "c.svg"]);
    let (said, files) = set(b"name\nt\n", 2, &["{name}", "-o", "OUT/../{name}.csv"]);
    assert!(!said.is_empty() && files.is_empty(), "{said}");
}

#[test]
fn the_forty_stickers_of_the_sample_are_set() {
    let names = root().join("samples/names.csv");
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("{name}.svg");
    let args = [
        "text",
        "{name}",
        "--data",
        names.to_str().unwrap(),
        "--fill",
        "{colour}",
        "--font",
        "display",
        "-o",
        out.to_str().unwrap(),
    ];
    let (_, said) = expect_code(0, &args);
    assert_eq!((said.as_str(), fs::read_dir(dir.path()).unwrap().count()), ("", 40));
    assert!(fs::read_to_string(dir.path().join("Smith, Jr..svg")).unwrap().contains("fill=\"#00796b\""));
}

#[test]
fn badges_are_made_from_a_table() {
    let dir = tempfile::tempdir().unwrap();
    let (csv, out) = (dir.path().join("t.csv"), dir.path().join("{name}.svg"));
    fs::write(&csv, "name,since\nHARBOUR,1887\nCAMP,2026\n").unwrap();
    let args = ["badge", "{name}", "SINCE {since}", "--data", csv.to_str().unwrap(), "-o", out.to_str().unwrap()];
    expect_code(0, &args);
    for (name, since) in [("HARBOUR", "1887"), ("CAMP", "2026")] {
        let drawing = fs::read_to_string(dir.path().join(format!("{name}.svg"))).unwrap();
        assert!(drawing.contains(&format!("<title>{name} SINCE {since}</title>")), "{drawing}");
    }
}
