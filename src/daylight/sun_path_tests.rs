use super::super::sun_position::azimuth_elevation;
use super::*;

fn observer(latitude: f64, longitude: f64) -> Observer {
    Observer {
        latitude,
        longitude,
        method: SunPositionMethod::Spa,
        refraction: true,
    }
}

fn path(latitude: f64, longitude: f64, when: &str) -> SunPath {
    let when = DateTime::parse_from_rfc3339(when).unwrap();
    SunPath::new(&observer(latitude, longitude), when).unwrap()
}

fn azimuth(direction: DVec3) -> f64 {
    azimuth_elevation(direction).0
}

fn elevation(direction: DVec3) -> f64 {
    azimuth_elevation(direction).1
}

/// Smallest angle between a direction and a line, degrees.
fn angle_to(lines: &[Line], direction: DVec3) -> f64 {
    let segments = lines.iter().flat_map(|line| line.windows(2));
    let distance = |ends: &[DVec3]| {
        let along = ends[1] - ends[0];
        let t = (direction - ends[0]).dot(along) / along.length_squared();
        let nearest = ends[0] + along * t.clamp(0.0, 1.0);
        nearest.angle_between(direction).to_degrees()
    };
    segments.map(distance).fold(f64::INFINITY, f64::min)
}

#[test]
fn at_an_equinox_the_sun_rises_in_the_east_and_sets_in_the_west() {
    for latitude in [-60.0, -33.9, 0.0, 40.0, 55.7, 60.0] {
        let geometric = Observer {
            refraction: false,
            ..observer(latitude, 12.5)
        };
        let when = DateTime::parse_from_rfc3339("2026-06-01T12:00:00+01:00").unwrap();
        let path = SunPath::new(&geometric, when).unwrap();
        let [line] = &path.equinox[..] else {
            panic!("{latitude}: {} lines", path.equinox.len());
        };
        let (rise, set) = (line[0], line[line.len() - 1]);
        let (east, west) = (azimuth(rise), azimuth(set));
        println!("{latitude}: rises {east:.2}°, sets {west:.2}°");
        assert!((east - 90.0).abs() < 1.0 && (west - 270.0).abs() < 1.0);
        assert!(elevation(rise).abs() < 1e-4 && elevation(set).abs() < 1e-4);
        // Lifted by the air it is up earlier, so the way is no shorter.
        let lifted = observer(latitude, 12.5).day(when.date_naive(), *when.offset());
        assert!(lifted.unwrap()[0].len() >= path.day[0].len());
    }
}

#[test]
fn noon_at_the_solstices_is_the_latitude_and_the_tilt() {
    let path = path(55.68, 12.57, "2026-06-21T12:00:00+02:00");
    let highest = |lines: &[Line]| {
        let all = lines.iter().flatten().copied();
        all.map(elevation).fold(f64::NEG_INFINITY, f64::max)
    };
    let noon = |tilt: f64| SunPosition::from_true(180.0, 90.0 - 55.68 + tilt);
    for (lines, tilt) in [
        (&path.june_solstice, 23.436),
        (&path.equinox, 0.0),
        (&path.december_solstice, -23.436),
    ] {
        let expected = noon(tilt).apparent_elevation_deg;
        // The equinox falls within half a day of noon: 0.2°.
        let tolerance = if tilt == 0.0 { 0.2 } else { 0.02 };
        assert!((highest(lines) - expected).abs() < tolerance, "{tilt}");
    }
    assert_eq!(path.day, path.june_solstice);
}

#[test]
fn polar_day_and_polar_night() {
    let summer = path(78.22, 15.65, "2026-06-21T12:00:00+02:00");
    assert_eq!(summer.polar, Some(Polar::Day));
    assert_eq!((summer.day.len(), summer.hours.len()), (1, 24));
    let line = &summer.day[0];
    assert!(
        line[0].angle_between(line[line.len() - 1]).to_degrees() < 0.1,
        "closed"
    );
    assert!(summer.events.sunrise.is_none() && summer.events.noon.is_some());
    assert!(summer.december_solstice.is_empty());
    let winter = path(78.22, 15.65, "2026-12-21T12:00:00+01:00");
    assert_eq!(winter.polar, Some(Polar::Night));
    assert!(winter.day.is_empty() && winter.hours.is_empty());
    let temperate = path(48.0, 15.65, "2026-12-21T12:00:00+01:00");
    assert_eq!(temperate.polar, None);
}

