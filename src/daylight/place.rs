//! Places on the earth: coordinates in the forms that people write, and the time zone of a place.

use chrono::{DateTime, Duration, FixedOffset, NaiveDateTime, Offset, TimeZone};
use chrono_tz::{TZ_VARIANTS, Tz};

use super::cities;

/// Largest distance of a listed city that determines a place's time zone, km.
const MAX_ZONE_KM: f64 = 1000.0;

/// A place on the earth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Degrees, north positive, −90..=90.
    pub latitude: f64,
    /// Degrees, east positive, −180..=180.
    pub longitude: f64,
}

impl Default for Place {
    /// Kongens Lyngby, where the lecture was given.
    fn default() -> Self {
        Self {
            latitude: 55.79,
            longitude: 12.52,
        }
    }
}

impl Place {
    /// The place of these coordinates, degrees.
    ///
    /// # Errors
    /// A latitude outside ±90°, a longitude outside ±180°.
    pub fn new(latitude: f64, longitude: f64) -> Result<Self, String> {
        if !(-90.0..=90.0).contains(&latitude) {
            return Err("latitude must be -90 to 90 degrees".to_owned());
        }
        if !(-180.0..=180.0).contains(&longitude) {
            return Err("longitude must be -180 to 180 degrees".to_owned());
        }
        Ok(Self {
            latitude,
            longitude,
        })
    }

    /// From `55.79,12.52`, `33.87° S, 151.21° E`, `S33.87 E151.21`, `33°52'S 151°12'E` or the name of a city.
    ///
    /// # Errors
    /// One line that says what is wrong, or names the city most similar to the text.
    pub fn parse(text: &str) -> Result<Self, String> {
        if text.contains(|c: char| c.is_ascii_digit()) {
            return coordinates(text);
        }
        let city = cities::named(text)?;
        Self::new(city.latitude, city.longitude)
    }

    /// The time zone: that of the nearest listed city within 1000 km, else the whole hour of the longitude
    /// (round(longitude / 15°)).
    ///
    /// By area, 75 % of the land gets its legal UTC offset in June, and 93 % is within an hour (without the cities: 42 % and
    /// 87 %), compared with the zones' polygons at 18 000 random points.
    pub fn zone(&self) -> Zone {
        let (city, km) = cities::nearest(self.latitude, self.longitude);
        if km <= MAX_ZONE_KM {
            return Zone::Civil(city.zone);
        }
        let hours = (self.longitude / 15.0).round() as i32;
        Zone::Offset(FixedOffset::east_opt(hours * 3600).unwrap_or_else(utc))
    }
}

impl std::fmt::Display for Place {
    /// As `33.87° S, 151.21° E`.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let latitude = Axis::Latitude.written(self.latitude);
        write!(f, "{latitude}, {}", Axis::Longitude.written(self.longitude))
    }
}

const FORM: &str = "write LAT,LON in degrees, for instance 55.79,12.52 or 33.87 S, 151.21 E";

/// One of the two coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// North (N) and south (S) of the equator.
    Latitude,
    /// East (E) and west (W) of Greenwich.
    Longitude,
}

impl Axis {
    /// An angle (degrees) with a hemisphere letter instead of a sign, to three decimals: `33.87° S` for −33.87.
    pub fn written(self, degrees: f64) -> String {
        let rounded = (degrees * 1e3).round() / 1e3;
        let letter = match (self, rounded < 0.0) {
            (Self::Latitude, false) => "N",
            (Self::Latitude, true) => "S",
            (Self::Longitude, false) => "E",
            (Self::Longitude, true) => "W",
        };
        format!("{}° {letter}", rounded.abs())
    }

    /// The degrees of a text such as `-33.87`, `33.87° S` or `33°52'S`; `None` if it is not an angle of this axis.
    pub fn parse(self, text: &str) -> Option<f64> {
        let (degrees, axis) = angle(text).ok()?;
        axis.is_none_or(|axis| axis == self).then_some(degrees)
    }
}

