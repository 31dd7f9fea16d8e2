//! The driver's pipeline cache, stored in a file between runs.
//!
//! The file is untrusted: data from another device or driver, or with a wrong hash, is discarded. Drivers are known to crash on
//! corrupt data.

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use ash::vk;

use crate::gpu::error::{During, Result};

/// Magic number of the file; the digits are the format version.
const MAGIC: &[u8; 8] = b"SKYLPC02";
/// Magic, vendor, device, driver, UUID, length, hash.
const HEADER: usize = 8 + 4 + 4 + 4 + vk::UUID_SIZE + 8 + blake3::OUT_LEN;
/// Size of the header that Vulkan puts before the data (`VK_PIPELINE_CACHE_HEADER_VERSION_ONE`), bytes.
const VULKAN_HEADER: usize = 16 + vk::UUID_SIZE;
/// Larger files are ignored.
const MAX_BYTES: u64 = 256 << 20;

/// The device and driver that a cache belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::gpu) struct Key {
    vendor: u32,
    device: u32,
    driver: u32,
    uuid: [u8; vk::UUID_SIZE],
}

impl Key {
    pub(in crate::gpu) fn new(properties: &vk::PhysicalDeviceProperties) -> Self {
        Self {
            vendor: properties.vendor_id,
            device: properties.device_id,
            driver: properties.driver_version,
            uuid: properties.pipeline_cache_uuid,
        }
    }

    #[cfg(test)]
    pub(in crate::gpu) fn of_numbers(vendor: u32, device: u32, driver: u32) -> Self {
        Self {
            vendor,
            device,
            driver,
            uuid: [5; vk::UUID_SIZE],
        }
    }

    fn bytes(&self) -> Vec<u8> {
        let numbers = [self.vendor, self.device, self.driver];
        let numbers = numbers.iter().flat_map(|n| n.to_le_bytes());
        numbers.chain(self.uuid).collect()
    }

    /// In letters and digits.
    pub(in crate::gpu) fn text(&self) -> String {
        self.bytes().iter().map(|b| format!("{b:02x}")).collect()
    }

    /// Name of the file of [`crate::gpu::RouteTimes`].
    pub(in crate::gpu) fn route_file(&self) -> String {
        format!("route-{:08x}-{:08x}.txt", self.vendor, self.device)
    }

    fn file(&self) -> String {
        format!("pipelines-{:08x}-{:08x}.bin", self.vendor, self.device)
    }

    /// Whether the Vulkan header of the data names the same device and driver.
    fn fits(&self, data: &[u8]) -> bool {
        let Some(header) = data.get(..VULKAN_HEADER) else {
            return false;
        };
        let version = vk::PipelineCacheHeaderVersion::ONE.as_raw().cast_unsigned();
        let numbers = [VULKAN_HEADER as u32, version, self.vendor, self.device];
        let expected = numbers.iter().flat_map(|n| n.to_ne_bytes());
        expected.chain(self.uuid).eq(header.iter().copied())
    }
}

/// Encodes the cache data as a file.
fn encode(key: &Key, data: &[u8]) -> Vec<u8> {
    let mut file = MAGIC.to_vec();
    file.extend(key.bytes());
    file.extend((data.len() as u64).to_le_bytes());
    let hash = hash(&file, data);
    file.extend(hash.as_bytes());
    file.extend(data);
    file
}

/// The cache data in a file, if it is intact and was written for this device and driver.
fn decode<'f>(key: &Key, file: &'f [u8]) -> Option<&'f [u8]> {
    let (header, data) = file.split_at_checked(HEADER)?;
    let (described, stored) = header.split_at(HEADER - blake3::OUT_LEN);
    let mut expected = MAGIC.to_vec();
    expected.extend(key.bytes());
    expected.extend((data.len() as u64).to_le_bytes());
    let intact = described == expected && stored == hash(described, data).as_bytes();
    (intact && key.fits(data)).then_some(data)
}

fn hash(header: &[u8], data: &[u8]) -> blake3::Hash {
    let mut hasher = blake3::Hasher::new();
    hasher.update(header).update(data);
    hasher.finalize()
}

fn read(path: &Path) -> Option<Vec<u8>> {
    let about = fs::metadata(path).ok()?;
    (about.is_file() && about.len() <= MAX_BYTES).then(|| fs::read(path).ok())?
}

