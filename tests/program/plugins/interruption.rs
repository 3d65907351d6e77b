//! Programs end with the run, however it ends.

use crate::support::events::awaited;
use crate::support::plugins::{Scratch, entry, text};
use rustix::process::{Pid, Signal, kill_process};
use std::process::Stdio;

/// Installs a plug-in that never answers, with a child process. It writes a line to the pipe that both hold.
fn install_hanging(scratch: &Scratch) {
    let script =
        format!("#!/bin/sh\necho '{}'\necho begun >&9\nsh -c 'sleep 9999' &\nexec sh -c 'sleep 9999'\n", entry("slow"));
    scratch.install("pathwarp-slow", &scratch.holding(&script));
}

#[test]
fn ctrl_c_ends_them() {
    for signal in [Signal::INT, Signal::TERM] {
        let scratch = Scratch::new();
        install_hanging(&scratch);
        let listed = scratch.listen();
        scratch.expect(0, &["list"]);
        listed.end("the program of the list ends");
        let asked = scratch.listen();
        let mut command = scratch.command(&["slow", "in.svg", "-o", "out.svg"]);
        let child = command.stderr(Stdio::piped()).spawn().unwrap();
        let asked = asked.line("the program starts");
        kill_process(Pid::from_child(&child), signal).unwrap();
        let out = awaited("the run ends", move || child.wait_with_output()).unwrap();
        assert_eq!(out.status.code(), Some(130), "{}", text(&out.stderr));
        asked.end("no process is left");
    }
}

/// The thread that watches the memory ends the process without unwinding.
#[test]
fn a_limit_ends_them() {
    let scratch = Scratch::new();
    install_hanging(&scratch);
    let asked = scratch.listen();
    let (_, said) = scratch.expect(3, &["slow", "in.svg", "-o", "out.svg", "--limit", "memory=1e6"]);
    assert!(said.contains("memory"), "{said}");
    asked.end("no process is left");
}