fn coordinates(text: &str) -> Result<Place, String> {
    let (first, second) = halves(text).ok_or(FORM)?;
    let (a, b) = (angle(first)?, angle(second)?);
    // Letters tell the axes apart; without them latitude comes first.
    let (latitude, longitude) = match (a.1, b.1) {
        (Some(a), Some(b)) if a == b => {
            return Err(format!(
                "\"{}\" gives one coordinate twice; {FORM}",
                text.trim()
            ));
        }
        (Some(Axis::Longitude), _) | (_, Some(Axis::Latitude)) => (b.0, a.0),
        _ => (a.0, b.0),
    };
    Place::new(latitude, longitude)
}

/// Splits a text into its two coordinates: at a semicolon, else at the comma unless it is a decimal one, else at a hemisphere letter or a
/// blank.
fn halves(text: &str) -> Option<(&str, &str)> {
    let text = text.trim();
    if let Some((a, b)) = text.split_once(';') {
        return (!b.contains(';')).then_some((a, b));
    }
    if let Some((a, b)) = decimal_commas(text) {
        return Some((a, b));
    }
    if let Some((a, b)) = text.split_once(',') {
        return (!b.contains(',')).then_some((a, b));
    }
    let mut letters = text.match_indices(|c: char| "NSEWnsew".contains(c));
    let at = match letters.next() {
        Some((0, _)) => letters.next()?.0,
        Some((at, _)) => at + 1,
        None => text.find(char::is_whitespace)?,
    };
    Some(text.split_at(at))
}

/// The coordinates of `55,68 12,57` or `55,68, 12,57`: two words with a decimal comma each.
fn decimal_commas(text: &str) -> Option<(&str, &str)> {
    let has_one = |word: &str| word.matches(',').count() == 1;
    let (a, b) = text.split_once(char::is_whitespace)?;
    let (a, b) = (a.strip_suffix(',').unwrap_or(a), b.trim());
    (has_one(a) && has_one(b)).then_some((a, b))
}

/// One coordinate, degrees, and its axis if a letter tells it.
fn angle(text: &str) -> Result<(f64, Option<Axis>), String> {
    let text = text.trim();
    let wrong = || format!("\"{text}\" is not a coordinate; {FORM}");
    let is_letter = |c: char| c.is_ascii_alphabetic();
    let number = text.trim_matches(is_letter);
    let letter = text.replacen(number, "", 1).to_ascii_uppercase();
    let (axis, is_negative) = match letter.as_str() {
        "" => (None, false),
        "N" => (Some(Axis::Latitude), false),
        "S" => (Some(Axis::Latitude), true),
        "E" => (Some(Axis::Longitude), false),
        "W" => (Some(Axis::Longitude), true),
        _ => return Err(wrong()),
    };
    let number = number.trim();
    let minus = number.strip_prefix(['-', '−']);
    let unsigned = minus.or(number.strip_prefix('+')).unwrap_or(number);
    let degrees = sexagesimal(unsigned).ok_or_else(wrong)?;
    // "-33.87 N" is 33.87 S, but "-33.87 S" is ambiguous.
    if minus.is_some() && is_negative {
        return Err(format!(
            "\"{text}\" has a minus and {letter}; write {degrees} {letter} or -{degrees}"
        ));
    }
    let sign = if minus.is_some() || is_negative {
        -1.0
    } else {
        1.0
    };
    Ok((sign * degrees, axis))
}

/// Degrees of `33.87`, `33.87°` or `33°52'12"`, not negative.
fn sexagesimal(text: &str) -> Option<f64> {
    let text = text
        .replace(['′', '’'], "'")
        .replace(['″', '”'], "\"")
        .replace('º', "°");
    let mut rest = text.trim();
    let (mut degrees, mut unit) = (0.0, 1.0);
    for mark in ['°', '\'', '"'] {
        let (number, after) = rest.split_once(mark).unwrap_or((rest, ""));
        let value: f64 = number.trim().replace(',', ".").parse().ok()?;
        let is_digit = |c: char| c.is_ascii_digit() || c == '.';
        if !number.trim().starts_with(is_digit) || (unit < 1.0 && value >= 60.0) {
            return None;
        }
        degrees += value * unit;
        unit /= 60.0;
        rest = after.trim();
        if rest.is_empty() {
            return Some(degrees);
        }
    }
    None
}