#[test]
fn a_clock_far_from_the_place_cuts_the_day_in_two() {
    let path = path(55.7, 12.5, "2026-06-21T12:00:00-12:00");
    assert_eq!(path.day.len(), 2);
    let ends: Vec<f64> = path
        .day
        .iter()
        .flat_map(|l| [l[0], l[l.len() - 1]])
        .map(elevation)
        .collect();
    // Midnight of that clock, sunset, sunrise, midnight.
    assert!(ends[0] > 40.0 && ends[1].abs() < 1e-4 && ends[2].abs() < 1e-4 && ends[3] > 40.0);
}

#[test]
fn hours_are_on_the_line_of_the_day() {
    let path = path(55.68, 12.57, "2026-09-03T12:00:00+02:00");
    let labels: Vec<_> = path.hours.iter().map(HourMark::label).collect();
    assert_eq!(labels.first().map(String::as_str), Some("7"), "{labels:?}");
    assert_eq!(labels.last().map(String::as_str), Some("19"), "{labels:?}");
    for mark in &path.hours {
        let off = angle_to(&path.day, mark.direction);
        assert!(off < 0.02, "{}: {off}°", mark.label());
        assert!((mark.direction.length() - 1.0).abs() < 1e-12);
    }
}

#[test]
fn the_noon_of_sydney_is_in_the_north() {
    let path = path(-33.87, 151.21, "2026-12-21T12:00:00+11:00");
    let noon = path.events.noon.expect("a noon");
    let sun = observer(-33.87, 151.21).sun(noon).unwrap();
    assert!(sun.z < 0.0 && elevation(sun) > 79.0, "{sun}");
    let turn = (azimuth(sun) + 180.0).rem_euclid(360.0) - 180.0;
    assert!(turn.abs() < 0.1, "{turn}");
    assert_eq!((noon.hour(), noon.minute() / 10), (12, 5));
}

#[test]
fn the_seasons_are_the_almanacs() {
    // US Naval Observatory.
    for (year, march, june, december) in [
        (
            2026,
            "2026-03-20T14:46:00Z",
            "2026-06-21T08:24:00Z",
            "2026-12-21T20:50:00Z",
        ),
        (
            2024,
            "2024-03-20T03:06:00Z",
            "2024-06-20T20:51:00Z",
            "2024-12-21T09:21:00Z",
        ),
    ] {
        let seasons = Seasons::of(year).unwrap();
        for (ours, theirs) in [
            (seasons.march_equinox, march),
            (seasons.june_solstice, june),
            (seasons.december_solstice, december),
        ] {
            let theirs = DateTime::parse_from_rfc3339(theirs).unwrap();
            let off = (ours.fixed_offset() - theirs).num_minutes();
            println!("{ours}: {off} min");
            assert!(off.abs() <= 15, "{ours}, not {theirs}");
        }
    }
}

#[test]
fn an_analemma_passes_through_the_hours_of_every_day() {
    let observer = observer(55.68, 12.57);
    let offset = FixedOffset::east_opt(3600).unwrap();
    let lines = observer.analemma(2026, offset, 12).unwrap();
    assert_eq!(lines.len(), 1, "noon is above the horizon all year");
    let closed = lines[0][0].angle_between(lines[0][lines[0].len() - 1]);
    assert!(closed.to_degrees() < 0.3);
    for month in 1..=12 {
        let day = NaiveDate::from_ymd_opt(2026, month, 17).unwrap();
        let marks = observer.hours(day, offset).unwrap();
        let noon = marks.iter().find(|m| m.label() == "12").unwrap();
        assert!(angle_to(&lines, noon.direction) < 0.1, "{month}");
    }
    let morning = observer.analemma(2026, offset, 6).unwrap();
    assert!(morning.iter().flatten().all(|d| d.y > -1e-6) && !morning.is_empty());
}

#[test]
fn what_the_ephemeris_does_not_cover_is_an_error() {
    let offset = FixedOffset::east_opt(0).unwrap();
    for year in [-501, 3001, 262_000, -262_000] {
        let day = NaiveDate::from_ymd_opt(year, 6, 1).unwrap();
        assert!(observer(50.0, 10.0).day(day, offset).is_err(), "{year}");
        assert!(Seasons::of(year).is_err());
    }
    let june = NaiveDate::from_ymd_opt(2026, 6, 1).unwrap();
    assert!(observer(91.0, 10.0).day(june, offset).is_err());
}
