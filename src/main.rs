//! The command line program.

use std::process::ExitCode;

use skylight::cli::{self, CliExit};
use skylight::commands;
use skylight::error::Result;
use skylight::output::print;

fn main() -> ExitCode {
    let command = match cli::parse(std::env::args_os()) {
        Ok(command) => command,
        Err(exit) => {
            match &exit {
                CliExit::Help(text) => return ended(print(text)),
                CliExit::Usage(line) => eprintln!("error: {line}"),
            }
            return exit.code().into();
        }
    };
    ended(commands::run(command))
}

fn ended(result: Result<()>) -> ExitCode {
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            error.exit_code().into()
        }
    }
}
