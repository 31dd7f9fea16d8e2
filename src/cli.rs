//! The command line: words to [`Command`]. It touches no file and prints nothing.

mod args;
mod series;
mod vary;
mod view;

use std::ffi::OsString;
use std::path::PathBuf;

use clap::error::ErrorKind;
use clap::{Arg, CommandFactory as _, Parser, Subcommand};

pub use args::{
    BakeArgs, BenchArgs, CompareArgs, DaylightArgs, HourArgs, Layout, Map, Metric, Motion, SkyArgs,
    Sweep, Texels, WeatherArgs,
};
pub use series::{Expose, MergeArgs, SequenceArgs, StudyArgs};
pub use vary::Vary;
pub use view::ViewArgs;

use crate::options::{
    OptionValues, Optional, SeveralPictures, choice, choice_enum, decides_light, one_line,
};

/// A command with its arguments.
#[derive(Debug, Clone, PartialEq, Subcommand)]
pub enum Command {
    /// `--print-config`, instead of a command.
    #[command(skip)]
    PrintConfig,
    /// Render a picture to a file, or several of one scene, without a window.
    ///
    /// --camera, --moment and --when may be given several times, or as lists (--camera porch,pool): every camera in every moment. The scene is
    /// loaded once, and each picture is the same as by itself.
    Render {
        /// Scene file (.toml), model (.obj, .gltf, .glb), or bundled scene (colonnade, the default; island).
        scene: Option<PathBuf>,
        /// File to write: .png is tone-mapped, .exr is scene-linear cd/m² (lux for irradiance). {camera} and {moment} in the name stand for
        /// those of each picture. - is standard output as PNG, exr:- as EXR.
        #[arg(short, long, value_name = "FILE", default_value = "skylight.png", value_parser = args::named_or_stdout(&["png", "exr"]))]
        output: PathBuf,
        /// Also write FILE.json: every option as resolved, command, place and moment, sun, exposure, device, version.
        #[arg(long)]
        sidecar: bool,
        /// An hour of a weather file.
        #[command(flatten)]
        at: HourArgs,
        /// Options of the picture.
        #[command(flatten)]
        options: SeveralPictures,
    },
    /// Render pictures of one scene at equal steps of time: frames, or a film. The scene is loaded once.
    ///
    /// Ctrl-C ends after the frame before; frames that are finished stay.
    Sequence {
        /// Arguments of its own.
        #[command(flatten)]
        args: SequenceArgs,
        /// Options of the picture.
        #[command(flatten)]
        options: OptionValues,
    },
    /// Render a shadow study: one sheet of pictures, a row for each day and a column for each hour, with the sun's place below each.
    ///
    /// Each picture is exposed by itself unless --ev100 is given; --size is that of one, by default 480x320, with 16 --samples.
    Study {
        /// Arguments of its own.
        #[command(flatten)]
        args: StudyArgs,
        /// Options of the picture.
        #[command(flatten)]
        options: OptionValues,
    },
    /// Put together what several machines did with --shard, and find what is missing or damaged.
    Merge {
        /// Arguments of its own.
        #[command(flatten)]
        args: MergeArgs,
    },
    /// Open a window on a scene; press ? in it for the keys.
    View {
        /// Arguments of its own.
        #[command(flatten)]
        args: ViewArgs,
        /// Options of the picture; --samples is the number of frames averaged at rest, by default 64.
        #[command(flatten)]
        options: OptionValues,
    },
    /// Time every pass of the frame.
    Bench {
        /// Arguments of its own.
        #[command(flatten)]
        args: BenchArgs,
        /// Options of the picture.
        #[command(flatten)]
        options: OptionValues,
    },
    /// Print the figures of a daylight: sun, illuminances, luminances.
    ///
    /// The options of a picture (its size, camera, tone ..) are accepted and have no effect, so that one list of options
    /// serves render, sky and bake.
    #[command(mut_args = hidden_if_of_pictures)]
    Sky {
        /// Arguments of its own.
        #[command(flatten)]
        args: SkyArgs,
        /// Options of the daylight.
        #[command(flatten)]
        options: OptionValues,
    },
    /// Measure daylight at points of a model, at a moment or over a year: sun, sky and every diffuse bounce, with standard errors. Needs no
    /// device.
    ///
    /// The options of a picture (its size, camera, tone ..) are accepted and have no effect.
    #[command(mut_args = of_sensors)]
    Daylight {
        /// Arguments of its own.
        #[command(flatten)]
        args: Box<DaylightArgs>,
        /// Options of the daylight.
        #[command(flatten)]
        options: OptionValues,
        /// The commands that --vary asks for.
        #[arg(skip)]
        variants: Vec<Variant>,
    },
    /// Print what a weather file holds: place, clock, irradiation and light of its months. Needs no device.
    ///
    /// All other options are accepted and have no effect.
    #[command(mut_args = hidden_in_weather)]
    Weather {
        /// Arguments of its own.
        #[command(flatten)]
        args: WeatherArgs,
        /// --strict, --no-warnings.
        #[command(flatten)]
        options: OptionValues,
    },
    /// Write the sky, its irradiance or its reflection in rough metals as an environment map, with a JSON file of its units beside it.
    ///
    /// No map has the discs of sun and moon: the JSON file has them as directional lights.
    /// The options of a picture (its size, camera, tone ..) are accepted and have no effect.
    #[command(mut_args = of_maps)]
    Bake {
        /// Arguments of its own.
        #[command(flatten)]
        args: BakeArgs,
        /// Options of the daylight.
        #[command(flatten)]
        options: OptionValues,
    },
    /// Compare two pictures of one view: radiometric errors, and FLIP, the difference that a viewer sees.
    Compare {
        /// Arguments of its own.
        #[command(flatten)]
        args: CompareArgs,
    },
    /// Prove the device that is there: what it draws against reference values, closed forms and the CPU.
    ///
    /// Exit code 1 when a check fails.
    Validate {
        /// Part of a device's name, or its number.
        #[arg(long, value_name = "NAME|INDEX")]
        device: Option<String>,
        /// Machine-readable instead of a table.
        #[arg(long)]
        json: bool,
        /// Do without something that the device has, as on devices that lack it.
        #[arg(long, value_name = "FEATURE", value_parser = choice::<Optional>())]
        without: Option<Optional>,
    },
    /// List the Vulkan devices and what each lacks.
    Info {
        /// Instead: draw the bundled scene, and tell where the time goes before its first picture is there.
        #[arg(long)]
        startup: bool,
        /// With --startup: part of a device's name, or its number.
        #[arg(long, value_name = "NAME|INDEX", requires = "startup")]
        device: Option<String>,
        /// Machine-readable instead of text.
        #[arg(long)]
        json: bool,
        /// Do without something that the devices have, as on devices that lack it.
        #[arg(long, value_name = "FEATURE", value_parser = choice::<Optional>())]
        without: Option<Optional>,
    },
}

