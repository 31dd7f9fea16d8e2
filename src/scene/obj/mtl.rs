//! MTL files: materials of OBJ models.

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

use glam::{Affine2, Vec2};

use crate::scene::builder::Builder;
use crate::scene::files::Lookup;
use crate::scene::glass;
use crate::scene::material::{MTL_DEFAULT, Material, MetallicRoughness, phong_of};
use crate::scene::texture::picture::{Channel, TextureKey};

/// The statements of one `newmtl` block.
#[derive(Debug, Default, Clone)]
struct Entry {
    name: String,
    diffuse: Option<[f32; 3]>,
    specular: Option<[f32; 3]>,
    emission: Option<[f32; 3]>,
    shininess: Option<f32>,
    dissolve: Option<f32>,
    transparency: Option<f32>,
    filter: Option<[f32; 3]>,
    illumination: Option<u32>,
    metallic: Option<f32>,
    roughness: Option<f32>,
    ior: Option<f32>,
    diffuse_map: Option<Map>,
    specular_map: Option<Map>,
    emissive_map: Option<Map>,
    mask: Option<Map>,
    bump: Option<Map>,
    metallic_map: Option<Map>,
    roughness_map: Option<Map>,
}

/// The arguments of a `map_..` statement.
#[derive(Debug, Clone)]
struct Map {
    /// Folder of the material library.
    folder: PathBuf,
    name: String,
    options: MapOptions,
}

impl Map {
    fn read(folder: &Path, rest: &str) -> Option<Self> {
        let (name, options) = map_options(rest);
        (!name.is_empty()).then(|| Self {
            folder: folder.to_owned(),
            name: name.to_owned(),
            options,
        })
    }

    /// Path of the image, which may not exist; `None` (with a warning) if it is outside the model's folder.
    fn path(&self, builder: &mut Builder, owner: &Path) -> Option<PathBuf> {
        match builder.files.find(&self.folder, &self.name) {
            Lookup::Found(path) | Lookup::Missing(path) => Some(path),
            Lookup::Outside(path) => {
                builder.warn_outside(owner, &path);
                None
            }
        }
    }
}

/// The material libraries of one OBJ file.
#[derive(Debug, Default)]
pub struct Libraries {
    entries: Vec<Entry>,
    by_name: HashMap<String, usize>,
}

impl Libraries {
    /// Reads the libraries listed by the `mtllib` lines. A missing library is a warning.
    pub fn read(builder: &mut Builder, obj: &Path, folder: &Path, names: &[String]) -> Self {
        let mut libraries = Self::default();
        let mut seen: HashSet<PathBuf> = HashSet::new();
        let mut asked: HashSet<&String> = HashSet::new();
        for rest in names.iter().filter(|rest| asked.insert(rest)) {
            let found = find_libraries(builder, obj, folder, rest);
            if found.is_empty() {
                builder.warn(
                    obj,
                    &format!(
                        "material library \"{rest}\" is missing; its materials are drawn grey"
                    ),
                );
            }
            for path in found {
                if !seen.insert(path.clone()) {
                    continue;
                }
                match builder.files.read_text(&path) {
                    Ok(text) => libraries.add(builder, &path, &text),
                    Err(error) => builder.warn(obj, &error.to_string()),
                }
            }
        }
        libraries
    }

    pub fn add(&mut self, builder: &mut Builder, path: &Path, text: &str) {
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut bad = Vec::new();
        for (number, line) in text.lines().enumerate() {
            if !self.line(folder, line.trim()) {
                bad.push(number + 1);
            }
        }
        if let Some(first) = bad.first() {
            let what = format!(
                "{} malformed lines ignored, the first is line {first}",
                bad.len()
            );
            builder.warn(path, &what);
        }
    }

