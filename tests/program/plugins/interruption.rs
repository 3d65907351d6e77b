//! Programs end with the run, however it ends.

use crate::support::plugins::{Scratch, entry, is_running, text};
use rustix::process::{Pid, Signal, kill_process};
use std::process::Stdio;
use std::time::{Duration, Instant};

/// A plug-in that never answers, with a child of its own.
fn hanging(mark: &str) -> String {
    format!("#!/bin/sh\necho '{}'\nsh -c 'sleep 1000; : {mark}' &\nexec sh -c 'sleep 1000; : {mark}'\n", entry("slow"))
}

fn wait_until(what: &str, is: impl Fn() -> bool) {
    let started = Instant::now();
    while !is() {
        assert!(started.elapsed() < Duration::from_secs(300), "{what}");
        std::thread::sleep(Duration::from_millis(5));
    }
}

#[test]
fn ctrl_c_ends_them() {
    for signal in [Signal::INT, Signal::TERM] {
        let scratch = Scratch::new();
        let mark = scratch.dir.path().display().to_string();
        scratch.install("pathwarp-slow", &hanging(&mark));
        scratch.expect(0, &["list"]);
        let sleeping = format!(": {mark}");
        wait_until("the program of the list ends", || !is_running(&sleeping));
        let mut command = scratch.command(&["slow", "in.svg", "-o", "out.svg"]);
        command.env("PATHWARP_PLUGIN_SECONDS", "1000").stderr(Stdio::piped());
        let child = command.spawn().unwrap();
        wait_until("the program starts", || is_running(&sleeping));
        std::thread::sleep(Duration::from_millis(100));
        kill_process(Pid::from_child(&child), signal).unwrap();
        let out = child.wait_with_output().unwrap();
        assert_eq!(out.status.code(), Some(130), "{}", text(&out.stderr));
        wait_until("no process is left", || !is_running(&sleeping));
    }
}

/// The thread that watches the memory ends the process without unwinding.
#[test]
fn a_limit_ends_them() {
    let scratch = Scratch::new();
    let mark = scratch.dir.path().display().to_string();
    scratch.install("pathwarp-slow", &hanging(&mark));
    let mut command = scratch.command(&["slow", "in.svg", "-o", "out.svg", "--limit", "memory=1e6"]);
    let out = command.env("PATHWARP_PLUGIN_SECONDS", "1000").output().unwrap();
    assert_eq!(out.status.code(), Some(3), "{}", text(&out.stderr));
    assert!(text(&out.stderr).contains("memory"), "{}", text(&out.stderr));
    wait_until("no process is left", || !is_running(&format!(": {mark}")));
}
