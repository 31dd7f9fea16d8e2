//! Files of shards: written whole, read with their checks.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize, de::DeserializeOwned};

use crate::error::{Error, Result};
use crate::output::write_text;
use crate::sensors::Shard;

/// Form of the files.
const FORM: u32 = 1;
/// Largest file of a shard, bytes.
const MAX_BYTES: u64 = 1 << 32;

/// What a job does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(in crate::commands) enum Kind {
    /// Frames of a sequence.
    Sequence,
    /// Sensors at a moment.
    Moment,
    /// Sensors over a year.
    Year,
    /// Variants of one of these.
    Study,
}

/// Which job a shard is part of.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::commands) struct JobKey {
    kind: Kind,
    /// Hash of everything that decides the result.
    run: String,
}

impl JobKey {
    /// Of a job that is decided by these texts and by this version of the program.
    pub fn new(kind: Kind, decided_by: &[String]) -> Self {
        let mut hasher = blake3::Hasher::new();
        for text in decided_by
            .iter()
            .map(String::as_str)
            .chain([env!("CARGO_PKG_VERSION")])
        {
            hasher.update(&(text.len() as u64).to_le_bytes());
            hasher.update(text.as_bytes());
        }
        let run = hasher.finalize().to_hex().to_string();
        Self { kind, run }
    }
}

#[derive(Serialize, Deserialize)]
struct File {
    skylight_shard: u32,
    #[serde(flatten)]
    key: JobKey,
    shard: u32,
    of: u32,
    /// Hash of all else.
    check: String,
    /// The result, as text, so that its hash is that of its bytes.
    body: String,
}

impl File {
    fn check(&self) -> String {
        let head = (FORM, &self.key, self.shard, self.of);
        let text = format!("{head:?}{}", self.body);
        blake3::hash(text.as_bytes()).to_hex().to_string()
    }

    fn is_whole(&self) -> bool {
        self.skylight_shard == FORM
            && (1..=self.of).contains(&self.shard)
            && self.check == self.check()
    }
}

/// Writes what a shard has found.
///
/// # Errors
/// The file cannot be written; an existing file stays unchanged.
pub(in crate::commands) fn write_part(
    path: &Path,
    key: &JobKey,
    shard: Shard,
    body: &impl Serialize,
) -> Result<()> {
    let failed = |error: serde_json::Error| Error::Write {
        path: path.to_owned(),
        reason: error.to_string(),
    };
    let mut file = File {
        skylight_shard: FORM,
        key: key.clone(),
        shard: shard.number,
        of: shard.of,
        check: String::new(),
        body: serde_json::to_string(body).map_err(failed)?,
    };
    file.check = file.check();
    write_text(
        path,
        &(serde_json::to_string(&file).map_err(failed)? + "\n"),
    )
}

/// A file that lies beside that of a shard, and the hash of its bytes.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(in crate::commands) struct FileBeside {
    /// Its name without folder.
    name: String,
    check: String,
}

impl FileBeside {
    /// Of a file that is written.
    ///
    /// # Errors
    /// It cannot be read again.
    pub fn new(file: &Path) -> Result<Self> {
        let check = check(file).map_err(|error| Error::Read {
            path: file.to_owned(),
            reason: error.to_string(),
        })?;
        let name = file.file_name().unwrap_or_default();
        Ok(Self {
            name: name.to_string_lossy().into_owned(),
            check,
        })
    }

    /// The file beside that of its shard, and what is wrong with it, if something is.
    pub fn found(&self, shard: &Path) -> (PathBuf, Option<String>) {
        let folder = shard.parent().unwrap_or_else(|| Path::new(""));
        let file = folder.join(&self.name);
        let fault = match check(&file) {
            Ok(check) if check == self.check => None,
            Ok(_) => Some(format!("{} is damaged", file.display())),
            Err(_) => Some(format!("{} is missing", file.display())),
        };
        (file, fault)
    }
}

fn check(file: &Path) -> std::io::Result<String> {
    let mut hasher = blake3::Hasher::new();
    hasher.update_reader(std::fs::File::open(file)?)?;
    Ok(hasher.finalize().to_hex().to_string())
}

/// The shards of one job, all of them, in their order.
#[derive(Debug)]
pub(in crate::commands) struct Parts {
    /// What the job does.
    pub kind: Kind,
    list: Vec<(PathBuf, String)>,
}

impl Parts {
    /// Their results, with the file of each.
    ///
    /// # Errors
    /// A result of another form.
    pub fn bodies<T: DeserializeOwned>(&self) -> Result<Vec<(PathBuf, T)>> {
        let body = |(path, text): &(PathBuf, String)| {
            let read = serde_json::from_str(text).map_err(|error| Error::Read {
                path: path.clone(),
                reason: error.to_string(),
            });
            Ok((path.clone(), read?))
        };
        self.list.iter().map(body).collect()
    }
}

