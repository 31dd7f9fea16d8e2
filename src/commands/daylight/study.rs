//! `--vary`: one command with several values of some options, and all its results together.

use std::fmt::Write as _;

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};

use super::super::merge::{JobKey, Kind};
use super::super::{interrupt, tell, tell_no_device, weather};
use super::moment::MomentReport;
use super::outcome::{Form, Outcome};
use super::table::Figure;
use super::{deliver, hour, moment, shards, year};
use crate::cli::{DaylightArgs, Variant};
use crate::error::{Error, Result};
use crate::options::OptionValues;
use crate::sensors::Shard;

/// What a variant found.
#[derive(Debug, Clone, Serialize, Deserialize)]
enum Found {
    /// A year, or what needs no hours.
    Year(Box<Outcome>),
    /// A moment.
    Moment(MomentReport),
}

/// An option with the values that it takes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Varied {
    name: String,
    values: Vec<String>,
}

/// Results of variants.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Study {
    form: Form,
    /// The last one changes from one variant to the next.
    varied: Vec<Varied>,
    /// Results with the numbers of their variants.
    found: Vec<(usize, Found)>,
}

/// Measures all variants, or those of a shard, and prints them together.
///
/// # Errors
/// Those of the first variant that cannot be measured, or an interrupt.
pub fn run(args: &DaylightArgs, options: &OptionValues, variants: &[Variant]) -> Result<()> {
    let settings = options.alone()?;
    tell_no_device("daylight", &settings);
    let shard = args.shard.unwrap_or(Shard::ALL);
    let varied = args.vary.iter().map(|vary| Varied {
        name: vary.name.clone(),
        values: vary.values.clone(),
    });
    let mut study = Study {
        form: Form::of(args),
        varied: varied.collect(),
        found: Vec::new(),
    };
    let mut told: Vec<String> = Vec::new();
    let mine = (0..variants.len()).filter(|number| shard.takes(*number));
    let mine: Vec<usize> = mine.collect();
    for number in &mine {
        let found = Found::of(&variants[*number])?;
        if interrupt::is_interrupted() {
            let (done, all) = (study.found.len(), mine.len());
            let what = "variants were measured, and nothing is written";
            return Err(Error::Interrupted { done, all, what });
        }
        let new: Vec<String> = found.warnings();
        let new: Vec<String> = new.into_iter().filter(|w| !told.contains(w)).collect();
        tell(&settings, new.iter())?;
        told.extend(new);
        study.found.push((*number, found));
    }
    if args.shard.is_some() {
        let count = ([mine.len(); 2], "variants");
        return shards::write(args, (&key(variants)?, shard), &study, count);
    }
    tell(&settings, study.oddities().iter())?;
    deliver(args.output.as_deref(), &study.text())
}

/// The job of all variants: what they are, and the model, the sensors and the weather of the first.
fn key(variants: &[Variant]) -> Result<JobKey> {
    let mut decided_by = Vec::new();
    for (number, variant) in variants.iter().enumerate() {
        // The shard is the only argument in which the machines differ.
        let args = DaylightArgs {
            shard: None,
            ..variant.args.clone()
        };
        if number == 0 {
            let key = if args.asks_for_metrics() {
                year::Given::new(&args, &variant.options)?.key(&args)
            } else {
                moment::Given::new(&args, &applied(variant)?)?.key(&args)
            };
            decided_by.push(format!("{key:?}"));
        }
        decided_by.push(variant.values.join(" "));
        // Weather is that of the first, unless it varies.
        if args.vary.iter().any(|vary| vary.name == "weather")
            && let Some(path) = &args.weather
        {
            let weather = weather::read_weather(path)?;
            decided_by.push(format!("{:?}", (&weather.station, &weather.records)));
        }
    }
    Ok(JobKey::new(Kind::Study, &decided_by))
}

/// The options of a moment, with its hour of the weather.
fn applied(variant: &Variant) -> Result<OptionValues> {
    hour::applied(
        &variant.args.at(),
        Some(&variant.args.scene),
        variant.options.clone(),
    )
}

