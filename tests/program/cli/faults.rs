//! Faults during a batch: a killed process, a full disk, a read-only folder, inputs that vanish. Every named output is whole or absent,
//! and the next run removes temporary files.
//!
//! `PATHWARP_FAULTS=200 cargo test --test program cli::faults` tries more moments.
#![cfg(unix)]

use super::common::{files_below, text};
use crate::support::events::Pipe;
use crate::support::{pathwarp_in, pathwarp_program, sample, start_in};
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::Write as _;
use std::path::Path;
use std::process::{Child, Command};

/// Number of batches that are disturbed, each at a different moment, unless the environment asks for more.
const MOMENTS: u32 = 12;
/// Inputs of a batch.
const FILES: usize = 16;

const BATCH: [&str; 9] =
    ["warp", "--style", "flag", "--out-dir", "out", "--preview", "out/{stem}.png", "--report", "out/r.json"];

/// Returns the arguments of the batch. The inputs are named, since a pipe among them is not found in a folder.
fn batch() -> Vec<String> {
    BATCH.iter().map(|w| (*w).to_owned()).chain((0..FILES).map(|i| format!("art/{i:03}.svg"))).collect()
}

fn run_batch(folder: &Path) -> std::process::Output {
    pathwarp_in(folder, &batch().iter().map(String::as_str).collect::<Vec<_>>(), b"")
}

fn moments() -> u32 {
    std::env::var("PATHWARP_FAULTS").ok().and_then(|n| n.parse().ok()).unwrap_or(MOMENTS)
}

fn artwork(folder: &Path) {
    let _ = fs::remove_dir_all(folder.join("art"));
    fs::create_dir(folder.join("art")).unwrap();
    for i in 0..FILES {
        fs::copy(sample("logo.svg"), folder.join(format!("art/{i:03}.svg"))).unwrap();
    }
}

/// The files of an undisturbed batch.
fn undisturbed(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let out = run_batch(folder);
    assert!(out.status.success(), "{}", text(&out.stderr));
    let all = contents(&folder.join("out"));
    assert_eq!(all.len(), 2 * FILES + 1);
    fs::remove_dir_all(folder.join("out")).unwrap();
    all
}

/// Starts a batch, and waits until it reads one of its inputs, which is a pipe. The golden ratio spreads these evenly over the inputs after
/// the first, which is finished before the others are begun.
fn start_up_to(moment: u32, folder: &Path) -> (Child, File) {
    let part = (f64::from(moment) * 0.618_033_988_749_895).fract();
    let input = folder.join(format!("art/{:03}.svg", 1 + ((FILES - 1) as f64 * part) as usize));
    fs::remove_file(&input).unwrap();
    let pipe = Pipe::new(input);
    let child = start_in(folder, &batch().iter().map(String::as_str).collect::<Vec<_>>());
    let open = pipe.is_read("the batch comes to the pipe");
    (child, open)
}

/// Lets a batch continue that waits for an input.
fn go_on(mut pipe: File) {
    // A batch that has ended breaks the pipe.
    let _ = pipe.write_all(&fs::read(sample("logo.svg")).unwrap());
}

fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let files = if folder.exists() { files_below(folder) } else { Vec::new() };
    files.into_iter().map(|f| (f.clone(), fs::read(folder.join(f)).unwrap())).collect()
}

/// Returns `true` if a file is whole. Reports contain times and failures, so they need only parse.
fn is_whole(name: &str, bytes: &[u8], whole: &BTreeMap<String, Vec<u8>>) -> bool {
    match name {
        "r.json" => serde_json::from_slice::<serde_json::Value>(bytes).is_ok(),
        _ => whole.get(name).is_some_and(|all| all == bytes),
    }
}

/// Asserts that every file under its final name is whole. Returns the numbers of such files and of temporary ones.
fn assert_whole(folder: &Path, whole: &BTreeMap<String, Vec<u8>>, when: &str) -> (usize, usize) {
    let (temporary, named): (Vec<_>, Vec<_>) =
        contents(&folder.join("out")).into_iter().partition(|(name, _)| name.starts_with(".pathwarp-"));
    for (name, bytes) in &named {
        assert!(is_whole(name, bytes, whole), "{when}: {name} is not whole");
    }
    (named.len(), temporary.len())
}

