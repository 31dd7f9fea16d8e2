//! `skylight bake`: the sky or its irradiance as an environment map, with a JSON description.

use std::path::{Path, PathBuf};

use glam::DVec3;
use serde_json::{Value, json};

use super::light::Light;
use super::panorama::{self, Picture};
use super::sky::exact_by_default;
use super::sky_report::SkyReport;
use crate::cli::{BakeArgs, Layout, Map};
use crate::daylight::irradiance::IrradianceEstimator;
use crate::error::Result;
use crate::options::{OptionValues, name};
use crate::output::{
    Channels, Layer, Metadata, check_writable, encode_exr, encode_hdr, print, write_set,
};

impl Map {
    const fn unit(self) -> &'static str {
        match self {
            Self::Sky => "cd/m^2",
            Self::Irradiance => "lux",
        }
    }
}

/// Computes the map and writes it with its description.
///
/// # Errors
/// Invalid options, or files that cannot be written; existing files are then left unchanged.
pub fn run(args: &BakeArgs, mut options: OptionValues) -> Result<()> {
    exact_by_default(&mut options);
    let light = Light::new(&options)?;
    let sidecar = args.output.with_extension("json");
    let names = names(args);
    for path in names.iter().chain([&sidecar]) {
        check_writable(path)?;
    }
    if !light.settings.quiet {
        for warning in &light.daylight.warnings {
            eprintln!("warning: {warning}");
        }
    }
    let pictures = pictures(args, &light);
    let mut files = Vec::new();
    for (path, picture) in names.iter().zip(&pictures) {
        files.push((path.clone(), encode(path, picture, args.map, &light)?));
    }
    let text = format!("{:#}\n", description(args, &light, &names, &pictures)?);
    files.push((sidecar.clone(), text.into_bytes()));
    write_set(&files)?;
    let line = |(path, picture): (&PathBuf, &Picture)| {
        let [width, height] = picture.size;
        let unit = args.map.unit();
        format!("{}: {width}x{height}, {unit}\n", path.display())
    };
    let lines: String = names.iter().zip(&pictures).map(line).collect();
    print(&format!("{lines}{}\n", sidecar.display()))
}

fn names(args: &BakeArgs) -> Vec<PathBuf> {
    let output = &args.output;
    let stem = output.file_stem().unwrap_or_default().to_string_lossy();
    let extension = output.extension().unwrap_or_default().to_string_lossy();
    match args.layout {
        Layout::Equirect | Layout::Cross => vec![output.clone()],
        Layout::Faces => panorama::FACE_NAMES
            .map(|face| output.with_file_name(format!("{stem}_{face}.{extension}")))
            .to_vec(),
    }
}

fn pictures(args: &BakeArgs, light: &Light) -> Vec<Picture> {
    let size = args.edge;
    let radiance = |direction: DVec3| light.daylight.radiance(direction);
    let progress = super::progress(
        panorama::rows(args.layout, size),
        "rows",
        light.settings.quiet,
    );
    let draw = |value: &(dyn Fn(DVec3) -> DVec3 + Sync)| {
        panorama::draw(args.layout, size, value, &|| progress.inc(1))
    };
    let pictures = match args.map {
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
    let mut metadata: Metadata = light.settings.light();
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
    args: &BakeArgs,
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
        "map": name(args.map),
        "layout": name(args.layout),
        "files": files,
        "unit": args.map.unit(),
        "colour": "linear RGB, BT.709 primaries, D65; 0.2126 R + 0.7152 G + 0.0722 B is the luminance or illuminance",
        "axes": "right-handed; +x east, +y up, -z north; azimuth in degrees clockwise from north",
        "orientation": orientation(args.layout),
        "sun_disc": "not in the map: add a directional light of sun.illuminance_rgb (lux at normal incidence) from sun.direction; while the sun gives none, of moon.illuminance_rgb from moon.direction",
        "inputs": report.inputs,
        "sun": report.sun,
        "moon": report.almanac.map(|almanac| almanac.moon),
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
