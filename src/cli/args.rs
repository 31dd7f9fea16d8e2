//! The arguments of single commands, besides the options that all share.

use std::ffi::OsString;
use std::path::PathBuf;

use clap::builder::{ArgPredicate, PathBufValueParser, TypedValueParser};
use clap::{Args, value_parser};

use crate::daylight::metrics::{Blinds, Schedule};
use crate::daylight::sun_hours::SunDate;
use crate::daylight::weather::YearHour;
use crate::options::{Direction, choice, choice_enum};
use crate::output::is_stdout;
use crate::sensors::Shard;

use super::vary::Vary;

/// What to measure, and where to put it.
#[derive(Debug, Clone, PartialEq, Args)]
pub struct BenchArgs {
    /// An hour of a weather file.
    #[command(flatten)]
    pub at: HourArgs,
    /// Scene file (.toml), model (.obj, .gltf, .glb), or bundled scene (colonnade, the default; island).
    pub scene: Option<PathBuf>,
    /// Write the table as JSON too; - is standard output, and the table is on standard error then.
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Write the table as CSV too, every row complete: device, commit, scene, size ..; - is standard output.
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
    /// Frames to measure; 10 by default at each step of a sweep.
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..=1_000_000), default_value_t = 100,
          default_value_if("sweep", ArgPredicate::IsPresent, "10"))]
    pub frames: u32,
    /// What moves from frame to frame while whole frames are timed.
    #[arg(long, value_name = "WHAT", value_parser = choice::<Motion>(), default_value_t)]
    pub motion: Motion,
    /// Measure again and again with more of one thing: cost against size, with the exponent of the growth.
    #[arg(long, value_name = "WHAT", value_parser = choice::<Sweep>(), conflicts_with = "compare")]
    pub sweep: Option<Sweep>,
    /// Compare with an earlier run's --json: the ratio of every time, and how far noise alone would move it.
    #[arg(long, value_name = "OLD.json")]
    pub compare: Option<PathBuf>,
    /// With --compare: exit code 1 when something takes more than R times as long as before, and not by noise alone.
    #[arg(long, value_name = "R", requires = "compare", allow_hyphen_values = true, value_parser = crate::options::ratio)]
    pub fail_above: Option<f64>,
}

choice_enum! {
    /// What moves while whole frames are timed.
    #[derive(Default)]
    pub enum Motion {
        None = "none": "Nothing: all frames are the same",
        #[default]
        Camera = "camera": "The camera, in every frame: nothing that depends on the view is reused",
        Sun = "sun": "Camera and sun, in every frame: sky, irradiance and shadow map start over",
    }
}

choice_enum! {
    /// What grows from step to step.
    pub enum Sweep {
        Resolution = "resolution": "Pixels of the picture, 640x360 to 3840x2160",
        Triangles = "triangles": "Triangles: the scene's, subdivided by 4, 9, 16 .., or without a scene hills of 10 000 to 2 million; one view sees all of them, one 5 %",
        Samples = "samples": "Irradiance samples of one pass, 64 to 4096",
        Shadow = "shadow": "Texels of the shadow map, 256² to 4096²",
        Ssao = "ssao": "Depth samples of a pixel's ambient occlusion",
    }
}

/// What to tell of a daylight.
#[derive(Debug, Clone, PartialEq, Args)]
pub struct SkyArgs {
    /// An hour of a weather file.
    #[command(flatten)]
    pub at: HourArgs,
    /// Machine-readable instead of a table.
    #[arg(long)]
    pub json: bool,
    /// Also the radiance in this direction, degrees; may be given several times.
    #[arg(long = "direction", value_name = "AZ,EL", value_parser = crate::options::direction, allow_hyphen_values = true)]
    pub directions: Vec<Direction>,
    /// Draw the sun's spectra (or the study) as an SVG file.
    #[arg(long, value_name = "FILE.svg", value_parser = named(&["svg"]))]
    pub plot: Option<PathBuf>,
    /// Instead: every model of the sky at this moment, with the levels that standards publish.
    #[arg(long, conflicts_with_all = ["irradiance_study", "directions", "plot"])]
    pub compare: bool,
    /// Instead: error against samples for each way of computing the irradiance of this sky.
    #[arg(long)]
    pub irradiance_study: bool,
}

