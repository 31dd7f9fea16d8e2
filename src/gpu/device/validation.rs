//! The validation layer: enabling synchronization validation, and collecting the reported messages.

use std::ffi::{CStr, c_void};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use ash::{ext, vk};

use crate::gpu::device::instance::has_instance_extension;
use crate::gpu::error::{During, GpuError, Result};

/// Name of the validation layer.
pub(in crate::gpu) const LAYER: &CStr = c"VK_LAYER_KHRONOS_validation";

/// The extension through which a layer enables synchronization validation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::gpu) enum SyncRequest {
    /// `VK_EXT_layer_settings`, supported by layers since 2024.
    LayerSettings,
    /// `VK_EXT_validation_features`, its predecessor.
    ValidationFeatures,
}

impl SyncRequest {
    /// The extension supported by the installed layer, if any.
    ///
    /// # Errors
    /// When the layer is not installed.
    pub(in crate::gpu) fn of_layer(entry: &ash::Entry) -> Result<Option<Self>> {
        // SAFETY: the call takes no pointers.
        let layers =
            unsafe { entry.enumerate_instance_layer_properties() }.during("list Vulkan layers")?;
        let is_layer = |l: &vk::LayerProperties| l.layer_name_as_c_str() == Ok(LAYER);
        if !layers.iter().any(is_layer) {
            return Err(GpuError::NoValidationLayer);
        }
        for request in [Self::LayerSettings, Self::ValidationFeatures] {
            if has_instance_extension(entry, Some(LAYER), request.extension())? {
                return Ok(Some(request));
            }
        }
        Ok(None)
    }

    pub(in crate::gpu) fn extension(self) -> &'static CStr {
        match self {
            Self::LayerSettings => ext::layer_settings::NAME,
            Self::ValidationFeatures => ext::validation_features::NAME,
        }
    }
}

/// The layer setting `validate_sync` with the value `on`.
pub(in crate::gpu) fn sync_setting(on: &vk::Bool32) -> vk::LayerSettingEXT<'_> {
    let mut setting = vk::LayerSettingEXT::default()
        .layer_name(LAYER)
        .setting_name(c"validate_sync")
        .ty(vk::LayerSettingTypeEXT::BOOL32);
    // The setter counts bytes; the specification counts values.
    setting.value_count = 1;
    setting.p_values = std::ptr::from_ref(on).cast();
    setting
}

/// A message from the layer.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Message {
    text: String,
    count: usize,
}

/// Messages so far. Messages that differ only in handles are merged and counted.
#[derive(Default)]
pub(in crate::gpu) struct Log {
    messages: Mutex<Vec<Message>>,
    /// Whether the program has read all of them.
    is_read: AtomicBool,
}

impl Log {
    /// Each message once, starting with its identifier, with its count if it was reported more than once.
    pub(in crate::gpu) fn read(&self) -> Vec<String> {
        self.is_read.store(true, Ordering::Relaxed);
        let line = |m: &Message| match m.count {
            1 => m.text.clone(),
            count => format!("{} ({count} times)", m.text),
        };
        self.lock().iter().map(line).collect()
    }

    fn lock(&self) -> MutexGuard<'_, Vec<Message>> {
        // Messages are pushed whole, so the list stays valid after a panic.
        self.messages.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn push(&self, identifier: &str, text: &str) {
        self.is_read.store(false, Ordering::Relaxed);
        let text = one_line(identifier, text);
        let mut messages = self.lock();
        let key = without_handles(&text);
        match messages
            .iter_mut()
            .find(|m| without_handles(&m.text) == key)
        {
            Some(message) => message.count += 1,
            None => messages.push(Message { text, count: 1 }),
        }
    }
}

/// A message on one line, starting with its identifier: older layers put it before the text, newer ones report it separately.
fn one_line(identifier: &str, text: &str) -> String {
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    if text.contains(&format!("[ {identifier} ]")) {
        text
    } else {
        format!("{identifier}: {text}")
    }
}

/// The text with hexadecimal numbers removed.
fn without_handles(text: &str) -> String {
    let mut parts = text.split("0x");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |text, part| {
        text + "0x" + part.trim_start_matches(|c: char| c.is_ascii_hexdigit())
    })
}

/// The debug callback, registered for as long as this value lives.
///
/// Only errors and warnings of type *validation* count: they report undefined or ineffective use of the API. Performance and
/// information messages are not requested, because they depend on layer and driver and say nothing about correctness. Messages
/// of type *general* come from the loader and the drivers, not from this program.
pub(in crate::gpu) struct Messenger {
    loader: ext::debug_utils::Instance,
    handle: vk::DebugUtilsMessengerEXT,
    log: Box<Log>,
}

