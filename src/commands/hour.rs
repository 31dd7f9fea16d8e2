//! Place, sun and sky of an hour of a weather file, as options: of `--weather` and `--hour`, and of these keys of scene files.

use std::path::Path;
use std::sync::Arc;

use chrono::{DateTime, FixedOffset};

use super::tell;
use super::weather::{read_weather, warnings};
use crate::cli::HourArgs;
use crate::daylight::place::Place;
use crate::daylight::weather::clock::ClockCheck;
use crate::daylight::weather::{Record, Weather, YearHour};
use crate::error::{Error, Result};
use crate::options::OptionValues;
use crate::scene::{Loaded, NamedOptions, SceneError, weather_of};

/// What a weather file gives; none of it can be given besides.
const GIVEN: [&str; 8] = [
    "place",
    "when",
    "solar",
    "sun",
    "sky",
    "dni",
    "dhi",
    "dew-point",
];

/// Hour near which a window opens on a weather file, unless one is asked for: noon of an equinox, which every place has.
const OPENING: YearHour = YearHour {
    month: 3,
    day: 21,
    hour: 12.5,
};

/// Options, by name and text.
type Pairs = Vec<(String, String)>;

/// Fails with the first option that a weather file gives, too.
///
/// # Errors
/// See above.
pub(super) fn check_given(options: &OptionValues) -> Result<()> {
    match GIVEN.iter().find(|name| options.get(name).is_some()) {
        None => Ok(()),
        Some(name) => Err(Error::usage(format!(
            "--weather gives place, sun and sky; leave out --{name}"
        ))),
    }
}

/// What an hour of a weather file gives: place, moment, irradiances and dew point of Perez' sky.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct HourLight {
    /// Of the file.
    pub place: Place,
    /// The middle of the hour.
    pub when: DateTime<FixedOffset>,
    /// W/m² at normal incidence.
    pub dni: f64,
    /// W/m² on a horizontal plane.
    pub dhi: f64,
    /// °C.
    pub dew_point: Option<f64>,
}

impl HourLight {
    /// Of a record; `None` if its irradiances are missing. An hour without light of the sky is dark.
    pub fn of(weather: &Weather, record: &Record) -> Option<Self> {
        let (dni, dhi) = (record.direct_normal_w?, record.diffuse_w?);
        Some(Self {
            place: weather.station.place,
            when: weather.moment(record),
            dni: if dhi > 0.0 { dni } else { 0.0 },
            dhi,
            dew_point: record.dew_point_c,
        })
    }

    /// As options.
    fn pairs(&self) -> Pairs {
        let own = [
            ("when", self.when.to_rfc3339()),
            ("sky", "perez".to_owned()),
            ("dni", self.dni.to_string()),
            ("dhi", self.dhi.to_string()),
        ];
        let dew_point = self.dew_point.map(|c| ("dew-point", c.to_string()));
        let rest = own.into_iter().chain(dew_point);
        let rest = rest.map(|(name, text)| (name.to_owned(), text));
        std::iter::once(place(self.place)).chain(rest).collect()
    }
}

/// A place as an option.
fn place(place: Place) -> (String, String) {
    let text = format!("{},{}", place.latitude, place.longitude);
    ("place".to_owned(), text)
}

/// The options of an hour that is asked for.
///
/// # Errors
/// An hour that the file lacks, or without irradiances.
fn at_hour((path, weather): (&Path, &Weather), hour: YearHour) -> Result<Pairs> {
    let shown = path.display();
    let record = weather.at(hour);
    let record = record.ok_or_else(|| Error::usage(format!("{shown} has no hour {hour}")))?;
    let light = HourLight::of(weather, record);
    let light =
        light.ok_or_else(|| Error::usage(format!("{shown} has no irradiances at {hour}")))?;
    Ok(light.pairs())
}

/// The hour with irradiances that is nearest to the one that a window opens on.
fn near_opening(weather: &Weather) -> Option<Pairs> {
    let at = |month: u32, day: u32, hour: f64| f64::from(31 * month + day) * 24.0 + hour;
    let opening = at(OPENING.month, OPENING.day, OPENING.hour);
    let apart = |r: &&Record| (at(r.month, r.day, r.hour) - opening).abs();
    let has_light = |r: &&Record| r.direct_normal_w.is_some() && r.diffuse_w.is_some();
    let records = weather.records.iter().filter(has_light);
    let nearest = records.min_by(|a, b| apart(a).total_cmp(&apart(b)))?;
    HourLight::of(weather, nearest).map(|light| light.pairs())
}

/// The user's options with place, moment and sky of an hour of a weather file, if one is asked for: of `--weather`, else of the scene file.
/// Tells what is odd about the file.
///
/// # Errors
/// A file that cannot be used, an hour that it lacks, options that it gives too, or a warning with `--strict`.
pub fn applied(at: &HourArgs, scene: Option<&Path>, options: OptionValues) -> Result<OptionValues> {
    if at.weather.is_some() && at.hour.is_none() {
        let what = "--weather needs the hour; add --hour, for instance --hour 3-21T12";
        return Err(Error::usage(what));
    }
    window(at, scene, options).map(|(options, _)| options)
}