    /// Parses a line; false if it is malformed.
    fn line(&mut self, folder: &Path, line: &str) -> bool {
        let (key, rest) = line
            .split_once(|c: char| c.is_whitespace())
            .unwrap_or((line, ""));
        let rest = rest.trim();
        let key = key.to_ascii_lowercase();
        if key == "newmtl" {
            self.begin(rest);
            return true;
        }
        let Some(entry) = self.entries.last_mut() else {
            // Lines before the first `newmtl` are ignored.
            return true;
        };
        let map = || Map::read(folder, rest);
        match key.as_str() {
            "kd" => set(&mut entry.diffuse, colour(rest)),
            "ks" => set(&mut entry.specular, colour(rest)),
            "ke" => set(&mut entry.emission, colour(rest)),
            "ns" => set(&mut entry.shininess, number(rest)),
            "ni" => set(&mut entry.ior, number(rest)),
            "d" => set(
                &mut entry.dissolve,
                number(rest.trim_start_matches("-halo")),
            ),
            "tf" => set(&mut entry.filter, colour(rest)),
            "tr" => set(&mut entry.transparency, number(rest)),
            "pm" => set(&mut entry.metallic, number(rest)),
            "pr" => set(&mut entry.roughness, number(rest)),
            "illum" => {
                entry.illumination = rest.parse().ok();
                true
            }
            "map_kd" => set(&mut entry.diffuse_map, map()),
            "map_ks" => set(&mut entry.specular_map, map()),
            "map_ke" => set(&mut entry.emissive_map, map()),
            "map_d" => set(&mut entry.mask, map()),
            "map_bump" | "bump" | "map_kn" | "norm" => set(&mut entry.bump, map()),
            "map_pm" => set(&mut entry.metallic_map, map()),
            "map_pr" => set(&mut entry.roughness_map, map()),
            _ => true,
        }
    }

    fn begin(&mut self, name: &str) {
        let name = if name.is_empty() { "unnamed" } else { name };
        // If two materials share a name, the first one wins, as in other readers.
        let number = self.entries.len();
        self.by_name.entry(name.to_owned()).or_insert(number);
        self.entries.push(Entry {
            name: name.to_owned(),
            ..Entry::default()
        });
    }

    /// Whether a material with this name exists.
    pub fn has(&self, name: &str) -> bool {
        self.by_name.contains_key(name)
    }

    /// The material with this name, with its textures decoded, and the transform from the mesh's texture coordinates (v
    /// pointing up) to those of the textures.
    pub fn material(
        &self,
        builder: &mut Builder,
        obj: &Path,
        name: &str,
    ) -> Option<(Material, Affine2)> {
        let entry = &self.entries[*self.by_name.get(name)?];
        Some((entry.material(builder, obj), entry.texture_from_mesh()))
    }
}

/// Stores a parsed value; false if there was none.
fn set<T>(place: &mut Option<T>, value: Option<T>) -> bool {
    let read = value.is_some();
    *place = value.or(place.take());
    read
}

impl Entry {
    /// The texture transform of the first map; all maps of a material share their texture coordinates.
    fn texture_from_mesh(&self) -> Affine2 {
        let maps = [
            &self.diffuse_map,
            &self.mask,
            &self.bump,
            &self.specular_map,
            &self.emissive_map,
        ];
        let first = maps.into_iter().flatten().next();
        first.map_or(Affine2::IDENTITY, |map| {
            let MapOptions { scale, offset, .. } = map.options;
            Affine2::from_scale_angle_translation(Vec2::from(scale), 0.0, Vec2::from(offset))
        })
    }

    fn material(&self, builder: &mut Builder, obj: &Path) -> Material {
        let diffuse_texture = self.diffuse_texture(builder, obj);
        let specular_texture = colour_texture(builder, obj, self.specular_map.as_ref());
        let (emission, emissive_texture) = self.emitted(builder, obj);
        let normal_texture = self.bump.as_ref().and_then(|map| {
            let path = map.path(builder, obj)?;
            builder.texture(obj, TextureKey::Normals(path, map.options.bump.to_bits()))
        });
        let has_mask = self.mask.is_some() && diffuse_texture.is_some();
        // A texture without `Kd` is the reflectance itself; with neither, the surface is grey.
        let default_diffuse = if diffuse_texture.is_some() && self.diffuse_map.is_some() {
            1.0
        } else {
            0.5
        };
        let unit = |rgb: [f32; 3]| rgb.map(|v| v.clamp(0.0, 1.0));
        let base = unit(self.diffuse.unwrap_or([default_diffuse; 3]));
        let (diffuse, specular, shininess) = self
            .metallic_roughness(builder, obj, base)
            .map(|surface| phong_of(&surface))
            .unwrap_or_else(|| (base, self.phong_specular(specular_texture), self.exponent()));
        Material {
            name: self.name.clone(),
            diffuse,
            specular,
            shininess,
            dissolve: self.opacity(),
            alpha_cutoff: has_mask.then_some(0.5),
            diffuse_texture,
            specular_texture,
            normal_texture,
            emission,
            emissive_texture,
            glass: if has_mask {
                None
            } else {
                glass::of_mtl(self.opacity(), self.filter, self.illumination)
            },
            ..MTL_DEFAULT
        }
    }

