//! `skylight bake`: the sky, its irradiance, or the sky prefiltered for rough metals as an environment map, with a JSON description.

mod description;
mod maps;

use std::path::{Path, PathBuf};

use self::description::description;
use self::maps::Baked;
use super::light::Light;
use super::panorama::{self, Picture};
use super::sky::exact_by_default;
use crate::cli::{BakeArgs, Layout, Map, Texels};
use crate::daylight::ggx::ROUGHEST_EDGE;
use crate::error::{Error, Result};
use crate::options::OptionValues;
use crate::output::{
    Channels, Layer, Metadata, TexelFormat, check_writable, encode_exr, encode_hdr, encode_ktx2,
    print, scale, write_set,
};

impl Map {
    const fn unit(self) -> &'static str {
        match self {
            Self::Sky | Self::Specular => "cd/m^2",
            Self::Irradiance => "lux",
        }
    }
}

impl BakeArgs {
    /// How the sphere is laid out in pictures; in a KTX2 file it is a cube.
    fn layout(&self) -> Layout {
        self.layout.unwrap_or_default()
    }
}

/// What a file's name asks for.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Container {
    Exr,
    Hdr,
    Ktx2,
}

impl Container {
    fn of(path: &Path) -> Self {
        let is = |name: &str| {
            path.extension()
                .is_some_and(|e| e.eq_ignore_ascii_case(name))
        };
        if is("ktx2") {
            Self::Ktx2
        } else if is("hdr") {
            Self::Hdr
        } else {
            Self::Exr
        }
    }
}

/// A file of a map.
struct File {
    path: PathBuf,
    /// Of the picture, or of a face of the first level.
    size: [u32; 2],
    /// Of a specular map's picture.
    roughness: Option<f64>,
    /// Of a cube in one file: what a stored 1 stands for, and the number of mip levels.
    scale_and_levels: Option<(f32, usize)>,
    bytes: Vec<u8>,
}

/// Computes the map and writes it with its description.
///
/// # Errors
/// Invalid options, or files that cannot be written; existing files are then left unchanged.
pub fn run(args: &BakeArgs, mut options: OptionValues) -> Result<()> {
    check(args)?;
    exact_by_default(&mut options);
    let light = Light::new(&options)?;
    let sidecar = args.output.with_extension("json");
    for path in names(args).iter().flatten().chain([&sidecar]) {
        check_writable(path)?;
    }
    super::tell_no_device("bake", &light.settings);
    super::tell(&light.settings, light.daylight.warnings.iter())?;
    let files = match Container::of(&args.output) {
        Container::Ktx2 => vec![cube_file(args, &light)?],
        Container::Exr | Container::Hdr => pictures(args, &light)?,
    };
    let text = format!("{:#}\n", description(args, &light, &files)?);
    let lines: String = files.iter().map(|file| line(file, args.map)).collect();
    let mut all: Vec<(PathBuf, Vec<u8>)> = files.into_iter().map(|f| (f.path, f.bytes)).collect();
    all.push((sidecar.clone(), text.into_bytes()));
    write_set(&all)?;
    print(&format!("{lines}{}\n", sidecar.display()))
}

/// Whether the arguments fit each other.
fn check(args: &BakeArgs) -> Result<()> {
    let is_cube = Container::of(&args.output) == Container::Ktx2;
    let refuse = |what: String| Err(Error::usage(what));
    if is_cube && args.layout.is_some() {
        return refuse(
            "a .ktx2 file holds a cube map: leave --layout out, or write .exr".to_owned(),
        );
    }
    if !is_cube && args.texels.is_some() {
        return refuse("--texels is for .ktx2 files: write one, or leave --texels out".to_owned());
    }
    let has_levels = is_cube || args.map == Map::Specular;
    if has_levels && !args.edge.is_power_of_two() {
        let (size, near) = (args.edge, args.edge.next_power_of_two());
        let what =
            format!("mip levels halve the edge: --size {near} instead of {size}, a power of two");
        return refuse(what);
    }
    if args.map == Map::Specular && args.edge < 2 * ROUGHEST_EDGE {
        let (size, least) = (args.edge, 2 * ROUGHEST_EDGE);
        return refuse(format!(
            "--size {size} has no room for levels of roughness: at least {least}"
        ));
    }
    Ok(())
}

