//! The user's file of defaults: where it is, and what of it a command takes.

use std::path::PathBuf;

use crate::cli::Command;
use crate::error::{Error, Result};
use crate::options::{OptionValues, OptionsError, read_config};
use crate::output::print;

/// Name of the environment variable that does the same as `--config`.
const VARIABLE: &str = "SKYLIGHT_CONFIG";
/// The word for no file.
const NONE: &str = "none";

/// The command with the user's defaults below its options.
///
/// # Errors
/// A file that was asked for and is not there, or one that is damaged: the line and the remedy.
pub fn applied(mut command: Command) -> Result<Command> {
    let Some(options) = command.options_mut() else {
        return Ok(command);
    };
    if let Some((file, is_asked)) = file_of(options.get("config"))
        && let Some(defaults) = read(&file, is_asked)?
    {
        let mut own = std::mem::take(options).with_defaults(defaults);
        // What a picture records is complete without the file.
        own.set("config", NONE);
        *options = own;
    }
    Ok(command)
}

/// The file, and whether it was asked for by name; `None` for none.
fn file_of(option: Option<&str>) -> Option<(PathBuf, bool)> {
    let variable = std::env::var_os(VARIABLE).filter(|text| !text.is_empty());
    match option.map(Into::into).or(variable) {
        Some(name) if name == NONE => None,
        Some(name) => Some((name.into(), true)),
        None => Some((dirs::config_dir()?.join("skylight/config.toml"), false)),
    }
}

fn read(file: &PathBuf, is_asked: bool) -> Result<Option<OptionValues>> {
    let text = match std::fs::read_to_string(file) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound && !is_asked => return Ok(None),
        Err(error) => {
            let path = file.clone();
            let reason = format!("{error}; --config none does without");
            return Err(Error::Read { path, reason });
        }
        Ok(text) => text,
    };
    let damaged = |error: OptionsError| OptionsError(format!("{}: {error}", file.display()));
    Ok(Some(read_config(&text).map_err(damaged)?))
}

/// Prints the file that is read and the defaults that it has, as lines of that file.
///
/// # Errors
/// As [`applied`].
pub fn show() -> Result<()> {
    let Some((file, is_asked)) = file_of(None) else {
        return print(&format!("# no file of defaults: {VARIABLE}={NONE}\n"));
    };
    let Some(defaults) = read(&file, is_asked)? else {
        return print(&format!(
            "# {} is not there: no defaults of yours\n",
            file.display()
        ));
    };
    let mut text = format!("# {}\n", file.display());
    for (name, value) in defaults.iter() {
        text += &format!("{name} = {}\n", toml::Value::from(value.as_str()));
    }
    print(&text)
}