/// Rule that converts local time to a moment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Zone {
    /// A time zone of the IANA database, with its history and summer times.
    Civil(Tz),
    /// A fixed UTC offset.
    Offset(FixedOffset),
}

impl Zone {
    /// From an IANA name (`Asia/Tokyo`, in any case), `Z`, `UTC`, or an offset (`+02:00`, `+0200`, `+02`, `UTC+2`).
    ///
    /// # Errors
    /// One line, with the zone that was probably meant if it can be guessed.
    pub fn parse(text: &str) -> Result<Self, String> {
        let text = text.trim();
        let is_utc = |word: &str| {
            ["z", "utc", "gmt"]
                .iter()
                .any(|utc| word.eq_ignore_ascii_case(utc))
        };
        if is_utc(text) {
            return Ok(Self::Offset(utc()));
        }
        if let Some(at) = text.find(['+', '-', '−'])
            && (at == 0 || is_utc(text[..at].trim()))
        {
            return offset(&text[at..]).map(Self::Offset);
        }
        let same = |zone: &&Tz| zone.name().eq_ignore_ascii_case(text);
        let zone = TZ_VARIANTS.iter().find(same).copied();
        zone.map(Self::Civil).ok_or_else(|| unknown_zone(text))
    }

    /// `when` in local time of this zone. The offset is in whole minutes, as RFC 3339 requires (local mean times were not).
    pub fn clock(self, when: DateTime<FixedOffset>) -> DateTime<FixedOffset> {
        match self {
            Self::Civil(zone) => when.with_timezone(&whole_minutes(
                zone.offset_from_utc_datetime(&when.naive_utc()).fix(),
            )),
            Self::Offset(offset) => when.with_timezone(&offset),
        }
    }

    /// Whether the zone has the UTC offset of `when` at that moment.
    pub fn has_offset_of(self, when: DateTime<FixedOffset>) -> bool {
        self.clock(when).offset() == when.offset()
    }

    /// The moment at which the local time is `local`.
    ///
    /// # Errors
    /// One line with both readings, if a clock change makes `local` occur twice or not at all.
    pub fn moment(self, local: NaiveDateTime) -> Result<DateTime<FixedOffset>, String> {
        let readings = self.readings(local);
        let [first, second] = readings;
        if first == second {
            return Ok(first);
        }
        let write = |when: DateTime<FixedOffset>| written(self.clock(when));
        let how = if first < second {
            "occurs twice"
        } else {
            "is skipped"
        };
        Err(format!(
            "{} {how} by the change of the clocks in {self}; write {} or {}",
            local.format("%Y-%m-%d %H:%M"),
            write(first),
            write(second)
        ))
    }

    /// As [`Self::moment`], but an ambiguous time takes the offset before the change.
    pub fn nearest_moment(self, local: NaiveDateTime) -> DateTime<FixedOffset> {
        self.clock(self.readings(local)[0])
    }

    /// `local` with the offsets before and after a clock change; equal if there is no change.
    fn readings(self, local: NaiveDateTime) -> [DateTime<FixedOffset>; 2] {
        let by = |offset: FixedOffset| at_offset(local, offset);
        let zone = match self {
            Self::Offset(offset) => return [by(offset); 2],
            Self::Civil(zone) => zone,
        };
        let offset = |utc: &NaiveDateTime| whole_minutes(zone.offset_from_utc_datetime(utc).fix());
        match zone.offset_from_local_datetime(&local) {
            chrono::MappedLocalTime::Single(one) => [by(whole_minutes(one.fix())); 2],
            chrono::MappedLocalTime::Ambiguous(before, after) => {
                [before, after].map(|o| by(whole_minutes(o.fix())))
            }
            chrono::MappedLocalTime::None => [-1, 1].map(|days| {
                let near = local.checked_add_signed(Duration::days(days));
                by(offset(&near.unwrap_or(local)))
            }),
        }
    }
}