impl Messenger {
    pub(in crate::gpu) fn new(entry: &ash::Entry, instance: &ash::Instance) -> Result<Self> {
        let loader = ext::debug_utils::Instance::new(entry, instance);
        let log = Box::new(Log::default());
        let info = vk::DebugUtilsMessengerCreateInfoEXT::default()
            .message_severity(
                vk::DebugUtilsMessageSeverityFlagsEXT::ERROR
                    | vk::DebugUtilsMessageSeverityFlagsEXT::WARNING,
            )
            .message_type(vk::DebugUtilsMessageTypeFlagsEXT::VALIDATION)
            .pfn_user_callback(Some(on_message))
            .user_data((&raw const *log).cast_mut().cast());
        // SAFETY: `log` is boxed, so the pointer outlives the messenger, which `Drop` destroys first.
        let handle = unsafe { loader.create_debug_utils_messenger(&info, None) }
            .during("create the validation messenger")?;
        Ok(Self {
            loader,
            handle,
            log,
        })
    }

    pub(in crate::gpu) fn log(&self) -> &Log {
        &self.log
    }
}

impl Drop for Messenger {
    fn drop(&mut self) {
        // SAFETY: created by this loader, destroyed once.
        unsafe { self.loader.destroy_debug_utils_messenger(self.handle, None) };
        // Messages are still unread if another error ended the program first, or if destroying the device caused them.
        if !self.log.is_read.load(Ordering::Relaxed) {
            for message in self.log.read() {
                eprintln!("validation: {message}");
            }
        }
    }
}

/// A string passed by the layer; empty if null.
///
/// # Safety
/// The pointer must be null or point to a NUL-terminated string that outlives `'a`.
unsafe fn text<'a>(pointer: *const std::ffi::c_char) -> std::borrow::Cow<'a, str> {
    if pointer.is_null() {
        return "".into();
    }
    // SAFETY: guaranteed by the caller.
    unsafe { CStr::from_ptr(pointer) }.to_string_lossy()
}

unsafe extern "system" fn on_message(
    _severity: vk::DebugUtilsMessageSeverityFlagsEXT,
    _types: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    user: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: the layer passes valid pointers; `user` is the boxed log of the messenger.
    unsafe {
        let log = &*user.cast::<Log>();
        log.push(&text((*data).p_message_id_name), &text((*data).p_message));
    }
    vk::FALSE
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::device::context::{Context, ContextOptions};
    use crate::gpu::memory::buffer::{Buffer, BufferKind};
    use crate::gpu::record::recorder::Recorder;
    use crate::gpu::record::timings::Timing;

    #[test]
    fn synchronization_hazards_are_reported() {
        let options = ContextOptions {
            device: std::env::var("SKYLIGHT_TEST_DEVICE").ok(),
            validate: true,
            ..ContextOptions::default()
        };
        let context = Context::new(&options).expect("a device with the validation layer");
        let mut recorder = Recorder::new(&context, Timing::Off).expect("a recorder");
        let buffer = |kind| Buffer::new(&context, "buffer", kind, 64).expect("a buffer");
        let (source, target) = (buffer(BufferKind::Staging), buffer(BufferKind::ReadBack));
        recorder.begin().expect("begun");
        let region = [vk::BufferCopy::default().size(64)];
        for _ in 0..2 {
            // SAFETY: both buffers hold the region and live until `finish`. The copies are deliberately unordered (a hazard
            // that the layer must report); they write the same bytes.
            unsafe {
                let raw = context.raw();
                raw.cmd_copy_buffer(recorder.command, source.raw(), target.raw(), &region);
            }
        }
        recorder.finish().expect("finished");
        let messages = context.validation_messages();
        let hazard = "SYNC-HAZARD-WRITE-AFTER-WRITE";
        assert!(messages.iter().any(|m| m.contains(hazard)), "{messages:?}");
    }

    #[test]
    fn a_message_is_kept_once_and_its_reports_counted() {
        let log = Log::default();
        for handle in ["0x1f", "0xabc0", "0x7"] {
            log.push("VUID-a-1", &format!("image {handle} has\nno layout"));
        }
        log.push("VUID-b-2", "[ VUID-b-2 ] image 0x1f is lost");
        assert_eq!(
            log.read(),
            [
                "VUID-a-1: image 0x1f has no layout (3 times)",
                "[ VUID-b-2 ] image 0x1f is lost"
            ]
        );
    }

    #[test]
    fn names_of_objects_distinguish_messages() {
        let log = Log::default();
        log.push("VUID-a-1", "image 0x1f[shadow map]");
        log.push("VUID-a-1", "image 0x1f[depth]");
        log.push("VUID-a-1", "image 0x2e[depth]");
        assert_eq!(log.read().len(), 2);
    }
}
