//! glTF materials, converted to ρ_d, ρ_s and p by [`phong_of`], and L_e.

use std::path::{Path, PathBuf};
use std::rc::Rc;

use glam::{Affine2, Vec2};
use gltf::material::AlphaMode;

use crate::scene::builder::Builder;
use crate::scene::files::Lookup;
use crate::scene::gltf::buffers::{Buffers, Uri, resolve};
use crate::scene::material::{MTL_DEFAULT, Material, MetallicRoughness, phong_of};
use crate::scene::mesh::soup::{MaterialUse, NONE};
use crate::scene::texture::picture::{EmbeddedImage, TextureKey};

/// A material as used by meshes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surface {
    /// The material; its texture transform has v pointing down.
    pub material: MaterialUse,
    /// Index of the texture coordinate set.
    pub texcoord_set: u32,
}

/// All materials of a file.
#[derive(Debug)]
pub struct Materials {
    surfaces: Vec<Surface>,
    /// Used for primitives without a material.
    default: Surface,
}

impl Materials {
    /// Reads all materials and their textures.
    pub fn read(
        builder: &mut Builder,
        path: &Path,
        gltf: &gltf::Document,
        buffers: &Buffers,
    ) -> Self {
        let mut reader = Reader {
            builder,
            path,
            buffers,
        };
        let surfaces = gltf.materials().map(|m| reader.surface(&m)).collect();
        let grey = reader.builder.add_material(MTL_DEFAULT);
        Self {
            surfaces,
            default: Surface {
                material: MaterialUse::plain(grey),
                texcoord_set: 0,
            },
        }
    }

    /// The material of a primitive.
    pub fn of(&self, material: &gltf::Material<'_>) -> Surface {
        let known = material.index().and_then(|i| self.surfaces.get(i));
        known.copied().unwrap_or(self.default)
    }
}

struct Reader<'r, 'p> {
    builder: &'r mut Builder<'p>,
    path: &'r Path,
    buffers: &'r Buffers,
}

impl Reader<'_, '_> {
    fn surface(&mut self, source: &gltf::Material<'_>) -> Surface {
        let pbr = source.pbr_metallic_roughness();
        let colour = pbr.base_color_texture();
        let normal = source.normal_texture();
        let material = self.material(source);
        let emissive = source.emissive_texture();
        let emissive = emissive.filter(|_| material.emissive_texture.is_some());
        let (texcoord_set, texture_from_mesh) = match (&colour, &normal, &emissive) {
            (Some(info), ..) | (None, None, Some(info)) => transform(info),
            (None, Some(info), _) => (info.tex_coord(), Affine2::IDENTITY),
            (None, None, None) => (0, Affine2::IDENTITY),
        };
        if emissive.is_some_and(|info| transform(&info) != (texcoord_set, texture_from_mesh)) {
            let what = "an emissive texture has texture coordinates of its own; those of the other maps are used";
            self.builder.warn(self.path, what);
        }
        if normal.is_some_and(|n| n.tex_coord() != texcoord_set) {
            let what = "a normal map has its own set of texture coordinates; the base colour's set is used";
            self.builder.warn(self.path, what);
        }
        let has_normal_map = material.normal_texture.is_some();
        let index = if material.is_drawn() {
            self.builder.add_material(material)
        } else {
            NONE
        };
        Surface {
            material: MaterialUse {
                index,
                texture_from_mesh,
                has_normal_map,
            },
            texcoord_set,
        }
    }

    fn material(&mut self, source: &gltf::Material<'_>) -> Material {
        let pbr = source.pbr_metallic_roughness();
        let [r, g, b, alpha] = pbr.base_color_factor();
        let cutoff = match source.alpha_mode() {
            AlphaMode::Opaque => None,
            AlphaMode::Mask => Some(source.alpha_cutoff().unwrap_or(0.5)),
            AlphaMode::Blend => Some(0.5),
        };
        let colour = pbr.base_color_texture();
        let diffuse_texture = colour.and_then(|info| self.colour(&info.texture(), cutoff));
        let normal = source.normal_texture();
        let normal_texture = normal.as_ref().and_then(|info| {
            let picture = self.picture(&info.texture().source())?;
            let wanted = TextureKey::Normals(picture, 1f32.to_bits());
            self.builder.texture(self.path, wanted)
        });
        let (emission, emissive_texture) = self.emitted(source);
        let surface = self.metallic_roughness(source, [r, g, b]);
        let (diffuse, specular, shininess) = phong_of(&surface);
        let finite = |v: f32| if v.is_finite() { v } else { 1.0 };
        Material {
            name: source.name().unwrap_or_default().to_owned(),
            diffuse,
            specular,
            shininess,
            dissolve: if cutoff.is_some() {
                finite(alpha).clamp(0.0, 1.0)
            } else {
                1.0
            },
            alpha_cutoff: cutoff.map(|c| finite(c).clamp(0.0, 1.0)),
            diffuse_texture,
            specular_texture: None,
            normal_texture,
            normal_scale: finite(normal.map_or(1.0, |n| n.scale())),
            emission,
            emissive_texture,
            ..MTL_DEFAULT
        }
    }