impl std::fmt::Display for Zone {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Civil(zone) => f.write_str(zone.name()),
            Self::Offset(offset) => write!(f, "UTC{offset}"),
        }
    }
}

/// A moment in the form of the command line, without seconds if they are zero.
fn written(when: DateTime<FixedOffset>) -> String {
    let seconds = if when.format("%S").to_string() == "00" {
        ""
    } else {
        ":%S"
    };
    when.format(&format!("%Y-%m-%dT%H:%M{seconds}%:z"))
        .to_string()
}

/// The moment of a local time at an offset. Cannot overflow: chrono's range is far wider than the accepted years.
fn at_offset(local: NaiveDateTime, offset: FixedOffset) -> DateTime<FixedOffset> {
    let utc = local.checked_sub_offset(offset).unwrap_or(local);
    DateTime::from_naive_utc_and_offset(utc, offset)
}

fn utc() -> FixedOffset {
    chrono::Utc.fix()
}

fn whole_minutes(offset: FixedOffset) -> FixedOffset {
    let seconds = offset.local_minus_utc();
    let minutes = (f64::from(seconds) / 60.0).round() as i32;
    FixedOffset::east_opt(minutes * 60).unwrap_or(offset)
}

/// `+02:00`, `+0200`, `+02`, `+2`.
fn offset(text: &str) -> Result<FixedOffset, String> {
    let wrong = || format!("\"{text}\" is not a UTC offset; write for instance +02:00");
    let sign = if text.starts_with('+') { 1 } else { -1 };
    let digits = text.trim_start_matches(['+', '-', '−']).trim();
    let (hours, minutes) = match digits.split_once(':') {
        Some(parts) => parts,
        None if digits.len() == 4 && digits.is_ascii() => digits.split_at(2),
        None => (digits, "00"),
    };
    let part = |text: &str, most: i32| {
        let is_short = (1..=2).contains(&text.len()) && text.bytes().all(|b| b.is_ascii_digit());
        let value: i32 = is_short
            .then(|| text.parse().ok())
            .flatten()
            .ok_or_else(wrong)?;
        if value > most {
            Err(wrong())
        } else {
            Ok(value)
        }
    };
    let seconds = part(hours, 23)? * 3600 + part(minutes, 59)? * 60;
    FixedOffset::east_opt(sign * seconds).ok_or_else(wrong)
}