/// The command with one choice of the values of --vary.
#[derive(Debug, Clone, PartialEq)]
pub struct Variant {
    /// The values, in the order of the options.
    pub values: Vec<String>,
    /// Arguments of its own.
    pub args: DaylightArgs,
    /// Options of the daylight.
    pub options: OptionValues,
}

/// Why the program ends without running a command.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum CliExit {
    /// Asked-for text for stdout; exit code 0.
    Help(String),
    /// One line for stderr; exit code 2.
    Usage(String),
}

impl CliExit {
    /// 0 or 2.
    pub fn code(&self) -> u8 {
        match self {
            Self::Help(_) => 0,
            Self::Usage(_) => 2,
        }
    }
}

#[derive(Debug, Parser)]
#[command(name = "skylight", version, max_term_width = 100)]
#[command(about = "Shows a 3D model in the daylight of a place and a moment, in cd/m² and lux")]
#[command(
    after_help = "An option overrides the scene file, and that the user's config.toml (see --print-config). Exit code: 0 done, 1 failed, 2 wrong usage. Results are on standard output, messages on standard error."
)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    /// Print where the file of your own defaults is, and what it sets: lines as size = "1920x1080", with the names of options. Command line,
    /// scene file and preset override it.
    #[arg(long)]
    print_config: bool,
    /// Colour the first word of messages: by default on a terminal, unless NO_COLOR is in the environment.
    #[arg(long, global = true, value_name = "WHEN", value_parser = choice::<Colour>(), default_value_t)]
    color: Colour,
}

