//! Moments at equal steps, and hours of days.

use std::str::FromStr;

use chrono::{DateTime, Duration, FixedOffset, NaiveTime};

use super::place::{Place, Zone};

/// Most moments of a series.
pub const MOST_MOMENTS: usize = 100_000;

/// Time from one moment of a series to the next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// Seconds, at least 1.
    Seconds(i64),
    /// Days of the clock of the place, at least 1: the same time of day, whatever its offset.
    Days(i64),
}

impl FromStr for Step {
    type Err = String;

    /// `30s`, `10min`, `2h`, `1d`.
    fn from_str(text: &str) -> Result<Self, String> {
        let text = text.trim();
        let end = text.find(|c: char| !c.is_ascii_digit());
        let (count, unit) = text.split_at(end.unwrap_or(text.len()));
        let count = count.parse::<i64>().ok();
        let count = count.filter(|count| (1..=1_000_000).contains(count));
        let step = count.and_then(|count| match unit.trim() {
            "s" => Some(Self::Seconds(count)),
            "min" => Some(Self::Seconds(60 * count)),
            "h" => Some(Self::Seconds(3600 * count)),
            "d" => Some(Self::Days(count)),
            _ => None,
        });
        step.ok_or_else(|| "write a number and s, min, h or d, for instance 10min".to_owned())
    }
}

impl Step {
    /// The moments `from`, one step later .. up to `to`, by the clock of the place; by that of `from` if that is another one.
    ///
    /// # Errors
    /// One line: `to` is before `from`, or there are more than [`MOST_MOMENTS`].
    pub fn moments(
        self,
        from: DateTime<FixedOffset>,
        to: DateTime<FixedOffset>,
        place: Place,
    ) -> Result<Vec<DateTime<FixedOffset>>, String> {
        if to < from {
            return Err(format!(
                "the end, {}, is before the start, {}",
                to.to_rfc3339(),
                from.to_rfc3339()
            ));
        }
        let own = place.zone();
        let zone = if own.has_offset_of(from) {
            own
        } else {
            Zone::Offset(*from.offset())
        };
        let mut all = Vec::new();
        for count in 0.. {
            let moment = match self {
                Self::Seconds(seconds) => {
                    from.checked_add_signed(Duration::seconds(seconds * count))
                }
                Self::Days(days) => {
                    let local = zone.clock(from).naive_local();
                    let later = local.checked_add_signed(Duration::days(days * count));
                    later.map(|local| zone.nearest_moment(local))
                }
            };
            match moment.map(|moment| zone.clock(moment)) {
                Some(moment) if moment <= to => all.push(moment),
                _ => return Ok(all),
            }
            if all.len() > MOST_MOMENTS {
                break;
            }
        }
        Err(format!(
            "more than {MOST_MOMENTS} moments; take a longer step or a shorter time"
        ))
    }
}

/// A time of day: `9`, `9:30`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DayTime(pub NaiveTime);

impl FromStr for DayTime {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (hour, minute) = text.trim().split_once(':').unwrap_or((text.trim(), "0"));
        let numbers = hour.parse().ok().zip(minute.parse().ok());
        let time = numbers.and_then(|(hour, minute)| NaiveTime::from_hms_opt(hour, minute, 0));
        time.map(Self)
            .ok_or_else(|| "write an hour, for instance 9 or 9:30".to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moments(step: &str, from: &str, to: &str) -> Result<Vec<String>, String> {
        let [from, to] = [from, to].map(|text| DateTime::parse_from_rfc3339(text).expect(text));
        let place = Place::parse("copenhagen").expect("a city");
        let all = step.parse::<Step>()?.moments(from, to, place)?;
        Ok(all.iter().map(DateTime::to_rfc3339).collect())
    }

    #[test]
    fn steps_run_to_the_end_and_no_further() {
        let [start, end] = ["2026-06-21T10:00:00+02:00", "2026-06-21T10:25:00+02:00"];
        let all = moments("10min", start, end).expect("moments");
        let expected = ["10:00", "10:10", "10:20"].map(|t| format!("2026-06-21T{t}:00+02:00"));
        assert_eq!(all, expected);
        assert_eq!(moments("1h", start, start).expect("one"), [start]);
        let error = moments("1h", end, start).expect_err("backward");
        assert!(error.contains("is before the start"), "{error}");
        let error = moments("1s", start, "2027-06-21T10:25:00+02:00").expect_err("many");
        assert!(error.contains("more than 100000 moments"), "{error}");
    }

    #[test]
    fn days_keep_the_time_of_the_clock_and_hours_keep_their_length() {
        // The clocks of Copenhagen go forward on 29 March 2026.
        let [start, end] = ["2026-03-28T12:00:00+01:00", "2026-03-30T12:00:00+02:00"];
        let days = moments("1d", start, end).expect("moments");
        let noon = [
            "28T12:00:00+01:00",
            "29T12:00:00+02:00",
            "30T12:00:00+02:00",
        ];
        assert_eq!(days, noon.map(|t| format!("2026-03-{t}")));
        let hours = moments("24h", start, end).expect("moments");
        assert_eq!(hours[1], "2026-03-29T13:00:00+02:00");
        // Somebody else's clock stays.
        let elsewhere = moments("24h", "2026-03-28T12:00:00+09:00", end).expect("moments");
        assert_eq!(elsewhere[1], "2026-03-29T12:00:00+09:00");
    }

    #[test]
    fn what_is_no_step_and_no_hour_is_told() {
        for text in ["", "10", "min", "0min", "-1h", "1.5h", "10m", "9999999s"] {
            assert!(text.parse::<Step>().is_err(), "{text}");
        }
        for text in ["", "24", "9:60", "noon", "9.5", "-1"] {
            assert!(text.parse::<DayTime>().is_err(), "{text}");
        }
        let half = "9:30".parse::<DayTime>().expect("half past nine");
        assert_eq!(half.0.to_string(), "09:30:00");
    }
}