#[test]
fn killed_batches_leave_whole_files() {
    let dir = tempfile::tempdir().unwrap();
    artwork(dir.path());
    let whole = undisturbed(dir.path());
    let (mut some, mut left_over) = (0, 0);
    for moment in 0..moments() {
        let signal = ["KILL", "TERM", "INT"][moment as usize % 3];
        let (mut child, pipe) = start_up_to(moment, dir.path());
        // Every second batch is killed where it waits, the others somewhere later.
        let waiting = if moment % 2 == 0 {
            Some(pipe)
        } else {
            go_on(pipe);
            None
        };
        let _ = Command::new("kill").args([format!("-{signal}"), child.id().to_string()]).status();
        child.wait().unwrap();
        drop(waiting);
        artwork(dir.path());
        let (named, temporary) = assert_whole(dir.path(), &whole, &format!("{signal} at moment {moment}"));
        some += usize::from(named > 0 && named < whole.len());
        left_over += temporary;
        assert!(signal == "KILL" || temporary == 0, "{signal} leaves temporary files");
        if moment % 4 < 2 {
            // The next run cleans up and succeeds as if nothing had happened.
            let out = run_batch(dir.path());
            assert!(out.status.success(), "{}", text(&out.stderr));
            let after = assert_whole(dir.path(), &whole, &format!("after {signal} at moment {moment}"));
            assert_eq!(after, (whole.len(), 0), "after {signal} at moment {moment}");
        }
        let _ = fs::remove_dir_all(dir.path().join("out"));
    }
    assert!(some > 0, "no moment was in the middle of a batch");
    println!("{some} batches were cut in the middle; {left_over} temporary files were left and removed");
}

#[test]
fn inputs_may_vanish() {
    let dir = tempfile::tempdir().unwrap();
    artwork(dir.path());
    let whole = undisturbed(dir.path());
    for moment in 0..moments().div_ceil(4) {
        artwork(dir.path());
        let (child, pipe) = start_up_to(moment, dir.path());
        for i in (0..FILES).filter(|i| i % 3 == moment as usize % 3) {
            let _ = fs::remove_file(dir.path().join(format!("art/{i:03}.svg")));
        }
        go_on(pipe);
        let end = child.wait_with_output().unwrap();
        assert!(matches!(end.status.code(), Some(0 | 1)), "{}", text(&end.stderr));
        let (_, temporary) = assert_whole(dir.path(), &whole, "vanished inputs");
        assert_eq!(temporary, 0);
        let _ = fs::remove_dir_all(dir.path().join("out"));
    }
}

/// A file-size limit makes writes fail in the middle, as a full disk does.
#[test]
fn a_write_that_fails_leaves_nothing_of_its_file() {
    let dir = tempfile::tempdir().unwrap();
    artwork(dir.path());
    let whole = undisturbed(dir.path());
    // In blocks of 512 bytes (POSIX sh).
    for blocks in [0, 1, 3, 6, 40] {
        let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$@\"");
        let end = Command::new("sh")
            .args(["-c", &script, "sh"])
            .arg(pathwarp_program())
            .args(batch())
            .current_dir(dir.path())
            .output();
        let end = end.unwrap();
        let said = text(&end.stderr);
        assert!(matches!(end.status.code(), Some(1 | 5)), "{blocks}: {:?} {said}", end.status);
        assert!(said.contains("cannot be written"), "{blocks}: {said}");
        let (_, temporary) = assert_whole(dir.path(), &whole, &format!("{blocks} blocks"));
        assert_eq!(temporary, 0, "{blocks}");
        let _ = fs::remove_dir_all(dir.path().join("out"));
    }
}

/// A tiny file system that fills up, and then one that is read-only. Needs user namespaces.
#[test]
fn full_and_read_only_file_systems() {
    let dir = tempfile::tempdir().unwrap();
    artwork(dir.path());
    let whole = undisturbed(dir.path());
    fs::create_dir_all(dir.path().join("out")).unwrap();
    fs::create_dir_all(dir.path().join("copy")).unwrap();
    // Only this process sees the mount, so its files are copied out.
    let script = "mount -t tmpfs -o size=48k none out || exit 77; \"$@\"; code=$?; cp -a out/. copy/; \
                  mount -o remount,ro none out || exit 77; \"$@\" 2>ro; echo $? $code; exit 0";
    let unshared = Command::new("unshare")
        .args(["--user", "--map-root-user", "--mount", "sh", "-c", script, "sh"])
        .arg(pathwarp_program())
        .args(batch())
        .current_dir(dir.path())
        .output();
    let Some(end) = unshared.ok().filter(|o| o.status.success()) else {
        crate::support::skipped("a full disk is not tested without user namespaces");
        return;
    };
    assert_eq!(text(&end.stdout).lines().last(), Some("5 1"), "{} {}", text(&end.stdout), text(&end.stderr));
    assert!(text(&end.stderr).contains("cannot be written"), "{}", text(&end.stderr));
    assert!(fs::read_to_string(dir.path().join("ro")).unwrap().contains("cannot be written"));
    fs::remove_dir(dir.path().join("out")).unwrap();
    fs::rename(dir.path().join("copy"), dir.path().join("out")).unwrap();
    let (named, temporary) = assert_whole(dir.path(), &whole, "a full file system");
    assert!(named > 0 && named < whole.len() && temporary == 0, "{named} {temporary}");
}
