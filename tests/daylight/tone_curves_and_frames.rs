//! Tone curves and tangent frames against `shared/reference`.

use crate::common::{Table, Worst};
use glam::DVec3;
use skylight::daylight::{tangent_frame, tone_curve};

#[test]
fn tone_curves() {
    let Some(table) = Table::read("tonemap_reference.csv") else {
        return;
    };
    type Curve = fn(DVec3) -> DVec3;
    // Parameters from the file's comment line: k 0.7, gamma 2.2, L_avg 0.6, key 0.18, L_logavg 0.4, L_white 3.
    let curves: [(&str, Curve); 10] = [
        ("linear_gamma", |c| tone_curve::linear_gamma(c, 0.7, 2.2)),
        ("srgb_oetf", |c| tone_curve::encode(c, None)),
        ("ferschin_perchannel", |c| tone_curve::exponential(c, 0.6)),
        ("ferschin_luminance", |c| {
            tone_curve::exponential_luminance(c, 0.6)
        }),
        ("reinhard_lum_white", |c| {
            tone_curve::reinhard(c, 0.18 / 0.4, 3.0)
        }),
        ("khronos_neutral", tone_curve::neutral),
        ("agx_base_encoded", tone_curve::agx_encoded),
        ("agx_base_linear", tone_curve::agx),
        ("aces_narkowicz", tone_curve::aces_narkowicz),
        ("aces_hill", tone_curve::aces_hill),
    ];
    for (name, curve) in curves {
        let mut worst = Worst::new("tone curve", 1e-9);
        for row in table.rows() {
            let input = row.get3(["in_r", "in_g", "in_b"]);
            for (channel, end) in ["r", "g", "b"].into_iter().enumerate() {
                let expected = row.get(&format!("{name}_{end}"));
                let error = curve(input)[channel] - expected;
                worst.see(
                    error / expected.abs().max(1.0),
                    format!("{name} of {input}"),
                );
            }
        }
        print!("{name}: ");
        worst.finish();
    }
}

#[test]
fn tangent_frames() {
    let Some(table) = Table::read("frames.csv") else {
        return;
    };
    let mut duff = Worst::new("Duff's frame", 1e-9);
    // 1 + n_z has few digits in the file where n_z is near -1.
    let mut frisvad = Worst::new("Frisvad's frame", 1e-6);
    for row in table.rows() {
        let n = row.get3(["nx", "ny", "nz"]);
        let see = |worst: &mut Worst, frame: (DVec3, DVec3), columns: [[&str; 3]; 2]| {
            worst.see((frame.0 - row.get3(columns[0])).abs().max_element(), n);
            worst.see((frame.1 - row.get3(columns[1])).abs().max_element(), n);
        };
        let columns = [
            ["duff_b1x", "duff_b1y", "duff_b1z"],
            ["duff_b2x", "duff_b2y", "duff_b2z"],
        ];
        see(&mut duff, tangent_frame::duff(n), columns);
        let columns = [
            ["fris_b1x", "fris_b1y", "fris_b1z"],
            ["fris_b2x", "fris_b2y", "fris_b2z"],
        ];
        see(&mut frisvad, tangent_frame::frisvad(n), columns);
    }
    duff.finish();
    frisvad.finish();
}
