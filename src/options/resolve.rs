//! From what the sources set to [`Options`]: their precedence, the cameras, moments and tables of a scene file.

use clap::parser::ValueSource;
use glam::Vec3;

use super::{
    OptionValues, Options, OptionsError, Preset, Reflections, Visibility, all_tables, long, name,
    tables,
};
use crate::error::Error;
use crate::scene::{
    Bounds, Camera, DEFAULT_FOV_DEG, LoadOptions, Loaded, NamedOptions, SceneError,
};

/// Samples from which on shadow maps from the sky are better than ambient occlusion in every view.
const DOME_SAMPLES: u32 = 16;

/// What `--preset lecture` sets, by the course's own defaults.
const LECTURE: [(&str, &str); 16] = [
    ("place", "45,0"),
    ("solar", "200,10"),
    ("sun-position", "lecture"),
    ("refraction", "off"),
    ("sky", "preetham"),
    ("turbidity", "2.4"),
    ("ground-albedo", "0"),
    ("fov", "55"),
    ("tonemap", "linear"),
    ("scale", "0.025"),
    ("gamma", "1"),
    ("irradiance", "monte-carlo"),
    ("irradiance-samples", "2000"),
    ("irradiance-error", "0"),
    ("ao-resolution", "half"),
    ("shadow-size", "4096"),
];

impl Options {
    /// The user's options over the scene file's, over the preset's, over the defaults.
    ///
    /// # Errors
    /// A bad key or value in the scene file, an unknown camera or moment, options that contradict each other.
    pub fn resolve(user: &OptionValues, loaded: &Loaded) -> Result<Self, Error> {
        let scene_file = |e: OptionsError| SceneError::SceneFile {
            path: loaded.path.clone(),
            what: e.0,
        };
        let file = scene_options(loaded).map_err(scene_file)?;
        let mut user = user.clone();
        let mut base = file.clone();
        if let Some(name) = user.get("moment") {
            let moment = find_named("moment", &loaded.moments, name, "--when and --place")?;
            let moment = OptionValues::from(moment.to_vec());
            moment.check().map_err(scene_file)?;
            base = moment.over(base);
        }
        let camera = user.get("camera").map(str::to_owned);
        if let Some(name) = &camera {
            let camera = find_named("camera", &loaded.cameras, name, "--eye and --target")?;
            let camera = OptionValues::from(camera.to_vec());
            camera.check().map_err(scene_file)?;
            // Not a mixture of two cameras: what the named one leaves open is open.
            base.remove(&["eye", "target", "fov"]);
            base = camera.over(base);
        }
        user.remove(&["moment", "camera"]);
        let mut given = user.over(base);
        if given.get("preset") == Some(name(Preset::Lecture)) {
            given = given.over(LECTURE.as_slice().into());
        }
        if let Some(camera) = camera {
            given.set("camera", camera);
        }
        let (mut options, matches) = given.parse()?;
        let is_default = matches.value_source("visibility") == Some(ValueSource::DefaultValue);
        if is_default && options.samples >= DOME_SAMPLES {
            options.visibility = Visibility::Dome;
        }
        options.check()?;
        Ok(options)
    }

    /// Whether they contradict each other.
    fn check(&self) -> Result<(), OptionsError> {
        if self.eye.is_some() && self.eye == self.target {
            let what = "--eye and --target are the same point; move one";
            return Err(OptionsError(what.to_owned()));
        }
        // The dome's shadow maps tell what occludes the sky in reflections.
        if self.reflections == Reflections::Hidden && self.visibility == Visibility::Ssao {
            let what =
                "--reflections hidden needs --visibility dome; give it, or --samples 16 or more";
            return Err(OptionsError(what.to_owned()));
        }
        match self.false_colour {
            Some(quantity) if !self.show.holds(quantity) => Err(OptionsError(format!(
                "--false-colour {quantity} has no meaning for --show {}; leave one out",
                self.show
            ))),
            _ => Ok(()),
        }
    }

    /// How a scene may be loaded; the cache is off.
    pub fn load_options(&self) -> LoadOptions {
        let bytes = |mib: u32| u64::from(mib) << 20;
        LoadOptions {
            smooth_deg: self.smooth.map(|degrees| degrees as f32),
            max_texture_edge: self.max_texture_edge,
            max_texture_bytes: bytes(self.max_texture_mib),
            max_file_bytes: bytes(self.max_file_mib),
            max_triangles: self.max_triangles as usize,
            allow_outside: self.allow_outside,
            cache: None,
        }
    }