/// As [`applied`], with the weather file of `--weather`, which needs no hour.
///
/// # Errors
/// See there.
pub fn window(
    at: &HourArgs,
    scene: Option<&Path>,
    mut options: OptionValues,
) -> Result<(OptionValues, Option<Arc<Weather>>)> {
    let file = match (&at.weather, at.hour) {
        (None, None) => return Ok((options, None)),
        (Some(file), _) => file.clone(),
        (None, Some(_)) => scene.and_then(weather_of).ok_or_else(|| {
            let what = "--hour needs a weather file; add --weather, or the key weather in [sky] of the scene file";
            Error::usage(what)
        })?,
    };
    check_given(&options)?;
    let weather = read_weather(&file)?;
    let pairs = match at.hour {
        Some(hour) => at_hour((&file, &weather), hour)?,
        None => near_opening(&weather).ok_or_else(|| no_light(&file))?,
    };
    for (name, text) in pairs {
        options.set(&name, text);
    }
    // Those of a scene file are told when it is opened.
    if at.weather.is_none() {
        return Ok((options, None));
    }
    tell(&options.alone()?, told(&weather).iter())?;
    Ok((options, Some(Arc::new(weather))))
}

fn no_light(file: &Path) -> Error {
    Error::usage(format!(
        "{} has no irradiances; take another file",
        file.display()
    ))
}

/// What is odd about a file and its clock.
fn told(weather: &Weather) -> Vec<String> {
    warnings(weather, ClockCheck::of(weather).as_ref())
}

/// What is made of a scene file with a weather file and without an hour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NoHour {
    /// It is refused: the options say no moment either.
    Refused,
    /// The place alone is taken from the file: the options say the rest.
    PlaceAlone,
    /// An hour is chosen, for a window.
    #[cfg(feature = "window")]
    Chosen,
}

/// Replaces the keys `weather` and `hour` of a scene file's tables by the options that they stand for; the weather, if there is one.
/// What is odd about it joins the warnings of the scene.
///
/// # Errors
/// A file that cannot be used, an hour that it lacks, or keys that it gives too.
pub fn expand(loaded: &mut Loaded, no_hour: NoHour) -> Result<Option<Arc<Weather>>> {
    let scene_file = loaded.path.clone();
    let fault = |what: String| {
        Error::from(SceneError::SceneFile {
            path: scene_file.clone(),
            what,
        })
    };
    let (path, hour) = (take(loaded, "weather"), take(loaded, "hour"));
    let mut of_moments = loaded.moments.iter().flat_map(|moment| &moment.options);
    let has_hours = hour.is_some() || of_moments.any(|(key, _)| key == "hour");
    let Some(path) = path else {
        let what = "hour needs a weather file; add weather = \"FILE.epw\" to [sky]";
        return if has_hours {
            Err(fault(what.to_owned()))
        } else {
            Ok(None)
        };
    };
    let path = Path::new(&path);
    let tables = loaded.options.iter().flat_map(|table| &table.options);
    refuse_given(tables, "weather").map_err(fault)?;
    let weather = read_weather(path)?;
    let of_hour = |text: &str| {
        let hour = text
            .parse()
            .map_err(|what| fault(format!("hour: {what}")))?;
        at_hour((path, &weather), hour)
    };
    let pairs = match (hour, no_hour) {
        (Some(hour), _) => of_hour(&hour)?,
        (None, NoHour::Refused) => {
            let what = "[sky] has a weather file and no hour; add hour = \"3-21T12\", or give --hour or --moment";
            return Err(fault(what.to_owned()));
        }
        (None, NoHour::PlaceAlone) => vec![place(weather.station.place)],
        #[cfg(feature = "window")]
        (None, NoHour::Chosen) => near_opening(&weather).ok_or_else(|| no_light(path))?,
    };
    loaded.options.extend(tables_of(pairs));
    for moment in &mut loaded.moments {
        let Some(at) = moment.options.iter().position(|(key, _)| key == "hour") else {
            continue;
        };
        let (_, hour) = moment.options.remove(at);
        refuse_given(moment.options.iter(), "hour").map_err(fault)?;
        moment.options.extend(of_hour(&hour)?);
    }
    loaded.scene.warnings.extend(told(&weather));
    Ok(Some(Arc::new(weather)))
}

/// Takes a key out of the table of the sky.
fn take(loaded: &mut Loaded, key: &str) -> Option<String> {
    let table = loaded
        .options
        .iter_mut()
        .find(|table| table.name == "sky")?;
    let at = table.options.iter().position(|(name, _)| name == key)?;
    Some(table.options.remove(at).1)
}

/// Fails with the first of the pairs that `by` gives, too.
fn refuse_given<'p>(
    mut pairs: impl Iterator<Item = &'p (String, String)>,
    by: &str,
) -> std::result::Result<(), String> {
    match pairs.find(|(key, _)| GIVEN.contains(&key.as_str())) {
        None => Ok(()),
        Some((key, _)) => Err(format!("{by} gives place, sun and sky; leave out {key}")),
    }
}

/// Options as tables of a scene file that may have them.
fn tables_of(pairs: Pairs) -> [NamedOptions; 2] {
    let is_of_place = |(name, _): &(String, String)| ["place", "when"].contains(&name.as_str());
    let (of_place, of_sky): (Pairs, Pairs) = pairs.into_iter().partition(is_of_place);
    [("place", of_place), ("sky", of_sky)].map(|(name, options)| NamedOptions {
        name: name.to_owned(),
        options,
    })
}
