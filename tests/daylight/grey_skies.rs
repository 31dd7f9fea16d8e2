//! The standard skies of the CIE and the measured sky of Perez against reference values: `shared/daylight/cie`, `perez`.

#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;

use crate::common::{Row, Table, Worst};
use glam::DVec3;
use skylight::daylight::cie::standard_sky;
use skylight::daylight::grey_sky::GreySky;
use skylight::daylight::perez::{AllWeather, Measured};
use skylight::daylight::quadrature::SphereQuadrature;
use skylight::daylight::sun_position::direction;
use skylight::daylight::{Conditions, Daylight, SkyModel, colour::luminance};

/// The models cie-1 to cie-15, in order.
const GENERAL: [SkyModel; 15] = [
    SkyModel::Cie1,
    SkyModel::Cie2,
    SkyModel::Cie3,
    SkyModel::Cie4,
    SkyModel::Cie5,
    SkyModel::Cie6,
    SkyModel::Cie7,
    SkyModel::Cie8,
    SkyModel::Cie9,
    SkyModel::Cie10,
    SkyModel::Cie11,
    SkyModel::Cie12,
    SkyModel::Cie13,
    SkyModel::Cie14,
    SkyModel::Cie15,
];

fn lux_up(fine: &SphereQuadrature, daylight: &Daylight) -> f64 {
    luminance(fine.irradiance(DVec3::Y, |dir| daylight.sky_radiance(dir)))
}

#[test]
fn the_general_skies_are_those_of_the_standard() {
    let Some(table) = Table::at("daylight/cie/cie15.csv") else {
        return;
    };
    let mut relative = Worst::new("CIE skies, L/L_z, relative", 1e-5);
    let mut absolute = Worst::new("CIE skies of 10 000 lux, relative", 1e-5);
    for row in table.rows() {
        let number = row.get("type") as u8;
        let sun = direction(row.get("sun_azi"), row.get("sun_alt"));
        let view = direction(row.get("azi"), row.get("alt"));
        let sky = GreySky::new(standard_sky(number).distribution, sun, 10_000.0);
        let found = sky.radiance(view).x;
        let at = || format!("type {number}, row {}", row.index);
        let ratio = found / sky.radiance(DVec3::Y).x;
        relative.see(ratio / row.get("L_over_Lz") - 1.0, at());
        let conditions = Conditions {
            model: GENERAL[usize::from(number) - 1],
            sun_azimuth_deg: row.get("sun_azi"),
            sun_elevation_deg: row.get("sun_alt"),
            horizontal_illuminance: Some(10_000.0),
            ..Conditions::default()
        };
        let whole = luminance(Daylight::new(&conditions).sky_radiance(view));
        absolute.see(whole / row.get("L_cd_m2_for_10000_lx") - 1.0, at());
    }
    relative.finish();
    absolute.finish();
}

#[test]
fn the_zeniths_are_those_of_the_standard() {
    let Some(table) = Table::at("daylight/cie/cie15_zenith.csv") else {
        return;
    };
    let mut worst = Worst::new("CIE skies, L_z/E, relative", 1e-5);
    for row in table.rows() {
        // Type 16 has no sun: a dash.
        let angle = |name| row.text(name).parse().unwrap_or(50.0);
        let sun = direction(angle("sun_azi"), angle("sun_alt"));
        let sky = GreySky::new(standard_sky(row.get("type") as u8).distribution, sun, 1.0);
        let ratio = sky.radiance(DVec3::Y).x / row.get("Lz_over_Ed_per_sr");
        worst.see(ratio - 1.0, row.index);
    }
    worst.finish();
}

fn measured(row: Row<'_>) -> Measured {
    let (month, day) = (row.get("month") as u32, row.get("day") as u32);
    let date = chrono::NaiveDate::from_ymd_opt(2019, month, day).unwrap();
    Measured {
        direct_normal_w: row.get("dni"),
        diffuse_horizontal_w: row.get("dhi"),
        dew_point_c: Some(row.get("td_C")),
        day_of_year: Some(chrono::Datelike::ordinal(&date)),
    }
}

fn sky_of_the_hour(row: Row<'_>) -> Conditions {
    Conditions {
        model: SkyModel::Perez,
        sun_azimuth_deg: row.get("spa_azi"),
        sun_elevation_deg: row.get("spa_alt"),
        measured: measured(row),
        ..Conditions::default()
    }
}

