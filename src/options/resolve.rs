//! Resolves the values of all sources to [`Options`]: precedence, and the cameras, moments and tables of a scene file.

use clap::parser::ValueSource;
use glam::{DVec3, Vec3};

use super::{
    Ambient, DomeBy, OptionValues, Options, OptionsError, Preset, Reflections, Show, SkyModel,
    Switch, Visibility, all_tables, long, name, tables,
};
use crate::daylight::atmosphere::air::Air;
use crate::daylight::sky::Conditions;
use crate::scene::{
    Bounds, Camera, DEFAULT_FOV_DEG, LoadOptions, Loaded, NamedOptions, SceneError, Subject,
};

/// Number of samples from which shadow maps of the sky beat screen-space ambient occlusion in every view.
const DOME_SAMPLES: u32 = 16;

/// The values of `--preset lecture`: the defaults of the course.
const LECTURE: [(&str, &str); 19] = [
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
    ("ambient", "ssao"),
    ("bounces", "0"),
    ("ao-resolution", "half"),
    ("shadow-size", "4096"),
    ("phong", "lecture"),
];

/// Options that cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum ResolveError {
    /// The user's options are invalid.
    #[error(transparent)]
    Options(#[from] OptionsError),
    /// The scene file's options are invalid.
    #[error(transparent)]
    Scene(#[from] SceneError),
}

impl Options {
    /// Resolves options: the user's override the scene file's, which override the preset's, which override the user's own defaults
    /// ([`OptionValues::defaults`]), which override those of the program.
    ///
    /// # Errors
    /// An invalid key or value in the scene file, an unknown camera or moment, options that contradict each other.
    pub fn resolve(user: &OptionValues, loaded: &Loaded) -> Result<Self, ResolveError> {
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
            // Do not mix two cameras: what the named one omits takes the default, not the scene's value.
            base.remove(&["eye", "target", "fov"]);
            base = camera.over(base);
        }
        user.remove(&["moment", "camera"]);
        let mut given = user.clone().over(base);
        if given.get("preset") == Some(name(Preset::Lecture)) {
            given = given.over(LECTURE.as_slice().into());
        }
        given = given.over(user.defaults());
        if let Some(camera) = camera {
            given.set("camera", camera);
        }
        let (mut options, matches) = given.parse()?;
        let is_default = |name| matches.value_source(name) == Some(ValueSource::DefaultValue);
        if is_default("visibility") && options.samples >= DOME_SAMPLES {
            options.visibility = Visibility::Dome;
        }
        // Who asks for ambient occlusion of the screen gets it.
        let asks_for_screen = !is_default("visibility") && options.visibility == Visibility::Ssao;
        if asks_for_screen && is_default("ambient") {
            options.ambient = Ambient::Ssao;
        }
        options.complete_air();
        options.check()?;
        options.aerial = options
            .has_air()
            .then(|| options.aerial.unwrap_or_default());
        Ok(options)
    }

    /// Sets the default of the air's one number if it has none, in the word that the sky is used with.
    fn complete_air(&mut self) {
        if self.turbidity.is_none() && self.aod.is_none() && self.visual_range.is_none() {
            if self.sky == SkyModel::Atmosphere {
                self.aod = Some(Air::default().aod);
            } else {
                self.turbidity = Some(Conditions::default().turbidity);
            }
        }
    }

    /// Fails if the options contradict each other.
    fn check(&self) -> Result<(), OptionsError> {
        if self.eye.is_some() && self.eye == self.target {
            let what = "--eye and --target are the same point; move one";
            return Err(OptionsError(what.to_owned()));
        }
        self.check_measured()?;
        if self.aerial == Some(Switch::On) && !self.has_air() {
            let what = format!(
                "--aerial on needs --sky atmosphere: --sky {} has no air to draw; choose that sky, or --aerial off",
                self.sky
            );
            return Err(OptionsError(what));
        }
        if self.reflections == Reflections::Hidden && self.dome_by == DomeBy::Rays {
            let what = "--reflections hidden needs the maps of the dome; leave out --dome-by rays";
            return Err(OptionsError(what.to_owned()));
        }
        // Occlusion in reflections comes from the dome's shadow maps.
        if self.reflections == Reflections::Hidden && self.visibility == Visibility::Ssao {
            let what =
                "--reflections hidden needs --visibility dome; give it, or --samples 16 or more";
            return Err(OptionsError(what.to_owned()));
        }
        if self.show == Show::SunHours && self.noise.is_some() {
            let what = "--show sun-hours has no noise: each sun is a frame; leave out --noise";
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

    /// Fails if the measured sky lacks its irradiances, or if there are none like them.
    fn check_measured(&self) -> Result<(), OptionsError> {
        if self.sky != SkyModel::Perez {
            return Ok(());
        }
        let what = match (self.dni, self.dhi) {
            (Some(dni), Some(dhi)) if dni > 0.0 && dhi == 0.0 => {
                "--dni above 0 with --dhi 0: no sky has the one without the other; give both as measured"
            }
            (Some(_), Some(_)) => return Ok(()),
            _ => {
                "--sky perez needs --dni and --dhi, the measured irradiances in W/m², each 0 to 1500"
            }
        };
        Err(OptionsError(what.to_owned()))
    }

    /// Limits and settings for loading a scene, without a cache.
    pub fn load_options(&self) -> LoadOptions {
        let bytes = |mib: u32| u64::from(mib) << 20;
        LoadOptions {
            smooth_deg: self.smooth.map(|degrees| degrees as f32),
            up: self.up,
            unit: self.unit,
            max_texture_edge: self.max_texture_edge,
            max_texture_bytes: bytes(self.max_texture_mib),
            max_file_bytes: bytes(self.max_file_mib),
            max_triangles: self.max_triangles as usize,
            allow_outside: self.allow_outside,
            cache: None,
        }
    }

    /// The camera for a subject relative to `origin`; what is not given is chosen to show it.
    pub fn camera(&self, subject: &Subject, origin: DVec3) -> Camera {
        let point = |p: [f64; 3]| (DVec3::from(p) - origin).as_vec3();
        Camera::from_parts(
            self.eye.map(point),
            self.target.map(point),
            Some(self.fov as f32),
            subject,
            self.aspect(),
        )
    }

    /// A camera that frames `bounds`, ignoring the camera options.
    pub fn framing(&self, bounds: &Bounds) -> Camera {
        Camera::framing(bounds, DEFAULT_FOV_DEG, self.aspect())
    }

    /// These options with `camera`, relative to `origin`, instead of their own.
    #[must_use]
    pub fn with_camera(&self, camera: &Camera, origin: DVec3) -> Self {
        let point = |p: Vec3| Some(in_world(p, origin));
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

/// A point relative to `origin` in world space, with as many digits as it has.
pub(crate) fn in_world(point: Vec3, origin: DVec3) -> [f64; 3] {
    let coordinate = |axis: usize| match origin[axis] {
        0.0 => shortest(point[axis]),
        // Whole metres and an `f32` that is small beside them: hundredths of a millimetre are what is left.
        far => ((far + f64::from(point[axis])) * 1e5).round() / 1e5,
    };
    [0, 1, 2].map(coordinate)
}

/// The decimal number with the fewest digits that rounds to the same `f32`.
pub(crate) fn shortest(value: f32) -> f64 {
    value.to_string().parse().unwrap_or(value.into())
}

/// The options set by the tables of a scene file. Checks the keys of its cameras and moments, too.
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
    // Those that no option holds: a name, and what stands for place, sun and sky.
    let others: &[&str] = match table {
        "camera" => &["name"],
        "moment" => &["name", "hour"],
        "sky" => &["weather", "hour"],
        _ => &[],
    };
    known.extend(others.iter().map(ToString::to_string));
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

/// The options of the camera or moment with this name.
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