    /// The camera for a model within `bounds`; what was not given is chosen so that the model is in view.
    pub fn camera(&self, bounds: &Bounds) -> Camera {
        let point = |p: [f64; 3]| Vec3::from(p.map(|v| v as f32));
        Camera::from_parts(
            self.eye.map(point),
            self.target.map(point),
            Some(self.fov as f32),
            bounds,
            self.aspect(),
        )
    }

    /// A camera that sees all within `bounds`, whatever was given.
    pub fn framing(&self, bounds: &Bounds) -> Camera {
        Camera::framing(bounds, DEFAULT_FOV_DEG, self.aspect())
    }

    /// These options with `camera` in place of what was given of one.
    #[must_use]
    pub fn with_camera(&self, camera: &Camera) -> Self {
        let point = |p: Vec3| Some(p.to_array().map(shortest));
        Self {
            eye: point(camera.eye),
            target: point(camera.target),
            fov: shortest(camera.fov_deg),
            camera: None,
            ..self.clone()
        }
    }

    fn aspect(&self) -> f32 {
        self.size.width as f32 / self.size.height as f32
    }
}

impl From<&[(&str, &str)]> for OptionValues {
    fn from(pairs: &[(&str, &str)]) -> Self {
        let owned = |(name, text): &(&str, &str)| ((*name).to_owned(), (*text).to_owned());
        Self::from(pairs.iter().map(owned).collect::<Vec<_>>())
    }
}

/// The number with the fewest digits that is the same in 32 bits.
fn shortest(value: f32) -> f64 {
    value.to_string().parse().unwrap_or(value.into())
}

/// What the tables of a scene file set; its cameras and moments are checked too.
fn scene_options(loaded: &Loaded) -> Result<OptionValues, OptionsError> {
    let mut all = OptionValues::default();
    for table in &loaded.options {
        if table.name != "camera" && !all_tables().any(|(_, list)| list.contains(&&*table.name)) {
            return Err(unknown_table(&table.name));
        }
        check_keys(&table.options, &table.name, &format!("[{}]", table.name))?;
        for (key, text) in &table.options {
            if all.get(key).is_some() {
                let table = &table.name;
                let what = format!("\"{key}\" is given twice; keep the one in [{table}]");
                return Err(OptionsError(what));
            }
            all.set(key, text);
        }
    }
    for camera in &loaded.cameras {
        check_keys(&camera.options, "camera", "[camera]")?;
    }
    for moment in &loaded.moments {
        check_keys(&moment.options, "moment", "[[moment]]")?;
    }
    all.check()?;
    Ok(all)
}

fn check_keys(pairs: &[(String, String)], table: &str, place: &str) -> Result<(), OptionsError> {
    let Some((key, _)) = pairs.iter().find(|(key, _)| !tables(key).contains(&table)) else {
        return Ok(());
    };
    let known = all_tables().filter(|(_, list)| list.contains(&table));
    let mut known: Vec<String> = known.map(|(field, _)| long(field)).collect();
    if ["camera", "moment"].contains(&table) {
        known.push("name".to_owned());
    }
    Err(OptionsError(format!(
        "unknown key \"{key}\" in {place}; known are {}",
        known.join(", ")
    )))
}

fn unknown_table(table: &str) -> OptionsError {
    let mut known = vec!["mesh"];
    for name in all_tables().flat_map(|(_, list)| list) {
        if !known.contains(name) {
            known.push(name);
        }
    }
    OptionsError(format!(
        "unknown key \"{table}\" in the scene file; known are {}",
        known.join(", ")
    ))
}

/// The options of the camera or moment of this name.
fn find_named<'a>(
    what: &str,
    list: &'a [NamedOptions],
    name: &str,
    instead: &str,
) -> Result<&'a [(String, String)], OptionsError> {
    let known: Vec<&str> = list.iter().map(|named| named.name.as_str()).collect();
    match list.iter().find(|named| named.name == name) {
        Some(named) => Ok(&named.options),
        None if known.is_empty() => Err(OptionsError(format!(
            "no {what} \"{name}\": the scene names no {what}s; use {instead}"
        ))),
        None => Err(OptionsError(format!(
            "no {what} \"{name}\"; the scene has {}",
            known.join(", ")
        ))),
    }
}

#[cfg(test)]
#[path = "resolve_tests.rs"]
mod tests;
