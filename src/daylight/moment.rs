//! Moments in the forms that people write: with a UTC offset, with a time zone, or in local time of the place.

use std::str::FromStr;

use chrono::{DateTime, FixedOffset, NaiveDate, NaiveDateTime, NaiveTime, Timelike};

use super::place::{Place, Zone};
use super::sun_position::{SunPositionError, YEARS};

const FORM: &str = "write a date and a time, for instance 2026-06-21T15:00+02:00, 2026-06-21 15:00 Europe/Copenhagen, or \
                    2026-06-21 15:00 (local time of the place)";

/// The default moment: 15:00 local time on 21 June 2026.
pub fn default_moment(place: Place) -> DateTime<FixedOffset> {
    let date = NaiveDate::from_ymd_opt(2026, 6, 21).unwrap_or_default();
    let time = NaiveTime::from_hms_opt(15, 0, 0).unwrap_or_default();
    place.zone().nearest_moment(date.and_time(time))
}

/// A date and time as given.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum When {
    /// With a UTC offset or a time zone.
    Moment(DateTime<FixedOffset>),
    /// Without either: local time of the place.
    Local(NaiveDateTime),
}

impl When {
    /// The moment, at this place.
    ///
    /// # Errors
    /// One line with both readings of a local time that a clock change repeats or skips.
    pub fn at(self, place: Place) -> Result<DateTime<FixedOffset>, String> {
        match self {
            Self::Moment(moment) => Ok(moment),
            Self::Local(local) => place.zone().moment(local),
        }
    }
}

impl std::fmt::Display for When {
    /// As it is read.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Moment(moment) => f.write_str(&moment.to_rfc3339()),
            Self::Local(local) => write!(f, "{}", local.format("%Y-%m-%dT%H:%M:%S%.f")),
        }
    }
}

impl FromStr for When {
    type Err = String;

    /// `DATE TIME [ZONE]`: RFC 3339, where the seconds, the `T` and the offset's minutes are optional, and the offset may be
    /// omitted or replaced by the name of a time zone. A leap second is second 60 of 23:59 UTC.
    fn from_str(text: &str) -> Result<Self, String> {
        let text = text.trim();
        let at = text.find(['T', 't', ' ']).unwrap_or(text.len());
        let date = date(&text[..at])?;
        let rest = text[at..].trim_start_matches(['T', 't', ' ']);
        let is_clock = |c: char| c.is_ascii_digit() || c == ':' || c == '.';
        let end = rest.find(|c| !is_clock(c)).unwrap_or(rest.len());
        let (clock, zone) = (&rest[..end], rest[end..].trim());
        if clock.is_empty() {
            return Err(if rest.is_empty() {
                format!("the time is missing; {FORM}")
            } else {
                FORM.to_owned()
            });
        }
        let (local, is_leap) = time(clock)?;
        let local = date.and_time(local);
        let given = if zone.is_empty() {
            Self::Local(local)
        } else {
            Self::Moment(zoned(local, zone)?)
        };
        if is_leap {
            return leap_second(given, clock);
        }
        Ok(given)
    }
}

/// The moment of a local time in a zone: a name, an offset, or both as in RFC 9557, `+09:00[Asia/Tokyo]`.
fn zoned(local: NaiveDateTime, text: &str) -> Result<DateTime<FixedOffset>, String> {
    let in_brackets = text.strip_suffix(']').and_then(|text| text.split_once('['));
    let (offset, name) = in_brackets.unwrap_or((text, ""));
    if offset.is_empty() {
        return Zone::parse(name)?.moment(local);
    }
    let moment = Zone::parse(offset)?.moment(local)?;
    if !name.is_empty() && !Zone::parse(name)?.has_offset_of(moment) {
        return Err(format!(
            "clocks in {name} have another UTC offset than {offset} then; leave one out"
        ));
    }
    Ok(moment)
}

/// `2026-06-21`, within [`YEARS`].
fn date(text: &str) -> Result<NaiveDate, String> {
    let minus = text.strip_prefix(['-', '−']);
    let unsigned = minus.or(text.strip_prefix('+')).unwrap_or(text);
    let numbers: Option<Vec<i32>> = unsigned.split('-').map(digits).collect();
    let Some(&[year, month, day]) = numbers.as_deref() else {
        return Err(FORM.to_owned());
    };
    let year = if minus.is_some() { -year } else { year };
    if !YEARS.contains(&year) {
        return Err(SunPositionError::Year(year).to_string());
    }
    let date = NaiveDate::from_ymd_opt(year, month as u32, day as u32);
    date.ok_or_else(|| format!("{text} is a date that does not exist"))
}

