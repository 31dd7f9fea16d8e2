//! `--report`: one page with assumptions, pictures, results and verdicts; XHTML that needs no other file.

mod assumptions;
mod verdicts;

use std::path::Path;

use self::assumptions::{assumptions, materials};
use self::verdicts::verdicts;
#[cfg(feature = "window")]
pub(in crate::commands) use self::verdicts::{LEED_EXPOSED, LEED_PERCENT};
use super::drawings::heading;
use super::results::Results;
use super::table::rounded;
use crate::error::Result;
use crate::output::{escaped, write_text};

/// Columns of which the page has plans, if they were measured.
const PLANS: [&str; 4] = ["da300", "ase_hours", "df", "udi_aut"];

/// For the screen and for paper.
const STYLE: &str = "@page { size: A4; margin: 16mm 14mm 18mm; }
body { font: 10.5pt/1.4 Helvetica, Arial, 'DejaVu Sans', sans-serif; color: #111; max-width: 185mm; margin: 8mm auto; padding: 0 4mm; }
h1 { font-size: 18pt; margin: 0 0 1mm; } h2 { font-size: 13pt; margin: 8mm 0 2mm; border-bottom: 1px solid #999; break-after: avoid; }
table { border-collapse: collapse; width: 100%; margin: 2mm 0; } th, td { text-align: left; padding: 0.8mm 2mm; border-bottom: 1px solid #ddd; vertical-align: top; }
thead th { border-bottom: 1px solid #666; } td.n, th.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
tr, figure { break-inside: avoid; } figure { margin: 4mm 0; } svg { width: 100%; height: auto; border: 1px solid #ddd; }
.met, .not-met { white-space: nowrap; font-weight: bold; } .met { color: #05620f; } .not-met { color: #a60b0b; } .open { color: #7a5200; font-weight: bold; }
.warning { background: #fff3d6; padding: 2mm 3mm; } .small { font-size: 9pt; color: #444; }
@media print { body { margin: 0; padding: 0; max-width: none; } }";

/// Writes the page.
///
/// # Errors
/// The file cannot be written.
pub(super) fn write(path: &Path, results: &Results) -> Result<()> {
    write_text(path, &page(results))
}

fn page(results: &Results) -> String {
    let name = results.args.scene.file_name().unwrap_or_default();
    let name = escaped(&name.to_string_lossy());
    let place = results
        .weather
        .map(|weather| escaped(&weather.station.name));
    let place = place.unwrap_or_default();
    let warnings: String = results
        .outcome
        .warnings()
        .iter()
        .map(|line| format!("<p class=\"warning\">{}</p>\n", escaped(line)))
        .collect();
    // Nothing in it may end the element.
    let data = results
        .outcome
        .json()
        .to_string()
        .replace('<', "\\u003c")
        .replace('&', "\\u0026");
    format!(
        "<!DOCTYPE html>\n<html xmlns=\"http://www.w3.org/1999/xhtml\" lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n<meta name=\"viewport\" content=\"width=device-width\"/>\n<title>Daylight: {name}, {place}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n<h1>Daylight of {name}</h1>\n<p>{place}; {count} sensors; skylight {version}</p>\n{warnings}<h2>Verdicts</h2>\n{verdicts}<h2>Results</h2>\n{table}<h2>Pictures</h2>\n{pictures}<h2>Assumptions</h2>\n{assumptions}<h2>Surfaces</h2>\n{materials}<script type=\"application/json\" id=\"results\">{data}</script>\n</body>\n</html>\n",
        count = results.sensors.len(),
        version = env!("CARGO_PKG_VERSION"),
        verdicts = verdicts(results),
        table = table(results),
        pictures = pictures(results),
        assumptions = assumptions(results),
        materials = materials(results.scene),
    )
}

/// A table of text, each cell escaped here; columns from `numbers` on are numbers.
fn rows(head: &[&str], numbers: usize, lines: &[Vec<String>]) -> String {
    let class = |at: usize| if at >= numbers { " class=\"n\"" } else { "" };
    let line = |cells: &mut dyn Iterator<Item = &str>, tag: &str| {
        let cells = cells.enumerate();
        let cells =
            cells.map(|(at, cell)| format!("<{tag}{}>{}</{tag}>", class(at), escaped(cell)));
        format!("<tr>{}</tr>\n", cells.collect::<String>())
    };
    let head = if head.is_empty() {
        String::new()
    } else {
        format!("<thead>{}</thead>\n", line(&mut head.iter().copied(), "th"))
    };
    let body: String = lines
        .iter()
        .map(|cells| line(&mut cells.iter().map(String::as_str), "td"))
        .collect();
    format!("<table>\n{head}<tbody>\n{body}</tbody>\n</table>\n")
}

/// Columns and shares with their errors.
fn table(results: &Results) -> String {
    let column = |column: &super::table::Column| {
        let figures = column.figures().map(rounded);
        let [mean, error, least, most] = figures.map(|figure| format!("{figure:.2}"));
        let name = format!("{} ({})", heading(&column.name), column.name);
        vec![name, column.unit.to_owned(), mean, error, least, most]
    };
    let columns: Vec<Vec<String>> = results.outcome.columns.iter().map(column).collect();
    let head = ["metric", "unit", "mean", "± error", "least", "most"];
    rows(&head, 2, &columns)
        + "<p class=\"small\">± error: standard error of a sensor, root mean square over the sensors. The results of every sensor, each with its own, are in this page as JSON: the element <code>results</code>.</p>\n"
}

fn pictures(results: &Results) -> String {
    let mut names: Vec<&str> = PLANS.to_vec();
    names.retain(|name| results.column(name).is_some());
    if names.is_empty() {
        names.extend(
            results
                .outcome
                .columns
                .first()
                .map(|column| column.name.as_str()),
        );
    }
    let plans = names.into_iter().filter_map(|name| results.column(name));
    let mut drawings: Vec<_> = plans.map(|column| results.plan(column)).collect();
    drawings.extend(results.weather.map(|weather| results.heat(weather)));
    drawings
        .iter()
        .map(|drawing| format!("<figure>\n{}</figure>\n", drawing.svg()))
        .collect()
}
