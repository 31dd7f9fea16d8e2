//! The physics against the reference data in `shared/reference`: one test per file.
//!
//! Both sides are f64, so most tolerances are 1e-9; a comment explains each wider one. In the files z is up.

#![allow(clippy::unwrap_used)]

use crate::common::{Row, Table, Worst};
use glam::{DMat3, DVec3};
use skylight::daylight::{colour, hosek::Hosek, preetham, preetham::Preetham};
use skylight::daylight::{spectrum, sun_position, sunlight, sunlight::Sunlight};

/// World direction (y up, -z north) of a direction of the files (x east, y north, z up).
fn world(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, z, -y)
}

/// The sun at `theta_s` and a view direction at (`theta`, `dphi`), radians, converted from the files to world space.
fn sun_and_view(theta_s: f64, theta: f64, dphi: f64) -> (DVec3, DVec3) {
    let sun = world(theta_s.sin(), 0.0, theta_s.cos());
    let view = world(
        theta.sin() * dphi.cos(),
        theta.sin() * dphi.sin(),
        theta.cos(),
    );
    (sun, view)
}

/// Largest difference of a channel over the largest channel.
fn relative(found: DVec3, expected: DVec3) -> f64 {
    (found - expected).abs().max_element() / expected.abs().max_element()
}

#[test]
fn preetham_coefficients() {
    let Some(table) = Table::read("preetham_coefficients.csv") else {
        return;
    };
    let mut worst = Worst::new("Perez coefficients and zenith constants", 1e-12);
    let at = |turbidity| Preetham::new(turbidity, DVec3::Y).perez().coefficients;
    for row in table.rows().filter(|row| row.text("kind") == "perez") {
        let quantity = ["Y", "x", "y"]
            .iter()
            .position(|q| *q == row.text("quantity"))
            .unwrap();
        let name = "ABCDE".find(row.text("name_or_theta_power")).unwrap();
        // Linear in T: the values at 0 and 1 are the constant and the sum.
        let (constant, sum) = (at(0.0)[quantity][name], at(1.0)[quantity][name]);
        let found = if row.text("T_power") == "T" {
            sum - constant
        } else {
            constant
        };
        worst.see(found - row.get("paper_4dec"), row.index);
    }
    let constants: Vec<f64> = zenith(&table, "Y")
        .map(|row| row.get("paper_4dec"))
        .collect();
    for (turbidity, theta) in [(2.0, 0.0), (3.0, 0.4), (7.5, 1.1), (10.0, 1.5)] {
        for (i, quantity) in ["x", "y"].into_iter().enumerate() {
            let expected = zenith(&table, quantity)
                .map(|row| term(row, turbidity, theta))
                .sum::<f64>();
            worst.see(
                preetham::zenith_chromaticity(turbidity, theta)[i] - expected,
                quantity,
            );
        }
        let [a, b, p, q, r, s] = constants[..] else {
            panic!("six constants for Y")
        };
        let chi = (a - turbidity / b) * (std::f64::consts::PI - 2.0 * theta);
        let expected = 1000.0 * ((p * turbidity + q) * chi.tan() + r * turbidity + s);
        // The file rounds 4/9 to twelve digits, and the tangent is steep.
        worst.see(
            1e-3 * (preetham::zenith_luminance(turbidity, theta) / expected - 1.0),
            "Y",
        );
    }
    worst.finish();
}

fn zenith<'a>(table: &'a Table, quantity: &'a str) -> impl Iterator<Item = Row<'a>> {
    table
        .rows()
        .filter(move |row| row.text("kind") == "zenith" && row.text("quantity") == quantity)
}

/// One term of the zenith's chromaticity polynomial.
fn term(row: Row<'_>, turbidity: f64, theta: f64) -> f64 {
    let power = |text: &str, base: f64| match text.split_once('^') {
        Some((_, exponent)) => base.powi(exponent.parse().unwrap()),
        None if text == "1" => 1.0,
        None => base,
    };
    row.get("paper_4dec")
        * power(row.text("T_power"), turbidity)
        * power(row.text("name_or_theta_power"), theta)
}

