//! Generated files with known contents.

use std::fmt::Write as _;

use super::clock::ClockCheck;
use super::summary::{months, year};
use super::*;
use crate::daylight::sun_position::direction;

/// An EPW file of a year at a place, with a clear sky whose sun is `minutes` later than the middle of each hour.
fn clear_year(latitude: f64, longitude: f64, zone: f64, minutes: f64) -> String {
    let mut text = format!(
        "LOCATION,Somewhere,-,XXX,made,0,{latitude},{longitude},{zone},12.0\nDATA PERIODS,1,1,Data,Sunday, 1/ 1,12/31\n"
    );
    let offset = FixedOffset::east_opt((zone * 3600.0) as i32).expect("a zone");
    let start = NaiveDate::from_ymd_opt(COMMON_YEAR, 1, 1).expect("a date");
    for hour in 0..8760 {
        let end = start.and_time(chrono::NaiveTime::MIN) + Duration::hours(hour);
        let middle = end + Duration::minutes(30) + Duration::seconds((minutes * 60.0) as i64);
        let moment = DateTime::from_naive_utc_and_offset(middle - offset, offset);
        let sun = spa(moment, latitude, longitude).expect("a sun");
        let height = direction(0.0, sun.elevation_deg).y.max(0.0);
        let direct = if height > 0.0 {
            900.0 * (-0.1 / height).exp()
        } else {
            0.0
        };
        let diffuse = 120.0 * height.sqrt();
        let global = diffuse + direct * height;
        use chrono::{Datelike, Timelike};
        let (m, d, h) = (end.month(), end.day(), end.hour() + 1);
        let _ = writeln!(
            text,
            "1999,{m},{d},{h},0,?,10,5,50,101300,0,0,300,{global:.1},{direct:.1},{diffuse:.1},0,0,0,0,0,0,0,0,20,77777,9,0,0,0,0,0,0,0,0"
        );
    }
    text
}

fn epw(text: &str) -> Result<Weather, String> {
    Weather::parse(text, false)
}

#[test]
fn the_clock_is_found_in_both_hemispheres_and_half_zones() {
    for (latitude, longitude, zone) in [
        (41.98, -87.92, -6.0),
        (28.58, 77.2, 5.5),
        (-33.9, 151.2, 10.0),
    ] {
        for minutes in [0.0, -30.0, 30.0, 40.0] {
            let weather = epw(&clear_year(latitude, longitude, zone, minutes)).expect("read");
            let clock = ClockCheck::of(&weather).expect("all three irradiances");
            assert!(
                f64::from(clock.minutes) - minutes <= 1.0,
                "{clock:?} for {minutes}"
            );
            assert!(
                minutes - f64::from(clock.minutes) <= 1.0,
                "{clock:?} for {minutes}"
            );
            assert!(clock.residual_w < 1.0, "{clock:?}");
            assert_eq!(clock.is_off(), minutes != 0.0, "{clock:?}");
            assert_eq!(clock.warning().is_some(), minutes != 0.0);
        }
    }
}

#[test]
fn a_year_is_summed_and_its_hours_are_those_of_its_clock() {
    let weather = epw(&clear_year(28.58, 77.2, 5.5, 0.0)).expect("read");
    assert_eq!(weather.warnings, Vec::<String>::new());
    assert!(weather.is_a_year());
    let noon = &weather.records[11];
    assert_eq!((noon.month, noon.day, noon.hour), (1, 1, 11.5));
    assert_eq!(
        weather.moment(noon).to_rfc3339(),
        "2019-01-01T11:30:00+05:30"
    );
    let months = months(&weather);
    let all = year(&months);
    let direct: f64 = weather
        .records
        .iter()
        .filter_map(|r| r.direct_normal_w)
        .sum();
    assert!((all.direct_normal_kwh - direct / 1000.0).abs() < 1e-6);
    assert!(months[5].global_kwh > 1.2 * months[11].global_kwh);
    // Perez' efficacies of clear skies are near 100 lm/W (sun) and 130 lm/W (sky).
    let efficacy = [
        all.direct_normal_klxh / all.direct_normal_kwh,
        all.diffuse_klxh / all.diffuse_kwh,
    ];
    assert!((80.0..120.0).contains(&efficacy[0]), "{efficacy:?}");
    assert!((110.0..150.0).contains(&efficacy[1]), "{efficacy:?}");
}

