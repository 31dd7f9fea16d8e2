//! Clouds before a clear sky: how much light sky and sun lose and gain with the cover.
//!
//! Kasten & Czeplak 1980, *Solar and terrestrial radiation dependent on the amount and type of cloud* (ten years of hourly values,
//! Hamburg), for a cover c of 0..=1 (their N oktas are c = N/8):
//!
//! - global illuminance G(c) = G(0) (1 - 0.75 c^3.4);
//! - share of the sky in it k(c) = 0.3 + 0.7 c². Their clear sky has 0.3; here k(0) is that of the clear model at this moment,
//!   so that no cloud changes nothing: k(c) = k(0) + (1 - k(0)) c².
//!
//! The clear model shows between the clouds with the weight 1 - c; what is left of the sky's illuminance has the luminances of
//! the CIE overcast sky. So a cover has no place in the sky and no edges: it is what many such hours are in the mean. The
//! relation is one of irradiances; the luminous efficacy of daylight, which is some 5 to 10 % higher under clouds, is left out.

/// Light of sky and sun under clouds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clouded {
    /// Factor on the light of the sun, 0..=1.
    pub sun: f64,
    /// Factor on the clear sky, 0..=1.
    pub clear_sky: f64,
    /// Horizontal illuminance by the clouds, lux.
    pub clouds_lux: f64,
}

/// The light under a cover of 0..=1, from the horizontal illuminances by the clear sky and by the sun without clouds, lux.
pub fn clouded(cover: f64, sky_lux: f64, sun_lux: f64) -> Clouded {
    let dimming = 1.0 - 0.75 * cover.powf(3.4);
    let sun = dimming * (1.0 - cover * cover);
    let global = dimming * (sky_lux + sun_lux);
    let sky = global - sun * sun_lux;
    Clouded {
        sun,
        clear_sky: 1.0 - cover,
        clouds_lux: sky - (1.0 - cover) * sky_lux,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_cloud_changes_nothing_and_a_full_cover_leaves_a_quarter() {
        let open = clouded(0.0, 12_000.0, 60_000.0);
        assert_eq!((open.sun, open.clear_sky, open.clouds_lux), (1.0, 1.0, 0.0));
        let full = clouded(1.0, 12_000.0, 60_000.0);
        assert_eq!((full.sun, full.clear_sky), (0.0, 0.0));
        assert!((full.clouds_lux / 18_000.0 - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_sky_of_three_tenths_has_the_published_shares() {
        let (sky, sun) = (3000.0, 7000.0);
        for oktas in 0..=8 {
            let cover = f64::from(oktas) / 8.0;
            let found = clouded(cover, sky, sun);
            let diffuse = found.clear_sky * sky + found.clouds_lux;
            let global = diffuse + found.sun * sun;
            let expected = 1.0 - 0.75 * cover.powf(3.4);
            assert!((global / (sky + sun) / expected - 1.0).abs() < 1e-12);
            let share = 0.3 + 0.7 * cover * cover;
            assert!((diffuse / global / share - 1.0).abs() < 1e-12, "{oktas}");
        }
    }

    #[test]
    fn clouds_never_take_light_that_is_not_there() {
        for sky_share in [0.0, 0.1, 0.5, 1.0] {
            for step in 0..=100 {
                let found = clouded(f64::from(step) / 100.0, sky_share, 1.0 - sky_share);
                assert!(found.clouds_lux >= -1e-12, "{sky_share} {step} {found:?}");
            }
        }
    }
}
