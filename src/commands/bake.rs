//! `skylight bake`: the sky or its irradiance as an environment map, with a JSON description.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use glam::DVec3;
use serde_json::{Value, json};

use super::light::Light;
use super::panorama::{self, Picture};
use super::sky::exact_by_default;
use super::sky_report::SkyReport;
use crate::daylight::irradiance::IrradianceEstimator;
use crate::error::Result;
use crate::output::{
    Channels, Layer, Metadata, check_writable, encode_exr, encode_hdr, print, write_set,
};
use crate::settings::{Options, name};

/// Quantity of a map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Map {
    /// Radiance of sky and ground without the sun's disc, cd/m².
    Sky,
    /// Irradiance E(n) of sky and ground without the sun, lux, by the direction of the normal.
    Irradiance,
}

impl Map {
    /// Default edge of a cube face, texels. Irradiance is smooth, and each of its texels costs a sum over the sky.
    const fn default_size(self) -> u32 {
        match self {
            Self::Sky => 256,
            Self::Irradiance => 32,
        }
    }

    const fn unit(self) -> &'static str {
        match self {
            Self::Sky => "cd/m^2",
            Self::Irradiance => "lux",
        }
    }
}

/// Layout of the sphere.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub enum Layout {
    /// 4N x 2N: first row the zenith, first column north, azimuth clockwise to the right.
    #[default]
    Equirect,
    /// 4N x 3N: -X +Z +X -Z in the middle row, +Y above and -Y below +Z; each face in Vulkan's orientation.
    Cross,
    /// Six files NAME_px .. NAME_nz, N x N, each in Vulkan's orientation.
    Faces,
}

/// Arguments of `bake`.
#[derive(Debug, Clone, PartialEq, Args)]
pub struct BakeWishes {
    /// Quantity of the map.
    #[arg(long, value_enum, value_name = "WHAT")]
    pub map: Map,
    /// Texels along an edge of a cube face, 4 to 4096 [default: 256 for sky, 32 for irradiance].
    #[arg(long = "size", id = "edge", value_name = "N", value_parser = clap::value_parser!(u32).range(4..=4096))]
    pub edge: Option<u32>,
    /// Layout of the sphere.
    #[arg(long, value_enum, value_name = "LAYOUT", default_value = "equirect")]
    pub layout: Layout,
    /// Output file: .exr (32-bit floats) or .hdr (Radiance); the JSON file has the same name.
    #[arg(short, long, value_name = "FILE", value_parser = map_path)]
    pub output: PathBuf,
}

fn map_path(text: &str) -> std::result::Result<PathBuf, String> {
    let path = PathBuf::from(text);
    let extension = path.extension().map(|e| e.to_ascii_lowercase());
    match extension.as_deref().and_then(std::ffi::OsStr::to_str) {
        Some("exr" | "hdr") => Ok(path),
        _ => Err("the name must end in .exr or .hdr".to_owned()),
    }
}

/// Computes and writes the map.
///
/// # Errors
/// Invalid options, or files that cannot be written; older files are left alone then.
pub fn run(wishes: &BakeWishes, mut options: Options) -> Result<()> {
    exact_by_default(&mut options);
    let light = Light::new(options)?;
    let sidecar = wishes.output.with_extension("json");
    let names = names(wishes);
    for path in names.iter().chain([&sidecar]) {
        check_writable(path)?;
    }
    if !light.settings.quiet {
        for warning in &light.daylight.warnings {
            eprintln!("warning: {warning}");
        }
    }
    let pictures = pictures(wishes, &light);
    let mut files = Vec::new();
    for (path, picture) in names.iter().zip(&pictures) {
        files.push((path.clone(), encode(path, picture, wishes.map, &light)?));
    }
    let text = format!("{:#}\n", description(wishes, &light, &names, &pictures)?);
    files.push((sidecar.clone(), text.into_bytes()));
    write_set(&files)?;
    let line = |(path, picture): (&PathBuf, &Picture)| {
        let [width, height] = picture.size;
        let unit = wishes.map.unit();
        format!("{}: {width}x{height}, {unit}\n", path.display())
    };
    let lines: String = names.iter().zip(&pictures).map(line).collect();
    print(&format!("{lines}{}\n", sidecar.display()))
}

