//! `skylight daylight`: plans, heat maps, reports.

use std::path::Path;
use std::process::Output;

use roxmltree::{Document, Node};
use serde_json::Value;
use skylight::daylight::colour::srgb_oetf;
use skylight::daylight::false_colour::ColourMap;

use super::daylight_year::{daylight_at, two_days};

/// Nine sensors, one metre apart, in the open beside the colonnade.
fn grid() -> String {
    let line = |n: i32| format!("{},1,{}\n", 30 + n % 3, 40 + n / 3);
    (0..9).map(line).collect()
}

fn daylight(folder: &Path, words: &str) -> Output {
    std::fs::write(folder.join("b.csv"), grid()).expect("written");
    daylight_at(folder, "b.csv", words)
}

const QUICK: &str = "--json --error 0.3 --max-paths 1024 --no-warnings";

/// A run that succeeds; its JSON.
fn ran(folder: &Path, words: &str) -> Value {
    let output = daylight(folder, &format!("{words} {QUICK}"));
    assert!(output.status.success(), "{output:?}");
    serde_json::from_slice(&output.stdout).expect("JSON")
}

fn text(folder: &Path, name: &str) -> String {
    std::fs::read_to_string(folder.join(name)).expect("a file")
}

fn of_class<'a, 'b>(xml: &'b Document<'a>, class: &str) -> Vec<Node<'b, 'a>> {
    let nodes = xml.descendants();
    nodes
        .filter(|node| node.attribute("class") == Some(class))
        .collect()
}

/// The colour of a map at a share, as SVG writes it.
fn colour(map: ColourMap, share: f64) -> String {
    let [r, g, b] = map
        .colour(share)
        .to_array()
        .map(|v| (255.0 * srgb_oetf(v)).round() as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}

#[test]
fn a_plan_has_the_colours_of_the_values() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let folder = folder.path();
    let report = ran(
        folder,
        "--weather a.epw --metrics da,cda,ase --schedule 0-8 --plan a.svg --colour-map viridis",
    );
    let svg = text(folder, "a.svg");
    let xml = Document::parse(&svg).expect("XML");
    let cells = of_class(&xml, "cell");
    let sensors = report["sensors"].as_array().expect("a list");
    assert_eq!((cells.len(), sensors.len()), (9, 9));
    for (cell, sensor) in cells.iter().zip(sensors) {
        // The first of --metrics: three of eight hours are light.
        let value = sensor["da300"].as_f64().expect("percent");
        assert_eq!(value, 37.5);
        let expected = colour(ColourMap::Viridis, value / 100.0);
        assert_eq!(cell.attribute("fill"), Some(expected.as_str()));
        let title = cell.first_element_child().and_then(|t| t.text());
        assert!(title.expect("a title").contains("37.50 %"), "{title:?}");
    }
    let words: Vec<&str> = xml
        .descendants()
        .filter(|n| n.has_tag_name("text"))
        .filter_map(|n| n.text())
        .collect();
    for word in ["N", "%", "100"] {
        assert!(words.contains(&word), "{word} in {words:?}");
    }
    let all = words.join("\n");
    for part in [
        "at least 300 lux",
        "da300: mean 37.50 %",
        "no blinds",
        "Havnby",
        " m",
    ] {
        assert!(all.contains(part), "{part} in {all}");
    }
    // Its second row lies north of its first: higher on the page.
    let corner = |cell: &Node| -> f64 {
        let points = cell.attribute("points").expect("points");
        let first = points.split([' ', ',']).nth(1).expect("a number");
        first.parse().expect("a number")
    };
    assert!(corner(&cells[3]) > corner(&cells[0]), "+Z is south");
}

#[test]
fn plans_are_of_the_metric_that_is_asked_for_and_pngs_too() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let folder = folder.path();
    ran(
        folder,
        "--metrics vsc,sunhours --place copenhagen --plan a.svg --plan-of sunhours",
    );
    assert!(text(folder, "a.svg").contains("Hours of sun without clouds"));
    let report = ran(folder, "--metrics vsc --plan a.png");
    let picture = image::open(folder.join("a.png"))
        .expect("a picture")
        .to_rgb8();
    let colour_of = |share: f64| {
        let linear = ColourMap::Turbo.colour(share);
        image::Rgb(
            linear
                .to_array()
                .map(|v| (255.0 * srgb_oetf(v)).round() as u8),
        )
    };
    // The scale ends at 100 %; nine cells fill most of the panel.
    for sensor in report["sensors"].as_array().expect("a list") {
        let value = sensor["vsc"].as_f64().expect("percent");
        assert!((50.0..100.0).contains(&value), "{value}");
        let ink = colour_of(value / 100.0);
        let count = picture.pixels().filter(|p| **p == ink).count();
        assert!(count > 50_000, "{count} pixels of {ink:?}");
    }
    let output = daylight(
        folder,
        "--sun 180,40 --sky preetham --error 0.1 --plan b.svg",
    );
    assert!(output.status.success(), "{output:?}");
    assert!(text(folder, "b.svg").contains("elevation 40.00°"));
}

