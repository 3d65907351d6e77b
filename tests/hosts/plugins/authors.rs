//! Experiences of a plug-in's author: values arrive whole, checks find mistakes, and standard error is shown.

use crate::support::plugins::{Scratch, python};
use std::fs;

/// The template as a plug-in called `name`, with these changes.
fn template(s: &Scratch, name: &str, changes: &[(&str, &str)]) -> String {
    s.expect(0, &["new-plugin", "python", name]);
    let file = format!("pathwarp-{name}.py");
    let mut text = fs::read_to_string(s.file(&file)).unwrap();
    for (old, new) in changes {
        assert!(text.contains(old), "{old}");
        text = text.replacen(old, new, 1);
    }
    fs::write(s.file(&file), text).unwrap();
    format!("./{file}")
}

const POINT: &str = "return x, y + self.height * math.sin(self.waves * x)";
/// The beginning of the template's laws: the text from there on is removed from the entry.
const LAWS: &str = "    \"laws\": [";

/// A template whose map answers `point`, with these laws and no cases.
fn with_laws(s: &Scratch, name: &str, point: &str, laws: &str, domain: &str) -> String {
    let laws =
        format!("    \"domain\": \"{domain}\", \"laws\": {laws},\n    \"cases\": [],\n}}\nREST = {{\n    \"laws\": [");
    template(s, name, &[(POINT, point), (LAWS, &laws)])
}

#[test]
fn repeated_values_and_texts_arrive_whole() {
    if !python() {
        return;
    }
    let s = Scratch::new();
    let params = r#""parameters": [
        {"name": "n", "kind": "number", "repeat": True, "help": "A."},
        {"name": "far", "kind": "length", "repeat": True, "help": "A."},
        {"name": "turn", "kind": "angle", "repeat": True, "help": "A."},
        {"name": "many", "kind": "count", "repeat": True, "help": "A."},
        {"name": "at", "kind": "point", "repeat": True, "help": "A."},
        {"name": "pair", "kind": "numbers", "count": 2, "repeat": True, "help": "A."},
        {"name": "way", "kind": "choice", "choices": ["up", "down"], "repeat": True, "help": "A."},
        {"name": "word", "kind": "text", "value": "WORD", "repeat": True, "help": "A."},"#;
    let show = "raise ValueError(json.dumps(values))\n        self.height = float";
    let file = template(&s, "rep", &[("\"parameters\": [", params), ("self.height = float", show)]);
    let given = "--n 1 --n 50% --n 3 --far 1mm --far 5 --turn 30 --turn 0.5turn --many 2 --many 7 --at 50,50 --at 1,2 --pair 1,2 --pair \
                 3,4 --way up --way down --word foo --word bar --frame 0,0,100,100";
    let mut args = vec!["rep", "in.svg", "--plugin", &file, "-o", "out.svg", "--word", "a\\b\nc"];
    args.extend(given.split(' '));
    let (_, said) = s.expect(3, &args);
    let json = said.split_once(": {").map(|(_, rest)| format!("{{{}", rest.trim())).unwrap_or_else(|| panic!("{said}"));
    let values: serde_json::Value = serde_json::from_str(&json).unwrap_or_else(|e| panic!("{e}: {json}"));
    let is = |name: &str, all: &[&str]| assert_eq!(values[name], serde_json::json!(all), "{said}");
    is("n", &["1", "0.5", "3"]);
    is("turn", &["30", "180"]);
    is("many", &["2", "7"]);
    is("at", &["50 50", "1 2"]);
    is("pair", &["1 2", "3 4"]);
    is("way", &["up", "down"]);
    is("word", &["a\\b\nc", "foo", "bar"]);
    let far = values["far"].as_array().unwrap();
    let mm: f64 = far[0].as_str().unwrap().parse().unwrap();
    assert!((mm - 96.0 / 25.4).abs() < 1e-9 && far[1] == "5", "{said}");
    // A program of the first version still gets only the last value.
    let text = fs::read_to_string(s.file("pathwarp-rep.py")).unwrap();
    fs::write(s.file("pathwarp-rep.py"), text.replace("\"pathwarp-plugin\": 2", "\"pathwarp-plugin\": 1")).unwrap();
    let (_, said) = s.expect(3, &["rep", "in.svg", "--plugin", &file, "-o", "out.svg", "--n", "1", "--n", "2"]);
    assert!(said.contains("\"n\": [\"2\"]"), "{said}");
}

