//! The command line program.

use std::process::ExitCode;

use skylight::cli::{self, CliExit};
use skylight::commands;
use skylight::error::Result;
use skylight::output::{message, print};

fn main() -> ExitCode {
    cli::colour(std::env::args_os()).write_global();
    let command = match cli::parse(std::env::args_os()) {
        Ok(command) => command,
        Err(exit) => {
            match &exit {
                CliExit::Help(text) => return ended(print(text)),
                CliExit::Usage(line) => message::error(line),
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
            message::error(&error);
            error.exit_code().into()
        }
    }
}