#[test]
fn missing_values_are_told_and_leap_days_are_read() {
    let good = clear_year(50.0, 10.0, 1.0, 0.0);
    let holes: String = good
        .lines()
        .enumerate()
        .map(|(i, line)| {
            let mut cells: Vec<&str> = line.split(',').collect();
            if i > 1 && i % 100 == 0 {
                (cells[14], cells[7]) = ("9999", "99.9");
            }
            cells.join(",") + "\r\n"
        })
        .collect();
    let weather = epw(&holes).expect("read");
    assert_eq!(weather.warnings.len(), 2, "{:?}", weather.warnings);
    assert!(weather.warnings[0].contains("87 of 8760 hours have no direct"));
    let march = good.lines().find(|line| line.starts_with("1999,3,1,1,"));
    let march = march.expect("a line");
    let february = march.replacen("3,1,1", "2,29,1", 1);
    let leap = good.replacen(march, &format!("{february}\n{march}"), 1);
    let leap = epw(&leap).expect("read");
    assert_eq!(leap.year(), LEAP_YEAR);
    assert_eq!(leap.warnings, ["it has 8761 hours, not those of a year"]);
}

#[test]
fn damage_is_one_line_with_its_place() {
    let good = clear_year(50.0, 10.0, 1.0, 0.0);
    let line = |n: usize, edit: &dyn Fn(&str) -> String| -> String {
        let lines = good.lines().enumerate();
        lines
            .map(|(i, l)| if i + 1 == n { edit(l) } else { l.to_owned() } + "\n")
            .collect()
    };
    let cell = |n: usize, column: usize, text: &str| {
        line(n, &|l| {
            let mut cells: Vec<&str> = l.split(',').collect();
            cells[column] = text;
            cells.join(",")
        })
    };
    let cut = good[..good.len() / 2].to_owned();
    let first = good.lines().nth(2).expect("a line");
    for (text, part) in [
        (String::new(), "empty"),
        ("<html>not found</html>".to_owned(), "no EPW file"),
        (
            good.lines().take(2).collect::<Vec<_>>().join("\n"),
            "no hours",
        ),
        (cell(1, 6, "north"), "line 1: the latitude is \"north\""),
        (cell(1, 7, "512"), "longitude must be"),
        (cell(1, 8, "60"), "time zone 60"),
        (
            cell(100, 14, "NaN"),
            "line 100: the direct irradiance is \"NaN\"",
        ),
        (cell(100, 1, "13"), "line 100: 13/"),
        (cell(100, 3, "25"), "line 100: "),
        (
            line(100, &|l| {
                l.split(',').take(23).collect::<Vec<_>>().join(",")
            }),
            "line 100 has 23 columns",
        ),
        (line(100, &|l| format!("{l}\n{l}")), "twice"),
        (line(100, &|_| first.to_owned()), "not in order"),
        (cut, "columns"),
    ] {
        let told = epw(&text).map(|_| part).expect_err(part);
        assert!(told.contains(part), "{told} for {part}");
        assert!(told.len() < 160 && !told.contains('\n'), "{told}");
    }
}

#[test]
fn the_clock_of_wea_is_positive_toward_the_west() {
    let head = "place New_Delhi\nlatitude 28.58\nlongitude -77.2\ntime_zone -82.5\nsite_elevation 216\nweather_data_file_units 1\n";
    let text = format!("{head}6 16 7.5 372 466\n6 16 8.5 394 600\n");
    let weather = Weather::parse(&text, true).expect("read");
    assert_eq!(weather.station.zone_hours, 5.5);
    assert_eq!(weather.station.place.longitude, 77.2);
    assert_eq!(weather.records[1].diffuse_w, Some(600.0));
    assert_eq!(ClockCheck::of(&weather), None);
    for (text, part) in [
        (
            head.replace("units 1", "units 3"),
            "only weather_data_file_units 1",
        ),
        (format!("{head}6 16 7.5 372"), "has 4 numbers"),
        (format!("{head}6 16 7.5 x 3"), "\"x\""),
        ("latitude 3\n6 16 7.5 3 3".to_owned(), "no longitude"),
        ("altitude 3\n".to_owned(), "no word"),
    ] {
        let told = Weather::parse(&text, true).map(|_| part).expect_err(part);
        assert!(told.contains(part), "{told} for {part}");
    }
}

#[test]
fn bundled_weather_is_a_whole_year_with_a_right_clock() {
    for (name, text) in BUNDLED {
        let weather = Weather::parse(text, false).expect(name);
        assert_eq!(
            (weather.records.len(), weather.step_hours),
            (8760, 1.0),
            "{name}"
        );
        assert_eq!(weather.warnings, Vec::<String>::new(), "{name}");
        let clock = ClockCheck::of(&weather).expect("all three irradiances");
        assert!(
            !clock.is_off() && clock.residual_w < 3.0,
            "{name}: {clock:?}"
        );
        assert_eq!(bundled(name.as_ref()), Some(text));
    }
    assert_eq!(bundled("chicago.epw".as_ref()), None);
    assert_eq!(bundled("src".as_ref()), None);
}
