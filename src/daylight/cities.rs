//! Cities by name, with their time zones.
//!
//! Names match regardless of case and accents: `sao` finds São Paulo, `koln` Cologne.

use chrono_tz::Tz;
use deunicode::deunicode;

pub use super::data::cities::CITIES;
use super::sun_position::direction;

/// Mean radius of the earth, km.
const EARTH_RADIUS_KM: f64 = 6371.0;

/// Jaro-Winkler similarity from which a name may be a misspelt one.
const LEAST_LIKENESS: f64 = 0.78;

/// A city of the list.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct City {
    /// English name.
    pub name: &'static str,
    /// An alternative name, such as the local or a former one; may be empty.
    pub other_name: &'static str,
    /// ISO 3166-1 code of the country or territory, two letters.
    pub country: &'static str,
    /// Degrees, positive north.
    pub latitude: f64,
    /// Degrees, positive east.
    pub longitude: f64,
    /// Time zone of the IANA database.
    pub zone: Tz,
}

impl City {
    fn names(&self) -> impl Iterator<Item = String> {
        [self.name, self.other_name]
            .into_iter()
            .filter(|name| !name.is_empty())
            .map(folded)
    }
}

/// A name in lower case, without accents and surrounding blanks.
fn folded(text: &str) -> String {
    deunicode(text.trim()).to_lowercase()
}

/// Cities whose names begin with `text`, then those with a word that begins with it, then those that contain it; each group
/// sorted by name. All cities if the text is empty.
pub fn search(text: &str) -> Vec<&'static City> {
    let wanted = folded(text);
    let rank = |city: &City| {
        let ranks = city.names().filter_map(|name| {
            let at = name.find(&wanted)?;
            let word = name.contains(&format!(" {wanted}"));
            Some(if at == 0 { 0 } else { 2 - u8::from(word) })
        });
        ranks.min()
    };
    let mut found: Vec<(u8, String, &City)> = CITIES
        .iter()
        .filter_map(|city| Some((rank(city)?, folded(city.name), city)))
        .collect();
    found.sort_by(|a, b| (a.0, &a.1).cmp(&(b.0, &b.1)));
    found.into_iter().map(|(_, _, city)| city).collect()
}

/// The city of this name.
///
/// # Errors
/// One line that suggests the most similar city name, if one is similar.
pub fn named(text: &str) -> Result<&'static City, String> {
    let wanted = folded(text);
    if let Some(city) = CITIES
        .iter()
        .find(|city| city.names().any(|name| name == wanted))
    {
        return Ok(city);
    }
    let text = text.trim();
    let like = || Some(alike(&wanted)).filter(|city| likeness(city, &wanted) >= LEAST_LIKENESS);
    match search(&wanted).first().copied().or_else(like) {
        Some(City { name, .. }) => Err(format!(
            "\"{text}\" is not a listed city; did you mean \"{name}\"? Otherwise write LAT,LON in degrees"
        )),
        None => Err(format!(
            "\"{text}\" is none of the {} listed cities; write LAT,LON in degrees, for instance 55.64,12.08",
            CITIES.len()
        )),
    }
}

/// Jaro-Winkler similarity, 0..1, of the most similar name of a city to a folded text.
fn likeness(city: &City, wanted: &str) -> f64 {
    let all = city.names().map(|name| strsim::jaro_winkler(&name, wanted));
    all.fold(0.0, f64::max)
}

/// The city whose name is most similar to `text` (Jaro-Winkler similarity).
pub fn alike(text: &str) -> &'static City {
    let wanted = folded(text);
    let best = CITIES
        .iter()
        .max_by(|a, b| likeness(a, &wanted).total_cmp(&likeness(b, &wanted)));
    best.unwrap_or(&CITIES[0])
}

