//! Materials of MTL files, converted to ρ_d, ρ_s, p, L_e and glass.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use glam::{Affine2, Vec2};

use crate::scene::builder::Builder;
use crate::scene::files::Lookup;
use crate::scene::glass;
use crate::scene::material::{MTL_DEFAULT, Material, MetallicRoughness, phong_of};
use crate::scene::number;
use crate::scene::obj::map_options::{MapOptions, map_options};
use crate::scene::texture::Wrap;
use crate::scene::texture::picture::{TextureKey, TextureKind};

/// The statements of one `newmtl` block.
#[derive(Debug, Default, Clone)]
pub struct Entry {
    pub name: String,
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

/// Statements that change the picture in other programs and are not drawn, and the value that does nothing.
const NOT_DRAWN: [(&str, Option<f32>); 19] = [
    ("aniso", Some(0.0)),
    ("bump_parallax", None),
    ("decal", None),
    ("disp", None),
    ("map_aniso", None),
    ("map_decal", None),
    ("map_disp", None),
    ("map_ni", None),
    ("map_ns", None),
    ("map_opacity", None),
    ("map_pc", None),
    ("map_ps", None),
    ("map_refl", None),
    ("map_tf", None),
    ("map_tr", None),
    ("map_transmission", None),
    ("pc", Some(0.0)),
    ("ps", Some(0.0)),
    ("refl", None),
];

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

    fn key(&self, kind: TextureKind) -> TextureKey {
        let wrap = if self.options.clamp {
            Wrap::Clamp
        } else {
            Wrap::Repeat
        };
        TextureKey {
            kind,
            wrap: [wrap; 2],
        }
    }

    /// Path of the image, which may not exist; `None` (with a warning) if it is outside the model's folder.
    fn path(&self, builder: &mut Builder, owner: &Path) -> Option<PathBuf> {
        // A comment may follow the name, and some programs mean the folder of the model.
        let plain = self
            .name
            .split_once(" #")
            .map_or("", |(name, _)| name.trim());
        let model = owner.parent().unwrap_or(Path::new(""));
        let places = [&self.folder, model].map(|folder| [(folder, &*self.name), (folder, plain)]);
        let places = places.into_iter().flatten();
        let lookups = places.filter(|(_, name)| !name.is_empty());
        let mut lookups = lookups.map(|(folder, name)| builder.files.find(folder, name));
        let first = lookups
            .next()
            .unwrap_or_else(|| Lookup::Missing(self.folder.clone()));
        let found = match first {
            Lookup::Missing(_) => lookups
                .find(|l| !matches!(l, Lookup::Missing(_)))
                .unwrap_or(first),
            found => found,
        };
        match found {
            Lookup::Found(path) | Lookup::Missing(path) => Some(path),
            Lookup::Outside(path) => {
                builder.warn_outside(owner, &path);
                None
            }
        }
    }
}