#[test]
fn checks_tell_of_crashes_of_edges_and_of_two_answers() {
    if !python() {
        return;
    }
    let s = Scratch::new();
    let crash = "return x + math.sin(self.height * y) / self.height, y";
    let file = with_laws(&s, "crash", crash, "[{\"identity\": {\"height\": 0}}]", "plane");
    let (told, _) = s.expect(1, &["check", &file]);
    assert!(told.contains("FAIL  laws") && told.contains("ended") && told.contains("{\"height\": 0}"), "{told}");

    let half = "return (x + x * x / 100, y) if x > 9 else (math.nan, math.nan)";
    let law = "[{\"keeps-lines-along\": [{}, [0, 1]]}]";
    for edge in ["write(\"ok\\n\")", "write(\"edge line 1 0 -9\\nok\\n\")"] {
        let _ = fs::remove_file(s.file("pathwarp-half.py"));
        let file = with_laws(&s, "half", half, law, "partial");
        let text = fs::read_to_string(s.file("pathwarp-half.py")).unwrap();
        fs::write(s.file("pathwarp-half.py"), text.replace("write(\"ok\\n\")", edge)).unwrap();
        let (told, _) = s.expect(0, &["check", &file]);
        assert!(
            told.contains("half is sound") && told.matches("outside of the domain are skipped").count() >= 2,
            "{told}"
        );
    }
    // A law that does not hold inside of the domain is still seen.
    let bent = "return (x + y * y / 100, y) if x > 9 else (math.nan, math.nan)";
    let file = with_laws(&s, "bends", bent, law, "partial");
    let (told, _) = s.expect(1, &["check", &file]);
    assert!(told.contains("FAIL  laws"), "{told}");

    let random = "import random; return x + random.random(), y";
    let file = with_laws(&s, "random", random, "[]", "plane");
    let (told, _) = s.expect(1, &["check", &file]);
    assert!(told.contains("gives two answers for the point 3.7,4.3: ") && !told.contains("refitting"), "{told}");
}

/// The check reports each mistake by its kind, in words that an author finds in the entry or can write into the program.
#[test]
fn mistakes_are_told_by_their_kind() {
    if !python() {
        return;
    }
    let s = Scratch::new();
    let laws = "[{\"identity\": {\"height\": 0}}, {\"keeps-lines\": {}}, {\"area\": [{}, 1]}, {\"undoes\": [{}, {}]}]";
    let counter = "self.n = getattr(self, 'n', 0) + 1; return x, y + (5 if self.height else self.n // 100)";
    for (name, point, laws, domain, words) in [
        (
            "kink",
            "return x, y + 0.3 * abs(x - 50)",
            "[]",
            "plane",
            vec!["FAIL  creases", "declare a crease at line 1 0 -50"],
        ),
        (
            "ring",
            "return x, y + max(0, 20 - math.hypot(x - 50, y - 40)) / 5",
            "[]",
            "plane",
            vec!["at circle 50 40 20"],
        ),
        ("rounds", "return x, round(y + 10 * math.sin(x / 9), 3)", "[]", "plane", vec!["y' is rounded to 3 decimals"]),
        (
            "swaps",
            "return y, x + math.sin(y / 9)",
            "[]",
            "plane",
            vec!["is sound", "it mirrors, as one does that swaps x and y"],
        ),
        (
            "counts",
            counter,
            "[{\"identity\": {\"height\": 0}}]",
            "plane",
            vec!["FAIL  laws", "{\"height\": 0} gives two answers for the point"],
        ),
        (
            "nothing",
            "return math.nan, math.nan",
            laws,
            "partial",
            vec!["FAIL  values", "has no value at any of 81 places"],
        ),
    ] {
        let file = with_laws(&s, name, point, laws, domain);
        let sound = i32::from(name != "swaps");
        let (told, _) = s.expect(sound, &["check", &file]);
        assert!(words.iter().all(|w| told.contains(w)) && !told.contains("Point {"), "{words:?}: {told}");
        if name == "nothing" {
            assert_eq!(told.matches("the map has no value at any place").count(), 3 + 1, "{told}");
            assert!(told.contains("area {}: the map"), "{told}");
        }
    }
    let crease = [("write(\"ok\\n\")", "write(\"crease line 0 0 5\\nok\\n\")")];
    let (told, _) = s.expect(1, &["check", &template(&s, "creased", &crease)]);
    assert!(told.contains("FAIL  build") && told.contains("`crease line 0 0 5` is not a crease"), "{told}");
}

#[test]
fn people_print() {
    if !python() {
        return;
    }
    let s = Scratch::new();
    let loud = "self.height = float";
    let print = "print(\"I was built\", file=sys.stderr)\n        self.height = float";
    let file = template(&s, "loud", &[(loud, print)]);
    let (_, said) = s.expect(0, &["loud", "in.svg", "--plugin", &file, "-o", "out.svg"]);
    assert!(said.contains("pathwarp-loud.py said: I was built"), "{said}");
    let (_, said) = s.expect(0, &["check", &file]);
    assert!(said.contains("pathwarp-loud.py said: I was built"), "{said}");
    // A part of a long text is shown.
    let flood = "print(\"x\" * 100_000, file=sys.stderr)\n        self.height = float";
    let file = template(&s, "flood", &[(loud, flood)]);
    let (_, said) = s.expect(0, &["flood", "in.svg", "--plugin", &file, "-o", "out.svg"]);
    assert!(said.contains("said: …xxx") && said.len() < 2000, "{} bytes", said.len());
    // Text on standard output breaks the protocol.
    let file = template(&s, "lost", &[(loud, "print(\"hello\")\n        self.height = float")]);
    let (_, said) = s.expect(3, &["lost", "in.svg", "--plugin", &file, "-o", "out.svg"]);
    assert!(said.contains("`hello") && said.contains("standard error") && said.contains("file=sys.stderr"), "{said}");
}