/// Writes a temporary file next to the target and renames it, so a crash leaves the old file intact.
pub(in crate::gpu) fn write(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    let folder = path.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(folder)?;
    let mut file = tempfile::Builder::new()
        .prefix(".pipelines-")
        .tempfile_in(folder)?;
    file.write_all(bytes)?;
    file.persist(path)?;
    Ok(())
}

/// Outcome of loading the cache file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CacheState {
    /// No folder was given.
    Off,
    /// The file did not exist.
    New,
    /// The file was loaded; holds the size of the driver's data, bytes.
    Read(usize),
    /// The file was corrupt or from another device or driver, and will be replaced.
    Refused,
}

/// The pipeline cache of a device.
pub(in crate::gpu) struct PipelineCache {
    pub(in crate::gpu) raw: vk::PipelineCache,
    pub(in crate::gpu) state: CacheState,
    key: Key,
    path: Option<PathBuf>,
    loaded: Vec<u8>,
}

impl PipelineCache {
    /// Creates the cache from the file in `folder`, if it exists.
    pub(in crate::gpu) fn new(
        device: &ash::Device,
        key: Key,
        folder: Option<&Path>,
    ) -> Result<Self> {
        let path = folder.map(|folder| folder.join(key.file()));
        let file = path.as_deref().and_then(read);
        let data = file.as_deref().and_then(|file| decode(&key, file));
        let state = match (&path, &file, data) {
            (None, ..) => CacheState::Off,
            (_, None, _) => CacheState::New,
            (.., Some(data)) => CacheState::Read(data.len()),
            (_, Some(_), None) => CacheState::Refused,
        };
        let loaded = data.unwrap_or_default().to_vec();
        let info = vk::PipelineCacheCreateInfo::default().initial_data(&loaded);
        // SAFETY: the data are undamaged and from this driver and device, or empty.
        let raw = unsafe { device.create_pipeline_cache(&info, None) }
            .during("create a pipeline cache")?;
        Ok(Self {
            raw,
            state,
            key,
            path,
            loaded,
        })
    }

    /// Writes the file if the cache has new data, and destroys the cache.
    ///
    /// # Safety
    /// The device must be alive, and no thread may be creating pipelines.
    pub(in crate::gpu) unsafe fn save_and_destroy(&self, device: &ash::Device) {
        if let Some(path) = &self.path {
            // SAFETY: guaranteed by the caller.
            let data = unsafe { device.get_pipeline_cache_data(self.raw) };
            // A missing file only makes the next start slower, so errors are ignored.
            if let Ok(data) = data
                && data != self.loaded
            {
                let _ = write(path, &encode(&self.key, &data));
            }
        }
        // SAFETY: guaranteed by the caller.
        unsafe { device.destroy_pipeline_cache(self.raw, None) };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key() -> Key {
        Key {
            vendor: 0x10005,
            device: 7,
            driver: 3,
            uuid: std::array::from_fn(|i| i as u8),
        }
    }

    /// Cache data in the layout a driver returns.
    fn data(key: &Key) -> Vec<u8> {
        let numbers = [VULKAN_HEADER as u32, 1, key.vendor, key.device];
        let header = numbers.iter().flat_map(|n| n.to_ne_bytes());
        header.chain(key.uuid).chain(*b"the driver's own").collect()
    }

    #[test]
    fn what_was_written_is_read() {
        let data = data(&key());
        assert_eq!(decode(&key(), &encode(&key(), &data)), Some(&data[..]));
    }

    #[test]
    fn no_bit_may_be_wrong_and_no_byte_missing() {
        let file = encode(&key(), &data(&key()));
        for bit in 0..8 * file.len() {
            let mut damaged = file.clone();
            damaged[bit / 8] ^= 1 << (bit % 8);
            assert_eq!(decode(&key(), &damaged), None, "bit {bit}");
        }
        for length in 0..file.len() {
            assert_eq!(decode(&key(), &file[..length]), None, "{length} bytes");
        }
        let longer = [&file[..], &[0]].concat();
        assert_eq!(decode(&key(), &longer), None);
    }

    #[test]
    fn other_devices_and_drivers_are_refused() {
        let file = encode(&key(), &data(&key()));
        let others = [
            Key { vendor: 1, ..key() },
            Key { device: 8, ..key() },
            Key { driver: 4, ..key() },
            Key {
                uuid: [9; vk::UUID_SIZE],
                ..key()
            },
        ];
        for other in others {
            assert_eq!(decode(&other, &file), None, "{other:?}");
            // A file whose header names this device but whose data is from another.
            assert!(other.driver != 3 || decode(&key(), &encode(&key(), &data(&other))).is_none());
        }
    }
}
