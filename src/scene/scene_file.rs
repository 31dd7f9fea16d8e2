//! Scene files (TOML): meshes with their placements, and tables of options named as on the command line.
//!
//! Options are kept as pairs of text. The code that defines the options interprets them later and decides which of them each
//! table may contain.

use std::path::{Path, PathBuf};

use glam::{DAffine3, DQuat, DVec3, EulerRot};
use serde::{Deserialize, Serialize};
use toml::{Table, Value};

use crate::scene::builder::Builder;
use crate::scene::error::SceneError;
use crate::scene::placement::{Placement, Unit, Up, upright};
use crate::scene::{LoadOptions, append_model};

const MESH_KEYS: &[&str] = &[
    "file",
    "translate",
    "rotate",
    "scale",
    "up",
    "unit",
    "smooth",
];

/// Pairs of option name and value, as on the command line.
type Pairs = Vec<(String, String)>;

/// A named set of options of a scene file: the name is that of a table, or one the user selects by.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NamedOptions {
    /// The name.
    pub name: String,
    /// The options, for instance `("eye", "1,2,3")`.
    pub options: Vec<(String, String)>,
}

/// A camera selected by `--camera NAME`.
pub type NamedCamera = NamedOptions;
/// Sun, sky and exposure selected by `--moment NAME`.
pub type NamedMoment = NamedOptions;

/// Settings of a scene file other than its meshes; see [`Loaded`](crate::scene::Loaded).
#[derive(Debug, Default)]
pub(super) struct SceneFileOptions {
    pub options: Vec<NamedOptions>,
    pub cameras: Vec<NamedCamera>,
    pub moments: Vec<NamedMoment>,
}

/// Adds the meshes of a scene file to the scene; returns its options.
///
/// Without an unnamed `[camera]`, the first named one is used in its place.
pub(super) fn append_scene(
    builder: &mut Builder,
    path: &Path,
    defaults: &LoadOptions,
) -> Result<SceneFileOptions, SceneError> {
    let text = builder.files.read_text(path)?;
    let wrong = |what: String| SceneError::SceneFile {
        path: path.to_owned(),
        what,
    };
    let table = parse(&text).map_err(wrong)?;
    let meshes = meshes(&table, defaults).map_err(wrong)?;
    let mut options = options(&table).map_err(wrong)?;
    let (camera, cameras) = cameras(&table).map_err(wrong)?;
    let moments = moments(&table).map_err(wrong)?;
    let camera = camera.or_else(|| cameras.first().map(|c| c.options.clone()));
    options.extend(camera.map(camera_table));
    let folder = path.parent().unwrap_or(Path::new(""));
    let sky = options.iter_mut().filter(|table| table.name == "sky");
    for (_, file) in sky.flat_map(|table| &mut table.options).filter(is_weather) {
        *file = weather_file(folder, file);
    }
    let whole = builder.progress;
    for (i, mesh) in meshes.iter().enumerate() {
        builder.progress = whole.part(i, meshes.len());
        append_model(builder, &folder.join(&mesh.file), &mesh.placement)?;
    }
    let has_unit = defaults.unit.is_some() || meshes.iter().any(|mesh| mesh.has_unit);
    builder.warn_of_size(path, has_unit);
    Ok(SceneFileOptions {
        options,
        cameras,
        moments,
    })
}

/// Whether a key names a weather file.
fn is_weather((key, _): &&mut (String, String)) -> bool {
    key == "weather"
}

/// A weather file whose name is relative to a folder. A name without an extension that is no file there stays: it may be that of bundled weather.
fn weather_file(folder: &Path, file: &str) -> String {
    let beside = folder.join(file);
    if Path::new(file).extension().is_none() && !beside.exists() {
        return file.to_owned();
    }
    beside.to_string_lossy().into_owned()
}

/// The weather file that a scene file names: `weather` in `[sky]`.
pub fn weather_of(scene_file: &Path) -> Option<PathBuf> {
    let extension = scene_file.extension()?;
    let is_scene_file = extension.eq_ignore_ascii_case("toml");
    let text = is_scene_file.then(|| std::fs::read_to_string(scene_file));
    let table = parse(&text?.ok()?).ok()?;
    let file = table.get("sky")?.get("weather")?.as_str()?;
    let folder = scene_file.parent().unwrap_or(Path::new(""));
    Some(weather_file(folder, file).into())
}

fn parse(text: &str) -> Result<Table, String> {
    let table: Table = text.parse().map_err(|error: toml::de::Error| {
        let before = error
            .span()
            .and_then(|span| text.get(..span.start))
            .unwrap_or("");
        let line = before.matches('\n').count() + 1;
        let what: Vec<&str> = error.message().split_whitespace().collect();
        format!("line {line} is no TOML: {}", what.join(" "))
    })?;
    Ok(table)
}

