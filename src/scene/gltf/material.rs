//! glTF materials: reflection by GGX, the same as ρ_d, ρ_s and p by [`phong_of`], and L_e.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use glam::{Affine2, Vec2};

use crate::scene::builder::Builder;
use crate::scene::files::Lookup;
use crate::scene::glass;
use crate::scene::gltf::buffers::{Buffers, Uri, resolve};
use crate::scene::gltf::extensions::Told;
use crate::scene::gltf::item::Item;
use crate::scene::losses::Losses;
use crate::scene::material::{
    MTL_DEFAULT, Material, MetallicRoughness, SpecularGlossiness, phong_of, phong_of_glossiness,
};
use crate::scene::mesh::soup::{MaterialUse, NONE};
use crate::scene::microfacet::Microfacet;
use crate::scene::texture::Wrap;
use crate::scene::texture::picture::{EmbeddedImage, TextureKey, TextureKind};

/// A material as used by meshes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surface {
    /// The material; its texture transform has v pointing down.
    pub material: MaterialUse,
    /// Index of the texture coordinate set.
    pub texcoord_set: usize,
}

/// The materials that meshes use, read when first used.
#[derive(Debug, Default)]
pub struct Materials(HashMap<Option<usize>, Surface>);

/// What materials are read from and told to.
pub struct Source<'r, 'p, 'j> {
    pub builder: &'r mut Builder<'p>,
    pub path: &'r Path,
    pub root: Item<'j>,
    pub buffers: &'r Buffers<'j>,
    pub losses: &'r mut Losses,
    pub told: &'r mut Told,
}

impl Materials {
    /// The material of a primitive.
    pub fn of(&mut self, source: Source<'_, '_, '_>, primitive: Item<'_>) -> Surface {
        let index = primitive.get("material").index();
        if let Some(surface) = self.0.get(&index) {
            return *surface;
        }
        let item = index.map(|i| source.root.get("materials").at(i));
        let surface = match item.filter(|item| item.exists()) {
            Some(item) => {
                let number = index.unwrap_or_default();
                Reader {
                    source,
                    number,
                    item,
                }
                .surface()
            }
            None => {
                if primitive.get("material").exists() {
                    let place =
                        || index.map_or("material".to_owned(), |i| format!("materials[{i}]"));
                    let what = "materials that do not exist drawn grey";
                    source.losses.add(what, place);
                }
                Surface {
                    material: MaterialUse::plain(source.builder.add_material(MTL_DEFAULT)),
                    texcoord_set: 0,
                }
            }
        };
        self.0.insert(index, surface);
        surface
    }
}

/// Reads one material.
struct Reader<'r, 'p, 'j> {
    source: Source<'r, 'p, 'j>,
    number: usize,
    item: Item<'j>,
}