impl Found {
    /// Measures a variant, whole. Its warnings are told by the study, once.
    fn of(variant: &Variant) -> Result<Self> {
        let args = DaylightArgs {
            shard: None,
            ..variant.args.clone()
        };
        if args.asks_for_metrics() {
            let given = year::Given::new(&args, &variant.options)?;
            let outcome = given.measured(&args, |results| Ok(results.outcome.clone()))?;
            return Ok(Self::Year(Box::new(outcome)));
        }
        let given = moment::Given::new(&args, &applied(variant)?)?;
        Ok(Self::Moment(given.measured(&args).1))
    }

    fn warnings(&self) -> Vec<String> {
        match self {
            Self::Year(outcome) => outcome.warnings(),
            Self::Moment(report) => report.warnings(),
        }
    }

    fn json(&self) -> Value {
        match self {
            Self::Year(outcome) => outcome.json(),
            Self::Moment(report) => report.json(),
        }
    }

    fn text(&self) -> String {
        match self {
            Self::Year(outcome) => outcome.text(),
            Self::Moment(report) => report.text(),
        }
    }

    fn figures(&self) -> Vec<Figure> {
        match self {
            Self::Year(outcome) => outcome.figures(),
            Self::Moment(report) => report.figures(),
        }
    }
}

impl Study {
    /// How many variants there are.
    fn count(&self) -> usize {
        self.varied.iter().map(|v| v.values.len()).product()
    }

    /// The values of a variant: its place in each list.
    fn places(&self, number: usize) -> Vec<usize> {
        let mut rest = number;
        let mut places = Vec::new();
        for varied in self.varied.iter().rev() {
            places.push(rest % varied.values.len());
            rest /= varied.values.len();
        }
        places.reverse();
        places
    }

    fn values(&self, number: usize) -> Vec<&str> {
        let places = self.places(number);
        let pairs = self.varied.iter().zip(places);
        pairs
            .map(|(varied, at)| varied.values[at].as_str())
            .collect()
    }

    /// Options whose values all give the same numbers.
    fn oddities(&self) -> Vec<String> {
        let results: Vec<Value> = self.found.iter().map(|(_, found)| found.json()).collect();
        let mut step = self.count();
        let mut lines = Vec::new();
        for varied in &self.varied {
            let count = varied.values.len();
            step /= count;
            let is_first = |number: usize| (number / step).is_multiple_of(count);
            let of = |number: usize| results.get(number).map(|result| &result["sensors"]);
            let changes = (0..results.len()).filter(|number| !is_first(*number));
            let mut changes = changes.map(|number| of(number) != of(number - step));
            if count > 1 && !changes.any(|is| is) {
                let name = &varied.name;
                lines.push(format!("--vary {name} changes no number here"));
            }
        }
        lines
    }

    fn text(&self) -> String {
        match self.form {
            Form::Json => format!("{:#}\n", self.json()),
            Form::Csv => self.csv(),
            Form::Table => self.table(),
        }
    }

    fn json(&self) -> Value {
        let names = || self.varied.iter().map(|varied| varied.name.clone());
        let variant = |(number, found): &(usize, Found)| {
            let values = self.values(*number);
            let pairs = names().zip(&values);
            let name: Vec<String> = pairs.map(|(name, v)| format!("{name}={v}")).collect();
            let pairs = names().zip(values.iter().map(|v| Value::from(*v)));
            json!({
                "name": name.join(", "),
                "values": pairs.collect::<Map<_, _>>(),
                "result": found.json(),
            })
        };
        let varied = self.varied.iter();
        let varied = varied.map(|v| json!({ "name": v.name, "values": v.values }));
        json!({
            "varied": varied.collect::<Vec<_>>(),
            "variants": self.found.iter().map(variant).collect::<Vec<_>>(),
            "warnings": self.oddities(),
        })
    }

