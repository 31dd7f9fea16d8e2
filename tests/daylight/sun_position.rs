//! Sun positions against `shared/reference`: SPA, and the lecture's formulas with the azimuth corrected.

#![allow(clippy::unwrap_used)]

use crate::common::{Row, Table, Worst};
use chrono::{DateTime, FixedOffset};
use glam::DVec3;
use skylight::daylight::preetham::angle_between;
use skylight::daylight::sun_position::{self, SunPosition};

fn moment(row: Row<'_>) -> DateTime<FixedOffset> {
    DateTime::parse_from_rfc3339(row.text("utc")).unwrap()
}

fn true_direction(position: &SunPosition) -> DVec3 {
    sun_position::direction(position.azimuth_deg, position.elevation_deg)
}

#[test]
fn spa() {
    let Some(table) = Table::read("solar_position_reference.csv") else {
        return;
    };
    // The reference uses ΔT = 67 s for every date: differences up to 3e-4 degrees.
    let mut angle = Worst::new("SPA direction, degrees", 1e-3);
    let mut seen = Worst::new("SPA apparent elevation, degrees", 1e-3);
    for row in table.rows() {
        let (latitude, longitude) = (row.get("lat_deg"), row.get("lon_deg_east_positive"));
        let found = sun_position::spa(moment(row), latitude, longitude).unwrap();
        let expected = sun_position::direction(
            row.get("spa_azimuth_N_cw_deg"),
            row.get("spa_elevation_true_deg"),
        );
        let error = angle_between(true_direction(&found), expected).to_degrees();
        angle.see(error, format!("{} {}", row.text("site"), row.text("utc")));
        let apparent = row.get("spa_elevation_apparent_deg");
        seen.see(found.apparent_elevation_deg - apparent, row.text("utc"));
    }
    angle.finish();
    seen.finish();
}

#[test]
fn lecture_against_spa() {
    let Some(table) = Table::read("solar_position_reference.csv") else {
        return;
    };
    let mut against_spa = Worst::new("the lecture's sun against SPA, degrees", 1.3);
    let mut hours = Worst::new("solar time, hours", 1e-9);
    let mut theta = Worst::new("the lecture's zenith angle, degrees", 1e-6);
    for row in table.rows() {
        let (latitude, longitude) = (row.get("lat_deg"), row.get("lon_deg_east_positive"));
        let solar = sun_position::solar_time(moment(row), longitude);
        let at = format!("{} {}", row.text("site"), row.text("utc"));
        let found = sun_position::lecture(solar.day_of_year, solar.hours, latitude);
        let spa = sun_position::direction(
            row.get("spa_azimuth_N_cw_deg"),
            row.get("spa_elevation_true_deg"),
        );
        against_spa.see(angle_between(true_direction(&found), spa).to_degrees(), &at);
        let difference = solar.hours - row.get("slides_solar_time_h");
        hours.see((difference + 12.0).rem_euclid(24.0) - 12.0, &at);
        theta.see(
            90.0 - found.elevation_deg - row.get("slides_theta_s_deg"),
            &at,
        );
    }
    against_spa.finish();
    hours.finish();
    theta.finish();
}

#[test]
fn lecture_formulas() {
    let Some(table) = Table::read("solar_position_slides.csv") else {
        return;
    };
    let mut worst = Worst::new("the lecture's sun as a vector", 1e-9);
    let mut azimuth = Worst::new("the lecture's azimuth, degrees", 1e-7);
    for row in table.rows() {
        let day = row.text("J").parse().unwrap();
        let found = sun_position::lecture(day, row.get("t_solar_h"), row.get("lat_deg"));
        let expected = DVec3::new(row.get("east"), row.get("up"), -row.get("north"));
        worst.see(
            (true_direction(&found) - expected).abs().max_element(),
            row.index,
        );
        let turn = found.azimuth_deg - row.get("azimuth_N_cw_deg");
        azimuth.see((turn + 180.0).rem_euclid(360.0) - 180.0, row.index);
    }
    worst.finish();
    azimuth.finish();
}