#[test]
fn the_heat_map_has_an_hour_for_each_hour_with_light() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let folder = folder.path();
    let report = ran(
        folder,
        "--weather a.epw --metrics illuminance --heat a.svg --heat-of 5 --ill a.ill",
    );
    assert!(report["sensors"][4]["mean_lux"].is_number());
    let svg = text(folder, "a.svg");
    let xml = Document::parse(&svg).expect("XML");
    let areas: usize = of_class(&xml, "hours")
        .iter()
        .map(|path| path.attribute("d").expect("areas").matches('M').count())
        .sum();
    let ill = text(folder, "a.ill");
    let lux: Vec<f64> = ill
        .lines()
        .map(|line| {
            line.split(' ')
                .nth(7)
                .expect("a sensor")
                .parse()
                .expect("lux")
        })
        .collect();
    assert_eq!(areas, lux.iter().filter(|lux| **lux > 0.0).count());
    assert!(svg.contains("sensor 5 (31, 1, 41)") && svg.contains(">Jun<"));
    // The brightest hour has the colour of its place between the ends of the legend: of 32 hours none is an outlier.
    let most = lux.iter().copied().fold(0.0, f64::max);
    let least = lux
        .iter()
        .copied()
        .filter(|lux| *lux > 0.0)
        .fold(most, f64::min);
    let (low, high) = (
        (2.0 * least.log10()).floor() / 2.0,
        (2.0 * most.log10()).ceil() / 2.0,
    );
    let share = (most.log10() - low) / (high - low);
    let expected = colour(ColourMap::Turbo, (share * 127.0).round() / 127.0);
    let last = of_class(&xml, "hours");
    let last = last.last().expect("hours").attribute("fill");
    assert_eq!(last, Some(expected.as_str()), "{most} lux");
}

#[test]
fn the_report_has_the_numbers_of_the_json() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let folder = folder.path();
    let report = ran(folder, "--weather a.epw --report a.html");
    let page = text(folder, "a.html");
    let options = roxmltree::ParsingOptions {
        allow_dtd: true,
        ..roxmltree::ParsingOptions::default()
    };
    let xml = Document::parse_with_options(&page, options).expect("well-formed");
    let data = xml
        .descendants()
        .find(|node| node.attribute("id") == Some("results"));
    let data = data.and_then(|node| node.text()).expect("data");
    let inside: Value = serde_json::from_str(data).expect("JSON");
    assert_eq!(inside, report);
    // The mean of each metric in the table is that of the sensors.
    let rows: Vec<Vec<&str>> = xml
        .descendants()
        .filter(|node| node.has_tag_name("tr"))
        .map(|row| {
            row.children()
                .map(|cell| cell.text().unwrap_or_default())
                .collect()
        })
        .collect();
    let sensors = report["sensors"].as_array().expect("a list");
    for key in [
        "da300",
        "cda300",
        "udi_aut",
        "ase_hours",
        "df",
        "en17037_hours_ge300",
    ] {
        let of = |key: &str| {
            let values = sensors.iter().map(|s| s[key].as_f64().expect(key));
            values.collect::<Vec<f64>>()
        };
        let (values, errors) = (of(key), of(&format!("{key}_se")));
        let mean = values.iter().sum::<f64>() / 9.0;
        let error = (errors.iter().map(|e| e * e).sum::<f64>() / 9.0).sqrt();
        let name = format!("({key})");
        let row = rows.iter().find(|row| row[0].ends_with(&name)).expect(key);
        let told = |at: usize| row[at].parse::<f64>().expect("a number");
        assert!((told(2) - mean).abs() < 0.0051, "{row:?} {mean}");
        assert!((told(3) - error).abs() < 0.0051, "{row:?} {error}");
    }
    for part in [
        "EN 17037:2018, daylight provision, method 2",
        "table A.1",
        "LM-83-12",
        "Havnby",
        "BLAKE3",
        "not checked",
        "jackknife",
        "@page",
        "seed",
    ] {
        assert!(page.contains(part), "{part}");
    }
    assert!(
        !page.contains("href=") && !page.contains("src="),
        "one file"
    );
    let pictures = xml
        .descendants()
        .filter(|n| n.has_tag_name(("http://www.w3.org/2000/svg", "svg")));
    assert_eq!(pictures.count(), 5, "four plans and the heat map");
}

#[test]
fn the_report_says_what_blinds_there_are() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let folder = folder.path();
    let report = ran(
        folder,
        "--weather a.epw --blinds lm83 --report a.html --plan a.svg",
    );
    // In the open every second hour has direct sun: ten of twenty.
    assert_eq!(report["blinds"], "lm83");
    assert_eq!(report["blinds_closed_hours"], 10.0);
    let page = text(folder, "a.html");
    for part in [
        "the windows of a room are one group",
        "10 of the occupied hours",
        "sDA300/50 of 75 %",
    ] {
        assert!(page.contains(part), "{part}");
    }
    assert!(!page.contains("LM-83 wants blinds") && !page.contains("no blinds"));
    assert!(text(folder, "a.svg").contains("blinds by LM-83"));
}

#[test]
fn pictures_that_cannot_be_drawn_are_one_line() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let folder = folder.path();
    assert_eq!(two_days().lines().count(), 50);
    for (words, what, code) in [
        (
            "--metrics vsc --plan a.svg --plan-of da300",
            "choose of vsc",
            2,
        ),
        ("--metrics vsc --plan a.pdf", ".svg or .png", 2),
        ("--metrics vsc --plan no/a.svg", "does not exist", 1),
        ("--metrics vsc --heat a.svg", "--weather", 2),
        (
            "--weather a.epw --heat a.svg --heat-of 10",
            "from 1 to 9",
            2,
        ),
        ("--sun 180,40 --plan a.svg --plan-of da300", "all light", 2),
        (
            "--weather a.epw --hour 6-20T12 --report a.html",
            "--hour",
            2,
        ),
    ] {
        let output = daylight(folder, words);
        let line = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(code), "{words}: {line}");
        let lines: Vec<&str> = line.lines().filter(|l| !l.starts_with("warning")).collect();
        assert_eq!(lines.len(), 1, "{line}");
        assert!(line.contains(what), "{line} for {what}");
    }
}