/// The city nearest to a place (degrees), and its distance, km.
pub fn nearest(latitude: f64, longitude: f64) -> (&'static City, f64) {
    // Longitude and latitude map to a direction like azimuth and elevation.
    let here = direction(longitude, latitude);
    let distance = |city: &City| {
        let there = direction(city.longitude, city.latitude);
        EARTH_RADIUS_KM * here.angle_between(there)
    };
    let mut best = (&CITIES[0], distance(&CITIES[0]));
    for city in &CITIES[1..] {
        let km = distance(city);
        if km < best.1 {
            best = (city, km);
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use chrono::{DateTime, Offset};
    use std::collections::HashSet;

    fn names(text: &str) -> Vec<&'static str> {
        search(text).iter().map(|city| city.name).collect()
    }

    #[test]
    fn the_list_is_sound() {
        let mut seen = HashSet::new();
        for city in CITIES {
            assert!(city.latitude.abs() <= 90.0 && city.longitude.abs() <= 180.0);
            assert!(
                city.country.len() == 2 && city.country.chars().all(|c| c.is_ascii_uppercase())
            );
            for name in city.names() {
                assert!(seen.insert(name.clone()), "{name} is there twice");
                let parts = name.split(',').count();
                assert!(
                    parts == 1 && name.starts_with(char::is_alphabetic),
                    "{name}"
                );
                assert_eq!(named(&name), Ok(city));
            }
            // A zone's meridian is within some 45° of its cities; a wrong sign or column would be farther off.
            let noon = DateTime::parse_from_rfc3339("2026-01-01T12:00:00Z").unwrap();
            let offset = noon.with_timezone(&city.zone).offset().fix();
            let offset_h = f64::from(offset.local_minus_utc()) / 3600.0;
            let off = (offset_h - city.longitude / 15.0 + 12.0).rem_euclid(24.0) - 12.0;
            let pole = city.latitude == -90.0;
            assert!(
                pole || off.abs() < 3.2,
                "{}: {off} h from its sun",
                city.name
            );
        }
        println!("{} cities", CITIES.len());
        assert!(CITIES.len() >= 200);
        for (low, high) in [
            (-91.0, -60.0),
            (-60.0, -30.0),
            (-30.0, 0.0),
            (0.0, 30.0),
            (30.0, 60.0),
            (60.0, 90.0),
        ] {
            let band = CITIES
                .iter()
                .filter(|c| c.latitude > low && c.latitude <= high);
            assert!(band.count() > 1, "{low}..{high}");
        }
    }

    #[test]
    fn searches_forgive_case_and_accents() {
        assert_eq!(names("sao"), ["São Paulo"]);
        assert_eq!(names("  ZÜR "), ["Zürich"]);
        assert_eq!(names("zur"), ["Zürich"]);
        assert_eq!(names("Tromso"), ["Tromsø"]);
        assert_eq!(names("københ"), ["Copenhagen"]);
        assert_eq!(names("kobenh"), ["Copenhagen"]);
        assert_eq!(names("xyzzy"), [""; 0]);
        assert_eq!(search("").len(), CITIES.len());
    }

    #[test]
    fn beginnings_come_first() {
        // Matches at the start of names, then at the start of words, then inside words.
        let found = names("port");
        let at = |name: &str| found.iter().position(|n| *n == name).expect(name);
        assert_eq!(&found[..3], ["Port Louis", "Port Moresby", "Portland"]);
        let found_or = names("or");
        let first_inside = found_or.iter().position(|n| *n == "New York").unwrap();
        assert!(found_or.iter().position(|n| *n == "New Orleans").unwrap() < first_inside);
        assert!(at("Porto") < found.len());
    }

    #[test]
    fn a_name_is_a_place_or_a_suggestion() {
        assert_eq!(named("copenhagen").map(|c| c.latitude), Ok(55.68));
        assert_eq!(named("SAO PAULO").map(|c| c.country), Ok("BR"));
        for (wrong, right) in [
            ("copenhagn", "Copenhagen"),
            ("kopenhagen", "Copenhagen"),
            ("copen", "Copenhagen"),
            ("Sidney", "Sydney"),
            ("reykjavic", "Reykjavík"),
            ("los angelos", "Los Angeles"),
        ] {
            let error = named(wrong).expect_err(wrong);
            assert!(
                error.contains(&format!("did you mean \"{right}\"?")),
                "{error}"
            );
            assert_eq!(error.lines().count(), 1);
        }
        // Nothing is like it: Oslo is no help.
        let error = named("Roskilde").expect_err("not listed");
        assert!(
            error.contains("\"Roskilde\" is none of the 275 listed cities; write LAT,LON"),
            "{error}"
        );
    }

    #[test]
    fn the_nearest_city_may_be_over_the_date_line() {
        let (city, km) = nearest(55.7, 12.55);
        assert_eq!(city.name, "Copenhagen");
        assert!(km < 5.0, "{km}");
        assert_eq!(nearest(-18.0, -179.9).0.name, "Suva");
        let (pole, km) = nearest(-90.0, 77.0);
        assert_eq!(pole.name, "South Pole");
        assert!(km < 1e-6, "{km}");
        let (_, lyngby) = nearest(55.79, 12.52);
        assert!(lyngby < 1.0);
    }
}
