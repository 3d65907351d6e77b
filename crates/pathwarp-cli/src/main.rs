//! The `pathwarp` program.

fn main() -> std::process::ExitCode {
    pathwarp_cli::main_with(pathwarp::deform::Registry::builtin())
}