#[test]
fn preetham_spectra() {
    let Some(table) = Table::read("preetham_spectra.csv") else {
        return;
    };
    let mut worst = Worst::new("spectral tables", 1e-9);
    for row in table.rows() {
        let nm = row.get("wavelength_nm");
        let [s0, s1, s2] = spectrum::daylight_components(nm);
        for (found, column) in [
            (sunlight::extraterrestrial_radiance(nm), "L_sun_W_m2_nm_sr"),
            (sunlight::ozone_absorption(nm), "k_o_per_cm"),
            (sunlight::water_vapour_absorption(nm), "k_wa_per_cm"),
            (sunlight::mixed_gas_absorption(nm), "k_g_per_cm"),
            (s0, "S0"),
            (s1, "S1"),
            (s2, "S2"),
        ] {
            worst.see(found - row.get(column), format!("{column} at {nm} nm"));
        }
    }
    let Some(table) = Table::read("preetham_spectra_extra_nodes.csv") else {
        return;
    };
    for row in table.rows() {
        let absorption = match row.text("table") {
            "k_wa" => sunlight::water_vapour_absorption,
            "k_g" => sunlight::mixed_gas_absorption,
            other => panic!("unknown table {other}"),
        };
        worst.see(
            absorption(row.get("wavelength_nm")) - row.get("value"),
            row.index,
        );
    }
    worst.finish();
}

#[test]
fn cie_1931_colour_matching_functions() {
    let mut worst = Worst::new("colour-matching functions", 0.0);
    for name in ["cie_1931_2deg.csv", "cie_1931_2deg_1nm.csv"] {
        let Some(table) = Table::read(name) else {
            return;
        };
        for row in table.rows() {
            let nm = row.get("wavelength_nm");
            let expected = row.get3(["xbar", "ybar", "zbar"]);
            worst.see(
                (spectrum::cie_1931_2deg(nm) - expected).abs().max_element(),
                nm,
            );
        }
    }
    worst.finish();
}

#[test]
fn srgb_matrices() {
    let Some(table) = Table::read("srgb_matrices.csv") else {
        return;
    };
    let mut exact = Worst::new("exact matrices", 1e-14);
    // The largest deviation is Lindbloom's first entry: 3.2404542 for 3.2409699.
    let mut rounded = Worst::new("rounded matrices", 6e-4);
    for row in table.rows() {
        let name = row.text("matrix");
        let ours: DMat3 = if name.starts_with("RGB") {
            colour::XYZ_FROM_RGB
        } else {
            colour::RGB_FROM_XYZ
        };
        let index: usize = row.text("row").parse().unwrap();
        let error = (ours.row(index) - row.get3(["c0", "c1", "c2"]))
            .abs()
            .max_element();
        if name.ends_with("exact") {
            &mut exact
        } else {
            &mut rounded
        }
        .see(error, name);
    }
    exact.finish();
    rounded.finish();
}

#[test]
fn declination_and_equation_of_time() {
    let Some(table) = Table::read("declination_eot.csv") else {
        return;
    };
    let mut worst = Worst::new("declination, degrees, and equation of time, minutes", 1e-9);
    for row in table.rows() {
        let day = row.text("J").parse().unwrap();
        let declination = sun_position::declination(day).to_degrees();
        worst.see(declination - row.get("declination_deg"), day);
        let minutes = 60.0 * sun_position::equation_of_time(day);
        worst.see(minutes - row.get("equation_of_time_min"), day);
    }
    worst.finish();
}

#[test]
fn preetham_sky() {
    let Some(table) = Table::read("preetham_sky_reference.csv") else {
        return;
    };
    let mut chromaticity = Worst::new("Preetham x, y", 1e-9);
    let mut luminance = Worst::new("Preetham Y, relative", 1e-9);
    let mut rgb = Worst::new("Preetham RGB, relative", 1e-9);
    for row in table.rows() {
        let angle = |name: &str| row.get(name).to_radians();
        let (sun, view) = sun_and_view(angle("theta_s_deg"), angle("theta_deg"), angle("dphi_deg"));
        let sky = Preetham::new(row.get("T"), sun);
        let (found, x, y) = sky.luminance_chromaticity(view);
        chromaticity.see(x - row.get("x"), row.index);
        chromaticity.see(y - row.get("y"), row.index);
        luminance.see(found / row.get("Y_cd_m2") - 1.0, row.index);
        rgb.see(
            relative(sky.radiance(view), row.get3(["R", "G", "B"])),
            row.index,
        );
    }
    chromaticity.finish();
    luminance.finish();
    rgb.finish();
}

