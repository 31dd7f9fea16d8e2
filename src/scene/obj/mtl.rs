//! MTL files: materials of OBJ models.

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

use glam::{Affine2, Vec2};

use crate::scene::builder::Builder;
use crate::scene::files::Place;
use crate::scene::material::{MTL_DEFAULT, Material, MetallicRoughness, phong_of};
use crate::scene::obj::map_options::{MapOptions, map_options};
use crate::scene::texture::picture::Wanted;

/// What one `newmtl` says.
#[derive(Debug, Default, Clone)]
struct Entry {
    name: String,
    diffuse: Option<[f32; 3]>,
    specular: Option<[f32; 3]>,
    shininess: Option<f32>,
    dissolve: Option<f32>,
    transparency: Option<f32>,
    illumination: Option<u32>,
    metallic: Option<f32>,
    roughness: Option<f32>,
    ior: Option<f32>,
    diffuse_map: Option<Map>,
    specular_map: Option<Map>,
    mask: Option<Map>,
    bump: Option<Map>,
    metallic_map: Option<Map>,
    roughness_map: Option<Map>,
}

/// A picture and its options.
#[derive(Debug, Clone)]
struct Map {
    /// Of the library.
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

    /// Where the picture is or should be; none where the model has no business.
    fn path(&self, builder: &mut Builder, owner: &Path) -> Option<PathBuf> {
        match builder.files.find(&self.folder, &self.name) {
            Place::Found(path) | Place::Missing(path) => Some(path),
            Place::Outside(path) => {
                builder.warn_outside(owner, &path);
                None
            }
        }
    }
}

/// A material, and how its texture coordinates come from those of the mesh.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::scene) struct Placed {
    pub material: Material,
    /// Texture coordinates as OBJ has them (v upward).
    pub texture_from_mesh: Affine2,
}

/// The material libraries of one OBJ file.
#[derive(Debug, Default)]
pub(in crate::scene) struct Libraries {
    entries: Vec<Entry>,
    by_name: HashMap<String, usize>,
}

