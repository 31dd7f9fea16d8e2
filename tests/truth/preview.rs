//! Single-frame renders of direct light with ambient occlusion of the screen against path-traced references under identical light (`../shared/truth`), term by term.
//!
//! No specular reflection, no ground light, and direct light of sun and sky without interreflection. Uncertain pixels are
//! excluded and counted: those within 2 pixels of an edge of the geometry or of a shadow.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use crate::truth::Exr;
use glam::DVec3;
use serde_json::Value;

const SIZE: [usize; 2] = [640, 360];
const PIXELS: usize = SIZE[0] * SIZE[1];

/// A view, and limits for the whole picture about a tenth above the measured values.
struct View {
    name: &'static str,
    /// Mean of our render over mean of the reference: lowest and highest.
    ratio: [f64; 2],
    /// RMSE over mean of the reference.
    rmse: f64,
    /// 95th percentile of the relative error.
    p95: f64,
}

const VIEWS: [View; 5] = [
    view("colonnade", [1.03, 1.047], 0.197, 2.4),
    view("house", [1.02, 1.036], 0.158, 0.95),
    view("house_low", [1.11, 1.141], 0.36, 1.02),
    view("medieval", [0.99, 1.003], 0.088, 0.56),
    view("teapot", [0.985, 1.0], 0.064, 0.32),
];

const fn view(name: &'static str, ratio: [f64; 2], rmse: f64, p95: f64) -> View {
    View {
        name,
        ratio,
        rmse,
        p95,
    }
}

/// Channels by name.
struct Picture(BTreeMap<String, Vec<f64>>);

impl Picture {
    fn new(exr: Exr) -> Self {
        let channels = exr.channels.into_iter().map(|(name, values)| {
            assert_eq!(values.len(), PIXELS, "{name}");
            (name, values.into_iter().map(f64::from).collect())
        });
        Self(channels.collect())
    }

    fn channel(&self, name: &str) -> &[f64] {
        let known = || self.0.keys().cloned().collect::<Vec<_>>().join(", ");
        self.0
            .get(name)
            .unwrap_or_else(|| panic!("no channel {name}, only {}", known()))
    }

    fn vectors(&self, names: [&str; 3]) -> Vec<DVec3> {
        let [x, y, z] = names.map(|name| self.channel(name));
        (0..PIXELS).map(|i| DVec3::new(x[i], y[i], z[i])).collect()
    }

    /// Luminance of a layer; the unnamed one is the picture itself.
    fn luminance(&self, layer: &str) -> Vec<f64> {
        let dot = if layer.is_empty() { "" } else { "." };
        let names = ["R", "G", "B"].map(|c| format!("{layer}{dot}{c}"));
        let rgb = self.vectors([&names[0], &names[1], &names[2]]);
        rgb.into_iter().map(luminance).collect()
    }
}

fn luminance(rgb: DVec3) -> f64 {
    rgb.dot(DVec3::new(0.2126, 0.7152, 0.0722))
}

/// The `q` quantile.
fn quantile(values: &[f64], q: f64) -> f64 {
    assert!(!values.is_empty(), "nothing to look at");
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted[((sorted.len() - 1) as f64 * q).round() as usize]
}

/// Relative errors at the pixels of `mask`.
fn relative(ours: &[f64], truth: &[f64], mask: &[bool]) -> Vec<f64> {
    let pixels = (0..PIXELS).filter(|i| mask[*i]);
    pixels.map(|i| (ours[i] / truth[i] - 1.0).abs()).collect()
}

/// Dilates `mask` by `reach` pixels in both axes.
fn grown(mask: &[bool], reach: usize) -> Vec<bool> {
    (0..PIXELS)
        .map(|i| neighbours(i, reach).any(|j| mask[j]))
        .collect()
}

/// The pixels within `reach` of a pixel, itself included, inside the picture.
fn neighbours(i: usize, reach: usize) -> impl Iterator<Item = usize> {
    let (x, y) = (i % SIZE[0], i / SIZE[0]);
    let columns = move || x.saturating_sub(reach)..=(x + reach).min(SIZE[0] - 1);
    let rows = y.saturating_sub(reach)..=(y + reach).min(SIZE[1] - 1);
    rows.flat_map(move |y| columns().map(move |x| y * SIZE[0] + x))
}

fn both(a: &[bool], b: &[bool]) -> Vec<bool> {
    a.iter().zip(b).map(|(a, b)| *a && *b).collect()
}

fn count(mask: &[bool]) -> usize {
    mask.iter().filter(|m| **m).count()
}

fn vector(value: &Value) -> DVec3 {
    let [x, y, z] = [0, 1, 2].map(|i| value[i].as_f64().expect("three numbers"));
    DVec3::new(x, y, z)
}

/// A view's reference and our render.
struct Compared {
    parameters: Value,
    truth: BTreeMap<&'static str, Picture>,
    ours: Picture,
}

