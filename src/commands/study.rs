//! `skylight study`: one sheet of pictures, a row for each day and a column for each hour.

use std::sync::Arc;

use chrono::{DateTime, Datelike, FixedOffset, NaiveDate};
use glam::{DVec3, Vec3};

use super::interrupt;
use super::job::Job;
use super::progress;
use super::render::{check_anti_aliasing, check_layers};
use super::renderer::{Picture, Renderer};
use super::sidecar;
use super::tiled::check_whole;
use crate::cli::StudyArgs;
use crate::daylight::place::Place;
use crate::daylight::steps::DayTime;
use crate::daylight::sun_hours::SunDate;
use crate::error::{Error, Result};
use crate::gpu::Context;
use crate::options::{OptionValues, Options, Show};
use crate::output::{
    Cell, Effort, Encoding, Metadata, SheetLayout, check_writable, compose, print, write_png,
};
use crate::scene::Camera;

/// Size of each picture unless `--size` is given.
const PICTURE: &str = "480x320";
/// Samples of each picture unless `--samples` is given: the fewest with converging shadows of the sky.
const SAMPLES: u32 = 16;
/// Most pixels of a sheet.
const MOST_PIXELS: u64 = 1 << 28;
/// Lines of the title and of each caption.
const LINES: [u32; 2] = [2, 3];

/// Draws all pictures and writes the sheet.
///
/// # Errors
/// Any error up to writing the file; an existing file is then left unchanged.
pub fn run(args: &StudyArgs, options: &OptionValues) -> Result<()> {
    if let Some(name) = ["solar", "sun"]
        .iter()
        .find(|name| options.get(name).is_some())
    {
        return Err(Error::usage(format!(
            "--dates and --hours say when; leave out --{name}"
        )));
    }
    check_layers(options, false)?;
    check_writable(&args.output)?;
    let mut options = options.clone();
    options.set_default("size", PICTURE);
    options.set_default("samples", SAMPLES);
    if args.plan.is_some() {
        // A plan is seen from so far that its air would show.
        options.set_default("aerial", "off");
    }
    let shows_hours = options.alone()?.show == Show::SunHours;
    if shows_hours {
        options.set("sun-dates", args.dates[0]);
    }
    let (job, context) = Job::on_device(args.scene.as_deref(), &options)?;
    check_anti_aliasing(&job.settings, false)?;
    check_whole(&job, &context)?;
    // Hours of sun are those of a day.
    let hours = if shows_hours {
        &args.hours[..1]
    } else {
        &args.hours[..]
    };
    let moments = moments(args, hours, &job.settings).map_err(Error::usage)?;
    let layout = layout(args, hours, &job.settings).map_err(Error::usage)?;
    let study = Study {
        args,
        options,
        job,
        context,
        layout,
    };
    study.run(&moments)
}

/// A study while it is drawn.
struct Study<'a> {
    args: &'a StudyArgs,
    options: OptionValues,
    job: Job,
    context: Arc<Context>,
    layout: SheetLayout,
}

impl Study<'_> {
    fn run(mut self, moments: &[DateTime<FixedOffset>]) -> Result<()> {
        let bar = progress(moments.len() as u64, "pictures", self.job.settings.quiet);
        interrupt::listen();
        let (mut renderer, mut cells) = (None, Vec::new());
        let (mut of_first, mut reports) = (None, Vec::new());
        for moment in moments {
            let picture = self.picture(*moment, &mut renderer)?;
            if picture.drawn.is_interrupted || interrupt::is_interrupted() {
                let (done, all) = (cells.len(), moments.len());
                let what = "pictures were drawn, and no sheet is written";
                return Err(Error::Interrupted { done, all, what });
            }
            if self.args.sidecar {
                let (job, output) = (&self.job, &self.args.output);
                reports.push(sidecar::report(
                    job,
                    &self.context,
                    output,
                    &picture.metadata,
                ));
            }
            of_first.get_or_insert_with(|| (picture.metadata.clone(), picture.encoding));
            cells.push(cell(&self.job, *moment, picture));
            bar.inc(1);
        }
        self.context.check_validation()?;
        bar.finish_and_clear();
        self.write(&cells, of_first.unwrap_or((Vec::new(), Encoding::Srgb)))?;
        if self.args.sidecar {
            let output = &self.args.output;
            sidecar::write(output, &sidecar::of_several(output, "pictures", &reports))?;
        }
        Ok(())
    }

    fn picture(
        &mut self,
        moment: DateTime<FixedOffset>,
        renderer: &mut Option<Renderer>,
    ) -> Result<Picture> {
        self.options.set("when", moment.to_rfc3339());
        if self.job.suns.is_some() {
            let day = moment.format("%Y-%-m-%-d");
            self.options.set("sun-dates", day);
        }
        let job = &mut self.job;
        job.turn_to(&self.options)?;
        if let Some(width) = self.args.plan {
            job.camera = plan(job, width, self.layout.aspect());
        }
        let renderer = match renderer {
            Some(renderer) => {
                renderer.turn_to(job)?;
                renderer
            }
            none => none.insert(Renderer::new(job, &self.context, false)?.without_progress()),
        };
        renderer.picture(job)
    }

    fn write(&self, cells: &[Cell], (metadata, encoding): (Metadata, Encoding)) -> Result<()> {
        let (args, job) = (self.args, &self.job);
        let (size, rgba) = compose(&self.layout, &title(args, job), cells);
        let metadata = of_sheet(args, metadata);
        let how = (encoding, Effort::Small);
        write_png(&args.output, size, &rgba, how, &metadata)?;
        let ([width, height], count) = (size, cells.len());
        let (output, view) = (args.output.display(), view(args, job));
        print(&format!(
            "{output}: {width}x{height}, {count} pictures{view}\n"
        ))
    }
}