choice_enum! {
    /// When messages are coloured.
    #[derive(Default)]
    pub enum Colour {
        #[default]
        Auto = "auto": "On a terminal, unless NO_COLOR is set",
        Always = "always": "Always",
        Never = "never": "Never",
    }
}

impl Command {
    /// The options that decide its picture or daylight.
    pub fn options_mut(&mut self) -> Option<&mut OptionValues> {
        match self {
            Self::Render { options, .. } => Some(&mut options.first),
            Self::Sequence { options, .. }
            | Self::Study { options, .. }
            | Self::View { options, .. }
            | Self::Bench { options, .. }
            | Self::Sky { options, .. }
            | Self::Daylight { options, .. }
            | Self::Weather { options, .. }
            | Self::Bake { options, .. } => Some(options),
            Self::PrintConfig
            | Self::Merge { .. }
            | Self::Compare { .. }
            | Self::Validate { .. }
            | Self::Info { .. } => None,
        }
    }
}

/// The definition of the command line, of which man pages and completions of shells are made (`examples/make_package`).
pub fn definition() -> clap::Command {
    Cli::command()
}

/// Reads the words of the command line; the first is the program's name.
///
/// # Errors
/// Help that was asked for, or one line about what is wrong.
pub fn parse(words: impl IntoIterator<Item = OsString>) -> Result<Command, CliExit> {
    let words: Vec<OsString> = words.into_iter().collect();
    let asked = vary::asked(&words);
    if asked.is_empty() {
        return read(&words);
    }
    // Each variant by itself: what one option needs another may vary.
    let usage = |what: String| CliExit::Usage(format!("{what} (see skylight daylight --help)"));
    let is_given = |name: &str| {
        let texts = words.iter().filter_map(|word| word.to_str());
        let mut names = texts.filter_map(|text| text.strip_prefix("--"));
        names.any(|text| text.split('=').next() == Some(name))
    };
    let mut all = None;
    for chosen in vary::variants(&asked, is_given).map_err(usage)? {
        // After the program and the command: what follows may end with `--` and a name.
        let own = chosen.words.into_iter().map(OsString::from);
        let own: Vec<OsString> = own.collect();
        let mut command = read(&[&words[..2], &own, &words[2..]].concat())?;
        let Command::Daylight {
            args,
            options,
            variants,
        } = &mut command
        else {
            return Ok(command);
        };
        vary::check(&asked, args).map_err(usage)?;
        variants.push(Variant {
            values: chosen.values,
            args: (**args).clone(),
            options: options.clone(),
        });
        match &mut all {
            None => all = Some(command),
            Some(Command::Daylight { variants: list, .. }) => list.append(variants),
            Some(_) => {}
        }
    }
    all.map_or_else(|| read(&words), Ok)
}

fn read(words: &[OsString]) -> Result<Command, CliExit> {
    let cli = Cli::try_parse_from(words).map_err(|error| exit(&error, words))?;
    match (cli.command, cli.print_config) {
        (Some(command), false) => Ok(command),
        (None, true) => Ok(Command::PrintConfig),
        (None, false) => Err(CliExit::Usage(missing_command())),
        (Some(_), true) => {
            let what = "--print-config stands alone; leave out the command";
            Err(CliExit::Usage(what.to_owned()))
        }
    }
}