impl<'j> Reader<'_, '_, 'j> {
    fn surface(&mut self) -> Surface {
        self.source.told.see(self.item);
        let (material, [colour, roughness]) = self.material();
        let emissive = self.item.get("emissiveTexture");
        let maps = [
            (colour, material.diffuse_texture),
            (self.item.get("normalTexture"), material.normal_texture),
            (emissive, material.emissive_texture),
            (roughness, material.microfacet.and_then(|m| m.texture)),
        ];
        let mut placed = maps.iter().filter(|(_, texture)| texture.is_some());
        let first = placed.next().map(|(info, _)| transform(*info));
        let (texcoord_set, texture_from_mesh) = first.unwrap_or((0, Affine2::IDENTITY));
        if placed.any(|(info, _)| Some(transform(*info)) != first) {
            let place = format!("materials[{}] \"{}\"", self.number, material.name);
            let what = "materials whose maps differ in their texture coordinates drawn with those of the first map";
            self.source.losses.add(what, || place);
        }
        let has_normal_map = material.normal_texture.is_some();
        let index = if material.is_drawn() {
            self.source.builder.add_material(material)
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

    /// The material, and the textures of its colour and its roughness as the file gives them.
    fn material(&mut self) -> (Material, [Item<'j>; 2]) {
        let cutoff = match self.item.get("alphaMode").text() {
            Some("MASK") => Some(self.item.get("alphaCutoff").float(0.5)),
            Some("BLEND") => Some(0.5),
            _ => None,
        };
        let gloss = self.item.extension("KHR_materials_pbrSpecularGlossiness");
        let pbr = self.item.get("pbrMetallicRoughness");
        let (factor, map) = if gloss.is_object() {
            (gloss.get("diffuseFactor"), gloss.get("diffuseTexture"))
        } else {
            (pbr.get("baseColorFactor"), pbr.get("baseColorTexture"))
        };
        let [r, g, b, alpha] = factor.floats([1.0; 4]);
        let base = [r, g, b];
        let roughness = pbr.get("metallicRoughnessTexture");
        let ((diffuse, specular, shininess), microfacet) = if gloss.is_object() {
            let surface = self.specular_glossiness(gloss, base);
            let microfacet = Microfacet::of_glossiness(&surface);
            (phong_of_glossiness(&surface), microfacet)
        } else {
            let surface = self.metallic_roughness(pbr, base);
            (phong_of(&surface), self.microfacet(pbr, &surface))
        };
        let kind = match cutoff {
            None => TextureKind::Colour,
            Some(_) => TextureKind::ColourAndAlpha as fn(PathBuf) -> TextureKind,
        };
        let diffuse_texture = self.texture(map, kind);
        let normal = self.item.get("normalTexture");
        let normal_texture =
            self.texture(normal, |path| TextureKind::Normals(path, 1f32.to_bits()));
        let (emission, emissive_texture) = self.emitted();
        let finite = |v: f32| if v.is_finite() { v } else { 1.0 };
        let material = Material {
            name: self.item.get("name").text().unwrap_or_default().to_owned(),
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
            normal_scale: finite(normal.get("scale").float(1.0)),
            emission,
            emissive_texture,
            glass: self.glass(base, alpha, map),
            microfacet: Some(microfacet),
        };
        (material, [map, roughness])
    }

    /// The surface for GGX, with the texture of its roughness and metalness instead of their means.
    fn microfacet(&mut self, pbr: Item<'_>, surface: &MetallicRoughness) -> Microfacet {
        let specular = self.item.extension("KHR_materials_specular");
        let f90 = if surface.specular == [0.0; 3] {
            0.0
        } else {
            specular.get("specularFactor").float(1.0)
        };
        if self.item.extension("KHR_materials_unlit").exists() {
            return Microfacet::of_metallic_roughness(surface, f90);
        }
        let texture = self.texture(pbr.get("metallicRoughnessTexture"), TextureKind::Numbers);
        let (metallic, roughness) = match texture {
            Some(_) => (
                pbr.get("metallicFactor").float(1.0),
                pbr.get("roughnessFactor").float(1.0),
            ),
            None => (surface.metallic, surface.roughness),
        };
        let surface = MetallicRoughness {
            metallic,
            roughness,
            ..*surface
        };
        Microfacet {
            texture,
            ..Microfacet::of_metallic_roughness(&surface, f90)
        }
    }

    /// The glass of a transmitting material, or of one that is blended without a texture: with one it is a cut-out.
    fn glass(&mut self, base: [f32; 3], alpha: f32, map: Item<'_>) -> Option<[f32; 3]> {
        let transmission = self.item.extension("KHR_materials_transmission");
        let factor = transmission.get("transmissionFactor").float(0.0);
        let blends = self.item.get("alphaMode").text() == Some("BLEND") && !map.is_object();
        if factor > 0.0 && transmission.get("transmissionTexture").is_object() {
            let instead = "its factor holds for the whole material";
            self.source
                .told
                .tell("transmissionTexture of KHR_materials_transmission", instead);
        }
        glass::of_gltf(base, factor, blends.then_some(alpha))
    }

    /// L_e, in the candelas per square metre of the specification, and its texture.
    fn emitted(&mut self) -> ([f32; 3], Option<usize>) {
        let strength = self.item.extension("KHR_materials_emissive_strength");
        let strength = strength.get("emissiveStrength").float(1.0);
        let factor = self.item.get("emissiveFactor").floats([0.0; 3]);
        let name = self.item.get("name").text().unwrap_or_default();
        let factor = factor.map(|v| v * strength);
        let emission = self.source.builder.emission(self.source.path, name, factor);
        if emission == [0.0; 3] {
            return (emission, None);
        }
        let texture = self.item.get("emissiveTexture");
        (emission, self.texture(texture, TextureKind::Colour))
    }

    /// Roughness and metalness textures are replaced by their means, because the lecture's p is constant over a material.
    fn metallic_roughness(&mut self, pbr: Item<'_>, base: [f32; 3]) -> MetallicRoughness {
        let [_, roughness, metallic, _] = self.mean(pbr.get("metallicRoughnessTexture"));
        let specular = self.item.extension("KHR_materials_specular");
        let factor = specular.get("specularFactor").float(1.0);
        let colour = specular.get("specularColorFactor").floats([1.0; 3]);
        let ior = self.item.extension("KHR_materials_ior");
        if self.item.extension("KHR_materials_unlit").exists() {
            let instead = "its surfaces are lit like matt ones";
            self.source.told.tell("KHR_materials_unlit", instead);
            return MetallicRoughness {
                base,
                metallic: 0.0,
                roughness: 1.0,
                ior: 1.5,
                specular: [0.0; 3],
            };
        }
        MetallicRoughness {
            base,
            metallic: pbr.get("metallicFactor").float(1.0) * metallic,
            roughness: pbr.get("roughnessFactor").float(1.0) * roughness,
            ior: ior.get("ior").float(1.5),
            specular: colour.map(|c| c * factor),
        }
    }

    /// The texture is replaced by its mean, as those of metallic-roughness are.
    fn specular_glossiness(&mut self, gloss: Item<'_>, diffuse: [f32; 3]) -> SpecularGlossiness {
        let [r, g, b, glossiness] = self.mean(gloss.get("specularGlossinessTexture"));
        let [fr, fg, fb] = gloss.get("specularFactor").floats([1.0; 3]);
        let linear = crate::scene::texture::linear_from_srgb;
        SpecularGlossiness {
            diffuse,
            specular: [fr * linear(r), fg * linear(g), fb * linear(b)],
            glossiness: gloss.get("glossinessFactor").float(1.0) * glossiness,
        }
    }

    /// Mean of a texture, RGBA as encoded; 1 without a texture.
    fn mean(&mut self, info: Item<'_>) -> [f32; 4] {
        let picture = self.picture(info);
        let Source { builder, path, .. } = &mut self.source;
        picture.map_or([1.0; 4], |picture| builder.mean(path, &picture))
    }

    fn texture(
        &mut self,
        info: Item<'_>,
        kind: impl FnOnce(PathBuf) -> TextureKind,
    ) -> Option<usize> {
        let picture = self.picture(info)?;
        let texture = self
            .source
            .root
            .get("textures")
            .at(info.get("index").index()?);
        let sampler = texture.get("sampler").index();
        let sampler = sampler.map(|i| self.source.root.get("samplers").at(i));
        let wrap = |key: &str| match sampler.and_then(|sampler| sampler.get(key).index()) {
            Some(33_071) => Wrap::Clamp,
            Some(33_648) => Wrap::Mirror,
            _ => Wrap::Repeat,
        };
        let key = TextureKey {
            kind: kind(picture),
            wrap: [wrap("wrapS"), wrap("wrapT")],
        };
        self.source.builder.texture(self.source.path, key)
    }

    /// The path of a texture's image; embedded images get a synthetic one.
    fn picture(&mut self, info: Item<'_>) -> Option<PathBuf> {
        if !info.exists() {
            return None;
        }
        let number = info.get("index").index();
        let image = number.and_then(|number| self.image(number));
        let Some(image) = image else {
            let place = || number.map_or("a texture".to_owned(), |i| format!("textures[{i}]"));
            let what = "textures without a picture that is read, drawn without them";
            self.source.losses.add(what, place);
            return None;
        };
        match self.locate(image) {
            Ok(path) => path,
            Err(why) => {
                let what = "pictures that cannot be read, drawn without them";
                self.source
                    .losses
                    .add(what, || format!("images[{image}]: {why}"));
                None
            }
        }
    }

    /// Number of the image of a texture. WebP comes before the picture for programs that do not read it; other kinds are told of.
    fn image(&mut self, number: usize) -> Option<usize> {
        let texture = self.source.root.get("textures").at(number);
        self.source.told.see(texture);
        let webp = texture.extension("EXT_texture_webp").get("source").index();
        if let Some(image) = webp.or(texture.get("source").index()) {
            return Some(image);
        }
        for name in texture.extensions() {
            if texture.extension(name).get("source").exists() {
                let instead = "its pictures are not read; save them as PNG, JPEG or WebP";
                self.source.told.tell(name, instead);
            }
        }
        None
    }

    fn locate(&mut self, number: usize) -> Result<Option<PathBuf>, String> {
        let Source {
            builder,
            path,
            root,
            buffers,
            ..
        } = &mut self.source;
        let image = root.get("images").at(number);
        let bytes = match (image.get("uri").text(), image.get("bufferView").index()) {
            (Some(uri), _) => match resolve(builder, path, uri)? {
                Uri::File(Lookup::Found(path) | Lookup::Missing(path)) => return Ok(Some(path)),
                Uri::File(Lookup::Outside(outside)) => {
                    builder.warn_outside(path, &outside);
                    return Ok(None);
                }
                Uri::Data(bytes) => EmbeddedImage {
                    range: 0..bytes.len(),
                    bytes: Rc::new(bytes),
                },
            },
            (None, Some(view)) => buffers.picture(view)?,
            (None, None) => return Err("it has neither a URI nor a buffer view".to_owned()),
        };
        let mut name = path.as_os_str().to_owned();
        name.push(format!(" image {number}"));
        let name = PathBuf::from(name);
        builder.textures.insert(name.clone(), bytes);
        Ok(Some(name))
    }
}

/// The texture coordinate set and the transform of KHR_texture_transform (scale, then rotation, then offset).
fn transform(info: Item<'_>) -> (usize, Affine2) {
    let set = info.get("texCoord").index().unwrap_or(0);
    let transform = info.extension("KHR_texture_transform");
    if !transform.is_object() {
        return (set, Affine2::IDENTITY);
    }
    // Counter-clockwise in the image, which is clockwise in these coordinates because v points down.
    let texture_from_mesh = Affine2::from_scale_angle_translation(
        Vec2::from(transform.get("scale").floats([1.0; 2])),
        -transform.get("rotation").float(0.0),
        Vec2::from(transform.get("offset").floats([0.0; 2])),
    );
    (
        transform.get("texCoord").index().unwrap_or(set),
        texture_from_mesh,
    )
}