/// Reads the files of all shards of a job.
///
/// # Errors
/// One line with every shard that is missing, doubled, damaged or of another job, and which to run again.
pub(super) fn gather(paths: &[PathBuf]) -> Result<Parts> {
    let mut faults = Vec::new();
    let mut whole: Vec<(&PathBuf, File)> = Vec::new();
    for path in paths {
        match read(path)? {
            Some(file) => whole.push((path, file)),
            None => faults.push(format!("{} is damaged", path.display())),
        }
    }
    let Some((first, of_first)) = whole.first() else {
        faults.push("run all shards again".to_owned());
        return Err(Error::Merge(faults.join("; ")));
    };
    let (key, of) = (of_first.key.clone(), of_first.of);
    let mut list: Vec<Option<(PathBuf, String)>> = vec![None; of as usize];
    for (path, file) in &whole {
        let place = &mut list[..];
        if file.key != key || file.of != of {
            let (path, first) = (path.display(), first.display());
            faults.push(format!("{path} is of another job than {first}"));
            continue;
        }
        match &mut place[file.shard as usize - 1] {
            Some((other, _)) => faults.push(format!(
                "shard {}/{of} is there twice, {} and {}: leave one out",
                file.shard,
                other.display(),
                path.display()
            )),
            none => *none = Some(((*path).clone(), file.body.clone())),
        }
    }
    let missing = (1..=of).zip(&list).filter(|(_, part)| part.is_none());
    let missing: Vec<String> = missing
        .map(|(number, _)| format!("{number}/{of}"))
        .collect();
    if !missing.is_empty() {
        faults.push(run_again(&missing));
    }
    if faults.is_empty() {
        return Ok(Parts {
            kind: key.kind,
            list: list.into_iter().flatten().collect(),
        });
    }
    Err(Error::Merge(faults.join("; ")))
}

fn run_again(shards: &[String]) -> String {
    let verb = if shards.len() == 1 { "is" } else { "are" };
    format!(
        "{} {verb} missing: run again with --shard {}",
        if shards.len() == 1 {
            "a shard"
        } else {
            "shards"
        },
        shards.join(", ")
    )
}

/// A file of a shard; `None` if it is damaged.
///
/// # Errors
/// A file that cannot be read at all.
fn read(path: &Path) -> Result<Option<File>> {
    let failed = |reason: String| Error::Read {
        path: path.to_owned(),
        reason,
    };
    let meta = std::fs::metadata(path).map_err(|e| failed(e.to_string()))?;
    if !meta.is_file() || meta.len() > MAX_BYTES {
        return Err(failed("it is no file of a shard".to_owned()));
    }
    let bytes = std::fs::read(path).map_err(|e| failed(e.to_string()))?;
    let file: Option<File> = serde_json::from_slice(&bytes).ok();
    Ok(file.filter(File::is_whole))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(folder: &Path, name: &str, shard: &str, run: &str) -> PathBuf {
        let path = folder.join(name);
        let key = JobKey::new(Kind::Moment, &[run.to_owned()]);
        let shard = shard.parse().expect("a shard");
        write_part(&path, &key, shard, &[1.5, 2.5]).expect("written");
        path
    }

    #[test]
    fn all_shards_of_a_job_are_gathered_in_their_order() {
        let dir = tempfile::tempdir().expect("a folder");
        let list = ["b 2/3", "a 1/3", "c 3/3"].map(|text| {
            let (name, shard) = text.split_once(' ').expect("two words");
            written(dir.path(), name, shard, "x")
        });
        let parts = gather(&list).expect("all");
        assert_eq!(parts.kind, Kind::Moment);
        let bodies = parts.bodies::<Vec<f64>>().expect("numbers");
        let names: Vec<_> = bodies.iter().map(|(path, _)| path.file_name()).collect();
        assert_eq!(
            names,
            ["a", "b", "c"].map(|n| Some(std::ffi::OsStr::new(n)))
        );
        assert_eq!(bodies[2].1, [1.5, 2.5]);
    }

    #[test]
    fn what_is_missing_doubled_damaged_or_foreign_is_named() {
        let dir = tempfile::tempdir().expect("a folder");
        let at = |name: &str, shard: &str, run: &str| written(dir.path(), name, shard, run);
        let (a, b, c) = (
            at("a", "1/4", "x"),
            at("b", "2/4", "x"),
            at("c", "3/4", "x"),
        );
        let again = at("again", "2/4", "x");
        let other = at("other", "4/4", "y");
        let fails = |list: &[&PathBuf]| {
            let list: Vec<PathBuf> = list.iter().map(|path| (*path).clone()).collect();
            let text = gather(&list).expect_err("a fault").to_string();
            assert_eq!(text.lines().count(), 1, "{text}");
            text
        };
        let text = fails(&[&a, &c]);
        assert!(text.contains("run again with --shard 2/4, 4/4"), "{text}");
        let text = fails(&[&a, &b, &c, &again]);
        assert!(text.contains("shard 2/4 is there twice"), "{text}");
        let text = fails(&[&a, &b, &c, &other]);
        assert!(text.contains("other is of another job than"), "{text}");
        // Cut, and one digit changed: both are damaged.
        let whole = std::fs::read_to_string(&b).expect("a file");
        for damaged in [
            whole[..whole.len() / 2].to_owned(),
            whole.replace("2.5", "2.6"),
            whole.replace("\"shard\":2", "\"shard\":4"),
            String::new(),
        ] {
            std::fs::write(&b, damaged).expect("written");
            let text = fails(&[&a, &b, &c]);
            assert!(text.contains("b is damaged"), "{text}");
            assert!(text.contains("--shard 2/4, 4/4"), "{text}");
        }
    }
}