/// `15`, `15:00`, `15:00:30.5`, and whether it is a leap second (second 60, returned as 59).
fn time(text: &str) -> Result<(NaiveTime, bool), String> {
    let (clock, fraction) = text.split_once('.').unwrap_or((text, ""));
    let numbers: Option<Vec<i32>> = clock.split(':').map(digits).collect();
    let (hour, minute, second) = match numbers.as_deref() {
        Some([hour]) if fraction.is_empty() => (*hour, 0, 0),
        Some([hour, minute]) if fraction.is_empty() => (*hour, *minute, 0),
        Some([hour, minute, second]) => (*hour, *minute, *second),
        _ => return Err(FORM.to_owned()),
    };
    let wrong = || format!("{text} is a time that does not exist");
    let nanoseconds: u32 = format!("{fraction:0<9.9}").parse().map_err(|_| FORM)?;
    let is_leap = second == 60;
    let second = second - i32::from(is_leap);
    let time = NaiveTime::from_hms_nano_opt(hour as u32, minute as u32, second as u32, nanoseconds);
    Ok((time.ok_or_else(wrong)?, is_leap))
}

/// Up to nine digits and nothing else.
fn digits(text: &str) -> Option<i32> {
    let is_number = (1..=9).contains(&text.len()) && text.bytes().all(|b| b.is_ascii_digit());
    is_number.then(|| text.parse().ok()).flatten()
}