    /// L_e and its texture. A texture without `Ke`, or beside the `Ke 0 0 0` that exporters write, is L_e itself.
    fn emitted(&self, builder: &mut Builder, obj: &Path) -> ([f32; 3], Option<usize>) {
        let texture = colour_texture(builder, obj, self.emissive_map.as_ref());
        let factor = self.emission.unwrap_or_default();
        let factor = match texture {
            Some(_) if factor == [0.0; 3] => [1.0; 3],
            _ => factor,
        };
        (builder.emission(obj, &self.name, factor), texture)
    }

    fn exponent(&self) -> f32 {
        self.shininess.unwrap_or(1.0).clamp(1.0, 1e5)
    }

    fn phong_specular(&self, texture: Option<usize>) -> [f32; 3] {
        if !self.has_highlights() {
            return [0.0; 3];
        }
        let default = if texture.is_some() { 1.0 } else { 0.0 };
        self.specular
            .unwrap_or([default; 3])
            .map(|v| v.clamp(0.0, 1.0))
    }

    /// The PBR statements, if any: `Pm`, `Pr` and the means of their maps. `Ni` is the index of refraction.
    fn metallic_roughness(
        &self,
        builder: &mut Builder,
        obj: &Path,
        base: [f32; 3],
    ) -> Option<MetallicRoughness> {
        let mut value = |number: Option<f32>, map: &Option<Map>| {
            let path = map.as_ref().and_then(|map| map.path(builder, obj));
            let mean = path.map(|path| builder.mean(obj, &path)[0]);
            match (number, mean) {
                (Some(n), Some(mean)) => Some(n * mean),
                (n, mean) => n.or(mean),
            }
        };
        let metallic = value(self.metallic, &self.metallic_map);
        let roughness = value(self.roughness, &self.roughness_map);
        if metallic.is_none() && roughness.is_none() {
            return None;
        }
        Some(MetallicRoughness {
            base,
            metallic: metallic.unwrap_or(0.0),
            roughness: roughness.unwrap_or(1.0),
            ior: self.ior.unwrap_or(1.5),
            specular: [1.0; 3],
        })
    }

    fn diffuse_texture(&self, builder: &mut Builder, obj: &Path) -> Option<usize> {
        let mut path = |map: &Option<Map>| map.as_ref()?.path(builder, obj);
        let (colour, mask) = (path(&self.diffuse_map), path(&self.mask));
        let channel = self.mask.as_ref().map(|map| map.options.channel);
        let wanted = match mask {
            Some(mask) => TextureKey::Masked(colour, mask, channel.unwrap_or_default()),
            None => TextureKey::Colour(colour?),
        };
        builder.texture(obj, wanted)
    }

    /// Whether the material has a specular lobe. Illumination models 0 and 1 (`illum`) have none, and many exporters write a
    /// meaningless `Ks` with them.
    fn has_highlights(&self) -> bool {
        !matches!(self.illumination, Some(0 | 1))
    }

    /// Opacity, 0..1: `d`, otherwise 1 − `Tr`. `Tr 1` alone is treated as opaque, because that is what some exporters mean. So
    /// is `d 0` with a mask, because the mask decides where the surface is opaque.
    fn opacity(&self) -> f32 {
        let opacity = match (self.dissolve, self.transparency) {
            (Some(d), _) if d <= 0.0 && self.mask.is_some() => 1.0,
            (Some(d), _) => d,
            (None, Some(tr)) if tr < 1.0 => 1.0 - tr,
            _ => 1.0,
        };
        opacity.clamp(0.0, 1.0)
    }
}

/// The texture of a map of colours.
fn colour_texture(builder: &mut Builder, obj: &Path, map: Option<&Map>) -> Option<usize> {
    let path = map?.path(builder, obj)?;
    builder.texture(obj, TextureKey::Colour(path))
}

fn colour(rest: &str) -> Option<[f32; 3]> {
    let values: Vec<f32> = rest
        .split_whitespace()
        .take(3)
        .map_while(|w| w.parse().ok())
        .collect();
    let rgb = match values[..] {
        [r, g, b] => [r, g, b],
        [grey] => [grey; 3],
        _ => return None,
    };
    rgb.iter().all(|v| v.is_finite()).then_some(rgb)
}

fn number(rest: &str) -> Option<f32> {
    let value = rest.split_whitespace().next()?.parse::<f32>().ok()?;
    value.is_finite().then_some(value)
}

/// The libraries listed by one `mtllib` line: one file whose name contains spaces, or several files in which spaces are written
/// as `\ `.
pub fn find_libraries(
    builder: &mut Builder,
    obj: &Path,
    folder: &Path,
    rest: &str,
) -> Vec<PathBuf> {
    if let Lookup::Found(path) = builder.files.find(folder, rest.trim_matches('"')) {
        return vec![path];
    }
    // File names cannot contain NUL, so it stands in for an escaped space while the line is split.
    let escaped = rest.replace("\\ ", "\0");
    let mut found = Vec::new();
    for name in escaped.split_whitespace() {
        match builder.files.find(folder, &name.replace('\0', " ")) {
            Lookup::Found(path) => found.push(path),
            Lookup::Outside(path) => builder.warn_outside(obj, &path),
            Lookup::Missing(_) => {}
        }
    }
    found
}