    /// L_e, in the candelas per square metre of the specification, and its texture.
    fn emitted(&mut self, source: &gltf::Material<'_>) -> ([f32; 3], Option<usize>) {
        let strength = source.emissive_strength().unwrap_or(1.0);
        let factor = source.emissive_factor().map(|v| v * strength);
        let name = source.name().unwrap_or_default();
        let emission = self.builder.emission(self.path, name, factor);
        let texture = source.emissive_texture();
        let texture = texture.filter(|_| emission != [0.0; 3]);
        let texture = texture.and_then(|info| self.colour(&info.texture(), None));
        (emission, texture)
    }

    /// Roughness and metalness textures are replaced by their means, because p is constant over a material.
    fn metallic_roughness(
        &mut self,
        source: &gltf::Material<'_>,
        base: [f32; 3],
    ) -> MetallicRoughness {
        let pbr = source.pbr_metallic_roughness();
        let map = pbr.metallic_roughness_texture();
        let picture = map.and_then(|info| self.picture(&info.texture().source()));
        let [_, roughness, metallic] =
            picture.map_or([1.0; 3], |path| self.builder.mean(self.path, &path));
        let specular = source.specular();
        let factor = specular.as_ref().map_or(1.0, |s| s.specular_factor());
        let colour = specular.map_or([1.0; 3], |s| s.specular_color_factor());
        MetallicRoughness {
            base,
            metallic: pbr.metallic_factor() * metallic,
            roughness: pbr.roughness_factor() * roughness,
            ior: source.ior().unwrap_or(1.5),
            specular: colour.map(|c| c * factor),
        }
    }

    fn colour(&mut self, texture: &gltf::Texture<'_>, cutoff: Option<f32>) -> Option<usize> {
        let picture = self.picture(&texture.source())?;
        let wanted = if cutoff.is_some() {
            TextureKey::ColourAndAlpha(picture)
        } else {
            TextureKey::Colour(picture)
        };
        self.builder.texture(self.path, wanted)
    }

    /// The path of an image; embedded images get a synthetic one.
    fn picture(&mut self, image: &gltf::Image<'_>) -> Option<PathBuf> {
        let mut name = self.path.as_os_str().to_owned();
        name.push(format!(" image {}", image.index()));
        let name = PathBuf::from(name);
        let bytes = match image.source() {
            gltf::image::Source::View { view, .. } => self.buffers.picture(&view).map(Some),
            gltf::image::Source::Uri { uri, .. } => match resolve(self.builder, self.path, uri) {
                Ok(Uri::File(Lookup::Found(path) | Lookup::Missing(path))) => return Some(path),
                Ok(Uri::File(Lookup::Outside(path))) => {
                    self.builder.warn_outside(self.path, &path);
                    Ok(None)
                }
                Ok(Uri::Data(bytes)) => Ok(Some(EmbeddedImage {
                    range: 0..bytes.len(),
                    bytes: Rc::new(bytes),
                })),
                Err(what) => Err(what),
            },
        };
        match bytes {
            Ok(bytes) => {
                self.builder.textures.insert(name.clone(), bytes?);
                Some(name)
            }
            Err(what) => {
                let what = format!("image {}: {what}", image.index());
                self.builder.warn(self.path, &what);
                None
            }
        }
    }
}

/// The texture coordinate set and the transform of KHR_texture_transform (scale, then rotation, then offset).
fn transform(info: &gltf::texture::Info<'_>) -> (u32, Affine2) {
    let Some(transform) = info.texture_transform() else {
        return (info.tex_coord(), Affine2::IDENTITY);
    };
    let set = transform.tex_coord().unwrap_or(info.tex_coord());
    // Counter-clockwise in the image, which is clockwise in these coordinates because v points down.
    let texture_from_mesh = Affine2::from_scale_angle_translation(
        Vec2::from(transform.scale()),
        -transform.rotation(),
        Vec2::from(transform.offset()),
    );
    (set, texture_from_mesh)
}