/// The leap second (second 60) after the given second 59.
fn leap_second(given: When, text: &str) -> Result<When, String> {
    let longer = |time: NaiveTime| time.with_nanosecond(time.nanosecond() + 1_000_000_000);
    let When::Moment(before) = given else {
        return Err(format!(
            "{text} is a leap second, which needs a UTC offset or a time zone"
        ));
    };
    let utc = before.naive_utc();
    let is_last = (utc.hour(), utc.minute(), utc.second()) == (23, 59, 59);
    let leap = longer(utc.time()).filter(|_| is_last);
    let leap = leap.ok_or_else(|| {
        format!("{text} is a time that does not exist; leap seconds follow 23:59:59 UTC")
    })?;
    Ok(When::Moment(DateTime::from_naive_utc_and_offset(
        utc.date().and_time(leap),
        *before.offset(),
    )))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moment(text: &str, place: &str) -> Result<String, String> {
        let when: When = text.parse()?;
        Ok(when.at(Place::parse(place)?)?.to_rfc3339())
    }

    #[test]
    fn an_afternoon_in_june_by_the_clocks_of_the_place() {
        for (place, expected) in [
            ("55.79,12.52", "2026-06-21T15:00:00+02:00"),
            ("tokyo", "2026-06-21T15:00:00+09:00"),
            ("sydney", "2026-06-21T15:00:00+10:00"),
            ("los angeles", "2026-06-21T15:00:00-07:00"),
            ("-40,-122", "2026-06-21T15:00:00-08:00"),
        ] {
            let when = default_moment(Place::parse(place).unwrap());
            assert_eq!(when.to_rfc3339(), expected, "{place}");
        }
    }

    #[test]
    fn moments_that_are_nearly_right_are_understood() {
        for text in [
            "2026-06-21T14:00+02:00",
            "2026-06-21T14:00:00+02:00",
            "2026-06-21T14:00:00.000+02:00",
            "2026-06-21 14:00:00+02:00",
            " 2026-06-21  14:00 +02:00 ",
            "2026-06-21t14:00+02",
            "2026-06-21T14:00+0200",
            "2026-06-21T14:00+2",
            "2026-6-21T14+02:00",
            "2026-06-21 14:00 UTC+2",
            "2026-06-21 14:00 Europe/Copenhagen",
            "2026-06-21 14:00 europe/copenhagen",
            "2026-06-21T14:00[Europe/Copenhagen]",
            "2026-06-21T14:00+02:00[Europe/Copenhagen]",
            "2026-06-21T14:00",
            "2026-06-21 14:00",
        ] {
            let found = moment(text, "copenhagen");
            assert_eq!(found.as_deref(), Ok("2026-06-21T14:00:00+02:00"), "{text}");
        }
        for text in [
            "2026-06-21T12:00Z",
            "2026-06-21t12:00z",
            "2026-06-21 12:00 utc",
        ] {
            let found = moment(text, "copenhagen");
            assert_eq!(found.as_deref(), Ok("2026-06-21T12:00:00+00:00"), "{text}");
        }
    }

    #[test]
    fn local_times_are_those_of_the_place() {
        let found = |text| moment(text, "tokyo").unwrap();
        assert_eq!(found("2026-12-21T15:00"), "2026-12-21T15:00:00+09:00");
        assert_eq!(
            found("2026-12-21 15:00 Asia/Tokyo"),
            "2026-12-21T15:00:00+09:00"
        );
        assert_eq!(
            found("2026-12-21 15:00 Europe/Paris"),
            "2026-12-21T15:00:00+01:00"
        );
        let error = moment("2026-10-25 02:30", "oslo").expect_err("twice");
        assert!(
            error.contains("write 2026-10-25T02:30+02:00 or 2026-10-25T02:30+01:00"),
            "{error}"
        );
        let readings = ["2026-10-25T02:30+02:00", "2026-10-25T02:30+01:00"];
        let [first, second] = readings.map(|text| moment(text, "oslo").unwrap());
        assert_ne!(first, second);
        let error = moment("2026-03-29 02:30 Europe/Oslo", "tokyo").expect_err("skipped");
        assert!(
            error.contains("write 2026-03-29T03:30+02:00 or 2026-03-29T01:30+01:00"),
            "{error}"
        );
    }

    #[test]
    fn what_is_written_is_read_again() {
        for text in [
            "2026-06-21T14:00:00+02:00",
            "2026-06-21T14:00:00",
            "2026-06-21T14:00:00.250",
            "2016-12-31T23:59:60+00:00",
        ] {
            assert_eq!(text.parse::<When>().expect(text).to_string(), text);
        }
    }

    #[test]
    fn leap_seconds_and_the_first_and_last_year_are_moments() {
        for text in [
            "2016-12-31T23:59:60+00:00",
            "2017-01-01T05:29:60.500+05:30",
            "-0500-01-01T00:00:00+00:00",
            "3000-12-31T23:59:59+00:00",
        ] {
            assert_eq!(moment(text, "oslo").as_deref(), Ok(text));
        }
        let zulu = moment("2016-12-31T23:59:60Z", "oslo");
        assert_eq!(zulu.as_deref(), Ok("2016-12-31T23:59:60+00:00"));
    }

    #[test]
    fn what_is_no_moment_is_told_in_one_line() {
        for (text, part) in [
            (
                "2026-02-30T12:00+01:00",
                "2026-02-30 is a date that does not exist",
            ),
            ("2025-02-29T12:00:00Z", "does not exist"),
            ("2026-13-01T12:00Z", "does not exist"),
            (
                "2026-06-21T25:00+02:00",
                "25:00 is a time that does not exist",
            ),
            ("2026-06-21T12:60Z", "12:60 is a time that does not exist"),
            ("2026-06-21T12:00:61Z", "does not exist"),
            ("2026-06-21T12:00:60Z", "leap seconds follow 23:59:59 UTC"),
            ("2026-06-21T23:59:60", "needs a UTC offset"),
            ("2026-06-21", "the time is missing"),
            ("2026-06-21T", "the time is missing"),
            ("tomorrow", "write a date"),
            ("", "write a date"),
            ("99999999999-01-01T00:00Z", "write a date"),
            ("2026-06-21T14:00:00:00Z", "write a date"),
            ("2026-06-21T14.5Z", "write a date"),
            ("2026-06-21T14:00+99:00", "not a UTC offset"),
            ("2026-06-21T14:00 Mars/Phobos", "is not a time zone"),
            ("2026-06-21T14:00+03:00[Europe/Oslo]", "another UTC offset"),
            ("3001-01-01T00:00Z", "the years -500 to 3000"),
            ("-501-01-01T00:00Z", "the years -500 to 3000"),
            ("+262142-12-31T23:59Z", "the years -500 to 3000"),
        ] {
            let error = moment(text, "oslo").expect_err(text);
            assert!(error.contains(part), "{text}: {error}");
            assert_eq!(error.lines().count(), 1, "{error}");
        }
    }
}
