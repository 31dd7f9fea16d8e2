//! The validation canary: messages of the layer are kept, so that a test or `--validate` can fail on them.

use std::ffi::{CStr, c_void};
use std::sync::Mutex;

use ash::{ext, vk};

use crate::gpu::error::{During, Result};

/// Name of the layer.
pub(in crate::gpu) const LAYER: &CStr = c"VK_LAYER_KHRONOS_validation";

/// Messages since the start.
#[derive(Default)]
pub(in crate::gpu) struct Log(Mutex<Vec<String>>);

impl Log {
    pub(in crate::gpu) fn messages(&self) -> Vec<String> {
        // A panic while pushing a string leaves a whole vector behind: poison says nothing here.
        self.0
            .lock()
            .unwrap_or_else(std::sync::PoisonError::into_inner)
            .clone()
    }

    fn push(&self, message: String) {
        self.0
            .lock()
            .unwrap_or_else(std::sync::PoisonError::into_inner)
            .push(message);
    }
}

/// The callback, registered as long as this lives.
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
            .message_type(
                vk::DebugUtilsMessageTypeFlagsEXT::VALIDATION
                    | vk::DebugUtilsMessageTypeFlagsEXT::PERFORMANCE,
            )
            .pfn_user_callback(Some(on_message))
            .user_data((&raw const *log).cast_mut().cast());
        // SAFETY: `log` is boxed, so the pointer outlives the messenger that `Drop` destroys first.
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
    }
}

unsafe extern "system" fn on_message(
    _severity: vk::DebugUtilsMessageSeverityFlagsEXT,
    _types: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    user: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: the layer passes valid pointers; `user` is the boxed log of the messenger.
    let (message, log) = unsafe {
        let text = (*data).p_message;
        let message = if text.is_null() {
            String::from("(no text)")
        } else {
            CStr::from_ptr(text).to_string_lossy().into_owned()
        };
        (message, &*user.cast::<Log>())
    };
    log.push(message);
    vk::FALSE
}