impl Compared {
    fn new(shared: &Path, name: &str) -> Self {
        let folder = shared.join("truth");
        let json = fs::read(folder.join(format!("{name}.json"))).expect("the view");
        let parameters: Value = serde_json::from_slice(&json).expect("JSON");
        let layers = ["sun", "sky", "direct", "aov", "ao_inf"];
        let read = |layer| Picture::new(Exr::read(&folder.join(format!("{name}_{layer}.exr"))));
        let further = ["--layers", "--bounces", "0", "--ambient", "ssao"];
        Self {
            ours: Picture::new(crate::truth::render(shared, &parameters, &further)),
            truth: layers.map(|layer| (layer, read(layer))).into(),
            parameters,
        }
    }

    /// Pixels that show a surface in the reference.
    fn geometry(&self) -> Vec<bool> {
        let depth = self.truth["aov"].channel("depth.T");
        depth.iter().map(|d| *d > 0.0).collect()
    }

    fn normals(&self) -> Vec<DVec3> {
        let normals = self.truth["aov"].vectors(["normal.X", "normal.Y", "normal.Z"]);
        normals.into_iter().map(DVec3::normalize_or_zero).collect()
    }

    /// World position at each pixel's centre, from the reference's distances.
    fn positions(&self) -> Vec<DVec3> {
        let camera = &self.parameters["camera"];
        let eye = vector(&camera["origin"]);
        let forward = (vector(&camera["target"]) - eye).normalize();
        let right = forward.cross(DVec3::Y).normalize();
        let up = right.cross(forward);
        let half = (camera["vfov"].as_f64().expect("degrees").to_radians() / 2.0).tan();
        let depth = self.truth["aov"].channel("depth.T");
        let position = |i: usize| {
            let at = |k: usize, n: usize| (2.0 * k as f64 + 1.0 - n as f64) / SIZE[1] as f64;
            let (x, y) = (at(i % SIZE[0], SIZE[0]), at(i / SIZE[0], SIZE[1]));
            let ray = forward + half * (x * right - y * up);
            eye + ray.normalize() * depth[i]
        };
        (0..PIXELS).map(position).collect()
    }

    /// Surfaces away from the background and from creases and depth discontinuities: where a neighbour's normal differs by more
    /// than 18°, or the neighbour is off the pixel's plane by 1 % of the distance (half floats resolve 0.05 %).
    fn inner(&self) -> Vec<bool> {
        let (normals, positions) = (self.normals(), self.positions());
        let (geometry, depth) = (self.geometry(), self.truth["aov"].channel("depth.T"));
        let is_edge = |i: usize| {
            neighbours(i, 1).any(|j| {
                let off = normals[i].dot(positions[j] - positions[i]).abs();
                geometry[i] != geometry[j]
                    || geometry[i] && (normals[i].dot(normals[j]) < 0.95 || off > 0.01 * depth[i])
            })
        };
        let edges: Vec<bool> = (0..PIXELS).map(is_edge).collect();
        let far: Vec<bool> = grown(&edges, 2).iter().map(|near| !near).collect();
        both(&geometry, &far)
    }

    /// The reference's V, from its sun term: L = ρ_d/π (n·l) V E_sun. `None` at grazing incidence, on surfaces that face away from
    /// the sun, and where the albedo is nearly zero.
    fn true_visibility(&self) -> Vec<Option<f64>> {
        let sun = &self.parameters["sun"];
        let (direction, illuminance) = (
            vector(&sun["direction"]),
            vector(&sun["illuminance_rgb_lux"]),
        );
        let albedo = self.ours.vectors(["albedo.R", "albedo.G", "albedo.B"]);
        let (normals, term) = (self.normals(), self.truth["sun"].luminance(""));
        let visibility = |i: usize| {
            let n_dot_l = normals[i].dot(direction);
            let reflected = luminance(albedo[i] * illuminance) / std::f64::consts::PI;
            (n_dot_l > 0.05 && albedo[i].max_element() > 0.01)
                .then(|| term[i] / (reflected * n_dot_l))
        };
        (0..PIXELS).map(visibility).collect()
    }

    /// Relative errors of the sky in the background.
    fn background(&self) -> Vec<f64> {
        let near = grown(&self.geometry(), 1);
        let truth = self.truth["direct"].luminance("");
        let sky: Vec<bool> = (0..PIXELS).map(|i| !near[i] && truth[i] > 0.0).collect();
        relative(&self.ours.luminance(""), &truth, &sky)
    }

    /// Mean ratio, RMSE over mean, and relative errors of surfaces, defined as in run.py.
    fn whole(&self) -> (f64, f64, Vec<f64>) {
        let outside: Vec<bool> = self.geometry().iter().map(|g| !g).collect();
        let near = grown(&outside, 1);
        let (ours, truth) = (self.ours.luminance(""), self.truth["direct"].luminance(""));
        let inside: Vec<usize> = (0..PIXELS).filter(|i| !near[*i]).collect();
        let mean = |f: &dyn Fn(usize) -> f64| {
            inside.iter().map(|i| f(*i)).sum::<f64>() / inside.len() as f64
        };
        let reference = mean(&|i| truth[i]);
        let rmse = mean(&|i| (ours[i] - truth[i]).powi(2)).sqrt();
        let error = |i: &usize| (ours[*i] - truth[*i]).abs() / truth[*i].max(0.02 * reference);
        (
            mean(&|i| ours[i]) / reference,
            rmse / reference,
            inside.iter().map(error).collect(),
        )
    }
}