impl Entry {
    pub fn new(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            ..Self::default()
        }
    }

    /// Reads a statement, with its key in small letters; false if it is malformed. What is not drawn is added to `told`.
    pub fn statement(
        &mut self,
        folder: &Path,
        key: &str,
        rest: &str,
        told: &mut BTreeSet<&'static str>,
    ) -> bool {
        let mut map = || {
            let map = Map::read(folder, rest);
            let has_gain = map.as_ref().is_some_and(|map| map.options.has_gain);
            told.extend(has_gain.then_some("-mm"));
            map
        };
        match key {
            "kd" => set(&mut self.diffuse, colour(rest)),
            "ks" => set(&mut self.specular, colour(rest)),
            "ke" => set(&mut self.emission, colour(rest)),
            "ns" => set(&mut self.shininess, float(rest)),
            "ni" => set(&mut self.ior, float(rest)),
            "d" => set(&mut self.dissolve, float(rest.trim_start_matches("-halo"))),
            "tf" => set(&mut self.filter, colour(rest)),
            "tr" => set(&mut self.transparency, float(rest)),
            "pm" => set(&mut self.metallic, float(rest)),
            "pr" => set(&mut self.roughness, float(rest)),
            "illum" => {
                let words = float(rest).filter(|v| (0.0..=10.0).contains(v));
                set(&mut self.illumination, words.map(|v| v as u32))
            }
            "map_kd" => set(&mut self.diffuse_map, map()),
            "map_ks" => set(&mut self.specular_map, map()),
            "map_ke" => set(&mut self.emissive_map, map()),
            "map_d" => set(&mut self.mask, map()),
            "map_bump" | "bump" | "map_kn" | "norm" => set(&mut self.bump, map()),
            "map_pm" => set(&mut self.metallic_map, map()),
            "map_pr" => set(&mut self.roughness_map, map()),
            _ => {
                let known = NOT_DRAWN.iter().find(|(own, _)| *own == key);
                let changes = |idle: Option<f32>| idle.is_none() || float(rest) != idle;
                told.extend(known.filter(|(_, idle)| changes(*idle)).map(|(own, _)| own));
                true
            }
        }
    }

    /// The texture transform of the first map; all maps of a material share their texture coordinates.
    pub fn texture_from_mesh(&self) -> Affine2 {
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

    pub fn material(&self, builder: &mut Builder, obj: &Path) -> Material {
        let diffuse_texture = self.diffuse_texture(builder, obj);
        let specular_texture = colour_texture(builder, obj, self.specular_map.as_ref());
        let (emission, emissive_texture) = self.emitted(builder, obj);
        let normal_texture = self.bump.as_ref().and_then(|map| {
            let path = map.path(builder, obj)?;
            let kind = TextureKind::Normals(path, map.options.bump.to_bits());
            builder.texture(obj, map.key(kind))
        });
        let has_mask = match diffuse_texture {
            Some(texture) => self.mask.is_some() || builder.textures.is_cut_out(texture),
            None => false,
        };
        let base = self.base(diffuse_texture.is_some() && self.diffuse_map.is_some());
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

    /// ρ_d without its texture. A texture without `Kd`, or beside the `Kd 0 0 0` that exporters write, is the reflectance itself;
    /// with neither, the surface is grey.
    fn base(&self, is_textured: bool) -> [f32; 3] {
        let base = match self.diffuse {
            Some(black) if is_textured && black == [0.0; 3] => [1.0; 3],
            Some(given) => given,
            None if is_textured => [1.0; 3],
            None => [0.5; 3],
        };
        base.map(|v| v.clamp(0.0, 1.0))
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
        let kind = match mask {
            Some(mask) => TextureKind::Masked(colour, mask, channel.unwrap_or_default()),
            None => TextureKind::ColourAndCutOut(colour?),
        };
        let map = self.diffuse_map.as_ref().or(self.mask.as_ref())?;
        builder.texture(obj, map.key(kind))
    }

    /// Whether the material has a specular lobe. Illumination models 0 and 1 (`illum`) have none, and many exporters write a
    /// meaningless `Ks` with them.
    fn has_highlights(&self) -> bool {
        !matches!(self.illumination, Some(0 | 1))
    }

    /// Opacity, 0..1: `d`, otherwise 1 − `Tr`. `Tr 1` alone is treated as opaque, because that is what some exporters mean. So
    /// is `d 0` with a mask, because the mask decides where the surface is opaque, and `d 0` with `Tr 0`, which contradict each other.
    fn opacity(&self) -> f32 {
        let opacity = match (self.dissolve, self.transparency) {
            (Some(d), _) if d <= 0.0 && self.mask.is_some() => 1.0,
            (Some(d), Some(tr)) if d <= 0.0 && tr <= 0.0 => 1.0,
            (Some(d), _) => d,
            (None, Some(tr)) if tr < 1.0 => 1.0 - tr,
            _ => 1.0,
        };
        opacity.clamp(0.0, 1.0)
    }
}

/// The texture of a map of colours.
fn colour_texture(builder: &mut Builder, obj: &Path, map: Option<&Map>) -> Option<usize> {
    let map = map?;
    let path = map.path(builder, obj)?;
    builder.texture(obj, map.key(TextureKind::Colour(path)))
}

/// Stores a parsed value; false if there was none.
fn set<T>(place: &mut Option<T>, value: Option<T>) -> bool {
    let read = value.is_some();
    *place = value.or(place.take());
    read
}

fn colour(rest: &str) -> Option<[f32; 3]> {
    let values: Vec<f32> = rest
        .split_whitespace()
        .take(3)
        .map_while(number::parse)
        .map(|v| v as f32)
        .collect();
    let rgb = match values[..] {
        [r, g, b] => [r, g, b],
        [grey] => [grey; 3],
        _ => return None,
    };
    rgb.iter().all(|v| v.is_finite()).then_some(rgb)
}

fn float(rest: &str) -> Option<f32> {
    let value = number::parse(rest.split_whitespace().next()?)? as f32;
    value.is_finite().then_some(value)
}
