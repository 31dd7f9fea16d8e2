//! Device errors. Each message names the cause and the remedy.

use ash::vk;

/// Result with a [`GpuError`].
pub type Result<T> = std::result::Result<T, GpuError>;

/// An error of the Vulkan driver, device selection or memory allocation.
#[derive(Debug, thiserror::Error)]
pub enum GpuError {
    /// The Vulkan loader is not installed.
    #[error("no Vulkan loader ({0}); install {loader}", loader = LOADER)]
    NoLoader(String),
    /// The loader finds no device.
    #[error("no Vulkan device; install {driver}", driver = DRIVER)]
    NoDevice,
    /// No device matches `--device`.
    #[error("no device matches \"{wanted}\"; there are: {present}")]
    NoSuchDevice {
        /// The text given by the user.
        wanted: String,
        /// Names of the available devices.
        present: String,
    },
    /// The device lacks required features.
    #[error("{missing} not supported by \"{device}\"; choose another with --device")]
    Unsupported {
        /// Missing features, extensions or formats, comma-separated.
        missing: String,
        /// Name of the device.
        device: String,
    },
    /// No driver presents to the window: what they all lack for it.
    #[error(
        "no driver here can present to this window ({} missing); skylight render writes pictures without one", list_with_verb(.0)
    )]
    CannotPresent(Vec<String>),
    /// The validation layer is requested but not installed.
    #[error(
        "the layer VK_LAYER_KHRONOS_validation is missing; install {layers}", layers = LAYERS
    )]
    NoValidationLayer,
    /// The validation layer reported errors or warnings, each message once. This is a bug in the program.
    #[error("{} validation message(s): {}", .0.len(), .0.join("\n"))]
    Validation(Vec<String>),
    /// A Vulkan call failed.
    #[error("{what}: {}", describe(*result))]
    Vulkan {
        /// The operation that failed.
        what: &'static str,
        /// The result code.
        result: vk::Result,
    },
    /// The device does not finish its work.
    #[error(
        "\"{device}\" has not finished its work for {seconds} s: its driver hangs; start again, or choose another with --device"
    )]
    Hung {
        /// Name of the device.
        device: String,
        /// How long it was waited for.
        seconds: u64,
    },
    /// Device memory is exhausted.
    #[error("no memory for {what}: {reason}; try a smaller --size")]
    Memory {
        /// Name of the image or buffer.
        what: String,
        /// The allocator's message.
        reason: String,
    },
    /// The description of an injected fault is invalid.
    #[error(
        "\"{0}\" is not a fault; write CALL@OCCURRENCE=ERROR, for instance submit@1=device-lost"
    )]
    BadFault(String),
    /// Shaders failed to reload; one line each.
    #[error("{0}")]
    Shaders(String),
    /// The window surface is unusable.
    #[error("the window cannot be drawn to: {0}")]
    Window(String),
    /// An image size exceeds the device limit.
    #[error(
        "{what} of {asked} exceeds what \"{device}\" supports ({limit}); choose a smaller --size"
    )]
    TooLarge {
        /// Name of the image.
        what: String,
        /// The requested size, pixels.
        asked: u32,
        /// The device's limit, pixels.
        limit: u32,
        /// Name of the device.
        device: String,
    },
}

impl GpuError {
    /// For tests: a lost device.
    #[cfg(test)]
    pub(crate) fn lost() -> Self {
        Self::Vulkan {
            what: "submit",
            result: vk::Result::ERROR_DEVICE_LOST,
        }
    }

    /// Whether the device was lost, or hangs.
    pub fn is_device_lost(&self) -> bool {
        let lost = vk::Result::ERROR_DEVICE_LOST;
        matches!(self, Self::Hung { .. })
            || matches!(self, Self::Vulkan { result, .. } if *result == lost)
    }
}

/// What to install on a system: a driver, the loader, the validation layer.
const fn remedies(system: &str) -> [&str; 3] {
    match system.as_bytes() {
        b"macos" => [
            "MoltenVK and the Vulkan loader (brew install molten-vk vulkan-loader, or the SDK of vulkan.lunarg.com)",
            "it (brew install vulkan-loader, or the SDK of vulkan.lunarg.com)",
            "it (brew install vulkan-validationlayers, or the SDK of vulkan.lunarg.com)",
        ],
        b"windows" => [
            "the newest driver of the graphics card, from its maker",
            "the newest driver of the graphics card, from its maker: it brings vulkan-1.dll",
            "the SDK of vulkan.lunarg.com",
        ],
        _ => [
            "a driver (Debian, Ubuntu: mesa-vulkan-drivers has the software device lavapipe)",
            "it (Debian, Ubuntu: libvulkan1)",
            "it (Debian, Ubuntu: vulkan-validationlayers)",
        ],
    }
}

const DRIVER: &str = remedies(std::env::consts::OS)[0];
const LOADER: &str = remedies(std::env::consts::OS)[1];
const LAYERS: &str = remedies(std::env::consts::OS)[2];

fn describe(result: vk::Result) -> String {
    match result {
        vk::Result::ERROR_OUT_OF_DEVICE_MEMORY => "out of device memory; try a smaller --size, or close what else uses the device".into(),
        vk::Result::ERROR_OUT_OF_HOST_MEMORY => "out of host memory; close other programs, or try a smaller --size".into(),
        vk::Result::ERROR_DEVICE_LOST => {
            "the device was lost (driver fault or reset); start again, or choose another with --device".into()
        },
        other => format!("{other:?}"),
    }
}

/// Names in a sentence: `A is`, `A, B are`.
pub(super) fn list_with_verb(names: &[String]) -> String {
    let verb = if names.len() == 1 { "is" } else { "are" };
    format!("{} {verb}", names.join(", "))
}

/// Attaches the name of the operation to a failed Vulkan call.
pub(super) trait During<T> {
    fn during(self, what: &'static str) -> Result<T>;
}

impl<T> During<T> for std::result::Result<T, vk::Result> {
    fn during(self, what: &'static str) -> Result<T> {
        self.map_err(|result| GpuError::Vulkan { what, result })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_system_has_its_own_remedies() {
        let [linux, mac, windows] = ["linux", "macos", "windows"].map(remedies);
        assert!(linux.iter().all(|text| text.contains("Debian")));
        assert!(mac.iter().all(|text| text.contains("brew")) && mac[0].contains("MoltenVK"));
        assert!(windows[0].contains("graphics card") && windows[2].contains("SDK"));
        let told = GpuError::NoDevice.to_string();
        assert!(told.ends_with(remedies(std::env::consts::OS)[0]), "{told}");
    }

    #[test]
    fn a_device_that_hangs_counts_as_lost() {
        let hung = GpuError::Hung {
            device: "GPU".to_owned(),
            seconds: 60,
        };
        assert!(hung.is_device_lost());
        assert!(
            hung.to_string()
                .contains("\"GPU\" has not finished its work for 60 s")
        );
    }
}