#[test]
fn measured_hours_have_the_coefficients_and_efficacies_of_the_papers() {
    let Some(table) = Table::at("daylight/perez/hours.csv") else {
        return;
    };
    // The file has five digits, and four of the position of the sun.
    let mut state = Worst::new("Perez: ε, Δ, efficacies and illuminances, relative", 3e-4);
    let mut form = Worst::new("Perez: coefficients a to e", 1e-3);
    for row in table.rows() {
        let found = AllWeather::new(&measured(row), row.get("spa_alt"));
        for (name, value) in [
            ("epsilon", found.clearness),
            ("delta", found.brightness),
            ("K_diffuse", found.diffuse_efficacy),
            ("K_direct", found.direct_efficacy),
            ("Edh_lx", found.diffuse_horizontal_lux),
            ("Edn_lx", found.direct_normal_lux),
        ] {
            let expected = row.get(name);
            let error = (value - expected).abs() / expected.max(1.0);
            state.see(error, format!("{name} of case {}", row.text("case")));
        }
        let [a, b, _] = found.distribution.gradation;
        let [_, c, d, e] = found.distribution.indicatrix;
        for (name, value) in [("a", a), ("b", b), ("c", c), ("d", d), ("e", e)] {
            let error = value - row.get(name);
            form.see(error, format!("{name} of case {}", row.text("case")));
        }
    }
    state.finish();
    form.finish();
}

#[test]
fn measured_hours_have_the_luminances_of_the_paper() {
    let (Some(hours), Some(table)) = (
        Table::at("daylight/perez/hours.csv"),
        Table::at("daylight/perez/luminance.csv"),
    ) else {
        return;
    };
    let skies: BTreeMap<&str, Daylight> = hours
        .rows()
        .map(|row| (row.text("case"), Daylight::new(&sky_of_the_hour(row))))
        .collect();
    let mut worst = Worst::new("Perez' luminances, relative", 5e-3);
    for row in table.rows() {
        let view = direction(row.get("azi"), row.get("alt"));
        let found = luminance(skies[row.text("case")].sky_radiance(view));
        let expected = row.get("perez_cd_m2");
        worst.see(
            (found - expected) / expected.max(1.0),
            format!("case {}, row {}", row.text("case"), row.index),
        );
    }
    worst.finish();
}

#[test]
fn sky_and_sun_close_with_the_illuminances_of_the_measurement() {
    let Some(table) = Table::at("daylight/perez/hours.csv") else {
        return;
    };
    let fine = SphereQuadrature::upper(150, 280);
    let mut sky = Worst::new("Perez' sky against its illuminance, relative", 1e-4);
    let mut sun = Worst::new("Perez' sun against its illuminance, relative", 1e-4);
    for row in table.rows() {
        let daylight = Daylight::new(&sky_of_the_hour(row));
        let weather = AllWeather::new(&measured(row), row.get("spa_alt"));
        let lux = weather.diffuse_horizontal_lux;
        sky.see(lux_up(&fine, &daylight) / lux - 1.0, row.text("case"));
        sky.see(
            luminance(daylight.sky_irradiance_up) / lux - 1.0,
            row.text("case"),
        );
        if weather.direct_normal_lux > 0.0 {
            let found = luminance(daylight.sun_illuminance) / weather.direct_normal_lux;
            sun.see(found - 1.0, row.text("case"));
        }
    }
    sky.finish();
    sun.finish();
}

#[test]
fn every_standard_sky_closes_with_its_level() {
    let fine = SphereQuadrature::upper(150, 280);
    let mut worst = Worst::new("CIE skies against their illuminance, relative", 1e-4);
    for (index, model) in GENERAL.into_iter().enumerate() {
        for sun_elevation_deg in [0.0, 3.0, 20.0, 55.0, 90.0] {
            let conditions = Conditions {
                model,
                sun_elevation_deg,
                ..Conditions::default()
            };
            let daylight = Daylight::new(&conditions);
            let told = luminance(daylight.sky_irradiance_up);
            worst.see(lux_up(&fine, &daylight) / told - 1.0, index + 1);
        }
    }
    worst.finish();
}

#[test]
fn clouds_dim_every_clear_sky_as_published() {
    let fine = SphereQuadrature::upper(150, 280);
    let mut worst = Worst::new("Kasten & Czeplak's global illuminance, relative", 1e-4);
    for model in [
        SkyModel::Preetham,
        SkyModel::Hosek,
        SkyModel::CieClear,
        SkyModel::Cie14,
    ] {
        let under = |cloud_cover| {
            Daylight::new(&Conditions {
                model,
                cloud_cover,
                sun_elevation_deg: 35.0,
                ..Conditions::default()
            })
        };
        let global = |day: &Daylight| {
            lux_up(&fine, day) + luminance(day.sun_illuminance) * day.sun_direction.y
        };
        let open = global(&under(0.0));
        for cover in [0.1, 0.4, 0.75, 1.0f64] {
            let found = global(&under(cover)) / open;
            let expected = 1.0 - 0.75 * cover.powf(3.4);
            worst.see(found / expected - 1.0, format!("{model:?} {cover}"));
        }
        let full = under(1.0);
        assert_eq!(full.sun_illuminance, DVec3::ZERO, "{model:?}");
        let ratio = full.sky_radiance(DVec3::Y).y / full.sky_radiance(DVec3::X).y;
        assert!((ratio - 3.0).abs() < 1e-9, "{model:?} {ratio}");
    }
    worst.finish();
}