/// What to bake.
#[derive(Debug, Clone, PartialEq, Args)]
pub struct BakeArgs {
    /// An hour of a weather file.
    #[command(flatten)]
    pub at: HourArgs,
    /// What the map holds.
    #[arg(long, value_name = "WHAT", value_parser = choice::<Map>())]
    pub map: Map,
    /// Texels along an edge of a cube face, 4 to 4096; 32 by default for irradiance, which is smooth, and each texel of it a sum
    /// over the sky. A power of two for mip levels: in .ktx2, and with --map specular.
    #[arg(long = "size", id = "edge", value_name = "N", value_parser = value_parser!(u32).range(4..=4096), default_value_t = 256,
          default_value_if("map", "irradiance", "32"))]
    pub edge: u32,
    /// How the sphere is laid out in .exr and .hdr (equirect by default); a .ktx2 file holds a cube.
    #[arg(long, value_name = "LAYOUT", value_parser = choice::<Layout>())]
    pub layout: Option<Layout>,
    /// How a .ktx2 file stores its texels (half by default).
    #[arg(long, value_name = "FORMAT", value_parser = choice::<Texels>())]
    pub texels: Option<Texels>,
    /// Where to: .exr (32-bit floats), .hdr (Radiance) or .ktx2 (cube map with mip levels); the JSON file has the same name.
    #[arg(short, long, value_name = "FILE", value_parser = named(&["exr", "hdr", "ktx2"]))]
    pub output: PathBuf,
}

choice_enum! {
    /// What a map holds.
    pub enum Map {
        Sky = "sky": "Radiance of sky and ground without the sun's disc, cd/m²",
        Irradiance = "irradiance": "Irradiance E(n) of sky and ground without the sun, lux, by the direction of the normal",
        Specular = "specular": "Sky and ground prefiltered for rough metals, cd/m²: GGX, one level for each roughness, from 0 to 1",
    }
}

choice_enum! {
    /// How a KTX2 file stores texels.
    #[derive(Default)]
    pub enum Texels {
        #[default]
        Half = "half": "R16G16B16A16_SFLOAT, 8 bytes a texel; the key skylight:scale says what a 1 stands for",
        Bc6h = "bc6h": "BC6H_UFLOAT_BLOCK, 1 byte a texel, in blocks of 4 x 4",
    }
}

choice_enum! {
    /// How the sphere is laid out.
    #[derive(Default)]
    pub enum Layout {
        #[default]
        Equirect = "equirect": "4N x 2N: first row the zenith, first column north, azimuth clockwise to the right",
        Cross = "cross": "4N x 3N: -X +Z +X -Z in the middle row, +Y above and -Y below +Z; faces in Vulkan's orientation",
        Faces = "faces": "Six files NAME_px .. NAME_nz, N x N, in Vulkan's orientation",
    }
}

/// What to compare, and how.
#[derive(Debug, Clone, PartialEq, Args)]
pub struct CompareArgs {
    /// The picture that is right: .exr (scene-linear), or .png and other 8-bit files (sRGB).
    pub reference: PathBuf,
    /// The picture in question.
    pub test: PathBuf,
    /// Compare only where this picture is not black, one pixel away from its edges: for instance an .exr with a depth.
    #[arg(long, value_name = "FILE")]
    pub mask: Option<PathBuf>,
    /// Factor on scene-linear light before LDR-FLIP; by default it brings the 75th percentile of the reference to 0.5.
    #[arg(long, value_name = "FACTOR", value_parser = crate::options::exposure_factor)]
    pub exposure: Option<f64>,
    /// Print JSON instead of a table.
    #[arg(long)]
    pub json: bool,
    /// Write the map of FLIP, black (none) to white.
    #[arg(long, value_name = "FILE.png", value_parser = named(&["png"]))]
    pub diff: Option<PathBuf>,
}

