//! The program as Inkscape calls it, without Inkscape: `--id=…`, the dialog's parameters, and the drawing's file last.

use crate::support::{inkscape_drawing, pathwarp, pathwarp_program};
use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

/// Objects of every kind that can be selected.
const BODY: &str = "<g id='layer' inkscape:groupmode='layer' inkscape:label='Layer 1'>\
    <path id='a' d='M 20,20 H 60 V 60 H 20 Z'/>\
    <path id='b' style='fill:#c03030' d='M 80,20 H 120 V 60 Z'/>\
    <g id='g' transform='translate(10,0)'><rect id='r' x='20' y='80' width='40' height='30'/><circle id='c' cx='90' cy='95' r='12'/></g>\
    <use id='u' xlink:href='#a' transform='translate(110,70)'/>\
    <text id='t' x='20' y='160' style='font-size:30px;font-family:sans-serif'>Warp</text></g>\
    <g id='locked' sodipodi:insensitive='true'><path id='l' d='M 150,150 h 30 v 30 z'/></g>";

/// The beginning of the attributes of a warped object.
const MEMORY: &str = " xmlns:pathwarp=\"";

struct Desk(tempfile::TempDir);

impl Desk {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn file(&self, svg: &str) -> String {
        let file = self.0.path().join("drawing.svg");
        fs::write(&file, svg).unwrap();
        file.display().to_string()
    }

    /// Calls an effect.
    fn call(&self, svg: &str, ids: &[&str], params: &[&str]) -> Output {
        let mut run = Command::new(pathwarp_program());
        run.args(ids.iter().map(|id| format!("--id={id}"))).args(["--tab=settings", "--selected-nodes=a:0:1"]);
        run.args(params).arg(self.file(svg)).env_remove("DOCUMENT_PATH").stdin(Stdio::null());
        run.output().unwrap()
    }

    /// The drawing that a call returns, which must be silent.
    fn result(&self, svg: &str, ids: &[&str], params: &[&str]) -> String {
        let out = self.call(svg, ids, params);
        let said = String::from_utf8_lossy(&out.stderr);
        assert!(out.status.success() && said.is_empty(), "{ids:?} {params:?}: {said}");
        String::from_utf8(out.stdout).unwrap()
    }

    /// The message of a call that fails, which must not return a drawing.
    fn message(&self, svg: &str, ids: &[&str], params: &[&str]) -> String {
        let out = self.call(svg, ids, params);
        assert!(!out.status.success() && out.stdout.is_empty(), "{ids:?} {params:?}");
        let said = String::from_utf8(out.stderr).unwrap();
        assert_eq!(said.matches("error: ").count(), 1, "{said}");
        assert!(!said.contains("drawing.svg") && !said.contains("/tmp/"), "the file is nothing to the user: {said}");
        said
    }

    /// Returns the command line's result for the drawing.
    fn command_line(&self, svg: &str, args: &[&str]) -> String {
        let out = self.0.path().join("out.svg").display().to_string();
        let file = self.file(svg);
        let done = pathwarp(&[&[args[0], &file][..], &args[1..], &["-q", "-o", &out]].concat());
        assert!(done.status.success(), "{args:?}: {}", String::from_utf8_lossy(&done.stderr));
        fs::read_to_string(out).unwrap()
    }
}

/// Returns a drawing without the attributes that its objects remember.
fn forgetful(svg: &str) -> String {
    let mut out = svg.to_owned();
    while let Some(start) = out.find(MEMORY) {
        let source = start + out[start..].find("pathwarp:source=\"").unwrap() + "pathwarp:source=\"".len();
        let end = source + out[source..].find('"').unwrap() + 1;
        out.replace_range(start..end, "");
    }
    out
}

const FLAG: [&str; 4] = ["--inkscape-deformation=warp", "--style=flag", "--bend_percent=40.000", "--strokes=auto"];

#[test]
fn what_is_selected_is_bent_and_nothing_else() {
    let desk = Desk::new();
    let svg = inkscape_drawing(BODY);
    for ids in [&["a"][..], &["b", "a"], &["g"], &["u"], &["t"], &["layer"], &["r", "t"]] {
        let got = desk.result(&svg, ids, &FLAG);
        let select: Vec<String> = ids.iter().map(|id| format!("--select=#{id}")).collect();
        let words: Vec<&str> = ["warp", "--style=flag", "--bend=40%", "--fit=none"]
            .into_iter()
            .chain(select.iter().map(String::as_str))
            .collect();
        assert_eq!(forgetful(&got), desk.command_line(&svg, &words), "{ids:?}");
        assert_eq!(got.matches(MEMORY).count(), ids.len(), "{ids:?}");
    }
    // Without a selection, the page is warped, except locked objects.
    let whole = desk.result(&svg, &[], &FLAG);
    let wanted = desk.command_line(&svg, &["warp", "--style=flag", "--bend=40%", "--fit=none", "--exclude=#locked"]);
    assert_eq!(forgetful(&whole), wanted);
    assert!(whole.contains("d='M 150,150 h 30 v 30 z'"));
}