/// The option table of the default camera.
pub(super) fn camera_table(options: Pairs) -> NamedOptions {
    NamedOptions {
        name: "camera".to_owned(),
        options,
    }
}

fn known_keys(table: &Table, place: &str, known: &[&str]) -> Result<(), String> {
    match table.keys().find(|key| !known.contains(&key.as_str())) {
        Some(key) => Err(format!(
            "unknown key \"{key}\" in {place}; known are {}",
            known.join(", ")
        )),
        None => Ok(()),
    }
}

struct Mesh {
    file: PathBuf,
    placement: Placement,
    /// Whether its size is meant as it is.
    has_unit: bool,
}

fn meshes(table: &Table, defaults: &LoadOptions) -> Result<Vec<Mesh>, String> {
    let list = match table.get("mesh") {
        Some(Value::Array(list)) if !list.is_empty() => list,
        Some(_) => return Err("mesh must be a list of tables; write [[mesh]]".to_owned()),
        None => return Err("has no [[mesh]]; add one with file = \"model.obj\"".to_owned()),
    };
    list.iter().map(|entry| mesh(entry, defaults)).collect()
}

fn mesh(entry: &Value, defaults: &LoadOptions) -> Result<Mesh, String> {
    let table = entry
        .as_table()
        .ok_or("mesh must be a list of tables; write [[mesh]]")?;
    known_keys(table, "[[mesh]]", MESH_KEYS)?;
    let file = table
        .get("file")
        .and_then(Value::as_str)
        .filter(|file| !file.is_empty());
    let file = PathBuf::from(file.ok_or("[[mesh]] needs file = \"model.obj\"")?);
    if file
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("toml"))
    {
        return Err(format!(
            "[[mesh]] file \"{}\" is a scene file; name a model (.obj)",
            file.display()
        ));
    }
    let smooth_deg = match table.get("smooth") {
        Some(value) => Some(
            number(value)
                .filter(|d| (0.0..=180.0).contains(d))
                .ok_or("smooth must be 0..180 degrees")? as f32,
        ),
        None => defaults.smooth_deg,
    };
    Ok(Mesh {
        file,
        placement: Placement {
            world_from_mesh: transform(table, defaults)?,
            smooth_deg,
        },
        has_unit: ["unit", "scale"].iter().any(|key| table.contains_key(*key)),
    })
}

/// Applies `up` and `unit`, then `scale`, then `rotate` about x, y and z in this order, then `translate`, metres.
fn transform(table: &Table, defaults: &LoadOptions) -> Result<DAffine3, String> {
    let translate = vector(table, "translate")?.unwrap_or(DVec3::ZERO);
    let rotate = vector(table, "rotate")?.unwrap_or(DVec3::ZERO) * 1f64.to_radians();
    let scale = scale(table)?;
    let up = match table.get("up").map(|up| up.as_str()) {
        None => defaults.up,
        Some(Some("y")) => Up::Y,
        Some(Some("z")) => Up::Z,
        Some(_) => return Err("up of a [[mesh]] must be \"y\" or \"z\"".to_owned()),
    };
    let unit = match table.get("unit").map(|unit| unit.as_str()) {
        None => defaults.unit.unwrap_or(Unit::M),
        Some(name) => unit(name.unwrap_or_default())
            .ok_or("unit of a [[mesh]] must be \"mm\", \"cm\", \"m\", \"in\" or \"ft\"")?,
    };
    let rotation = DQuat::from_euler(EulerRot::ZYX, rotate.z, rotate.y, rotate.x);
    let placed = DAffine3::from_scale_rotation_translation(scale, rotation, translate);
    Ok(placed * upright(up, unit))
}

fn unit(name: &str) -> Option<Unit> {
    Some(match name {
        "mm" => Unit::Mm,
        "cm" => Unit::Cm,
        "m" => Unit::M,
        "in" => Unit::In,
        "ft" => Unit::Ft,
        _ => return None,
    })
}

fn scale(table: &Table) -> Result<DVec3, String> {
    let scale = match table.get("scale") {
        None => DVec3::ONE,
        Some(Value::Array(_)) => vector(table, "scale")?.unwrap_or(DVec3::ONE),
        Some(value) => DVec3::splat(number(value).ok_or("scale must be a number or three")?),
    };
    // Outside this range a model is a point or overflows.
    let sound = scale.abs().min_element() >= 1e-6 && scale.abs().max_element() <= 1e6;
    sound
        .then_some(scale)
        .ok_or_else(|| "scale must be 0.000001 to 1000000 (negative mirrors)".to_owned())
}