/// Options of a `map_..` statement. `-clamp`, `-blendu`, `-blendv`, `-mm`, `-t`, `-type` and unknown options are ignored.
#[derive(Debug, Clone, Copy, PartialEq)]
struct MapOptions {
    /// `-s`: factor on the texture coordinates.
    scale: [f32; 2],
    /// `-o`: offset of the texture coordinates, applied after the scale.
    offset: [f32; 2],
    /// `-bm`: factor on the heights of a bump map.
    bump: f32,
    /// `-imfchan`: channel used as a mask.
    channel: Channel,
}

impl Default for MapOptions {
    fn default() -> Self {
        Self {
            scale: [1.0; 2],
            offset: [0.0; 2],
            bump: 1.0,
            channel: Channel::Automatic,
        }
    }
}

/// Options that may also follow the file name.
const TRAILING_OPTIONS: [&str; 10] = [
    " -bm ",
    " -o ",
    " -s ",
    " -t ",
    " -imfchan ",
    " -clamp ",
    " -blendu ",
    " -blendv ",
    " -mm ",
    " -texres ",
];

/// Splits the arguments into the file name (possibly with spaces) and the options, which exporters write in either order.
fn map_options(rest: &str) -> (&str, MapOptions) {
    let mut options = MapOptions::default();
    let rest = options.take_leading(rest.trim());
    let end = TRAILING_OPTIONS.iter().filter_map(|o| rest.find(o)).min();
    let (name, mut trailing) = rest.split_at(end.unwrap_or(rest.len()));
    // Here the arguments of the last option end the line.
    while let Some((option, tail)) = option_word(trailing.trim_start()) {
        trailing = options.take(option, tail, true);
    }
    (name.trim().trim_matches('"'), options)
}

fn option_word(rest: &str) -> Option<(&str, &str)> {
    let (word, tail) = rest.split_once(char::is_whitespace)?;
    let letters = word.strip_prefix('-')?;
    (!letters.is_empty() && letters.chars().all(char::is_alphabetic))
        .then_some((letters, tail.trim_start()))
}

impl MapOptions {
    fn take_leading<'a>(&mut self, mut rest: &'a str) -> &'a str {
        while let Some((option, tail)) = option_word(rest) {
            rest = self.take(option, tail, false);
        }
        rest
    }

    /// Parses the arguments of an option; returns the remaining text. With `last`, the arguments may end the line.
    fn take<'a>(&mut self, option: &str, tail: &'a str, last: bool) -> &'a str {
        let numbers_only = matches!(option, "o" | "s" | "t");
        let most = match option {
            "o" | "s" | "t" => 3,
            "mm" => 2,
            _ => 1,
        };
        let (mut rest, mut arguments) = (tail, [""; 3]);
        for argument in arguments.iter_mut().take(most) {
            let (word, tail) = match rest.split_once(char::is_whitespace) {
                Some(both) => both,
                None if last => (rest, ""),
                // The last word is always the file name.
                None => break,
            };
            if numbers_only && word.parse::<f32>().is_err() {
                break;
            }
            (*argument, rest) = (word, tail.trim_start());
        }
        self.set(option, arguments);
        rest
    }

    fn set(&mut self, option: &str, arguments: [&str; 3]) {
        let number = |i: usize| {
            let value = arguments[i].parse::<f32>().ok();
            value.filter(|v| v.is_finite() && v.abs() < 1e6)
        };
        match option {
            // A missing second number defaults to scale 1, offset 0.
            "s" => {
                let u = number(0).unwrap_or(1.0);
                self.scale = [u, number(1).unwrap_or(1.0)];
            }
            "o" => self.offset = [number(0).unwrap_or(0.0), number(1).unwrap_or(0.0)],
            "bm" => self.bump = number(0).unwrap_or(1.0),
            "imfchan" => self.channel = channel(arguments[0]),
            _ => {}
        }
    }
}

fn channel(word: &str) -> Channel {
    match word {
        "r" => Channel::Number(0),
        "g" => Channel::Number(1),
        "b" => Channel::Number(2),
        "m" => Channel::Number(3),
        _ => Channel::Automatic,
    }
}

#[cfg(test)]
#[path = "mtl_tests.rs"]
mod tests;