#[test]
fn failures_are_one_message_and_no_drawing() {
    let desk = Desk::new();
    let svg = inkscape_drawing(BODY);
    let needs = desk.message(&svg, &["t"], &["--inkscape-deformation=bend"]);
    assert!(needs.contains("“Along”") && needs.contains("above it"), "{needs}");
    let pole = desk.message(&svg, &["a"], &["--inkscape-deformation=mobius", "--pole=60,40"]);
    assert!(!pole.contains("--"), "options are named as in the dialog: {pole}");
    desk.message(&svg, &["a"], &["--inkscape-deformation=wobble"]);
    desk.message("<svg", &["a"], &FLAG);
    let none = desk.message(&svg, &[], &["--inkscape-action=release"]);
    assert!(none.contains("nothing is selected"), "{none}");
    assert!(desk.message(&svg, &["a"], &["--inkscape-action=edit"]).contains("not warped"));
    // With warnings on, both messages appear.
    let far = [&["--inkscape-warnings=true", "--bend_percent=900"], &FLAG[..]].concat();
    let out = desk.call(&svg, &["layer"], &far);
    assert!(out.status.success() && out.stdout.starts_with(b"<svg"));
    assert!(String::from_utf8_lossy(&out.stderr).contains("warning: "));
}

#[test]
fn guides_are_the_topmost_paths_or_go_by_their_labels() {
    let desk = Desk::new();
    let cage = "M 20,180 L 30,20 Q 100,60 170,20 L 180,180 Z";
    let art = "<path id='a' d='M 20,20 H 60 V 60 H 20 Z'/><path id='b' d='M 80,20 H 120 V 60 Z'/>";
    let above = inkscape_drawing(&format!("{art}<path id='cage1' style='fill:none' d='{cage}'/>"));
    let below = inkscape_drawing(&format!("<path id='p7' inkscape:label='Cage' style='fill:none' d='{cage}'/>{art}"));
    let shaper = "--inkscape-deformation=shaper";
    let select = ["--select=#a", "--select=#b"];
    let wanted = desk.command_line(&above, &[&["shaper", "--shaper=#cage1"], &select[..]].concat());
    assert_eq!(forgetful(&desk.result(&above, &["cage1", "b", "a"], &[shaper])), wanted, "whatever was selected last");
    assert_eq!(
        forgetful(&desk.result(&above, &["a", "b"], &[shaper, "--shaper=cage1"])),
        wanted,
        "named in the dialog"
    );
    let wanted = desk.command_line(&below, &[&["shaper", "--shaper=#p7"], &select[..]].concat());
    assert_eq!(forgetful(&desk.result(&below, &["a", "b"], &[shaper])), wanted, "labelled, not selected");
    assert_eq!(forgetful(&desk.result(&below, &["b", "p7", "a"], &[shaper])), wanted, "labelled and selected");
    assert_eq!(forgetful(&desk.result(&below, &[], &[shaper])), wanted, "nothing selected");
    assert!(wanted.contains(&format!("d='{cage}'")), "the guide stays");
    // A group around the guide is opened: the guide stays, its neighbours are bent.
    let inside = inkscape_drawing(&format!("<g id='all'>{art}<path id='p7' inkscape:label='shaper' d='{cage}'/></g>"));
    let got = desk.result(&inside, &["all"], &[shaper]);
    assert!(got.contains(&format!("inkscape:label='shaper' d='{cage}'")) && got.matches(MEMORY).count() == 2, "{got}");
    // Two guides.
    let two =
        inkscape_drawing(&format!("{art}<path id='base1' d='M 0,100 H 100'/><path id='target1' d='M 0,120 H 150'/>"));
    let got =
        desk.result(&two, &["a", "base1", "target1"], &["--inkscape-deformation=similitude", "--inkscape-guides=2"]);
    let wanted = ["similitude", "--base=#base1", "--target=#target1", "--select=#a"];
    assert_eq!(forgetful(&got), desk.command_line(&two, &wanted));
}