/// The parser of a file name with one of these extensions; it need not be UTF-8.
pub(super) fn named(extensions: &'static [&'static str]) -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().try_map(move |path| ends_in(path, extensions))
}

/// As [`named`]; or one of the names of standard output.
pub(super) fn named_or_stdout(
    extensions: &'static [&'static str],
) -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().try_map(move |path: PathBuf| {
        if is_stdout(&path) {
            return Ok(path);
        }
        ends_in(path, extensions)
    })
}

fn ends_in(path: PathBuf, extensions: &[&str]) -> Result<PathBuf, String> {
    let extension = path.extension().map(|e| e.to_ascii_lowercase());
    let is_known = |known: &&str| extension.as_ref() == Some(&OsString::from(known));
    if extensions.iter().any(is_known) {
        return Ok(path);
    }
    let known: Vec<String> = extensions.iter().map(|e| format!(".{e}")).collect();
    Err(format!("the name must end in {}", known.join(" or ")))
}

/// An hour of a weather file, instead of a place, a moment and a sky.
#[derive(Debug, Clone, Default, PartialEq, Args)]
pub struct HourArgs {
    /// Weather file (.epw, .wea), or bundled weather (chicago), that gives place, sun and sky of --hour: --sky perez with its irradiances and dew point.
    #[arg(long, value_name = "FILE")]
    pub weather: Option<PathBuf>,
    /// Hour of the weather file, or of that of the scene file: the one that holds this time of its clock, local standard time without
    /// daylight saving.
    #[arg(long, value_name = "M-DThh")]
    pub hour: Option<YearHour>,
}

/// The weather file, and the form of the table.
#[derive(Debug, Clone, PartialEq, Eq, Args)]
pub struct WeatherArgs {
    /// EnergyPlus weather (.epw), Radiance's .wea, or bundled weather (chicago).
    pub file: PathBuf,
    /// Print JSON instead of a table.
    #[arg(long)]
    pub json: bool,
}

