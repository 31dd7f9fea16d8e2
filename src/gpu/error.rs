//! What can go wrong on the device, each with the thing and the remedy.

use ash::vk;

/// Result of the room.
pub type Result<T> = std::result::Result<T, GpuError>;

/// A fault of the Vulkan driver, of the choice of a device, or of memory.
#[derive(Debug, thiserror::Error)]
pub enum GpuError {
    /// The Vulkan loader is not installed.
    #[error("no Vulkan loader ({0}); install it (Debian, Ubuntu: libvulkan1)")]
    NoLoader(String),
    /// The loader works but offers no device.
    #[error(
        "no Vulkan device; install a driver (Debian, Ubuntu: mesa-vulkan-drivers has the software device lavapipe)"
    )]
    NoDevice,
    /// `--device` matches nothing.
    #[error("no device matches \"{wanted}\"; there are: {present}")]
    NoSuchDevice {
        /// The text of the user.
        wanted: String,
        /// Names of the devices that exist.
        present: String,
    },
    /// The device lacks something the renderer needs.
    #[error("{missing} not supported by \"{device}\"; choose another with --device")]
    Unsupported {
        /// Features, extensions or formats, separated by commas.
        missing: String,
        /// Name of the device.
        device: String,
    },
    /// Validation was asked for but its layer is not installed.
    #[error(
        "the layer VK_LAYER_KHRONOS_validation is missing; install it (Debian, Ubuntu: vulkan-validationlayers)"
    )]
    NoValidationLayer,
    /// The validation layer complained: a fault of this program.
    #[error("{count} validation message(s), the first: {first}")]
    Validation {
        /// How many there were.
        count: usize,
        /// Text of the first.
        first: String,
    },
    /// A Vulkan call failed.
    #[error("{what}: {}", describe(*result))]
    Vulkan {
        /// What was being done.
        what: &'static str,
        /// The driver's answer.
        result: vk::Result,
    },
    /// Device memory could not be had.
    #[error("no memory for {what}: {reason}; try a smaller --size")]
    Memory {
        /// Name of the image or buffer.
        what: String,
        /// The allocator's words.
        reason: String,
    },
    /// A planned fault that names no call.
    #[error("\"{0}\" is no fault; write CALL@NUMBER=ANSWER, for instance submit@1=device-lost")]
    BadFault(String),
    /// Shaders that cannot be reloaded, a line each.
    #[error("{0}")]
    Shaders(String),
    /// The window's surface is of no use.
    #[error("the window cannot be drawn to: {0}")]
    Window(String),
    /// A size beyond what the device can do.
    #[error(
        "{what} of {asked} exceeds what \"{device}\" supports ({limit}); choose a smaller --size"
    )]
    TooLarge {
        /// Name of the image.
        what: String,
        /// The size wanted, pixels.
        asked: u32,
        /// The device's limit, pixels.
        limit: u32,
        /// Name of the device.
        device: String,
    },
}

impl GpuError {
    /// Whether the device is of no use any more.
    pub fn is_device_lost(&self) -> bool {
        let lost = vk::Result::ERROR_DEVICE_LOST;
        matches!(self, Self::Vulkan { result, .. } if *result == lost)
    }
}

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

/// Says what was being done when a Vulkan call failed.
pub(super) trait During<T> {
    fn during(self, what: &'static str) -> Result<T>;
}

impl<T> During<T> for std::result::Result<T, vk::Result> {
    fn during(self, what: &'static str) -> Result<T> {
        self.map_err(|result| GpuError::Vulkan { what, result })
    }
}
