//! Lines on standard error: errors, warnings, notices. Their first word is coloured on a terminal, unless `NO_COLOR` or `--color` say otherwise.

use std::fmt::Display;

const RED: &str = "\x1b[1;31m";
const YELLOW: &str = "\x1b[1;33m";
const CYAN: &str = "\x1b[36m";
const PLAIN: &str = "\x1b[0m";

/// What ends the program, or a part of its work.
pub fn error(text: impl Display) {
    say(RED, "error", text);
}

/// What the user should look at.
pub fn warning(text: impl Display) {
    say(YELLOW, "warning", text);
}

/// What is done otherwise than usual.
pub fn notice(text: impl Display) {
    say(CYAN, "notice", text);
}

fn say(colour: &str, kind: &str, text: impl Display) {
    anstream::eprintln!("{colour}{kind}:{PLAIN} {text}");
}