/// Points to measure at, what to measure, and where to put the result.
#[derive(Debug, Clone, PartialEq, Args)]
pub struct DaylightArgs {
    /// Scene file (.toml), model (.obj, .gltf, .glb), or bundled scene (colonnade, island).
    pub scene: PathBuf,
    /// Sensors: lines of x y z, or x y z and a normal (up without one), separated by blanks or commas. A .pts file is Radiance's, with
    /// +Z up; any other has the model's axes. Metres.
    #[arg(long, value_name = "FILE", required_unless_present_any = ["plane", "facade"])]
    pub grid: Option<PathBuf>,
    /// Makes the sensors instead: this height above the floor of every room, metres. A room has walls, a ceiling and a level floor. The
    /// grid is fitted between its walls.
    #[arg(long, value_name = "M", conflicts_with = "grid", value_parser = crate::options::plane_height)]
    pub plane: Option<f64>,
    /// Makes sensors on façades instead: before the outer faces of upright surfaces, facing out. With names those of these materials,
    /// separated by commas; without, the surfaces that see the sky. Bodies must face outward.
    #[arg(long, value_name = "NAMES", num_args = 0..=1, require_equals = true, default_missing_value = "", value_delimiter = ',', conflicts_with_all = ["grid", "plane"])]
    pub facade: Option<Vec<String>>,
    /// Distance of the sensors of --facade from their surface, metres.
    #[arg(long, value_name = "M", conflicts_with_all = ["grid", "plane"], default_value_t = 0.05, value_parser = crate::options::offset)]
    pub offset: f64,
    /// Largest distance from one made sensor to the next, metres.
    #[arg(long, value_name = "M", conflicts_with = "grid", default_value_t = 0.5, value_parser = crate::options::spacing)]
    pub spacing: f64,
    /// Least distance of made sensors from walls and furniture, metres.
    #[arg(long, value_name = "M", requires = "plane", conflicts_with = "facade", default_value_t = 0.0, value_parser = crate::options::inset)]
    pub inset: f64,
    /// Materials of floors on which to make sensors, separated by commas, instead of those of rooms that are found.
    #[arg(
        long,
        value_name = "NAMES",
        value_delimiter = ',',
        requires = "plane",
        conflicts_with = "facade"
    )]
    pub rooms: Vec<String>,
    /// Weather file (.epw, .wea), or bundled weather (chicago): measures its year, every hour with its own sun and Perez' sky; with --hour one moment of it.
    #[arg(long, value_name = "FILE")]
    pub weather: Option<PathBuf>,
    /// A moment instead of the year: the hour of the weather file, or of that of the scene file, that holds this time of its clock, local standard
    /// time.
    #[arg(long, value_name = "M-DThh")]
    pub hour: Option<YearHour>,
    /// What to measure instead of a moment, separated by commas; da,cda,udi,sda,ase by default for a year. All but df, vsc and sunhours
    /// need --weather.
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = choice::<Metric>(), conflicts_with = "hour")]
    pub metrics: Vec<Metric>,
    /// Dates of sunhours, separated by commas: 3-21, 2026-3-21, or year.
    #[arg(
        long,
        value_name = "LIST",
        value_delimiter = ',',
        default_value = "3-21"
    )]
    pub dates: Vec<SunDate>,
    /// Elevation above which sunhours counts the sun, degrees.
    #[arg(long, value_name = "DEGREES", value_parser = crate::options::elevation, default_value_t = 0.0)]
    pub min_elevation: f64,
    /// Occupied hours of every day, by the clock of the weather file.
    #[arg(long, value_name = "FROM-TO", default_value_t, requires = "weather")]
    pub schedule: Schedule,
    /// Whether blinds close against the sun.
    #[arg(long, value_name = "RULE", value_parser = choice::<Blinds>(), default_value_t, requires = "weather", conflicts_with = "hour")]
    pub blinds: Blinds,
    /// Thresholds of daylight autonomy, lux.
    #[arg(long, value_name = "LUX", value_delimiter = ',', value_parser = crate::options::threshold, allow_hyphen_values = true, default_value = "300", requires = "weather")]
    pub thresholds: Vec<f64>,
    /// Measure every value of an option, for instance turbidity=2,3,4 or glass=.6,.7,.8; of several --vary every combination. All results are
    /// in one table, each named by its values. A number of a material is glass.NAME or reflectance.NAME; values that hold commas
    /// are separated by semicolons.
    #[arg(long, value_name = "NAME=LIST", conflicts_with_all = ["ill", "plan", "heat", "report"])]
    pub vary: Vec<Vary>,
    /// Print JSON instead of a table.
    #[arg(long, conflicts_with = "csv")]
    pub json: bool,
    /// Print CSV instead of a table.
    #[arg(long)]
    pub csv: bool,
    /// Also write the illuminance of every hour in Radiance's form: a line for each hour, month, day and hour and the sensors' lux.
    #[arg(
        long,
        value_name = "FILE.ill",
        conflicts_with = "hour",
        requires = "weather"
    )]
    pub ill: Option<PathBuf>,
    /// Also draw a metric over the plane of the sensors: false colours, contours, the model's lines, legend, north arrow, scale bar.
    #[arg(long, value_name = "FILE.svg|.png", value_parser = named(&["svg", "png"]))]
    pub plan: Option<PathBuf>,
    /// What --plan shows: a metric, or a column of --csv; by default the first of --metrics.
    #[arg(long, value_name = "METRIC", requires = "plan")]
    pub plan_of: Option<String>,
    /// Also draw the illuminance of every hour, hour by day over the year: the mean of all sensors.
    #[arg(long, value_name = "FILE.svg|.png", value_parser = named(&["svg", "png"]), conflicts_with = "hour", requires = "weather")]
    pub heat: Option<PathBuf>,
    /// The sensor that --heat shows instead of the mean: its number in the order of the grid, from 1.
    #[arg(long, value_name = "N", requires = "heat", value_parser = value_parser!(u32).range(1..))]
    pub heat_of: Option<u32>,
    /// Also write a page with assumptions, pictures, results, and the verdict of each standard; en17037 is then one of the default metrics.
    #[arg(long, value_name = "FILE.html", value_parser = named(&["html"]), conflicts_with = "hour", requires = "weather")]
    pub report: Option<PathBuf>,
    /// Where to, instead of printing.
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Measure the sensors of one part of the job, for instance 3/12, into a file, here daylight_3-of-12.shard unless -o names another:
    /// other machines measure the others, and skylight merge makes the result of all. Over a year a part has whole blocks of 256 sensors, which
    /// share their light. With --vary a part has whole variants.
    #[arg(long, value_name = "I/N", conflicts_with_all = ["plan", "heat", "report"])]
    pub shard: Option<Shard>,
    /// Standard error at which to stop. Of a moment: of each sensor's total, relative to it. Of a year: of each metric, root mean square
    /// over the sensors; 0.01 is one point of a percentage, or 1 % of an illuminance or a daylight factor.
    #[arg(long, value_name = "R", value_parser = crate::options::ratio, default_value_t = 0.01)]
    pub error: f64,
    /// Most paths of a sensor.
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1024..), default_value_t = 1 << 22)]
    pub max_paths: u32,
}

