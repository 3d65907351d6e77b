//! Output of the program to a terminal.

use crate::support::pathwarp_program;
use std::fs;
use std::process::Command;

/// On a terminal, a picture is refused. A Python program simulates the terminal.
#[test]
fn pictures_do_not_go_to_a_terminal() {
    let dir = tempfile::tempdir().unwrap();
    let square = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'><path d='M0,0H100V100H0Z'/></svg>";
    fs::write(dir.path().join("a.svg"), square).unwrap();
    let play = "import pty, sys; sys.exit(pty.spawn(sys.argv[1:]) >> 8)";
    let program = pathwarp_program().display().to_string();
    let on_a_terminal = |args: &[&str]| {
        let run = Command::new("python3").args(["-c", play, &program]).args(args).current_dir(dir.path()).output();
        run.ok().map(|out| (out.status.code(), String::from_utf8_lossy(&out.stdout).into_owned()))
    };
    for (args, part) in [
        (&["render", "a.svg"][..], "-o"),
        (&["render", "a.svg", "--format", "jpg"], "-o"),
        (&["warp"], "no drawing is named"),
    ] {
        let Some((code, said)) = on_a_terminal(args) else {
            return crate::support::skipped("terminals: there is no python3");
        };
        assert_eq!(code, Some(2), "{args:?}: {said}");
        assert!(said.contains(part) && said.lines().count() == 1, "{args:?}: {said}");
    }
    // Text may go to a terminal.
    let (code, said) = on_a_terminal(&["warp", "a.svg"]).unwrap();
    assert!(code == Some(0) && said.contains("</svg>"), "{said}");
}
