//! Hour by day over the year: the illuminance of a sensor or the mean of all, in false colours.

use std::collections::BTreeMap;

use super::scale::Scale;
use crate::commands::weather::MONTHS;
use crate::daylight::false_colour::ColourMap;
use crate::daylight::metrics::Schedule;
use crate::daylight::weather::Weather;
use crate::output::{Anchor, Drawing, Fill, Ink, Part, Size, Stroke};
use crate::sensors::{Year, YearLight};

/// Left, top, width, height of the map, pixels.
const MAP: [f64; 4] = [60.0, 70.0, 730.0, 240.0];

/// Colours that are told apart.
const COLOURS: f64 = 128.0;

/// Colour of hours without light.
const DARK: Ink = Ink([225, 225, 225]);

/// Illuminance of each record of a weather file, lux; none in the dark.
pub struct Heat<'a> {
    /// The file.
    pub weather: &'a Weather,
    /// One number for each record.
    pub lux: Vec<Option<f64>>,
    /// What it is of.
    pub title: String,
    /// Hours that are marked.
    pub schedule: Schedule,
    /// Colours.
    pub map: ColourMap,
}

/// Illuminance of each record, of a sensor or the mean of all, of a year that has kept its hours.
pub fn hours(
    weather: &Weather,
    light: &YearLight,
    year: &Year,
    sensor: Option<usize>,
) -> Vec<Option<f64>> {
    let mut lux = vec![None; weather.records.len()];
    for (at, hour) in light.hours.iter().enumerate() {
        let all = year.sensors.iter().map(|own| f64::from(own.lux[at]));
        lux[hour.record] = match sensor {
            Some(number) => all.clone().nth(number),
            None => Some(all.sum::<f64>() / year.sensors.len().max(1) as f64),
        };
    }
    lux
}

impl Heat<'_> {
    /// Draws it.
    pub fn drawing(&self) -> Drawing {
        let [x, y, width, height] = MAP;
        let scale = Scale::logarithmic(self.lux.iter().filter_map(|lux| *lux), "lux", self.map);
        let mut drawing = Drawing::new([x + width + 120.0, y + height + 60.0], self.title.clone());
        drawing.text([x, 30.0], Anchor::Start, Size::Large, self.title.clone());
        let note = format!(
            "{}; local standard time; dashed: occupied hours {}; grey: no daylight",
            self.weather.station.name, self.schedule
        );
        drawing.text([x, 50.0], Anchor::Start, Size::Small, note);
        drawing.parts.push(Part::Fill(Fill {
            areas: vec![MAP],
            ink: DARK,
            title: String::new(),
            name: "dark",
        }));
        let days = self.days();
        let day_width = width / (days.last().map_or(0, |last| *last) + 1) as f64;
        self.draw_hours(&mut drawing, &days, day_width, &scale);
        self.draw_axes(&mut drawing, &days, day_width);
        scale.draw(&mut drawing, [x + width + 30.0, y + 10.0], height - 20.0);
        drawing
    }

    /// Number of the day of each record, from 0.
    fn days(&self) -> Vec<usize> {
        let mut day = 0;
        let records = self.weather.records.iter();
        let before = std::iter::once(None).chain(records.clone().map(Some));
        let number = |(record, before): (&crate::daylight::weather::Record, Option<&_>)| {
            let is_new = before.is_some_and(|before: &crate::daylight::weather::Record| {
                (before.month, before.day) != (record.month, record.day)
            });
            day += usize::from(is_new);
            day
        };
        records.zip(before).map(number).collect()
    }

    /// A rectangle for each hour with light, those of a colour together.
    fn draw_hours(&self, drawing: &mut Drawing, days: &[usize], day_width: f64, scale: &Scale) {
        let [x, y, _, height] = MAP;
        let step = self.weather.step_hours;
        let mut of_colour: BTreeMap<usize, Vec<[f64; 4]>> = BTreeMap::new();
        for ((record, day), lux) in self.weather.records.iter().zip(days).zip(&self.lux) {
            let Some(lux) = lux else { continue };
            let colour = (scale.share(*lux) * (COLOURS - 1.0)).round() as usize;
            let end = record.hour + 0.5 * step;
            of_colour.entry(colour).or_default().push([
                x + *day as f64 * day_width,
                y + height * (1.0 - end / 24.0),
                day_width,
                height * step / 24.0,
            ]);
        }
        for (colour, areas) in of_colour {
            drawing.parts.push(Part::Fill(Fill {
                areas,
                ink: scale.ink(colour as f64 / (COLOURS - 1.0)),
                title: String::new(),
                name: "hours",
            }));
        }
    }

    fn draw_axes(&self, drawing: &mut Drawing, days: &[usize], day_width: f64) {
        let [x, y, width, height] = MAP;
        let at_hour = |hour: f64| y + height * (1.0 - hour / 24.0);
        for hour in [0, 6, 12, 18, 24] {
            let at = at_hour(f64::from(hour));
            drawing.line(vec![[x - 4.0, at], [x, at]], Ink::BLACK, 1.0);
            let label = format!("{hour}:00");
            drawing.text([x - 8.0, at + 4.0], Anchor::End, Size::Small, label);
        }
        let mut before = None;
        for (record, day) in self.weather.records.iter().zip(days) {
            if before == Some(record.month) {
                continue;
            }
            let is_first = before.is_none();
            before = Some(record.month);
            let at = x + *day as f64 * day_width;
            if !is_first {
                drawing.line(
                    vec![[at, y + height], [at, y + height + 6.0]],
                    Ink::BLACK,
                    1.0,
                );
            }
            let name: String = MONTHS[record.month as usize - 1].chars().take(3).collect();
            let place = [at + 6.0, y + height + 18.0];
            drawing.text(place, Anchor::Start, Size::Small, name);
        }
        drawing.parts.push(Part::Stroke(Stroke {
            runs: [self.schedule.from, self.schedule.to]
                .map(|hour| vec![[x, at_hour(hour)], [x + width, at_hour(hour)]])
                .to_vec(),
            ink: Ink::BLACK,
            width: 1.0,
            dash: 4.0,
            name: "schedule",
        }));
        let corners = [
            [x, y],
            [x + width, y],
            [x + width, y + height],
            [x, y + height],
            [x, y],
        ];
        drawing.line(corners.to_vec(), Ink::BLACK, 1.0);
    }
}