impl DaylightArgs {
    /// Whether anything but a moment is asked for.
    pub fn asks_for_metrics(&self) -> bool {
        self.hour.is_none() && (self.weather.is_some() || !self.metrics.is_empty())
    }

    /// What is measured over the year, or without hours.
    pub fn asked_metrics(&self) -> Vec<Metric> {
        if self.metrics.is_empty() {
            use Metric::{Ase, Cda, Da, Sda, Udi};
            let mut metrics = vec![Da, Cda, Udi, Sda, Ase];
            metrics.extend(self.report.as_ref().map(|_| Metric::En17037));
            return metrics;
        }
        self.metrics.clone()
    }

    /// Whether the light of every hour of a weather file counts.
    pub fn needs_hours(&self) -> bool {
        let has_blinds = self.blinds != Blinds::None;
        self.asked_metrics()
            .iter()
            .any(|metric| metric.needs_hours())
            || self.keeps_hours()
            || has_blinds
    }

    /// Whether the illuminances of every hour are kept.
    pub fn keeps_hours(&self) -> bool {
        self.ill.is_some() || self.heat.is_some() || self.report.is_some()
    }

    /// The files that are written besides the result.
    pub fn files(&self) -> impl Iterator<Item = &PathBuf> {
        let files = [&self.ill, &self.plan, &self.heat, &self.report];
        files.into_iter().flatten()
    }

    /// The hour of the weather file, if one is asked for.
    pub fn at(&self) -> HourArgs {
        HourArgs {
            weather: self.weather.clone(),
            hour: self.hour,
        }
    }
}

impl Metric {
    /// Whether it is made of the hours of a weather file.
    pub fn needs_hours(self) -> bool {
        !matches!(self, Self::Df | Self::Vsc | Self::Sunhours)
    }
}

choice_enum! {
    /// What is measured over a year.
    pub enum Metric {
        Df = "df": "Daylight factor: illuminance under the overcast sky of the CIE, percent of that of open ground",
        Da = "da": "Daylight autonomy: occupied hours with at least the threshold, percent",
        Cda = "cda": "Continuous daylight autonomy: hours below the threshold count in part",
        Udi = "udi": "Useful daylight illuminance: below 100, to below 300, to 3000 and above 3000 lux, percent of the occupied hours",
        Sda = "sda": "Spatial daylight autonomy: sensors with 300 lux in half of the occupied hours, percent (IES LM-83; without --blinds lm83 higher than it has it)",
        Ase = "ase": "Annual sunlight exposure: sensors with more than 1000 lux of direct sun in more than 250 occupied hours, percent",
        En17037 = "en17037": "EN 17037, daylight provision by both methods",
        Illuminance = "illuminance": "Mean illuminance of all hours, lux",
        Vsc = "vsc": "Light of the overcast sky without reflection, percent of that of open ground: on a façade the vertical sky component",
        Sunhours = "sunhours": "Hours in which the sun shines on the sensor on --dates if no cloud hides it",
    }
}
