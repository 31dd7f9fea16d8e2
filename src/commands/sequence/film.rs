//! Frames to a film, by ffmpeg.

use std::path::Path;
use std::process::{Command, Stdio};

use crate::error::{Error, Result};

/// Whether frames are to be made a film.
pub(super) fn is_film(output: &Path) -> bool {
    output
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("mp4"))
}

/// The program.
const FFMPEG: &str = "ffmpeg";

/// Fails, before the work begins, if there is no ffmpeg.
///
/// # Errors
/// See above.
pub(in crate::commands) fn check_ffmpeg(film: &Path) -> Result<()> {
    let run = Command::new(FFMPEG)
        .arg("-version")
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    if run.is_ok_and(|status| status.success()) {
        return Ok(());
    }
    let stem = film.file_stem().unwrap_or_default().to_string_lossy();
    Err(Error::Write {
        path: film.to_owned(),
        reason: format!(
            "films need ffmpeg, which is not installed (apt install ffmpeg); or write frames, -o {stem}_%04d.png"
        ),
    })
}

/// Makes a film of the frames `pattern` with numbers from 0. It is written beside the target and renamed when whole.
///
/// # Errors
/// What ffmpeg says.
pub(in crate::commands) fn write_film(pattern: &Path, per_second: u32, film: &Path) -> Result<()> {
    let failed = |reason: String| Error::Write {
        path: film.to_owned(),
        reason,
    };
    let mut builder = tempfile::Builder::new();
    let work = builder.prefix(".skylight-").tempdir_in(folder_of(film));
    let work = work.map_err(|e| failed(e.to_string()))?;
    let whole = std::path::absolute(work.path().join("film.mp4"));
    let whole = whole.map_err(|e| failed(e.to_string()))?;
    let output = Command::new(FFMPEG)
        .args([
            "-nostdin",
            "-loglevel",
            "error",
            "-framerate",
            &per_second.to_string(),
        ])
        .args(["-start_number", "0", "-i"])
        .arg(pattern.file_name().unwrap_or_default())
        // Players want colours at half resolution, and that an even size; the matrix is that of the pictures' primaries.
        .args([
            "-vf",
            "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709,format=yuv420p",
        ])
        .args([
            "-colorspace",
            "bt709",
            "-color_primaries",
            "bt709",
            "-color_trc",
            "iec61966-2-1",
        ])
        .args([
            "-c:v",
            "libx264",
            "-crf",
            "18",
            "-movflags",
            "+faststart",
            "-map_metadata",
            "-1",
        ])
        .arg(&whole)
        // A % in the name of a folder is not part of the pattern.
        .current_dir(folder_of(pattern))
        .stdin(Stdio::null())
        .output();
    let output = output.map_err(|e| failed(format!("{FFMPEG}: {e}")))?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        let line = said.lines().next_back().unwrap_or("it failed").to_owned();
        return Err(failed(format!("{FFMPEG}: {line}")));
    }
    std::fs::rename(&whole, film).map_err(|e| failed(e.to_string()))
}

/// The folder of a file.
pub(super) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}