#[test]
fn sun_transmittances() {
    let Some(table) = Table::read("sun_transmittance_spectra.csv") else {
        return;
    };
    let mut worst = Worst::new("transmittances", 1e-9);
    let mut radiance = Worst::new("radiance through the air, relative", 1e-9);
    for row in table.rows() {
        let (turbidity, nm) = (row.get("T"), row.get("wavelength_nm"));
        let mass = sunlight::air_mass(90.0 - row.get("theta_s_deg"));
        let total = sunlight::transmittance(nm, mass, turbidity);
        for (found, column) in [
            (sunlight::rayleigh_transmittance(nm, mass), "tau_rayleigh"),
            (
                sunlight::aerosol_transmittance(nm, mass, turbidity),
                "tau_aerosol",
            ),
            (sunlight::ozone_transmittance(nm, mass), "tau_ozone"),
            (sunlight::mixed_gas_transmittance(nm, mass), "tau_gas"),
            (sunlight::water_vapour_transmittance(nm, mass), "tau_water"),
            (total, "tau_total"),
        ] {
            worst.see(found - row.get(column), format!("{column} at {nm} nm"));
        }
        let found = sunlight::extraterrestrial_radiance(nm) * total;
        radiance.see(found / row.get("L_W_m2_nm_sr") - 1.0, row.index);
    }
    worst.finish();
    radiance.finish();
}

#[test]
fn sun_radiance() {
    let Some(table) = Table::read("sun_radiance_reference.csv") else {
        return;
    };
    let mut worst = Worst::new("the sun's disc, relative", 1e-9);
    let mut illuminance = Worst::new("the sun's illuminance, relative", 1e-9);
    for row in table.rows() {
        let (turbidity, zenith) = (row.get("T"), row.get("theta_s_deg"));
        let sun = if row.get("air_mass") == 0.0 {
            Sunlight::extraterrestrial()
        } else {
            worst.see(
                sunlight::air_mass(90.0 - zenith) / row.get("air_mass") - 1.0,
                row.index,
            );
            worst.see(
                sunlight::angstrom_beta(turbidity) / row.get("beta") - 1.0,
                row.index,
            );
            Sunlight::new(turbidity, 90.0 - zenith)
        };
        let expected = row.get3(["X_cd_m2", "Y_cd_m2", "Z_cd_m2"]);
        worst.see(relative(sun.luminance_xyz, expected), row.index);
        worst.see(
            relative(sun.luminance(), row.get3(["R_cd_m2", "G_cd_m2", "B_cd_m2"])),
            row.index,
        );
        worst.see(
            sun.radiance_w / row.get("L_380_750_W_m2_sr") - 1.0,
            row.index,
        );
        let rgb = row.get3(["ER_lux", "EG_lux", "EB_lux"]);
        illuminance.see(relative(sun.illuminance(), rgb), row.index);
        illuminance.see(
            sun.irradiance_w() / row.get("E_380_750_W_m2") - 1.0,
            row.index,
        );
    }
    worst.finish();
    illuminance.finish();
}

#[test]
fn hosek_sky() {
    let Some(table) = Table::read("hosek_reference.csv") else {
        return;
    };
    // The crate's tables and their interpolation are f32.
    let mut rgb = Worst::new("Hosek RGB, relative", 1e-5);
    // The authors' RGB and XYZ tables are separate fits, up to 8.5 % apart: this checks the unit only.
    let mut luminance = Worst::new("Hosek luminance against the XYZ fit, relative", 9e-2);
    for row in table.rows() {
        let angle = |name: &str| row.get(name).to_radians();
        let theta_s = std::f64::consts::FRAC_PI_2 - angle("elevation_deg");
        let (sun, view) = sun_and_view(theta_s, angle("theta_deg"), angle("dphi_deg"));
        let found = Hosek::new(row.get("T"), row.get("albedo"), sun).radiance(view);
        let native = row.get3(["R_native", "G_native", "B_native"]);
        rgb.see(
            relative(found, native * spectrum::LUMINOUS_EFFICACY),
            row.index,
        );
        luminance.see(
            colour::luminance(found) / row.get("luminance_cd_m2") - 1.0,
            row.index,
        );
    }
    rgb.finish();
    luminance.finish();
}