#[test]
fn warps_are_edited_and_released() {
    let desk = Desk::new();
    let svg = inkscape_drawing(BODY);
    // The clone of a is not warped itself.
    let flag = [&FLAG[..], &["--clones=follow"]].concat();
    let warped = desk.result(&svg, &["a", "t"], &flag);
    let warped = desk.result(&warped, &["g"], &["--inkscape-deformation=swirl", "--angle=70.0"]);
    // Change the settings of one of the objects that were warped together.
    let edited = desk.result(&warped, &["a"], &["--inkscape-action=edit", "--inkscape-changes=bend=-20%\nstyle=arc"]);
    let frame = frame_of(&warped, "a");
    let line = ["warp", "--style=arc", "--bend=-20%", "--select=#a", &frame];
    let direct = desk.command_line(&svg, &line);
    assert_eq!(element(&forgetful(&edited), "a"), element(&direct, "a"));
    assert_eq!(element(&edited, "t"), element(&warped, "t"));
    // Unchanged settings give an unchanged drawing.
    assert_eq!(desk.result(&warped, &["a", "t"], &["--inkscape-action=edit"]), warped);
    // In the dialog, another bend replaces the first one; so does another deformation if the user says so.
    let twice = desk.result(&warped, &["a"], &["--inkscape-deformation=warp", "--style=arc", "--bend_percent=-20"]);
    let alone = desk.command_line(&svg, &["warp", "--style=arc", "--bend=-20%", "--select=#a"]);
    assert_eq!(element(&forgetful(&twice), "a"), element(&alone, "a"));
    // Sources come back one by one, to the byte.
    let back = desk.result(&edited, &["t"], &["--inkscape-action=release"]);
    assert_eq!(element(&back, "t"), element(&svg, "t"));
    assert_eq!(element(&back, "a"), element(&edited, "a"));
    let back = desk.result(&edited, &["layer"], &["--inkscape-action=release"]);
    assert_eq!(back, svg, "all that a group holds");
    // A warp of a warp.
    let more = desk.result(&warped, &["a"], &["--inkscape-deformation=swirl", "--angle=70.0", "--clones=follow"]);
    assert_eq!(desk.result(&more, &["a"], &["--inkscape-action=release"]), warped);
    // Settings as text, and a wrong name.
    let out = desk.call(&warped, &["a"], &["--inkscape-action=edit", "--inkscape-show=true"]);
    let said = String::from_utf8(out.stderr).unwrap();
    assert!(out.stdout.is_empty() && said.contains("a (warp):\nstyle=flag\nbend=40%\nclones=follow\nframe="), "{said}");
    let wrong = desk.message(&warped, &["a"], &["--inkscape-action=edit", "--inkscape-changes=bnd=3"]);
    assert!(wrong.contains("has no `bnd`") && wrong.contains("bend"), "{wrong}");
}

/// Each step of a recipe applies to its part of the selection, and to nothing outside.
#[test]
fn steps_for_parts_stay_within_the_selection() {
    let desk = Desk::new();
    let body = "<g id='one'><path id='a' class='x' d='M 20,20 H 60 V 60 H 20 Z'/><path id='b' class='y' d='M 80,20 H 120 V 60 Z'/></g>\
                <g id='two'><path id='c' class='x' d='M 20,120 H 60 V 160 Z'/><path id='d' class='y' d='M 80,120 H 120 V 160 Z'/></g>";
    let svg = inkscape_drawing(body);
    let warped = desk.result(&svg, &["one"], &FLAG);
    let own = attribute(&element(&warped, "one"), "recipe");
    let frame = frame_of(&warped, "one");
    let edited = |recipe: &str| {
        let asked = warped.replace(&own, recipe);
        assert_ne!(asked, warped);
        desk.result(&asked, &["one"], &["--inkscape-action=edit"])
    };
    for (recipe, line) in [
        (
            format!("warp --style=flag --select=.x {frame} + swirl --select=.y"),
            vec!["warp", "--style=flag", "--select=#a", "+", "swirl", "--select=#b"],
        ),
        // A selection in one part applies to all of them.
        (
            format!("warp --style=flag {frame} + swirl --select=.y"),
            vec!["warp", "--style=flag", "--select=#b", "+", "swirl"],
        ),
        (format!("warp --style=flag {frame} + swirl"), vec!["warp", "--style=flag", "--select=#one", "+", "swirl"]),
    ] {
        let got = edited(&recipe);
        let wanted = desk.command_line(&svg, &[&line[..], &["--fit=none", &frame]].concat());
        for id in ["a", "b", "c", "d"] {
            assert_eq!(attribute(&element(&got, id), "d"), attribute(&element(&wanted, id), "d"), "{recipe}: {id}");
        }
    }
}

