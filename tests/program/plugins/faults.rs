//! Plug-ins that fail: each is ended within its limits and named, no file is written, and no process is left.

use crate::support::plugins::{Scratch, entry, script};
use std::fs;
use std::os::unix::fs::PermissionsExt;

/// The seconds that a silent program gets, and the words of its fault. A shell starts in a thousandth of that.
const SILENT: (&str, &str) = ("10", "within 10 seconds");

/// Runs the plug-in `bad` and asserts that the error names it and says `words`.
fn fails(kind: &str, scratch: &Scratch, words: &[&str]) {
    let (_, stderr) = scratch.expect(3, &["bad", "in.svg", "-o", "out.svg"]);
    for word in [&["pathwarp-bad"], words].concat() {
        assert!(stderr.contains(word), "{kind}: `{word}` not in:\n{stderr}");
    }
    assert!(!scratch.file("out.svg").exists(), "{kind}");
}

/// Words of the fault of a program that closes its input. It may do so after a request was written; then it counts as silent at first.
const DEAF: &str = "closed its standard input";

/// A folder for a fault.
fn scratch(words: &[&str]) -> Scratch {
    let mut scratch = Scratch::new();
    if words.contains(&SILENT.1) || words.contains(&DEAF) {
        scratch.seconds = SILENT.0;
    }
    scratch
}

/// Asserts a fault of the script `text` while it is in use.
fn fails_in_use(kind: &str, text: &str, words: &[&str]) {
    let scratch = scratch(words);
    scratch.install("pathwarp-bad", &scratch.holding(text));
    let processes = scratch.listen();
    fails(kind, &scratch, words);
    // The entry is correct, so it is listed.
    let (list, _) = scratch.expect(0, &["list"]);
    assert!(list.contains("bad  ") && !list.contains("Broken"), "{kind}: {list}");
    processes.end(&format!("{kind}: no process is left"));
}

/// Asserts a fault of the script `text` before there is an entry: it is listed as broken.
fn fails_at_start(kind: &str, text: &str, mode: u32, words: &[&str]) {
    let scratch = scratch(words);
    let file = scratch.install("pathwarp-bad", &scratch.holding(text));
    fs::set_permissions(&file, fs::Permissions::from_mode(mode)).unwrap();
    let processes = scratch.listen();
    // A silent program is waited for three times, so all of these wait together.
    let ((list, _), (check, stderr)) = std::thread::scope(|s| {
        let list = s.spawn(|| scratch.expect(0, &["list"]));
        let check = s.spawn(|| scratch.expect(3, &["check", "bad"]));
        fails(kind, &scratch, words);
        (list.join().unwrap(), check.join().unwrap())
    });
    let (_, broken) = list.split_once("Broken plug-ins").unwrap_or_else(|| panic!("{kind}: {list}"));
    for word in words {
        assert!(broken.contains(word), "{kind}: `{word}` not in:\n{list}");
    }
    assert!(check.is_empty() && stderr.contains(words[0]), "{kind}: {check}{stderr}");
    processes.end(&format!("{kind}: no process is left"));
}

/// Returns a script that prints its entry and then runs `commands`.
fn then(commands: &str) -> String {
    format!("#!/bin/sh\necho '{}'\n{commands}\n", entry("bad"))
}

#[test]
fn crashes() {
    fails_in_use("at once", &then("echo 'no such file' >&2; exit 7"), &["exit status: 7", "no such file"]);
    fails_in_use("by a signal", &then("read -r line; kill -SEGV $$"), &["signal: 11"]);
    fails_in_use(
        "mid-batch",
        &script("bad", "echo $line; [ $i -gt 3 ] && kill -9 $$"),
        &["without giving the answer for", "signal: 9"],
    );
    fails_at_start("before its entry", "#!/bin/sh\nexit 3\n", 0o755, &["its entry as JSON", "exit status: 3"]);
}

#[test]
fn hangs() {
    let at_build = then("exec sh -c 'read x; sleep 9999'");
    let at_points = script("bad", "sh -c 'sleep 9999'");
    let before_its_entry = "#!/bin/sh\nsh -c 'sleep 9999'\n";
    // Signals that can be caught make no difference.
    let stubborn = then("trap '' TERM INT HUP; sh -c 'sleep 9999'");
    // All of them wait, so they wait together.
    std::thread::scope(|s| {
        s.spawn(|| fails_in_use("at build", &at_build, &["the answer to `build`", SILENT.1]));
        s.spawn(|| fails_in_use("at points", &at_points, &["points", SILENT.1]));
        s.spawn(|| fails_at_start("before its entry", before_its_entry, 0o755, &["entry as JSON", SILENT.1]));
        s.spawn(|| fails_in_use("stubbornly", &stubborn, &[SILENT.1]));
    });
}

#[test]
fn floods() {
    fails_in_use("in an answer", &script("bad", "yes 1 2"), &["points is followed by `1 2"]);
    fails_in_use("at build", &then("exec yes xyz"), &["bytes where the answer to `build`"]);
    fails_in_use("of errors", &then("read x; exec yes 'oh no' >&2"), &["bytes to standard error", "oh no"]);
    fails_in_use(
        "of errors beside answers",
        &script("bad", "echo $line; head -c 2000000 /dev/zero >&2"),
        &["standard error"],
    );
    fails_at_start("instead of an entry", "#!/bin/sh\necho '{'; exec yes\n", 0o755, &["bytes where its entry"]);
}

