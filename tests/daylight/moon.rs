//! The moon against `shared/sky/moon.csv`: 20 moments at 5 places, by three programs that agree within 0.0022°.

use crate::common::{Table, Worst};
use chrono::{DateTime, NaiveDateTime};
use skylight::daylight::moon::Moon;
use skylight::daylight::sun_position::{direction, spa};

#[test]
fn the_moon_is_where_and_as_full_as_the_almanacs_say() {
    let Some(table) = Table::at("sky/moon.csv") else {
        return;
    };
    let mut place = Worst::new("moon's position, degrees", 0.01);
    let mut altitude = Worst::new("moon's elevation, degrees", 0.01);
    let mut fraction = Worst::new("moon's lit fraction", 0.001);
    let mut phase = Worst::new("moon's phase angle, degrees", 0.02);
    let mut distance = Worst::new("moon's distance, relative", 3e-4);
    let mut magnitude = Worst::new("moon's magnitude up to 120° from full", 0.25);
    for row in table.rows() {
        let at = format!("{} {}", row.text("utc"), row.text("place"));
        let when: NaiveDateTime = row.text("utc").parse().expect("a moment");
        let when: DateTime<_> = when.and_utc().fixed_offset();
        let (latitude, longitude) = (row.get("lat_deg"), row.get("lon_deg_east"));
        let moon = Moon::at(when, latitude, longitude).expect("in range");
        let sun = spa(when, latitude, longitude).expect("in range");
        let expected = direction(row.get("moon_az"), row.get("moon_alt"));
        let found = direction(moon.azimuth_deg, moon.elevation_deg);
        place.see(found.angle_between(expected).to_degrees(), &at);
        altitude.see(moon.elevation_deg - row.get("moon_alt"), &at);
        place.see(
            direction(sun.azimuth_deg, sun.elevation_deg)
                .angle_between(direction(row.get("sun_az"), row.get("sun_alt")))
                .to_degrees(),
            format!("the sun at {at}"),
        );
        fraction.see(
            moon.illuminated_fraction() - row.get("illuminated_fraction"),
            &at,
        );
        phase.see(moon.phase_angle_deg - row.get("phase_angle_deg"), &at);
        distance.see(moon.distance_km / row.get("moon_distance_km") - 1.0, &at);
        if moon.phase_angle_deg < 120.0 {
            magnitude.see(moon.magnitude() - row.get("ae_mag"), &at);
        }
    }
    place.finish();
    altitude.finish();
    fraction.finish();
    phase.finish();
    distance.finish();
    magnitude.finish();
}
