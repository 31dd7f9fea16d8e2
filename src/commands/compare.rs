//! `skylight compare`: the difference between two images, as figures and as an image.

use std::path::Path;

use serde_json::json;

use crate::cli::CompareArgs;
use crate::compare::{
    Picture, Referred, Statistics, check_comparable, eroded, exposure_of, flip, read,
};
use crate::error::{Error, Result};
use crate::output::{Effort, Encoding, check_writable, print, write_png};

/// Compares two images and prints the figures.
///
/// # Errors
/// An image that cannot be read, or two that cannot be compared.
pub fn run(args: &CompareArgs) -> Result<()> {
    if let Some(path) = &args.diff {
        check_writable(path)?;
    }
    let (reference, test) = (read(&args.reference)?, read(&args.test)?);
    check_comparable(&reference, &test)?;
    let mask = mask(args, &reference)?;
    let statistics = Statistics::new(&reference, &test, &mask)?;
    let perceived = Perceived::new(args, [&reference, &test], &mask);
    if let Some(path) = &args.diff {
        write_map(path, reference.size, &perceived.map)?;
    }
    if args.json {
        return print(&format!("{:#}\n", json(&statistics, &perceived)));
    }
    print(&(report(&statistics) + &perceived.report()))
}

/// The same figures as the table, by name.
fn json(s: &Statistics, perceived: &Perceived) -> serde_json::Value {
    let mut figures = json!({
        "pixels": s.pixels,
        "mean_ratio": s.mean_ratio,
        "rmse_over_mean": s.rmse_over_mean,
        "relative_error_median": s.median,
        "relative_error_95": s.p95,
        "flip": perceived.shown,
    });
    if let Some(hdr) = &perceived.hdr {
        figures["flip_exposure"] = hdr.exposure.into();
        figures["flip_hdr"] = hdr.flip.into();
        let (start, stop, count) = hdr.exposures;
        figures["flip_hdr_exposures"] = json!({ "start": start, "stop": stop, "count": count });
    }
    figures
}

fn mask(args: &CompareArgs, reference: &Picture) -> Result<Vec<bool>> {
    let Some(path) = &args.mask else {
        return Ok(vec![true; reference.rgb.len()]);
    };
    let picture = read(path)?;
    if picture.size != reference.size {
        return Err(Error::Compare(format!(
            "{}: the mask's size is not that of the pictures; render it with the same --size",
            path.display()
        )));
    }
    let lit: Vec<bool> = picture.rgb.iter().map(|p| *p != [0.0; 3]).collect();
    Ok(eroded(picture.size, &lit))
}

fn report(s: &Statistics) -> String {
    format!(
        "pixels                 {}\nmean ratio             {:.4}\nRMSE / mean            {:.4}\n\
         relative error, median {:.4}\nrelative error, 95 %   {:.4}\n",
        s.pixels, s.mean_ratio, s.rmse_over_mean, s.median, s.p95
    )
}

/// What a viewer sees of the difference.
struct Perceived {
    /// FLIP of the pictures as they are shown.
    shown: f64,
    /// Of scene-linear pictures only.
    hdr: Option<Hdr>,
    /// FLIP of every pixel, for the difference image.
    map: Vec<f32>,
}

/// FLIP of scene-linear pictures.
struct Hdr {
    /// Factor with which they are shown.
    exposure: f32,
    /// HDR-FLIP.
    flip: f64,
    /// First and last exposure of HDR-FLIP, stops, and their number.
    exposures: (f32, f32, usize),
}

impl Perceived {
    /// FLIP within the mask.
    fn new(args: &CompareArgs, [reference, test]: [&Picture; 2], mask: &[bool]) -> Self {
        let (a, b) = (reference.masked(mask), test.masked(mask));
        let mean = |map: &[f32]| {
            let kept = map.iter().zip(mask).filter(|(_, kept)| **kept);
            let kept: Vec<f32> = kept.map(|(v, _)| *v).collect();
            flip::mean(&kept)
        };
        if reference.referred == Referred::Display {
            let map = flip::ldr(&a, &b);
            let shown = mean(&map);
            return Self {
                shown,
                hdr: None,
                map,
            };
        }
        let exposure = args
            .exposure
            .map_or_else(|| exposure_of(reference, mask), |e| e as f32);
        let shown = flip::ldr(&a.exposed(exposure), &b.exposed(exposure));
        let map = flip::hdr(&a, &b);
        let hdr = Hdr {
            exposure,
            flip: mean(&map),
            exposures: flip::exposures(&a),
        };
        Self {
            shown: mean(&shown),
            hdr: Some(hdr),
            map,
        }
    }

    fn report(&self) -> String {
        let Some(hdr) = &self.hdr else {
            return format!("FLIP                   {:.4}\n", self.shown);
        };
        let (start, stop, count) = hdr.exposures;
        format!(
            "FLIP, shown            {:.4} (exposure {:.4e}, sRGB)\n\
             FLIP, HDR              {:.4} ({count} exposures, {start:.2} to {stop:.2} stops)\n",
            self.shown, hdr.exposure, hdr.flip
        )
    }
}

fn write_map(path: &Path, size: [usize; 2], map: &[f32]) -> Result<()> {
    let grey = |v: &f32| {
        let v = (v * 255.0).round() as u8;
        [v, v, v, 255]
    };
    let bytes: Vec<u8> = map.iter().flat_map(grey).collect();
    let size = size.map(|edge| edge as u32);
    let metadata = vec![("Title".to_owned(), "FLIP, 0 to 1".to_owned())];
    let how = (Encoding::Gamma(1.0), Effort::Small);
    write_png(path, size, &bytes, how, &metadata)
}