fn names(wishes: &BakeWishes) -> Vec<PathBuf> {
    let output = &wishes.output;
    let stem = output.file_stem().unwrap_or_default().to_string_lossy();
    let extension = output.extension().unwrap_or_default().to_string_lossy();
    match wishes.layout {
        Layout::Equirect | Layout::Cross => vec![output.clone()],
        Layout::Faces => panorama::FACE_NAMES
            .map(|face| output.with_file_name(format!("{stem}_{face}.{extension}")))
            .to_vec(),
    }
}

fn pictures(wishes: &BakeWishes, light: &Light) -> Vec<Picture> {
    let size = wishes.edge.unwrap_or(wishes.map.default_size());
    let radiance = |direction: DVec3| light.daylight.radiance(direction);
    let progress = super::progress(
        panorama::rows(wishes.layout, size),
        "rows",
        light.settings.quiet,
    );
    let draw = |value: &(dyn Fn(DVec3) -> DVec3 + Sync)| {
        panorama::draw(wishes.layout, size, value, &|| progress.inc(1))
    };
    let pictures = match wishes.map {
        Map::Sky => draw(&radiance),
        Map::Irradiance => {
            let settings = &light.settings;
            let samples = settings.irradiance_samples;
            let e = IrradianceEstimator::new(settings.irradiance, radiance, samples);
            draw(&|normal| e.at(normal))
        }
    };
    progress.finish_and_clear();
    pictures
}

fn encode(path: &Path, picture: &Picture, map: Map, light: &Light) -> Result<Vec<u8>> {
    let hdr = path
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("hdr"));
    if hdr {
        return encode_hdr(path, picture.size, &picture.texels);
    }
    let mut metadata: Metadata = light
        .inputs()
        .map(|(key, value)| (key.to_owned(), value))
        .collect();
    metadata.push(("unit".to_owned(), map.unit().to_owned()));
    let layer = Layer {
        name: "",
        channels: Channels::Rgb,
        texels: picture.texels.clone(),
    };
    encode_exr(path, picture.size, &[layer], &metadata)
}

/// The JSON description: everything needed to light a scene with the map.
fn description(
    wishes: &BakeWishes,
    light: &Light,
    names: &[PathBuf],
    pictures: &[Picture],
) -> Result<Value> {
    let report = SkyReport::new(light, &[])?;
    let file = |(path, picture): (&PathBuf, &Picture)| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        json!({ "name": name, "width": picture.size[0], "height": picture.size[1] })
    };
    let files: Vec<Value> = names.iter().zip(pictures).map(file).collect();
    Ok(json!({
        "software": concat!("skylight ", env!("CARGO_PKG_VERSION")),
        "map": name(wishes.map),
        "layout": name(wishes.layout),
        "files": files,
        "unit": wishes.map.unit(),
        "colour": "linear RGB, BT.709 primaries, D65; 0.2126 R + 0.7152 G + 0.0722 B is the luminance or illuminance",
        "axes": "right-handed; +x east, +y up, -z north; azimuth in degrees clockwise from north",
        "orientation": orientation(wishes.layout),
        "sun_disc": "not in the map: add a directional light of sun.illuminance_rgb (lux at normal incidence) from sun.direction",
        "inputs": report.inputs,
        "sun": report.sun,
        "sky": report.sky,
        "ground": report.ground,
        "global_horizontal_lux": report.global_horizontal_lux,
        "warnings": report.warnings,
    }))
}

const fn orientation(layout: Layout) -> &'static str {
    match layout {
        Layout::Equirect => {
            "texel (i, j) of W x H is at azimuth 360 (i + 1/2)/W and elevation 90 - 180 (j + 1/2)/H: first row zenith, first column north, clockwise to the right"
        }
        Layout::Cross => {
            "rows of faces: [none, +y, none, none], [-x, +z, +x, -z], [none, -y, none, none]; each face as Vulkan's cube maps have it; the rest is 0"
        }
        Layout::Faces => "px nx py ny pz nz: +x -x +y -y +z -z, each as Vulkan's cube maps have it",
    }
}