fn unknown_zone(text: &str) -> String {
    let wanted = text.to_lowercase().replace(' ', "_");
    let likeness = |zone: &Tz| {
        let name = zone.name().to_lowercase();
        let city = name.rsplit('/').next().unwrap_or(&name);
        strsim::jaro_winkler(&name, &wanted).max(strsim::jaro_winkler(city, &wanted))
    };
    let alike = TZ_VARIANTS
        .iter()
        .max_by(|a, b| likeness(a).total_cmp(&likeness(b)));
    let meant = cities::named(text).map_or(alike.copied(), |city| Some(city.zone));
    let meant = meant.map_or("Europe/Copenhagen", |zone| zone.name());
    format!(
        "\"{text}\" is not a time zone; did you mean {meant}? Otherwise write a UTC offset such as +02:00"
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use chrono::NaiveDate;

    fn local(year: i32, month: u32, day: u32, hour: u32, minute: u32) -> NaiveDateTime {
        let date = NaiveDate::from_ymd_opt(year, month, day).unwrap();
        date.and_hms_opt(hour, minute, 0).unwrap()
    }

    fn moment(text: &str) -> DateTime<FixedOffset> {
        DateTime::parse_from_rfc3339(text).unwrap()
    }

    fn place(text: &str) -> Result<(f64, f64), String> {
        Place::parse(text).map(|p| (p.latitude, p.longitude))
    }

    #[test]
    fn coordinates_are_read_as_people_write_them() {
        for text in [
            "-33,87; 151,21",
            "-33,87 151,21",
            "-33,87, 151,21",
            "-33.87,151.21",
            " -33.87 , +151.21 ",
            "−33.87, 151.21",
            "-33.87 151.21",
            "33.87 S, 151.21 E",
            "33.87° S, 151.21° E",
            "33.87s 151.21e",
            "33.87°S151.21°E",
            "S33.87 E151.21",
            "S 33.87°; E 151.21°",
            "151.21 E, 33.87 S",
            "E151.21, -33.87",
            // A minus sign inverts N.
            "-33.87° N, 151.21° E",
        ] {
            assert_eq!(place(text), Ok((-33.87, 151.21)), "{text}");
        }
        let (latitude, longitude) = place("33°52'12\"S 151°12′36″E").unwrap();
        assert!((latitude + 33.87).abs() < 1e-12 && (longitude - 151.21).abs() < 1e-12);
        assert_eq!(place("40.5 N 74 W"), Ok((40.5, -74.0)));
        assert_eq!(place("-40.5 E, 10 N"), Ok((10.0, -40.5)));
        assert_eq!(place("1e1,2"), Ok((10.0, 2.0)));
    }

    #[test]
    fn coordinates_that_contradict_themselves_are_refused() {
        for (text, part) in [
            ("-33.87° S, 151 E", "write 33.87 S or -33.87"),
            ("-74 W, 40 N", "write 74 W or -74"),
            ("33 N, 151 S", "one coordinate twice"),
            ("33 E 151 W", "one coordinate twice"),
            ("91,0", "latitude must be -90 to 90 degrees"),
            ("0,181", "longitude must be -180 to 180 degrees"),
            ("151 E, 99 S", "latitude must be"),
            ("NaN,0", "not a coordinate"),
            ("1e400,0", "latitude must be"),
            ("33 Q, 151 E", "not a coordinate"),
            ("NN33, 151 E", "not a coordinate"),
            ("33°70', 1", "not a coordinate"),
            ("--3, 1", "not a coordinate"),
            ("1", "write LAT,LON"),
            ("1,2,3", "write LAT,LON"),
            ("33°", "write LAT,LON"),
            ("Tokio", "did you mean \"Tokyo\"?"),
            ("", "write LAT,LON"),
        ] {
            let error = place(text).expect_err(text);
            assert!(error.contains(part), "{text}: {error}");
            assert_eq!(error.lines().count(), 1, "{error}");
        }
    }

    #[test]
    fn places_are_shown_with_hemispheres() {
        let text = |latitude, longitude| Place::new(latitude, longitude).unwrap().to_string();
        assert_eq!(text(-33.87, 151.21), "33.87° S, 151.21° E");
        assert_eq!(text(40.123_45, -74.0), "40.123° N, 74° W");
        assert_eq!(text(-1e-9, 0.0), "0° N, 0° E");
        assert_eq!(Axis::Latitude.parse("33.87° S"), Some(-33.87));
        assert_eq!(Axis::Longitude.parse("-151.21"), Some(-151.21));
        assert_eq!(Axis::Longitude.parse("33.87 S"), None);
    }

    #[test]
    fn a_place_has_the_zone_of_the_nearest_city_or_its_solar_hour() {
        let zone = |text: &str| Place::parse(text).unwrap().zone().to_string();
        assert_eq!(zone("tokyo"), "Asia/Tokyo");
        assert_eq!(zone("35.7,139.7"), "Asia/Tokyo");
        assert_eq!(zone("55.79,12.52"), "Europe/Copenhagen");
        assert_eq!(zone("-33.87° N, 151.21° E"), "Australia/Sydney");
        // The middle of the Pacific and of the southern Atlantic.
        assert_eq!(zone("-40,-122"), "UTC-08:00");
        assert_eq!(zone("-50,-8"), "UTC-01:00");
        assert_eq!(zone("-60,-179"), "UTC-12:00");
    }

    #[test]
    fn zones_are_read_by_name_and_offset() {
        let zone = |text: &str| Zone::parse(text).map(|zone| zone.to_string());
        for text in ["+02:00", "+0200", "+02", "+2", "UTC+2", "gmt+02:00"] {
            assert_eq!(zone(text), Ok("UTC+02:00".to_owned()), "{text}");
        }
        for text in ["Z", "z", "utc", "+00:00", "-00:00"] {
            assert_eq!(zone(text), Ok("UTC+00:00".to_owned()), "{text}");
        }
        assert_eq!(zone("-0330"), Ok("UTC-03:30".to_owned()));
        assert_eq!(zone("−03:30"), Ok("UTC-03:30".to_owned()));
        assert_eq!(zone("asia/tokyo"), Ok("Asia/Tokyo".to_owned()));
        assert_eq!(
            zone("America/Port-au-Prince"),
            Ok("America/Port-au-Prince".to_owned())
        );
        for (text, part) in [
            ("Asia/Tokio", "did you mean Asia/Tokyo?"),
            ("Tokyo", "did you mean Asia/Tokyo?"),
            ("københavn", "did you mean Europe/Copenhagen?"),
            ("+99:00", "not a UTC offset"),
            ("+2:60", "not a UTC offset"),
            ("+02:00:00", "not a UTC offset"),
            ("+é2", "not a UTC offset"),
            ("+", "not a UTC offset"),
        ] {
            let error = zone(text).expect_err(text);
            assert!(error.contains(part), "{text}: {error}");
        }
    }

    #[test]
    fn clocks_keep_summer_time() {
        let copenhagen = Zone::parse("Europe/Copenhagen").unwrap();
        let offset = |when: &str| copenhagen.clock(moment(when)).offset().local_minus_utc() / 3600;
        assert_eq!(
            (
                offset("2026-01-15T12:00:00Z"),
                offset("2026-07-15T12:00:00Z")
            ),
            (1, 2)
        );
        assert!(copenhagen.has_offset_of(moment("2026-07-15T12:00:00+02:00")));
        assert!(!copenhagen.has_offset_of(moment("2026-01-15T12:00:00+02:00")));
        for (zone, hour) in [("Australia/Sydney", 11.0), ("Asia/Kolkata", 5.5)] {
            let when = Zone::parse(zone)
                .unwrap()
                .moment(local(2026, 1, 15, 12, 0))
                .unwrap();
            assert_eq!(f64::from(when.offset().local_minus_utc()) / 3600.0, hour);
        }
        // Local mean time, +00:53:28, to the minute.
        let berlin = Zone::parse("Europe/Berlin").unwrap();
        let long_ago = berlin.moment(local(1850, 6, 21, 15, 0)).unwrap();
        assert_eq!(long_ago.to_rfc3339(), "1850-06-21T15:00:00+00:53");
        for extreme in [NaiveDateTime::MIN, NaiveDateTime::MAX] {
            copenhagen.nearest_moment(extreme);
        }
    }

    #[test]
    fn the_change_of_the_clocks_has_two_readings() {
        let copenhagen = Zone::parse("Europe/Copenhagen").unwrap();
        // Clocks are put forward on 29 March and back on 25 October.
        let skipped = copenhagen.moment(local(2026, 3, 29, 2, 30)).unwrap_err();
        assert_eq!(
            skipped,
            "2026-03-29 02:30 is skipped by the change of the clocks in Europe/Copenhagen; \
             write 2026-03-29T03:30+02:00 or 2026-03-29T01:30+01:00"
        );
        let twice = copenhagen.moment(local(2026, 10, 25, 2, 30)).unwrap_err();
        assert_eq!(
            twice,
            "2026-10-25 02:30 occurs twice by the change of the clocks in Europe/Copenhagen; \
             write 2026-10-25T02:30+02:00 or 2026-10-25T02:30+01:00"
        );
        for (time, first) in [
            (local(2026, 3, 29, 2, 30), "2026-03-29T03:30:00+02:00"),
            (local(2026, 10, 25, 2, 30), "2026-10-25T02:30:00+02:00"),
        ] {
            assert_eq!(copenhagen.nearest_moment(time), moment(first));
        }
        // A whole day was skipped when Samoa crossed the date line.
        let samoa = Zone::parse("Pacific/Apia").unwrap();
        let error = samoa.moment(local(2011, 12, 30, 12, 0)).unwrap_err();
        assert!(
            error.ends_with("write 2011-12-31T12:00+14:00 or 2011-12-29T12:00-10:00"),
            "{error}"
        );
    }
}
