//! EnergyPlus weather: Crawley, Hand & Lawrie 1999, *Improving the weather information available to simulation programs*; the columns are
//! those of EnergyPlus' *Auxiliary Programs*.

use super::{
    Record, Station, Weather, date, number, plausible_dew_point, plausible_irradiance, zone,
};
use crate::daylight::place::Place;

/// Least number of columns: up to the opaque sky cover. Older files end before the rain.
const COLUMNS: usize = 24;

pub(super) fn parse(text: &str) -> Result<Weather, String> {
    let lines = || {
        (1..)
            .zip(text.lines())
            .filter(|(_, line)| !line.trim().is_empty())
    };
    let (number, first) = lines().next().ok_or("it is empty")?;
    let station = station(first, number)?;
    let is_data = |line: &str| line.trim_start().starts_with(|c: char| c.is_ascii_digit());
    let header = lines().take_while(|(_, line)| !is_data(line));
    let periods = header
        .filter(|(_, line)| keyword(line) == "DATA PERIODS")
        .last();
    let per_hour = match periods {
        Some((number, line)) => records_per_hour(line, number)?,
        None => 1.0,
    };
    let data: Vec<(usize, &str)> = lines().skip_while(|(_, line)| !is_data(line)).collect();
    // Files leave out columns at the end, but all lines of a file the same ones.
    let width = data.first().map_or(0, |(_, line)| line.split(',').count());
    let width = width.max(COLUMNS);
    let records = data
        .iter()
        .map(|(number, line)| record(line, *number, per_hour, width));
    Ok(Weather {
        station,
        records: records.collect::<Result<_, _>>()?,
        step_hours: 1.0 / per_hour,
        warnings: Vec::new(),
    })
}

fn keyword(line: &str) -> String {
    let word = line.split(',').next().unwrap_or_default();
    word.trim().to_ascii_uppercase()
}

fn station(line: &str, at: usize) -> Result<Station, String> {
    let cells: Vec<&str> = line.split(',').map(str::trim).collect();
    if keyword(line) != "LOCATION" {
        return Err("it does not begin with LOCATION; this is no EPW file".to_owned());
    }
    if cells.len() < 10 {
        return Err(format!(
            "line {at}: LOCATION has {} columns, not 10",
            cells.len()
        ));
    }
    let name = cells[1..4].iter().filter(|c| !c.is_empty() && **c != "-");
    let place = Place::new(
        number(cells[6], "the latitude", at)?,
        number(cells[7], "the longitude", at)?,
    );
    Ok(Station {
        name: name.copied().collect::<Vec<_>>().join(", "),
        place: place.map_err(|what| format!("line {at}: {what}"))?,
        zone_hours: zone(number(cells[8], "the time zone", at)?, at)?,
        elevation_m: number(cells[9], "the elevation", at)?,
    })
}

/// The second number of `DATA PERIODS,1,1,Data,Sunday,1/1,12/31`.
fn records_per_hour(line: &str, at: usize) -> Result<f64, String> {
    let text = line.split(',').nth(2).unwrap_or("1");
    let count = number(text, "the number of records an hour", at)?;
    if !(1.0..=60.0).contains(&count) || (60.0 / count).fract() != 0.0 {
        return Err(format!(
            "line {at}: {count} records an hour do not divide it"
        ));
    }
    Ok(count)
}

fn record(line: &str, at: usize, per_hour: f64, width: usize) -> Result<Record, String> {
    let cells: Vec<&str> = line.split(',').collect();
    if cells.len() < width {
        return Err(format!(
            "line {at} has {} columns instead of {width}; the file is cut or damaged",
            cells.len()
        ));
    }
    let cell = |column: usize, what: &str| number(cells[column], what, at);
    let hour = cell(3, "the hour")?;
    // The hour is that at the end of the interval, 1 to 24. The minute of hourly files is 0 or 60 and means nothing.
    let middle = if per_hour > 1.0 {
        hour - 1.0 + (cell(4, "the minute")? - 30.0 / per_hour) / 60.0
    } else {
        hour - 0.5
    };
    let (month, day, hour) = date(cell(1, "the month")?, cell(2, "the day")?, middle, at)?;
    Ok(Record {
        month,
        day,
        hour,
        global_w: plausible_irradiance(cell(13, "the global irradiance")?),
        direct_normal_w: plausible_irradiance(cell(14, "the direct irradiance")?),
        diffuse_w: plausible_irradiance(cell(15, "the diffuse irradiance")?),
        dew_point_c: plausible_dew_point(cell(7, "the dew point")?),
    })
}
