//! What a package has beside the program: man pages, completions of shells, and the licences of all crates that are in it.
//!
//! `cargo run --example make_package -- FOLDER [TARGET]` writes
//!
//! - `man/man1/*.1` and `completions/` from the definition of the command line,
//! - `THIRD-PARTY.txt` from `cargo metadata`: every crate that the program is linked from, its licence, and the texts that it comes with.
//!
//! The files have no dates and are the same each time. `scripts/release` runs it.

mod licences;

use std::fs;
use std::path::Path;

use clap_complete::Shell;
use skylight::cli;

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

fn main() -> Result<()> {
    let mut words = std::env::args().skip(1);
    let folder = words.next().ok_or("give the folder to write to")?;
    let target = words
        .next()
        .unwrap_or("x86_64-unknown-linux-gnu".to_owned());
    let folder = Path::new(&folder);
    manual(&folder.join("man/man1"))?;
    completions(&folder.join("completions"))?;
    let (text, crates) = licences::collected(&target)?;
    fs::write(folder.join("THIRD-PARTY.txt"), text)?;
    println!("{crates} crates in THIRD-PARTY.txt");
    Ok(())
}

/// A page of the program and one of each command.
fn manual(folder: &Path) -> Result<()> {
    fs::create_dir_all(folder)?;
    clap_mangen::generate_to(cli::definition().disable_help_subcommand(true), folder)?;
    Ok(())
}

fn completions(folder: &Path) -> Result<()> {
    fs::create_dir_all(folder)?;
    for shell in [Shell::Bash, Shell::Fish, Shell::Zsh] {
        clap_complete::generate_to(shell, &mut cli::definition(), "skylight", folder)?;
    }
    Ok(())
}