/// The choice of `--color`, also for a line that is wrong otherwise.
pub fn colour(words: impl IntoIterator<Item = OsString>) -> anstream::ColorChoice {
    let words: Vec<OsString> = words.into_iter().collect();
    let given = |at: usize| {
        let word = words[at].to_str()?;
        match word.strip_prefix("--color")? {
            "" => words.get(at + 1)?.to_str(),
            rest => rest.strip_prefix('='),
        }
    };
    match (0..words.len()).find_map(given) {
        Some("always") => anstream::ColorChoice::Always,
        Some("never") => anstream::ColorChoice::Never,
        _ => anstream::ColorChoice::Auto,
    }
}

fn exit(error: &clap::Error, words: &[OsString]) -> CliExit {
    let usage = |what: String| {
        let mut command = words.get(1).and_then(|word| word.to_str()).into_iter();
        let hint = command.find(|word| is_command(word));
        let hint = hint.map_or("skylight".to_owned(), |word| format!("skylight {word}"));
        CliExit::Usage(format!("{what} (see {hint} --help)"))
    };
    match error.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => match file_taken_for_help(words) {
            Some(file) => usage(format!("no option {file}; write ./{file} if it is a file")),
            None => CliExit::Help(error.render().to_string()),
        },
        ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand | ErrorKind::MissingSubcommand => {
            CliExit::Usage(missing_command())
        }
        ErrorKind::InvalidUtf8 => {
            let mut odd = words.iter().filter(|word| word.to_str().is_none());
            let word = odd.next().map(|word| word.to_string_lossy());
            usage(format!("'{}' is not UTF-8", word.unwrap_or_default()))
        }
        _ => usage(one_line(error)),
    }
}

/// A word such as `-house.obj`, which starts with the letter of an option for help, when nothing else asks for it.
fn file_taken_for_help(words: &[OsString]) -> Option<&str> {
    let texts = || words.iter().skip(1).filter_map(|word| word.to_str());
    let asks = |word: &str| ["-h", "--help", "-V", "--version", "help"].contains(&word);
    let is_file =
        |word: &&str| word.len() > 2 && (word.starts_with("-h") || word.starts_with("-V"));
    texts().find(is_file).filter(|_| !texts().any(asks))
}

/// Hides an option that decides a picture from the help of a command that makes none.
fn hidden_if_of_pictures(arg: Arg) -> Arg {
    const OF_THE_COMMAND: [&str; 4] = ["preset", "quiet", "no-warnings", "strict"];
    let name = arg.get_long().unwrap_or_default();
    let is_shared = arg.get_help_heading().is_some();
    let hidden = is_shared && !decides_light(name) && !OF_THE_COMMAND.contains(&name);
    arg.hide(hidden)
}

/// As [`hidden_if_of_pictures`], with what else decides the light at sensors.
fn of_sensors(arg: Arg) -> Arg {
    let name = arg.get_long().unwrap_or_default();
    if ["bounces", "glass", "reflectance", "seed"].contains(&name) {
        return arg;
    }
    hidden_if_of_pictures(arg)
}

/// Hides all shared options but those of messages.
fn hidden_in_weather(arg: Arg) -> Arg {
    let name = arg.get_long().unwrap_or_default();
    let hidden = arg.get_help_heading().is_some() && !["no-warnings", "strict"].contains(&name);
    arg.hide(hidden)
}

/// As [`hidden_if_of_pictures`]; a map has a `--size` of its own, so that of pictures makes way.
fn of_maps(arg: Arg) -> Arg {
    if arg.get_id() == "size" {
        return arg.long("picture-size").hide(true);
    }
    hidden_if_of_pictures(arg)
}

fn is_command(word: &str) -> bool {
    Command::has_subcommand(word)
}