/// Checks of one view. Failures are collected, so that all figures are printed.
struct Checks {
    view: &'static str,
    failures: Vec<String>,
}

impl Checks {
    fn at_most(&mut self, what: &str, value: f64, limit: f64) {
        // NaN exceeds every limit.
        if value.is_nan() || value > limit {
            self.fail(format!("{what} is {value:.4}, allowed {limit}"));
        }
    }

    fn at_least(&mut self, what: &str, value: f64, limit: f64) {
        if value.is_nan() || value < limit {
            self.fail(format!("{what} is {value:.4}, wanted {limit}"));
        }
    }

    fn fail(&mut self, what: String) {
        self.failures.push(format!("{}: {what}", self.view));
    }
}

fn check(shared: &Path, view: &View) -> Vec<String> {
    let compared = Compared::new(shared, view.name);
    let mut checks = Checks {
        view: view.name,
        failures: Vec::new(),
    };
    let sky = compared.background();
    let (sky_median, sky_p95) = (quantile(&sky, 0.5), quantile(&sky, 0.95));
    checks.at_most("median error of the background", sky_median, 0.0025);

    // Sunlit or not, away from penumbrae: not within 2 pixels of partial visibility or a shadow edge in the reference.
    let truth_v = compared.true_visibility();
    let penumbra: Vec<bool> = truth_v
        .iter()
        .map(|v| v.is_some_and(|v| (0.05..=0.95).contains(&v)))
        .collect();
    let lit: Vec<bool> = truth_v.iter().map(|v| v.is_some_and(|v| v > 0.5)).collect();
    let shadowed: Vec<bool> = truth_v
        .iter()
        .map(|v| v.is_some_and(|v| v <= 0.5))
        .collect();
    let (near_lit, near_shadowed) = (grown(&lit, 2), grown(&shadowed, 2));
    let near_penumbra = grown(&penumbra, 2);
    let inner = compared.inner();
    let certain: Vec<bool> = (0..PIXELS)
        .map(|i| {
            inner[i]
                && truth_v[i].is_some()
                && !near_penumbra[i]
                && !(near_lit[i] && near_shadowed[i])
        })
        .collect();
    let ours_v = compared.ours.channel("visibility.Y");
    let agree: Vec<bool> = (0..PIXELS).map(|i| lit[i] == (ours_v[i] > 0.5)).collect();
    let agreement = count(&both(&certain, &agree)) as f64 / count(&certain) as f64;
    checks.at_least("agreement of lit and shadowed", agreement, 0.9999);
    let facing = (0..PIXELS).filter(|i| inner[*i] && truth_v[*i].is_some());
    let kept = count(&certain) as f64 / facing.count() as f64;
    checks.at_least("share of sunward pixels that are compared", kept, 0.62);

    let lit = both(&certain, &lit);
    let sun_truth = compared.truth["sun"].luminance("");
    let sun = relative(&compared.ours.luminance("sun"), &sun_truth, &lit);
    checks.at_most(
        "median error of the sun on lit pixels",
        quantile(&sun, 0.5),
        0.0004,
    );

    let open = compared.truth["ao_inf"].channel("Y");
    let open: Vec<bool> = (0..PIXELS).map(|i| inner[i] && open[i] > 0.98).collect();
    let sky_truth = compared.truth["sky"].luminance("");
    let open = both(
        &open,
        &sky_truth.iter().map(|s| *s > 0.0).collect::<Vec<_>>(),
    );
    let ambient = relative(&compared.ours.luminance("sky"), &sky_truth, &open);
    checks.at_most(
        "median error of the sky on open pixels",
        quantile(&ambient, 0.5),
        0.0136,
    );
    checks.at_least("open pixels", ambient.len() as f64, 1700.0);

    let (ratio, rmse, errors) = compared.whole();
    println!(
        "{:10} background {sky_median:.4} (p95 {sky_p95:.4}) | lit {:.3} % of {} ({:.0} % of sunward inner) | sun {:.4} of {} | \
         sky {:.4} of {} | ratio {ratio:.3} RMSE/mean {rmse:.3} median {:.4} p95 {:.3}",
        view.name,
        100.0 * agreement,
        count(&certain),
        100.0 * kept,
        quantile(&sun, 0.5),
        sun.len(),
        quantile(&ambient, 0.5),
        ambient.len(),
        quantile(&errors, 0.5),
        quantile(&errors, 0.95),
    );
    checks.at_least("mean ratio", ratio, view.ratio[0]);
    checks.at_most("mean ratio", ratio, view.ratio[1]);
    checks.at_most("RMSE/mean", rmse, view.rmse);
    checks.at_most("p95", quantile(&errors, 0.95), view.p95);
    checks.failures
}

#[test]
fn every_view_meets_the_path_tracer() {
    let Some(shared) = crate::common::shared() else {
        return;
    };
    let failures: Vec<String> = VIEWS.iter().flat_map(|view| check(&shared, view)).collect();
    assert!(failures.is_empty(), "{failures:#?}");
}
