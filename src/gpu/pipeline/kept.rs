//! Pipelines that were made before, kept for passes that are made again.
//!
//! Passes are made anew where an option, a size or a scene changes, and most of their pipelines are the same as before. Drivers keep compiled
//! code of their own, but some make it only at the first draw of a pipeline, within a frame: so the pipelines themselves are kept.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use ash::vk;

use crate::gpu::error::Result;
use crate::gpu::pipeline::{Blend, Depth, Made, PipelineDesc};

/// Most pipelines that are kept though nothing uses them: several times those of a frame.
const UNUSED: usize = 128;

/// A description.
#[derive(Debug, Clone, PartialEq)]
struct Key {
    name: String,
    /// Names of the stages, which are unique.
    stages: Vec<&'static str>,
    vertex: Vec<vk::Format>,
    colors: Vec<vk::Format>,
    depth: Depth,
    blend: Blend,
    constants: Vec<(String, u32)>,
}

impl Key {
    fn new(desc: &PipelineDesc<'_>) -> Self {
        let constants = desc.constants.iter();
        Self {
            name: desc.name.to_owned(),
            stages: desc.stages.iter().map(|stage| stage.name).collect(),
            vertex: desc.vertex.to_vec(),
            colors: desc.colors.to_vec(),
            depth: desc.depth,
            blend: desc.blend,
            constants: constants
                .map(|(n, bits)| ((*n).to_owned(), *bits))
                .collect(),
        }
    }
}

/// A pipeline of a description; without one where shaders were compiled again since.
struct Entry {
    key: Option<Key>,
    made: Arc<Made>,
}

impl Entry {
    fn is_used(&self) -> bool {
        Arc::strong_count(&self.made) > 1
    }
}

/// The pipelines of a device, those asked for last at the end.
#[derive(Default)]
pub(in crate::gpu) struct Kept(Mutex<Vec<Entry>>);

impl Kept {
    fn entries(&self) -> MutexGuard<'_, Vec<Entry>> {
        // Entries are added and removed whole, so the list stays valid after a panic.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The pipeline of a description, or a new one by `make`. Destroys the oldest ones beyond [`UNUSED`].
    ///
    /// # Errors
    /// Those of `make`.
    pub(in crate::gpu::pipeline) fn find_or(
        &self,
        device: Option<&ash::Device>,
        desc: &PipelineDesc<'_>,
        make: impl FnOnce() -> Result<Made>,
    ) -> Result<Arc<Made>> {
        let key = Some(Key::new(desc));
        let mut entries = self.entries();
        let entry = match entries.iter().position(|entry| entry.key == key) {
            Some(at) => entries.remove(at),
            None => {
                // Several threads make pipelines at once; two of one description do no harm.
                drop(entries);
                let made = Arc::new(make()?);
                entries = self.entries();
                Entry { key, made }
            }
        };
        let made = Arc::clone(&entry.made);
        entries.push(entry);
        if let Some(device) = device {
            destroy(device, &mut entries, UNUSED);
        }
        Ok(made)
    }

    /// Forgets what was made of the shaders so far: they were compiled again.
    #[cfg(feature = "hot-reload")]
    pub(in crate::gpu::pipeline) fn forget(&self) {
        for entry in self.entries().iter_mut() {
            entry.key = None;
        }
    }

    /// Destroys all pipelines. None may be used any more.
    pub(in crate::gpu) fn destroy(&self, device: &ash::Device) {
        destroy(device, &mut self.entries(), 0);
    }
}

/// Destroys the oldest unused pipelines but for so many.
fn destroy(device: &ash::Device, entries: &mut Vec<Entry>, most: usize) {
    let unused = entries.iter().filter(|entry| !entry.is_used()).count();
    let mut excess = unused.saturating_sub(most);
    entries.retain(|entry| {
        let is_kept = excess == 0 || entry.is_used();
        if !is_kept {
            excess -= 1;
            entry.made.destroy(device);
        }
        is_kept
    });
}