#[test]
fn garbage() {
    fails_at_start("no entry", "#!/bin/sh\necho hello\n", 0o755, &["`hello", "its entry as JSON"]);
    fails_at_start("no JSON", "#!/bin/sh\necho '{\"a\": 1,}'\n", 0o755, &["wrong entry", "it is not JSON"]);
    let binary = "#!/bin/sh\nhead -c 300 /dev/urandom | tr '{ \\n\\t\\r' x\nsleep 5\n";
    fails_at_start("binary", binary, 0o755, &["its entry as JSON"]);
    fails_in_use("words for numbers", &script("bad", "echo one two"), &["`one two`", "a line of 2 numbers"]);
    fails_in_use("three numbers", &script("bad", "echo 1 2 3"), &["`1 2 3`", "a line of 2 numbers"]);
    fails_in_use("an answer to build", &then("echo yes; sleep 5"), &["`build`"]);
}

#[test]
fn wrong_entries() {
    let at_start = |kind: &str, entry: &str, words: &[&str]| {
        fails_at_start(kind, &format!("#!/bin/sh\ncat <<'E'\n{entry}\nE\n"), 0o755, words);
    };
    let good = entry("bad");
    at_start("of another version", &good.replace("\"pathwarp-plugin\": 1", "\"pathwarp-plugin\": 3"), &["version 3"]);
    at_start("without a version", "{\"name\": \"bad\"}", &["lacks \"pathwarp-plugin\": 2"]);
    at_start("of another name", &entry("worse"), &["its name is `worse`"]);
    at_start("with an unknown field", &good.replace("\"about\"", "\"colour\": 1, \"about\""), &["colour"]);
    let with_param = |p: &str| good.replace("\"title\"", &format!("\"parameters\": [{p}], \"title\""));
    at_start(
        "with an unknown kind",
        &with_param(r#"{"name": "a", "help": "A.", "kind": "colour"}"#),
        &["`colour`", "kinds are"],
    );
    at_start(
        "with an option's name",
        &with_param(r#"{"name": "tolerance", "help": "A.", "kind": "number"}"#),
        &["`tolerance`"],
    );
    let scratch = Scratch::new();
    scratch.install("pathwarp-wave", &script("wave", "echo $line"));
    let (list, _) = scratch.expect(0, &["list"]);
    assert!(list.contains("has the name of a command, wave"), "{list}");
    // The built-in deformation takes precedence.
    scratch.expect(0, &["wave", "in.svg", "-o", "out.svg", "--height", "3"]);
}

#[test]
fn wrong_counts_and_values() {
    fails_in_use("too many", &script("bad", "echo $line; [ $i = 0 ] && echo 5 5"), &["is followed by"]);
    fails_in_use("too few", &script("bad", "[ $i = 0 ] || echo $line"), &[SILENT.1]);
    fails_in_use("NaN", &script("bad", "echo nan 3"), &["NaN or infinity for the point"]);
    fails_in_use("infinity", &script("bad", "echo 3 inf"), &["NaN or infinity for the point"]);
    fails_in_use("refusal", &script("bad", "echo error no ink left"), &["no ink left"]);
}

#[test]
fn closed_pipes_and_children() {
    fails_in_use("closes its input", &then("exec <&-; exec sh -c 'sleep 9999'"), &[DEAF]);
    fails_in_use("closes its output", &then("exec >&-; exec sh -c 'sleep 9999'"), &["closed its standard output"]);
    let forks = then("sh -c 'sleep 9999' & exit 4");
    fails_in_use("leaves a child that holds the pipes", &forks, &["exit status: 4"]);
}

#[test]
fn never_starts() {
    fails_at_start(
        "not executable",
        &script("bad", "echo $line"),
        0o644,
        &["is not executable; allow it with chmod +x"],
    );
    fails_at_start("no interpreter", "#!/no/such/interpreter\n", 0o755, &["cannot be started"]);
    fails_at_start("no program", "\u{7f}ELF and then nothing", 0o755, &["cannot be started"]);
    let scratch = Scratch::new();
    let (_, stderr) = scratch.expect(3, &["bad", "in.svg", "--plugin", "./nothing.py"]);
    assert!(stderr.contains("nothing.py: is not a file"), "{stderr}");
}

/// A shape or an input that fails because of a plug-in does not count as skipped.
#[test]
fn nothing_is_skipped_for_a_plug_in_that_fails() {
    let scratch = Scratch::new();
    scratch.install("pathwarp-bad", &script("bad", "echo nan nan"));
    let (_, stderr) = scratch.expect(3, &["bad", "in.svg", "-o", "out.svg", "--on-error", "skip"]);
    assert!(stderr.contains("NaN") && !scratch.file("out.svg").exists(), "{stderr}");
    // A plug-in that declares a partial domain may answer NaN.
    let partial = script("bad", "echo nan nan").replace("\"title\"", "\"domain\": \"partial\", \"title\"");
    scratch.install("pathwarp-bad", &partial);
    let (_, stderr) = scratch.expect(1, &["bad", "in.svg", "-o", "out.svg", "--on-error", "skip"]);
    assert!(stderr.contains("is not warped") && stderr.contains("infinity"), "{stderr}");
}