fn missing_command() -> String {
    "no command given; try: skylight render (see skylight --help)".to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::options::SunInput;
    use clap::CommandFactory;
    use std::path::Path;

    fn words(line: &str) -> Vec<OsString> {
        std::iter::once("skylight")
            .chain(line.split_whitespace())
            .map(OsString::from)
            .collect()
    }

    fn render(line: &str) -> (Option<PathBuf>, PathBuf, crate::options::Options) {
        match parse(words(line)) {
            Ok(Command::Render {
                scene,
                output,
                options,
                ..
            }) => (scene, output, options.first.alone().expect(line)),
            other => panic!("{line}: {other:?}"),
        }
    }

    fn longitude(options: &crate::options::Options) -> f64 {
        match options.sun {
            SunInput::Place { longitude, .. } => longitude,
            sun => panic!("{sun:?}"),
        }
    }

    #[test]
    fn the_definition_is_sound() {
        Cli::command().debug_assert();
    }

    #[test]
    fn negative_numbers_are_values() {
        for line in [
            "render --eye=-17.5,3,13 --place=-33.8,-70",
            "render --eye -17.5,3,13 --place -33.8,-70",
        ] {
            let (_, _, options) = render(line);
            assert_eq!(options.eye, Some([-17.5, 3.0, 13.0]));
            assert_eq!(longitude(&options), -70.0);
        }
        let (_, _, options) = render("render --place Zürich");
        assert_eq!(longitude(&options), 8.54);
    }

    #[test]
    fn good_lines() {
        let (scene, output, options) =
            render("render a.toml -o b.EXR --size 4x3 --layers --when 2026-06-21T14:00+02:00");
        assert_eq!(scene, Some("a.toml".into()));
        assert_eq!(output, Path::new("b.EXR"));
        assert!(options.layers);
        assert_eq!(render("render").1, Path::new("skylight.png"));
        assert_eq!(
            parse(words("info")),
            Ok(Command::Info {
                startup: false,
                device: None,
                json: false,
                without: None
            })
        );
        assert!(matches!(
            parse(words("bench --frames 3 --json t.json")),
            Ok(Command::Bench { args, .. }) if args.frames == 3
        ));
    }

    #[test]
    fn bad_lines_are_one_line_each() {
        for (line, part) in [
            ("", "no command given"),
            ("paint", "'paint'"),
            ("render --size 0x0", "1 to 32768"),
            ("render --size", "--size"),
            ("render --turbidity abc", "not a number"),
            ("render --turbidity nan", "finite"),
            ("render --turbidity -1000", "turbidity must be -100 to 100"),
            ("render --turbidty 3", "--turbidity"),
            (
                "render --when 2026-02-30T12:00Z",
                "a date that does not exist",
            ),
            ("render --sky blue", "preetham"),
            (
                "render --sun 1,2 --when 2026-02-01T12:00Z",
                "cannot be used with",
            ),
            ("render --ev100 3 --exposure auto", "cannot be used with"),
            ("render --eye 1,2", "three numbers"),
            ("sky --place copenhagn", "did you mean \"Copenhagen\"?"),
            ("render -o picture.jpg", ".png or .exr"),
            ("render -o png", ".png or .exr"),
            ("render --samples 0", "--samples"),
            ("render -house.obj", "-house.obj; write ./-house.obj"),
            ("-Villa.obj", "./-Villa.obj"),
            ("render -Villa.obj", "'-V' found"),
            ("render a.obj b.obj", "b.obj"),
            ("render --size 1x1 --size 2x2", "--size"),
            ("bench --frames 0", "--frames"),
            ("info --size 3x3", "--size"),
        ] {
            match parse(words(line)) {
                Err(CliExit::Usage(text)) => {
                    assert!(text.contains(part), "{line}: {text}");
                    assert_eq!(text.lines().count(), 1, "{line}: {text}");
                    assert!(text.contains("--help"), "{line}: {text}");
                }
                other => panic!("{line}: {other:?}"),
            }
        }
    }

    #[test]
    fn help_is_no_error_and_names_every_group() {
        let Err(CliExit::Help(text)) = parse(words("render --help")) else {
            panic!("no help")
        };
        for part in [
            "Picture:",
            "Sun and sky:",
            "Camera:",
            "Tone:",
            "Light:",
            "Program:",
            "[default: 1280x720]",
        ] {
            assert!(text.contains(part), "{part} is missing in {text}");
        }
        assert!(matches!(parse(words("--version")), Err(CliExit::Help(_))));
    }
}