#[test]
fn what_was_done_by_hand_is_kept_or_asked_about() {
    let desk = Desk::new();
    let svg = inkscape_drawing(BODY);
    let warped = desk.result(&svg, &["a"], &FLAG);
    let again = ["--inkscape-action=edit", "--inkscape-changes=bend=60%"];
    let plain = element(&desk.result(&warped, &["a"], &again), "a");
    // The object was moved with a transform; the new bend is applied at its new position.
    let moved = warped.replace(" id='a'", " transform='translate(7,-3)' id='a'");
    let edited = desk.result(&moved, &["a"], &again);
    assert_eq!(attribute(&element(&edited, "a"), "d"), attribute(&plain, "d"));
    assert!(element(&edited, "a").contains("transform=\"matrix(1 0 0 1 7 -3)\""), "{}", element(&edited, "a"));
    assert_eq!(attribute(&element(&desk.result(&edited, &["a"], &again), "a"), "transform"), "matrix(1 0 0 1 7 -3)");
    // A node was moved, which would be lost.
    let d = attribute(&element(&warped, "a"), "d");
    let number: String = d[1..].chars().take_while(|c| c.is_ascii_digit() || *c == '.').collect();
    let bent = warped.replace(&d, &d.replacen(&number, "3", 1));
    assert!(desk.message(&bent, &["a"], &again).contains("by hand"));
    let given_up = desk.result(&bent, &["a"], &[&again[..], &["--inkscape-discard=true"]].concat());
    assert_eq!(element(&given_up, "a"), plain);
}

/// A drawing may come from anybody, and so may its recipes.
#[test]
fn recipes_in_drawings_write_no_files() {
    let desk = Desk::new();
    let warped = desk.result(&inkscape_drawing(BODY), &["a"], &FLAG);
    let own = attribute(&element(&warped, "a"), "recipe");
    let out = desk.0.path().join("evil.svg").display().to_string();
    for recipe in [
        format!("warp --out={out}"),
        format!("warp --report={out}"),
        format!("ffd --save-lattice={out}"),
        format!("convert --out={out}"),
        format!("warp {out}"),
        "warp --style=/dev/zero.toml".to_owned(),
        "mesh --mesh=/dev/zero".to_owned(),
        "warp + install".to_owned(),
    ] {
        let evil = warped.replace(&own, &recipe);
        desk.message(&evil, &["a"], &["--inkscape-action=edit"]);
        desk.message(&evil, &["a"], &["--inkscape-action=edit", "--inkscape-discard=true"]);
        assert!(!Path::new(&out).exists(), "{recipe}");
    }
}

#[test]
fn artwork_follows_its_guide() {
    let desk = Desk::new();
    let cage =
        |dx: u32| format!("<path id='k' style='fill:none' d='M {},180 L 30,20 Q 100,60 170,20 L 180,180 Z'/>", 20 + dx);
    let art = "<path id='a' d='M 20,20 H 60 V 60 H 20 Z'/>";
    let svg = inkscape_drawing(&format!("{art}{}", cage(0)));
    let warped = desk.result(&svg, &["a", "k"], &["--inkscape-deformation=shaper"]);
    let moved = desk.result(&warped.replace(&cage(0), &cage(25)), &["a"], &["--inkscape-action=edit"]);
    let wanted = desk.command_line(&inkscape_drawing(&format!("{art}{}", cage(25))), &["shaper", "--shaper=#k"]);
    assert_eq!(attribute(&element(&moved, "a"), "d"), attribute(&element(&wanted, "a"), "d"));
    // The guide is gone, but the object has a copy of it.
    let without = warped.replace(&cage(0), "");
    let edited = desk.result(&without, &["a"], &["--inkscape-action=edit", "--inkscape-changes=reverse-shaper=true"]);
    let wanted = desk.command_line(&svg, &["shaper", "--shaper=#k", "--reverse-shaper"]);
    assert_eq!(attribute(&element(&edited, "a"), "d"), attribute(&element(&wanted, "a"), "d"));
    let again = desk.result(&edited, &["a"], &["--inkscape-action=edit", "--inkscape-changes=reverse-shaper="]);
    assert_eq!(attribute(&element(&again, "a"), "d"), attribute(&element(&warped, "a"), "d"));
}

