//! The command line program.

use std::process::ExitCode;

use skylight::cli::{self, CliExit};
use skylight::faces;

fn main() -> ExitCode {
    let command = match cli::parse(std::env::args_os()) {
        Ok(command) => command,
        Err(exit) => {
            match &exit {
                CliExit::Help(text) => print!("{text}"),
                CliExit::Usage(line) => eprintln!("error: {line}"),
            }
            return exit.code().into();
        }
    };
    match faces::run(command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            error.exit_code().into()
        }
    }
}