impl Libraries {
    /// Reads what the rests of the `mtllib` lines name. A library that is missing is a warning.
    pub fn read(builder: &mut Builder, obj: &Path, folder: &Path, names: &[String]) -> Self {
        let mut libraries = Self::default();
        let mut seen: HashSet<PathBuf> = HashSet::new();
        let mut asked: HashSet<&String> = HashSet::new();
        for rest in names.iter().filter(|rest| asked.insert(rest)) {
            let found = find_libraries(builder, obj, folder, rest);
            if found.is_empty() {
                builder.warn(
                    obj,
                    &format!("material library \"{rest}\" is missing; drawn grey"),
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

    pub(in crate::scene) fn add(&mut self, builder: &mut Builder, path: &Path, text: &str) {
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut bad = Vec::new();
        for (number, line) in text.lines().enumerate() {
            if !self.line(folder, line.trim()) {
                bad.push(number + 1);
            }
        }
        if let Some(first) = bad.first() {
            let what = format!(
                "{} lines are not understood and left out, the first is line {first}",
                bad.len()
            );
            builder.warn(path, &what);
        }
    }

    /// False for nonsense.
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
            // Before the first material there is nothing to say.
            return true;
        };
        let map = || Map::read(folder, rest);
        match key.as_str() {
            "kd" => set(&mut entry.diffuse, colour(rest)),
            "ks" => set(&mut entry.specular, colour(rest)),
            "ns" => set(&mut entry.shininess, number(rest)),
            "ni" => set(&mut entry.ior, number(rest)),
            "d" => set(
                &mut entry.dissolve,
                number(rest.trim_start_matches("-halo")),
            ),
            "tr" => set(&mut entry.transparency, number(rest)),
            "pm" => set(&mut entry.metallic, number(rest)),
            "pr" => set(&mut entry.roughness, number(rest)),
            "illum" => {
                entry.illumination = rest.parse().ok();
                true
            }
            "map_kd" => set(&mut entry.diffuse_map, map()),
            "map_ks" => set(&mut entry.specular_map, map()),
            "map_d" => set(&mut entry.mask, map()),
            "map_bump" | "bump" | "map_kn" | "norm" => set(&mut entry.bump, map()),
            "map_pm" => set(&mut entry.metallic_map, map()),
            "map_pr" => set(&mut entry.roughness_map, map()),
            _ => true,
        }
    }

    fn begin(&mut self, name: &str) {
        let name = if name.is_empty() { "unnamed" } else { name };
        // The first of two materials with one name is meant, as with other readers.
        let number = self.entries.len();
        self.by_name.entry(name.to_owned()).or_insert(number);
        self.entries.push(Entry {
            name: name.to_owned(),
            ..Entry::default()
        });
    }

    /// Whether there is a material of this name.
    pub fn has(&self, name: &str) -> bool {
        self.by_name.contains_key(name)
    }

    /// The material of this name, its textures decoded.
    pub fn material(&self, builder: &mut Builder, obj: &Path, name: &str) -> Option<Placed> {
        let entry = &self.entries[*self.by_name.get(name)?];
        Some(entry.place(builder, obj))
    }
}

/// Takes a value that could be read; false if it could not.
fn set<T>(place: &mut Option<T>, value: Option<T>) -> bool {
    let read = value.is_some();
    *place = value.or(place.take());
    read
}

impl Entry {
    fn place(&self, builder: &mut Builder, obj: &Path) -> Placed {
        let maps = [
            &self.diffuse_map,
            &self.mask,
            &self.bump,
            &self.specular_map,
        ];
        let placing = maps.into_iter().flatten().next();
        let texture_from_mesh = placing.map_or(Affine2::IDENTITY, |map| {
            let MapOptions { scale, offset, .. } = map.options;
            Affine2::from_scale_angle_translation(Vec2::from(scale), 0.0, Vec2::from(offset))
        });
        Placed {
            material: self.material(builder, obj),
            texture_from_mesh,
        }
    }

    fn material(&self, builder: &mut Builder, obj: &Path) -> Material {
        let diffuse_texture = self.diffuse_texture(builder, obj);
        let specular_texture = self.specular_map.as_ref().and_then(|map| {
            let path = map.path(builder, obj)?;
            builder.texture(obj, Wanted::Colour(path))
        });
        let normal_texture = self.bump.as_ref().and_then(|map| {
            let path = map.path(builder, obj)?;
            builder.texture(obj, Wanted::Normals(path, map.options.bump.to_bits()))
        });
        let has_mask = self.mask.is_some() && diffuse_texture.is_some();
        // A texture alone is the reflectance itself; without anything the body is grey and has no gloss.
        let bare_diffuse = if diffuse_texture.is_some() && self.diffuse_map.is_some() {
            1.0
        } else {
            0.5
        };
        let unit = |rgb: [f32; 3]| rgb.map(|v| v.clamp(0.0, 1.0));
        let base = unit(self.diffuse.unwrap_or([bare_diffuse; 3]));
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
            ..MTL_DEFAULT
        }
    }

    fn exponent(&self) -> f32 {
        self.shininess.unwrap_or(1.0).clamp(1.0, 1e5)
    }

    fn phong_specular(&self, texture: Option<usize>) -> [f32; 3] {
        if !self.has_highlights() {
            return [0.0; 3];
        }
        let bare = if texture.is_some() { 1.0 } else { 0.0 };
        self.specular
            .unwrap_or([bare; 3])
            .map(|v| v.clamp(0.0, 1.0))
    }

    /// The PBR keys, if any is there: `Pm`, `Pr` and the means of their maps. `Ni` is the index of refraction.
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
            Some(mask) => Wanted::Masked(colour, mask, channel.unwrap_or_default()),
            None => Wanted::Colour(colour?),
        };
        builder.texture(obj, wanted)
    }

    /// Whether the material reflects specularly at all. The illumination models 0 and 1 of MTL (`illum`) have no highlights;
    /// many exporters write a stray `Ks` beside them.
    fn has_highlights(&self) -> bool {
        !matches!(self.illumination, Some(0 | 1))
    }

    /// `d`, else 1 − `Tr`. `Tr 1` alone is read as opaque: some exporters mean that, and nobody exports the invisible. So is
    /// `d 0` beside a mask: the mask says where it is opaque.
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

/// The libraries that the rest of one `mtllib` line names: one file with spaces in its name, or several files with
/// `\ ` for a space.
pub(in crate::scene) fn find_libraries(
    builder: &mut Builder,
    obj: &Path,
    folder: &Path,
    rest: &str,
) -> Vec<PathBuf> {
    if let Place::Found(path) = builder.files.find(folder, rest.trim_matches('"')) {
        return vec![path];
    }
    // No file name holds a NUL, so it can stand for an escaped space while the line is split.
    let escaped = rest.replace("\\ ", "\0");
    let mut found = Vec::new();
    for name in escaped.split_whitespace() {
        match builder.files.find(folder, &name.replace('\0', " ")) {
            Place::Found(path) => found.push(path),
            Place::Outside(path) => builder.warn_outside(obj, &path),
            Place::Missing(_) => {}
        }
    }
    found
}

#[cfg(test)]
#[path = "mtl_tests.rs"]
mod tests;