    /// A line for each sensor of each variant, with the values in front.
    fn csv(&self) -> String {
        let names: Vec<String> = self.varied.iter().map(|v| quoted(&v.name)).collect();
        let texts: Vec<String> = self.found.iter().map(|(_, found)| found.text()).collect();
        let mut columns: Vec<&str> = Vec::new();
        for column in texts.iter().filter_map(|text| text.lines().next()) {
            let new = column.split(',').filter(|c| !columns.contains(c));
            columns.extend(new.collect::<Vec<_>>());
        }
        let mut all = [&names.join(","), ",", &columns.join(","), "\n"].concat();
        for ((number, _), text) in self.found.iter().zip(&texts) {
            let values: Vec<String> = self.values(*number).into_iter().map(quoted).collect();
            let mut lines = text.lines();
            let head: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
            let places = columns.iter().map(|c| head.iter().position(|own| own == c));
            let places: Vec<Option<usize>> = places.collect();
            for line in lines {
                let cells: Vec<&str> = line.split(',').collect();
                let row = places.iter().map(|at| at.map_or("", |at| cells[at]));
                let row: Vec<&str> = row.collect();
                let _ = writeln!(all, "{},{}", values.join(","), row.join(","));
            }
        }
        all
    }

    /// A line for each variant: means and figures of the whole grid.
    fn table(&self) -> String {
        let mut columns: Vec<String> = self.varied.iter().map(|v| v.name.clone()).collect();
        let figures: Vec<Vec<Figure>> = self.found.iter().map(|(_, f)| f.figures()).collect();
        for figure in figures.iter().flatten() {
            if !columns.contains(&figure.name) {
                columns.push(figure.name.clone());
            }
        }
        let mut rows = vec![columns.clone()];
        for ((number, _), figures) in self.found.iter().zip(&figures) {
            let mut row: Vec<String> = self.values(*number).into_iter().map(Into::into).collect();
            row.extend(columns[row.len()..].iter().map(|name| {
                let own = figures.iter().find(|figure| figure.name == *name);
                own.map_or(String::new(), |figure| figure.text.clone())
            }));
            rows.push(row);
        }
        let width = |at: usize| {
            rows.iter()
                .map(|r| r[at].chars().count())
                .max()
                .unwrap_or(0)
        };
        let widths: Vec<usize> = (0..columns.len()).map(width).collect();
        let mut text = self.head();
        for row in &rows {
            let cells = row.iter().zip(&widths).enumerate();
            let cell = |(at, (cell, width)): (usize, (&String, &usize))| {
                if at < self.varied.len() {
                    format!("{cell:width$}")
                } else {
                    format!("{cell:>width$}")
                }
            };
            let line: Vec<String> = cells.map(cell).collect();
            text += line.join("  ").trim_end();
            text.push('\n');
        }
        text
    }

    /// What is the same for all variants, and what the figures are.
    fn head(&self) -> String {
        let heads = self.found.iter().map(|(_, found)| match found {
            Found::Year(outcome) => outcome.head(),
            Found::Moment(_) => String::new(),
        });
        let mut heads: Vec<String> = heads.collect();
        heads.dedup();
        let head = match &heads[..] {
            [one] => one.clone(),
            _ => String::new(),
        };
        head + "means of the sensors; least and most are of their totals\n\n"
    }

    /// All parts as one. `None` if a variant is missing or there twice, or without parts.
    pub fn merged(parts: Vec<Self>) -> Option<Self> {
        let mut all = parts.first()?.clone();
        let mut found: Vec<Option<Found>> = vec![None; all.count()];
        for (number, result) in parts.into_iter().flat_map(|part| part.found) {
            if found.get_mut(number)?.replace(result).is_some() {
                return None;
            }
        }
        let found: Vec<Found> = found.into_iter().collect::<Option<_>>()?;
        all.found = found.into_iter().enumerate().collect();
        Some(all)
    }

    /// The text of the result, and what is odd about it.
    pub fn finished(&self) -> (String, Vec<String>) {
        (self.text(), self.oddities())
    }
}

/// A word of CSV.
fn quoted(word: &str) -> String {
    if word.contains([',', '"', '\n']) {
        return format!("\"{}\"", word.replace('"', "\"\""));
    }
    word.to_owned()
}
