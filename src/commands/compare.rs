//! `skylight compare`: the difference of two pictures in numbers and as a picture.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;

use crate::compare::{
    Picture, Referred, Statistics, check_comparable, eroded, exposure_of, flip, read,
};
use crate::error::{Error, Result};
use crate::output::{Effort, Encoding, check_writable, print, write_png};

/// Arguments of `compare`.
#[derive(Debug, Clone, PartialEq, Args)]
pub struct CompareWishes {
    /// Reference picture: .exr (scene-linear), or .png and other 8-bit files (sRGB).
    reference: PathBuf,
    /// Picture to test.
    test: PathBuf,
    /// Compare only where this picture is not black, except within one pixel of its edges; for instance an .exr of the depth.
    #[arg(long, value_name = "FILE")]
    mask: Option<PathBuf>,
    /// Exposure factor of scene-linear pictures for LDR-FLIP [default: brings the 75th percentile of the reference to 0.5].
    #[arg(long, value_name = "FACTOR", value_parser = crate::settings::exposure_factor)]
    exposure: Option<f64>,
    /// Write the FLIP map, black (0) to white (1).
    #[arg(long, value_name = "FILE.png", value_parser = png_path)]
    diff: Option<PathBuf>,
}

fn png_path(text: &str) -> std::result::Result<PathBuf, String> {
    let path = Path::new(text);
    match path.extension() {
        Some(e) if e.eq_ignore_ascii_case("png") => Ok(path.to_owned()),
        _ => Err("the name must end in .png".to_owned()),
    }
}

/// Compares two pictures and prints the figures.
///
/// # Errors
/// A picture cannot be read, or the two differ in size or kind.
pub fn run(wishes: &CompareWishes) -> Result<()> {
    if let Some(path) = &wishes.diff {
        check_writable(path)?;
    }
    let (reference, test) = (read(&wishes.reference)?, read(&wishes.test)?);
    check_comparable(&reference, &test)?;
    let mask = mask(wishes, &reference)?;
    let statistics = Statistics::new(&reference, &test, &mask)?;
    let mut text = report(&statistics);
    let map = flip_map(wishes, [&reference, &test], &mask, &mut text);
    if let Some(path) = &wishes.diff {
        write_map(path, reference.size, &map)?;
    }
    print(&text)
}

fn mask(wishes: &CompareWishes, reference: &Picture) -> Result<Vec<bool>> {
    let Some(path) = &wishes.mask else {
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

/// Appends the mean FLIP within the mask to `text`; returns the FLIP map.
fn flip_map(
    wishes: &CompareWishes,
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
    let exposure = wishes
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
