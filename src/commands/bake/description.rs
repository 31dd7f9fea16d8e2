//! The JSON file beside a map: everything needed to light a scene with it.

use std::path::Path;

use serde_json::{Value, json};

use super::{Container, File};
use crate::cli::{BakeArgs, Layout, Map};
use crate::commands::light::Light;
use crate::commands::sky_report::SkyReport;
use crate::error::Result;
use crate::options::name;

/// What the file says of the map in these files.
pub fn description(args: &BakeArgs, light: &Light, files: &[File]) -> Result<Value> {
    let report = SkyReport::new(light, &[])?;
    Ok(json!({
        "software": concat!("skylight ", env!("CARGO_PKG_VERSION")),
        "map": name(args.map),
        "layout": match Container::of(&args.output) {
            Container::Ktx2 => "cube",
            Container::Exr | Container::Hdr => name(args.layout()),
        },
        "files": files.iter().map(of_file).collect::<Vec<Value>>(),
        "unit": args.map.unit(),
        "colour": "linear RGB, BT.709 primaries, D65; 0.2126 R + 0.7152 G + 0.0722 B is the luminance or illuminance",
        "axes": "right-handed; +x east, +y up, -z north; azimuth in degrees clockwise from north",
        "orientation": orientation(Container::of(&args.output), args.layout()),
        "roughness": roughness(args.map),
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

fn of_file(file: &File) -> Value {
    let name = Path::new(&file.path)
        .file_name()
        .unwrap_or_default()
        .to_string_lossy();
    let mut value = json!({ "name": name, "width": file.size[0], "height": file.size[1] });
    if let Some(roughness) = file.roughness {
        value["roughness"] = json!(roughness);
    }
    if let Some((scale, levels)) = file.scale_and_levels {
        value["scale"] = json!(scale);
        value["levels"] = json!(levels);
    }
    value
}

const fn roughness(map: Map) -> Option<&'static str> {
    match map {
        Map::Specular => Some(
            "level / (levels - 1); GGX, alpha = roughness^2, the first factor of the split sum: view = normal = direction",
        ),
        Map::Sky | Map::Irradiance => None,
    }
}

const fn orientation(container: Container, layout: Layout) -> &'static str {
    match (container, layout) {
        (Container::Ktx2, _) => {
            "faces +x -x +y -y +z -z as Vulkan's cube maps have them: a lookup in a direction of these axes is the value from there; a texel times scale is the value"
        }
        (_, Layout::Equirect) => {
            "texel (i, j) of W x H is at azimuth 360 (i + 1/2)/W and elevation 90 - 180 (j + 1/2)/H: first row zenith, first column north, clockwise to the right"
        }
        (_, Layout::Cross) => {
            "rows of faces: [none, +y, none, none], [-x, +z, +x, -z], [none, -y, none, none]; each face as Vulkan's cube maps have it; the rest is 0"
        }
        (_, Layout::Faces) => {
            "px nx py ny pz nz: +x -x +y -y +z -z, each as Vulkan's cube maps have it"
        }
    }
}
