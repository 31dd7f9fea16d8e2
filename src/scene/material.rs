//! Materials: what an MTL file says, as the lecture's ρ_d, ρ_s and p.

use std::borrow::Cow;
use std::fmt::Write;
use std::path::{Path, PathBuf};

use super::builder::Builder;
use super::files::Files;

/// How a surface reflects: Lambert plus a Phong lobe.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// Name in its file.
    pub name: String,
    /// Diffuse reflectance ρ_d (MTL `Kd`), linear RGB, 0..1; multiplies `diffuse_texture`.
    pub diffuse: [f32; 3],
    /// Specular reflectance ρ_s (MTL `Ks`), linear RGB, 0..1; multiplies `specular_texture`.
    pub specular: [f32; 3],
    /// Phong exponent p (MTL `Ns`), 1..100 000.
    pub shininess: f32,
    /// Opacity (MTL `d`, or 1 − `Tr`), 0..1. Materials below 0.5 are not drawn at all.
    pub dissolve: f32,
    /// Number of the texture of ρ_d in [`Scene::textures`](super::Scene::textures).
    pub diffuse_texture: Option<usize>,
    /// Number of the texture of ρ_s in [`Scene::textures`](super::Scene::textures).
    pub specular_texture: Option<usize>,
}

/// The material of a model without materials: a 0.5 grey Lambert body.
pub(super) const MTL_DEFAULT: Material = Material {
    name: String::new(),
    diffuse: [0.5; 3],
    specular: [0.0; 3],
    shininess: 1.0,
    dissolve: 1.0,
    diffuse_texture: None,
    specular_texture: None,
};

impl Default for Material {
    fn default() -> Self {
        MTL_DEFAULT.clone()
    }
}

/// The material libraries of one OBJ file.
#[derive(Debug, Default)]
pub(super) struct Libraries {
    /// All of them in one, in the form that `tobj` reads; a map's "file name" is its number in `maps`.
    pub text: String,
    /// The textures that the materials name.
    maps: Vec<PathBuf>,
}

impl Libraries {
    /// Reads what the rests of the `mtllib` lines name. A library that is missing is a warning.
    pub fn read(builder: &mut Builder, obj: &Path, folder: &Path, names: &[String]) -> Self {
        let mut libraries = Self::default();
        let mut seen: Vec<PathBuf> = Vec::new();
        for rest in names {
            let found = find_libraries(&builder.files, folder, rest);
            if found.is_empty() {
                builder.warn(
                    obj,
                    &format!("material library \"{rest}\" is missing; drawn grey"),
                );
            }
            for path in found {
                if seen.contains(&path) {
                    continue;
                }
                match builder.files.read_text(&path) {
                    Ok(text) => libraries.add(builder, &path, &text),
                    Err(error) => builder.scene.warnings.push(error.to_string()),
                }
                seen.push(path);
            }
        }
        libraries
    }

