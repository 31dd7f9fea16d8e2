//! The command reference of the manual, from the definition of the command line: `cargo run --example make_reference` writes
//! `docs/commands.md`. A test compares the file with it.

use std::fmt::Write as _;

use clap::{Arg, Command};

fn main() -> std::io::Result<()> {
    std::fs::write("docs/commands.md", reference())
}

/// The page: what the help of each command tells, the options that commands share once.
pub fn reference() -> String {
    let mut definition = skylight::cli::definition().disable_help_subcommand(true);
    definition.build();
    let mut text = format!(
        "# Command reference\n\n<!-- Made by: cargo run --example make_reference -->\n\n{}.\n{}\n\n",
        about(&definition),
        paragraph(&definition.get_after_help().map(ToString::to_string))
    );
    text += &arguments(definition.get_arguments());
    for command in definition.get_subcommands() {
        text += &section(command);
    }
    text += "\n## Options that commands share\n\nMost are keys of scene files too ([formats](formats.md#scene-files)).\n";
    let shared = definition
        .get_subcommands()
        .find(|c| c.get_name() == "render");
    let shared: Vec<&Arg> = shared
        .into_iter()
        .flat_map(Command::get_arguments)
        .collect();
    for heading in headings(shared.iter().copied()) {
        let of = shared
            .iter()
            .filter(|arg| arg.get_help_heading() == Some(&heading));
        let _ = write!(text, "\n### {heading}\n\n{}", arguments(of.copied()));
    }
    text
}

/// A command: what it does, its words, the options that it has alone, and the groups of those that it shares.
fn section(command: &Command) -> String {
    let usage = command.clone().render_usage().to_string();
    let usage = usage.trim_start_matches("Usage: ").trim().to_owned();
    let own = command
        .get_arguments()
        .filter(|arg| arg.get_help_heading().is_none() && arg.get_id() != "color");
    let shared = command.get_arguments().filter(|arg| !arg.is_hide_set());
    let groups = headings(shared).join(", ");
    let mut text = format!(
        "\n## skylight {}\n\n{}.\n{}\n\n```text\n{usage}\n```\n\n{}",
        command.get_name(),
        about(command),
        paragraph(&long_about(command)),
        arguments(own)
    );
    if !groups.is_empty() {
        let _ = writeln!(text, "\nAnd of the shared ones: {groups}.");
    }
    text.replace("\n\n\n", "\n\n")
}

/// Headings of the help in order, each once.
fn headings<'a>(arguments: impl Iterator<Item = &'a Arg>) -> Vec<String> {
    let mut list: Vec<String> = Vec::new();
    for heading in arguments.filter_map(|arg| arg.get_help_heading()) {
        if !list.iter().any(|known| known == heading) {
            list.push(heading.to_owned());
        }
    }
    list
}

fn about(command: &Command) -> String {
    let text = command.get_about().map(ToString::to_string);
    escaped(text.unwrap_or_default().trim_end_matches('.'))
}

/// What follows the first paragraph of the long description.
fn long_about(command: &Command) -> Option<String> {
    let text = command.get_long_about()?.to_string();
    text.split_once("\n\n").map(|(_, rest)| rest.to_owned())
}

fn paragraph(text: &Option<String>) -> String {
    text.as_ref().map_or(String::new(), |text| escaped(text))
}

/// A list: the words of each argument, its help, its default and its values.
fn arguments<'a>(list: impl Iterator<Item = &'a Arg>) -> String {
    let is_of_all = |arg: &Arg| ["help", "version"].contains(&arg.get_id().as_str());
    let shown = list.filter(|arg| !arg.is_hide_set() && !is_of_all(arg));
    shown.map(argument).collect()
}

fn argument(arg: &Arg) -> String {
    let help = arg.get_long_help().or(arg.get_help());
    let help = help.map(ToString::to_string).unwrap_or_default();
    let defaults = arg.get_default_values().iter();
    let defaults: Vec<_> = defaults.map(|v| v.to_string_lossy()).collect();
    let takes_value = arg.get_num_args().is_none_or(|n| n.takes_values());
    let default = match defaults.join(",") {
        none if none.is_empty() || !takes_value => String::new(),
        text => format!(" Default: `{text}`."),
    };
    let help = escaped(help.trim().trim_end_matches('.'));
    let mut text = format!("- `{}`: {help}.{default}\n", words(arg));
    let values = arg.get_possible_values();
    for value in values.iter().filter(|v| !v.is_hide_set() && takes_value) {
        let help = value
            .get_help()
            .map(ToString::to_string)
            .unwrap_or_default();
        let _ = writeln!(text, "  - `{}`: {}", value.get_name(), escaped(&help));
    }
    text
}

/// The argument as it is typed.
fn words(arg: &Arg) -> String {
    let takes_value = arg.get_num_args().is_none_or(|n| n.takes_values());
    let names = arg.get_value_names().unwrap_or_default();
    let value = names.first().map(ToString::to_string);
    let value = value.unwrap_or_else(|| arg.get_id().to_string().to_uppercase());
    let Some(long) = arg.get_long() else {
        return value;
    };
    let short = arg.get_short().map_or(String::new(), |c| format!("-{c}, "));
    let joint = if arg.is_require_equals_set() {
        "="
    } else {
        " "
    };
    let is_optional = arg.get_num_args().is_some_and(|n| n.min_values() == 0);
    match (takes_value, is_optional) {
        (false, _) => format!("{short}--{long}"),
        (true, true) => format!("{short}--{long}[{joint}{value}]"),
        (true, false) => format!("{short}--{long}{joint}{value}"),
    }
}

/// Text in which nothing is markup.
fn escaped(text: &str) -> String {
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    text.replace('<', "\\<")
        .replace('*', "\\*")
        .replace('_', "\\_")
}
