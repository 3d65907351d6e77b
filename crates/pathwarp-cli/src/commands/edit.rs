//! `pathwarp edit FILE`: bends a drawing by hand in the browser.

use crate::arguments;
use crate::commands::args::{file_arg, given_file, option, out_arg, switch, target};
use crate::ending::Status;
use crate::plugins::Plugins;
use crate::{interruption, terminal};
use clap::{ArgMatches, Command, value_parser};
use pathwarp::deform::Registry;
use pathwarp_editor::{EngineHost, News, Options, Purpose};
use pathwarp_engine::failure::Failure;
use pathwarp_engine::options::Given;
use pathwarp_engine::{input, output};
use std::sync::Arc;

pub(super) fn edit_command() -> Command {
    Command::new("edit")
        .about("Bend a drawing by hand in the browser, and see it while you drag")
        .arg(file_arg("FILE", "An SVG file, a picture (PNG, JPEG, WebP), or a result of this command, to go on with it"))
        .arg(out_arg("OUT", "Save to this file; without it, the page offers a name beside the drawing"))
        .arg(
            option("port", "N", "Listen on this port of 127.0.0.1 [default: that of the last run on the drawing, or a free one]")
                .value_parser(value_parser!(u16).range(1..)),
        )
        .arg(switch("no-open", "Only print the page's address"))
        .args(arguments::reading_args())
        .after_help(
            "The first line on standard output is the address of the page. Only this computer can open it, and only with the token \
             in the address. The program ends when the page is closed, or with Ctrl-C. Steps that are not saved yet are kept in \
             your folder for state ($XDG_STATE_HOME, %LOCALAPPDATA%) and are there again next time, and a page that is still \
             open goes on.\n\nExamples:\n  pathwarp edit logo.svg\n  pathwarp edit \
             logo.svg -o flag.svg   # Save writes flag.svg\n  pathwarp edit flag.svg         # goes on: the source and the steps are in \
             the file\n  pathwarp edit logo.svg --no-open --port 8000",
        )
}

pub(super) fn edit(registry: &Registry, plugins: &Plugins, m: &ArgMatches) -> Result<Status, Failure> {
    /// Size in bytes up to which files open without noticeable delay.
    const SMALL: u64 = 2 << 20;
    let file = given_file(m, "FILE")?;
    if output::is_stdout(file) {
        return Err(Failure::usage("edit needs a file: its results are saved beside it"));
    }
    let size = file.metadata().map_err(|e| Failure::file(file, input::unreadable(file, &e)))?.len();
    if size > SMALL {
        terminal::note(&format!("opening {}, {} MB; its page comes up in some seconds", file.display(), size >> 20));
    }
    let options = Options {
        file: file.to_owned(),
        purpose: Purpose::Files { out: target(m, [file])?.map(ToOwned::to_owned) },
        port: m.get_one::<u16>("port").copied(),
        open: !m.get_flag("no-open"),
    };
    // Ctrl-C is the usual end of this command.
    interruption::end_quietly();
    let host = EngineHost::new(registry.clone(), Given::default(), arguments::given(m));
    let host = Arc::new(host.with_plugins(plugins.options()));
    let announce = |news: &News<'_>| match news {
        News::Address(address) => drop(output::to_stdout(format!("{address}\n").as_bytes())),
        News::NoBrowser(e) => terminal::warning(&format!("no browser can be started ({e}); open the address in one")),
    };
    pathwarp_editor::serve(host, &options, announce).map_err(Failure::Input)?;
    Ok(Status::Complete)
}
