//! Screenshots: PNG as shown and EXR in cd/m² or lux, both with the parameters of the image.

use std::path::{Path, PathBuf};

use crate::error::Result;
use crate::gpu::{Pixels, read_back};
use crate::output::{
    Channels, Effort, Encoding, Layer, Metadata, write_exr, write_png, write_text,
};

use super::document::Document;
use super::stage::Stage;

/// Writes the newest frame to the working directory; returns a message that names the files.
///
/// # Errors
/// Fails when a file cannot be written.
pub(super) fn save(stage: &mut Stage, document: &mut Document) -> Result<String> {
    let stem = free_name(document);
    let (png, exr) = (stem.with_extension("png"), stem.with_extension("exr"));
    let metadata = metadata(stage, document)?;
    save_png(stage, document, &png, &metadata)?;
    save_exr(stage, document, &exr, &metadata)?;
    let desk = document.desk.as_ref().filter(|desk| desk.is_shown);
    let record = document.record_shown();
    let values = desk.and_then(|desk| desk.csv(&document.job, record));
    let also = match values {
        Some(values) => {
            write_text(&stem.with_extension("csv"), &values)?;
            ", .exr, and .csv with the values of the sensors"
        }
        None => " and .exr",
    };
    Ok(format!("wrote {}{also}", png.display()))
}

/// First unused name of the form `skylight-SCENE-N`.
fn free_name(document: &Document) -> PathBuf {
    let scene = document.job.path.as_deref().and_then(Path::file_stem);
    let scene = scene.map_or("bundled".into(), |s| s.to_string_lossy());
    let mut number = 1;
    loop {
        let stem = format!("skylight-{scene}-{number}");
        let taken = |extension: &&str| Path::new(&format!("{stem}.{extension}")).exists();
        if !["png", "exr", "csv"].iter().any(taken) {
            return stem.into();
        }
        number += 1;
    }
}

fn metadata(stage: &mut Stage, document: &Document) -> Result<Metadata> {
    let mut metadata = document.job.metadata();
    let (averaged, _) = document.progress();
    metadata.push(("samples drawn".into(), averaged.max(1).to_string()));
    if document.job.settings.ev100.is_none() {
        let average = read_back(stage.idle()?, document.frame().average_luminance())?.floats()[0];
        let ev100 = document.job.automatic_ev100(f64::from(average) * 1e3);
        metadata.push(("ev100 used".into(), format!("{ev100:.3}")));
    }
    Ok(metadata)
}

/// The newest frame as a file has it: an HDR screen shows another picture.
fn display_of_file(stage: &mut Stage, document: &mut Document) -> Result<Pixels> {
    let peak = document.frame().settings().tone.peak;
    if peak.is_none() {
        return Ok(read_back(stage.idle()?, document.display())?);
    }
    stage.work(|rec| document.retone(rec, None))?;
    let pixels = read_back(stage.idle()?, document.display())?;
    stage.work(|rec| document.retone(rec, peak))?;
    Ok(pixels)
}

fn save_png(
    stage: &mut Stage,
    document: &mut Document,
    path: &Path,
    metadata: &Metadata,
) -> Result<()> {
    let pixels = display_of_file(stage, document)?;
    let gamma = document.job.settings.gamma;
    let encoding = gamma.map_or(Encoding::Srgb, Encoding::Gamma);
    write_png(
        path,
        pixels.size,
        &pixels.bytes,
        (encoding, Effort::Small),
        metadata,
    )
}

fn save_exr(
    stage: &mut Stage,
    document: &Document,
    path: &Path,
    metadata: &Metadata,
) -> Result<()> {
    let pixels = read_back(stage.idle()?, document.frame().radiance())?;
    let unit = document.job.file_unit(document.job.settings.show);
    let texels = pixels.rgba().into_iter().map(|t| t.map(|v| v * unit));
    let layer = Layer {
        name: "",
        channels: Channels::Rgb,
        texels: texels.collect(),
    };
    write_exr(path, pixels.size, &[layer], metadata)
}