fn line(file: &File, map: Map) -> String {
    let ([width, height], unit) = (file.size, map.unit());
    let kind = match file.scale_and_levels {
        Some((_, levels)) => format!(", cube of {levels} levels"),
        None => String::new(),
    };
    format!("{}: {width}x{height}{kind}, {unit}\n", file.path.display())
}

/// Names of the pictures of each level: `NAME`, with `_m0` .. for the levels of a specular map and `_px` .. for faces.
fn names(args: &BakeArgs) -> Vec<Vec<PathBuf>> {
    let output = &args.output;
    let stem = output.file_stem().unwrap_or_default().to_string_lossy();
    let extension = output.extension().unwrap_or_default().to_string_lossy();
    let named = |suffix: &str| output.with_file_name(format!("{stem}{suffix}.{extension}"));
    if Container::of(output) == Container::Ktx2 {
        return vec![vec![output.clone()]];
    }
    let levels = match args.map {
        Map::Specular => (0..crate::daylight::ggx::levels(args.edge))
            .map(|k| format!("_m{k}"))
            .collect(),
        Map::Sky | Map::Irradiance => vec![String::new()],
    };
    let of_level = |level: String| match args.layout() {
        Layout::Equirect | Layout::Cross => vec![named(&level)],
        Layout::Faces => panorama::FACE_NAMES
            .map(|face| named(&format!("{level}_{face}")))
            .to_vec(),
    };
    levels.into_iter().map(of_level).collect()
}

/// The map as one cube with mip levels.
fn cube_file(args: &BakeArgs, light: &Light) -> Result<File> {
    let levels = maps::cube_levels(&maps::bake(args, Layout::Faces, light));
    let scale = scale(&levels);
    let format = match args.texels.unwrap_or_default() {
        Texels::Half => TexelFormat::Half,
        Texels::Bc6h => TexelFormat::Bc6h,
    };
    let mut metadata = metadata(args.map, light);
    metadata.push(("scale".to_owned(), f64::from(scale).to_string()));
    if args.map == Map::Specular {
        metadata.push(("roughness".to_owned(), "level / (levels - 1)".to_owned()));
    }
    Ok(File {
        path: args.output.clone(),
        size: [args.edge; 2],
        roughness: None,
        scale_and_levels: Some((scale, levels.len())),
        bytes: encode_ktx2(&args.output, &levels, format, scale, &metadata)?,
    })
}

/// The map as pictures.
fn pictures(args: &BakeArgs, light: &Light) -> Result<Vec<File>> {
    let baked = maps::bake(args, args.layout(), light);
    let mut files = Vec::new();
    for (
        names,
        Baked {
            roughness,
            pictures,
        },
    ) in names(args).into_iter().zip(&baked)
    {
        for (path, picture) in names.into_iter().zip(pictures) {
            files.push(File {
                bytes: encode(&path, picture, *roughness, args.map, light)?,
                path,
                size: picture.size,
                roughness: *roughness,
                scale_and_levels: None,
            });
        }
    }
    Ok(files)
}

fn encode(
    path: &Path,
    picture: &Picture,
    roughness: Option<f64>,
    map: Map,
    light: &Light,
) -> Result<Vec<u8>> {
    if Container::of(path) == Container::Hdr {
        return encode_hdr(path, picture.size, &picture.texels);
    }
    let mut metadata = metadata(map, light);
    metadata.extend(roughness.map(|r| ("roughness".to_owned(), r.to_string())));
    let layer = Layer {
        name: "",
        channels: Channels::Rgb,
        texels: picture.texels.clone(),
    };
    encode_exr(path, picture.size, &[layer], &metadata)
}

/// The options of the light, and the unit.
fn metadata(map: Map, light: &Light) -> Metadata {
    let mut metadata = light.settings.light();
    metadata.push(("unit".to_owned(), map.unit().to_owned()));
    metadata
}