fn number(value: &Value) -> Option<f64> {
    let number = value
        .as_float()
        .or_else(|| value.as_integer().map(|i| i as f64))?;
    number.is_finite().then_some(number)
}

fn vector(table: &Table, key: &str) -> Result<Option<DVec3>, String> {
    let Some(value) = table.get(key) else {
        return Ok(None);
    };
    let numbers: Option<Vec<f64>> = value
        .as_array()
        .and_then(|list| list.iter().map(number).collect());
    match numbers.as_deref() {
        Some([x, y, z]) => Ok(Some(DVec3::new(*x, *y, *z))),
        _ => Err(format!(
            "{key} must be three numbers, for instance [0, 1.5, 0]"
        )),
    }
}

/// The option tables, in order of their names.
fn options(table: &Table) -> Result<Vec<NamedOptions>, String> {
    let others = table
        .iter()
        .filter(|(name, _)| !["mesh", "camera", "moment"].contains(&name.as_str()));
    let option_table = |(name, value): (&String, &Value)| match value {
        Value::Table(table) => Ok(NamedOptions {
            name: name.clone(),
            options: table_pairs(table)?,
        }),
        _ => Err(format!(
            "unknown key \"{name}\" in the scene file; options stand in tables such as [sky]"
        )),
    };
    others.map(option_table).collect()
}

fn table_pairs(table: &Table) -> Result<Pairs, String> {
    table
        .iter()
        .map(|(key, value)| Ok((key.clone(), option_text(key, value)?)))
        .collect()
}

/// A value as it would be typed after `--key=`.
pub(crate) fn option_text(key: &str, value: &Value) -> Result<String, String> {
    match value {
        Value::String(text) => Ok(text.clone()),
        Value::Integer(number) => Ok(number.to_string()),
        Value::Float(number) => Ok(number.to_string()),
        Value::Datetime(moment) => Ok(moment.to_string()),
        Value::Array(list) => {
            let words: Result<Vec<_>, _> = list
                .iter()
                .map(|value| {
                    if value.is_array() {
                        Err(bad_value(key))
                    } else {
                        option_text(key, value)
                    }
                })
                .collect();
            Ok(words?.join(","))
        }
        Value::Boolean(_) | Value::Table(_) => Err(bad_value(key)),
    }
}

fn bad_value(key: &str) -> String {
    format!("{key} must be a number, a text or a list of numbers")
}

/// The moments: named sets of options.
fn moments(table: &Table) -> Result<Vec<NamedMoment>, String> {
    let list = match table.get("moment") {
        None => return Ok(Vec::new()),
        Some(Value::Array(list)) => list,
        Some(_) => return Err("moment must be a list of tables; write [[moment]]".to_owned()),
    };
    let mut named: Vec<NamedMoment> = Vec::new();
    for entry in list {
        let table = entry
            .as_table()
            .ok_or("moment must be a list of tables; write [[moment]]")?;
        let (name, options) = split_name(table_pairs(table)?);
        let name = name.ok_or("a [[moment]] needs name = \"..\"")?;
        if named.iter().any(|m| m.name == name) {
            return Err(format!("two moments are named \"{name}\"; rename one"));
        }
        named.push(NamedMoment { name, options });
    }
    Ok(named)
}

fn split_name(pairs: Pairs) -> (Option<String>, Pairs) {
    let (name, options): (Pairs, Pairs) = pairs.into_iter().partition(|(key, _)| key == "name");
    (name.into_iter().next().map(|(_, name)| name), options)
}

/// The options of the unnamed camera, if there is one, and the named cameras.
fn cameras(table: &Table) -> Result<(Option<Pairs>, Vec<NamedCamera>), String> {
    let entries: Vec<&Value> = match table.get("camera") {
        None => Vec::new(),
        Some(Value::Array(list)) => list.iter().collect(),
        Some(single) => vec![single],
    };
    let mut nameless = None;
    let mut named: Vec<NamedCamera> = Vec::new();
    for entry in entries {
        let table = entry
            .as_table()
            .ok_or("camera must be a table; write [camera]")?;
        let (name, options) = split_name(table_pairs(table)?);
        match name {
            Some(name) if named.iter().any(|c| c.name == name) => {
                return Err(format!("two cameras are named \"{name}\"; rename one"));
            }
            Some(name) => named.push(NamedCamera { name, options }),
            None if nameless.is_some() => {
                return Err("two cameras have no name; add name = \"..\"".to_owned());
            }
            None => nameless = Some(options),
        }
    }
    Ok((nameless, named))
}

#[cfg(test)]
#[path = "scene_file_tests.rs"]
mod tests;