/// The view from above; a width of 0 is that of the model.
fn plan(job: &Job, width: f64, aspect: f32) -> Camera {
    let width = (width > 0.0).then_some(width as f32);
    let mut camera = Camera::plan(&job.subject.bounds, width, aspect);
    if let Some(target) = job.settings.target {
        let middle = (DVec3::from(target) - job.scene.origin).as_vec3();
        let aside = (middle - camera.target) * Vec3::new(1.0, 0.0, 1.0);
        (camera.eye, camera.target) = (camera.eye + aside, camera.target + aside);
    }
    camera
}

/// Every hour of every day, by the clock of the place.
fn moments(
    args: &StudyArgs,
    hours: &[DayTime],
    settings: &Options,
) -> std::result::Result<Vec<DateTime<FixedOffset>>, String> {
    let place = settings.sun.place();
    let (latitude, longitude, when) = place.ok_or("a study needs a place; give --place")?;
    let place = Place {
        latitude,
        longitude,
    };
    let mut all = Vec::new();
    for date in &args.dates {
        let SunDate::Day(year, month, day) = *date else {
            return Err("--dates of a study are days, for instance 3-21".to_owned());
        };
        let year = year.unwrap_or(when.year());
        let date = NaiveDate::from_ymd_opt(year, month, day);
        let date = date.ok_or_else(|| format!("--dates: {year} has no {month}-{day}"))?;
        for hour in hours {
            let moment = place.zone().moment(date.and_time(hour.0));
            all.push(moment.map_err(|what| format!("--hours: {what}"))?);
        }
    }
    Ok(all)
}

fn layout(
    args: &StudyArgs,
    hours: &[DayTime],
    settings: &Options,
) -> std::result::Result<SheetLayout, String> {
    let [title_lines, caption_lines] = LINES;
    let layout = SheetLayout {
        picture: [settings.size.width, settings.size.height],
        columns: hours.len() as u32,
        rows: args.dates.len() as u32,
        title_lines,
        caption_lines,
    };
    let pixels = |[width, height]: [u32; 2]| u64::from(width) * u64::from(height);
    let picture = pixels(layout.picture) * hours.len() as u64 * args.dates.len() as u64;
    if picture.max(pixels(layout.size())) > MOST_PIXELS {
        return Err(format!(
            "the sheet would have more than {} million pixels; choose a smaller --size, or fewer --dates or --hours",
            MOST_PIXELS >> 20
        ));
    }
    Ok(layout)
}

/// A picture with date, hour, and where the sun stands.
fn cell(job: &Job, moment: DateTime<FixedOffset>, picture: Picture) -> Cell {
    let (elevation, azimuth) = (job.sun.apparent_elevation_deg, job.sun.azimuth_deg);
    let mut caption = match &job.suns {
        Some(suns) => vec![
            moment.format("%Y-%m-%d").to_string(),
            format!("the sun is up for {:.1} h", suns.hours),
        ],
        None => vec![
            moment.format("%Y-%m-%d  %H:%M %:z").to_string(),
            format!("sun at {elevation:.1}°, azimuth {azimuth:.1}°"),
        ],
    };
    caption.extend(picture.ev100.map(|ev100| format!("EV100 {ev100:.1}")));
    Cell {
        rgba: picture.rgba,
        caption,
    }
}

fn title(args: &StudyArgs, job: &Job) -> Vec<String> {
    let place = job
        .settings
        .sun
        .place()
        .map(|(latitude, longitude, _)| Place {
            latitude,
            longitude,
        });
    let place = place.map_or(String::new(), |place| place.to_string());
    vec![
        format!("{}  {place}", job.name),
        format!("sky {}{}", job.settings.sky, view(args, job)),
    ]
}

/// How a plan is seen; nothing for other views.
fn view(args: &StudyArgs, job: &Job) -> String {
    if args.plan.is_none() {
        return String::new();
    }
    let above = job.camera.eye.y - job.camera.target.y;
    format!(
        ", seen from {above:.0} m above, north up (perspective of {}°)",
        job.camera.fov_deg
    )
}

/// The options of the sheet: those of its first picture, and its days and hours.
fn of_sheet(args: &StudyArgs, mut metadata: Metadata) -> Metadata {
    let of_one = [
        "when",
        "command",
        "ev100 used",
        "sun azimuth",
        "sun elevation",
    ];
    let is_of_one = |name: &str| of_one.contains(&name) || name.ends_with(" illuminance");
    metadata.retain(|(name, _)| !is_of_one(name));
    let hours: Vec<String> = args
        .hours
        .iter()
        .map(|h| h.0.format("%H:%M").to_string())
        .collect();
    let days: Vec<String> = args.dates.iter().map(SunDate::to_string).collect();
    metadata.push(("dates".to_owned(), days.join(",")));
    metadata.push(("hours".to_owned(), hours.join(",")));
    metadata
}