#[test]
fn clones_follow_and_pages_stay_with_the_artwork() {
    let desk = Desk::new();
    let svg = inkscape_drawing(BODY);
    let follow = desk.result(&svg, &["a"], &[&FLAG[..], &["--clones=follow"]].concat());
    assert!(follow.contains("<use id='u' xlink:href='#a' transform='translate(110,70)'/>"), "{follow}");
    let copied = desk.result(&svg, &["a"], &[&FLAG[..], &["--clones=copy"]].concat());
    assert!(!copied.contains("<use "), "{copied}");
    assert!(element(&copied, "u").starts_with("<g id='u'"), "a copy: {}", element(&copied, "u"));

    let view = "<sodipodi:namedview id='v'><inkscape:page x='0' y='0' width='200' height='200' id='p1'/><inkscape:page \
                x='210' y='0' width='100' height='200' id='p2'/><sodipodi:guide position='30,40' orientation='0,1' id='h'/></sodipodi:namedview>";
    let move_left =
        ["--inkscape-deformation=affine", "--move-x=-50", "--move-x_unit=user", "--move-y=25", "--fit=grow"];
    let body = "<rect id='r' x='0' y='100' width='200' height='100'/>";
    let got = desk.result(&inkscape_drawing(&format!("{view}{body}")), &["r"], &move_left);
    // The artwork now covers x from -50 and y to 225.
    assert!(got.contains("viewBox='-50 0 250 225'"), "{got}");
    assert!(got.contains("<inkscape:page x='0' y='0' width='250' height='225' id='p1'/>"), "{got}");
    assert!(got.contains("x='260' y='0' width='100' height='200' id='p2'"), "{got}");
    assert!(got.contains("position='80,65'"), "{got}");
    // Without the option, which is the default, the page stays.
    let got = desk.result(&inkscape_drawing(&format!("{view}{body}")), &["r"], &move_left[..4]);
    assert!(got.contains("viewBox='0 0 200 200'") && !got.contains("--fit"), "{got}");
}

#[test]
fn installing_and_removing() {
    let desk = Desk::new();
    let folder = desk.0.path().join("extensions");
    let at = folder.display().to_string();
    let home = folder.join("pathwarp");
    let names = |home: &Path| {
        let entries = fs::read_dir(home).into_iter().flatten();
        entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect::<Vec<_>>()
    };
    let run = |args: &[&str]| {
        let out = pathwarp(&[&["install", "inkscape", "--folder", &at][..], args].concat());
        assert!(out.status.success(), "{args:?}: {}", String::from_utf8_lossy(&out.stderr));
        String::from_utf8(out.stdout).unwrap()
    };
    assert!(run(&["--dry-run"]).lines().all(|l| l.starts_with("would write")));
    assert!(!folder.exists());
    run(&["--program", "pathwarp"]);
    let all = names(&home);
    assert!(all.iter().all(|n| n.ends_with(".inx")) && all.len() > 20, "{all:?}");
    let warp = fs::read_to_string(home.join("pathwarp-warp.inx")).unwrap();
    assert!(warp.contains("<command location=\"path\">pathwarp</command>"));
    run(&[]);
    let program = home.join("pathwarp").with_extension(std::env::consts::EXE_EXTENSION);
    let version = Command::new(&program).arg("--version").output().unwrap();
    assert!(version.status.success(), "the copy runs");
    fs::write(home.join("own.txt"), "mine").unwrap();
    run(&["--remove"]);
    assert_eq!(names(&home), ["own.txt"]);
}

/// The option with the frame that an object remembers.
fn frame_of(svg: &str, id: &str) -> String {
    let recipe = attribute(&element(svg, id), "recipe");
    recipe.split(' ').find(|w| w.starts_with("--frame=")).unwrap().to_owned()
}

/// Returns the text of the element with an id. The drawings here hold no two elements of a name inside one another.
fn element(svg: &str, id: &str) -> String {
    let at = svg.find(&format!(" id='{id}'")).unwrap_or_else(|| panic!("no {id}: {svg}"));
    let start = svg[..at].rfind('<').unwrap();
    let name: String = svg[start + 1..].chars().take_while(|c| c.is_alphanumeric()).collect();
    let rest = &svg[start..];
    let open = rest.find('>').unwrap() + 1;
    let end = if rest[..open].ends_with("/>") {
        open
    } else {
        let close = format!("</{name}>");
        open + rest[open..].find(&close).unwrap() + close.len()
    };
    rest[..end].to_owned()
}

/// The value of an attribute.
fn attribute(element: &str, name: &str) -> String {
    for quote in ['"', '\''] {
        for lead in [' ', ':'] {
            let key = format!("{lead}{name}={quote}");
            if let Some(at) = element.find(&key) {
                let rest = &element[at + key.len()..];
                return rest[..rest.find(quote).unwrap()].to_owned();
            }
        }
    }
    panic!("no {name}: {element}")
}