    fn add(&mut self, builder: &mut Builder, path: &Path, text: &str) {
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut bad = Vec::new();
        for (number, line) in text.lines().enumerate() {
            if !self.line(&builder.files, folder, line.trim()) {
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

    /// Writes the line as `tobj` wants it (it panics at a colour of two numbers). False for nonsense.
    fn line(&mut self, files: &Files, folder: &Path, line: &str) -> bool {
        let (key, rest) = line
            .split_once(|c: char| c.is_whitespace())
            .unwrap_or((line, ""));
        let rest = rest.trim();
        let key = key.to_ascii_lowercase();
        match key.as_str() {
            "newmtl" => {
                let name = if rest.is_empty() { "unnamed" } else { rest };
                self.push("newmtl", name);
                true
            }
            "kd" => self.colour("Kd", rest),
            "ks" => self.colour("Ks", rest),
            "ns" => self.number("Ns", rest),
            "d" => self.number("d", rest.trim_start_matches("-halo").trim()),
            "tr" => self.number("Tr", rest),
            "map_kd" => self.map("map_Kd", files, folder, rest),
            "map_ks" => self.map("map_Ks", files, folder, rest),
            _ => true,
        }
    }

    fn push(&mut self, key: &str, value: &str) {
        let _ = writeln!(self.text, "{key} {value}");
    }

    fn colour(&mut self, key: &str, rest: &str) -> bool {
        let values: Vec<f32> = rest
            .split_whitespace()
            .take(3)
            .map_while(|w| w.parse().ok())
            .collect();
        let rgb = match values[..] {
            [r, g, b] => [r, g, b],
            [grey] => [grey; 3],
            _ => return false,
        };
        if !rgb.iter().all(|v| v.is_finite()) {
            return false;
        }
        let [r, g, b] = rgb;
        self.push(key, &format!("{r} {g} {b}"));
        true
    }

    fn number(&mut self, key: &str, rest: &str) -> bool {
        let value = rest
            .split_whitespace()
            .next()
            .and_then(|w| w.parse::<f32>().ok());
        let Some(value) = value.filter(|v| v.is_finite()) else {
            return false;
        };
        self.push(key, &value.to_string());
        true
    }

    fn map(&mut self, key: &str, files: &Files, folder: &Path, rest: &str) -> bool {
        let name = texture_name(rest);
        if name.is_empty() {
            return false;
        }
        let number = self.maps.len().to_string();
        self.push(key, &number);
        self.maps.push(find(files, folder, name));
        true
    }

    /// The scene's material for one of `tobj`'s, its textures decoded.
    pub fn material(&self, builder: &mut Builder, obj: &Path, source: &tobj::Material) -> Material {
        let diffuse_texture = self.texture(builder, obj, source.diffuse_texture.as_deref());
        let specular_texture = self.texture(builder, obj, source.specular_texture.as_deref());
        // A texture alone is the reflectance itself; without anything the body is grey and has no gloss.
        let bare_diffuse = if diffuse_texture.is_some() { 1.0 } else { 0.5 };
        let bare_specular = if specular_texture.is_some() { 1.0 } else { 0.0 };
        Material {
            name: source.name.clone(),
            diffuse: source
                .diffuse
                .unwrap_or([bare_diffuse; 3])
                .map(|v| v.clamp(0.0, 1.0)),
            specular: if has_highlights(source) {
                source
                    .specular
                    .unwrap_or([bare_specular; 3])
                    .map(|v| v.clamp(0.0, 1.0))
            } else {
                [0.0; 3]
            },
            shininess: source.shininess.unwrap_or(1.0).clamp(1.0, 1e5),
            dissolve: dissolve(source),
            diffuse_texture,
            specular_texture,
        }
    }

    fn texture(&self, builder: &mut Builder, obj: &Path, map: Option<&str>) -> Option<usize> {
        let path = self.maps.get(map?.parse::<usize>().ok()?)?;
        builder.texture(obj, path)
    }
}

/// Whether the material reflects specularly at all. The illumination models 0 and 1 of MTL (`illum`) have no highlights;
/// many exporters write a stray `Ks` beside them.
fn has_highlights(source: &tobj::Material) -> bool {
    !matches!(source.illumination_model, Some(0 | 1))
}

/// `d`, else 1 − `Tr`. `Tr 1` alone is read as opaque: some exporters mean that, and nobody exports the invisible.
fn dissolve(source: &tobj::Material) -> f32 {
    let transparency = || source.unknown_param.get("Tr")?.parse::<f32>().ok();
    let dissolve = match (source.dissolve, transparency()) {
        (Some(d), _) => d,
        (None, Some(tr)) if tr < 1.0 => 1.0 - tr,
        _ => 1.0,
    };
    dissolve.clamp(0.0, 1.0)
}

/// The libraries that the rest of one `mtllib` line names: one file with spaces in its name, or several files with
/// `\ ` for a space.
fn find_libraries(files: &Files, folder: &Path, rest: &str) -> Vec<PathBuf> {
    let whole = find(files, folder, rest.trim_matches('"'));
    if files.has(&whole) {
        return vec![whole];
    }
    // No file name holds a NUL, so it can stand for an escaped space while the line is split.
    let escaped = rest.replace("\\ ", "\0");
    let names = escaped
        .split_whitespace()
        .map(|name| name.replace('\0', " "));
    names
        .map(|name| find(files, folder, &name))
        .filter(|path| files.has(path))
        .collect()
}

/// The file that a name in a model means: beside the model as written, with back-slashes as separators, or, for the
/// absolute paths of somebody else's machine, its last part.
fn find(files: &Files, folder: &Path, name: &str) -> PathBuf {
    let forward: Cow<str> = if name.contains('\\') {
        name.replace('\\', "/").into()
    } else {
        name.into()
    };
    let last = forward.rsplit('/').next().unwrap_or(&forward);
    let candidates = [folder.join(name), folder.join(&*forward), folder.join(last)];
    candidates
        .iter()
        .find(|path| files.has(path))
        .unwrap_or(&candidates[1])
        .clone()
}

/// The file name of a `map_..` line: options before it (`-s 1 1 1`, `-bm 2`, ..) and after it are left out.
fn texture_name(rest: &str) -> &str {
    let mut rest = rest.trim();
    while let Some((option, tail)) = option_word(rest) {
        rest = skip_arguments(option, tail);
    }
    let known = [
        " -bm ",
        " -o ",
        " -s ",
        " -t ",
        " -imfchan ",
        " -clamp ",
        " -blendu ",
        " -blendv ",
        " -mm ",
    ];
    let end = known
        .iter()
        .filter_map(|option| rest.find(option))
        .min()
        .unwrap_or(rest.len());
    rest[..end].trim().trim_matches('"')
}

fn option_word(rest: &str) -> Option<(&str, &str)> {
    let (word, tail) = rest.split_once(char::is_whitespace)?;
    let letters = word.strip_prefix('-')?;
    (!letters.is_empty() && letters.chars().all(char::is_alphabetic))
        .then_some((letters, tail.trim_start()))
}

fn skip_arguments<'a>(option: &str, tail: &'a str) -> &'a str {
    let numbers_only = matches!(option, "o" | "s" | "t");
    let most = match option {
        "o" | "s" | "t" => 3,
        "mm" => 2,
        _ => 1,
    };
    let mut rest = tail;
    for _ in 0..most {
        // The last word is always the file name.
        let Some((word, tail)) = rest.split_once(char::is_whitespace) else {
            break;
        };
        if numbers_only && word.parse::<f32>().is_err() {
            break;
        }
        rest = tail.trim_start();
    }
    rest
}

#[cfg(test)]
#[path = "material_tests.rs"]
mod tests;
