//! `skylight compare`: the difference between two images, as figures and as an image.

use std::fmt::Write as _;
use std::path::Path;

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
    let mut text = report(&statistics);
    let map = flip_map(args, [&reference, &test], &mask, &mut text);
    if let Some(path) = &args.diff {
        write_map(path, reference.size, &map)?;
    }
    print(&text)
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

/// Appends FLIP within the mask to `text`, and returns the map for the difference image.
fn flip_map(
    args: &CompareArgs,
    [reference, test]: [&Picture; 2],
    mask: &[bool],
    text: &mut String,
) -> Vec<f32> {
    let (a, b) = (reference.masked(mask), test.masked(mask));
    let mean = |map: &[f32]| {
        let kept = map.iter().zip(mask).filter(|(_, kept)| **kept);
        let kept: Vec<f32> = kept.map(|(v, _)| *v).collect();
        flip::mean(&kept)
    };
    if reference.referred == Referred::Display {
        let map = flip::ldr(&a, &b);
        let _ = writeln!(text, "FLIP                   {:.4}", mean(&map));
        return map;
    }
    let exposure = args
        .exposure
        .map_or_else(|| exposure_of(reference, mask), |e| e as f32);
    let shown = flip::ldr(&a.exposed(exposure), &b.exposed(exposure));
    let map = flip::hdr(&a, &b);
    let (start, stop, count) = flip::exposures(&a);
    let _ = writeln!(
        text,
        "FLIP, shown            {:.4} (exposure {exposure:.4e}, sRGB)\n\
         FLIP, HDR              {:.4} ({count} exposures, {start:.2} to {stop:.2} stops)",
        mean(&shown),
        mean(&map)
    );
    map
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
