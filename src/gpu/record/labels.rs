//! Names of passes in captures and validation messages.

use ash::vk;

use crate::gpu::record::recorder::Recorder;

impl Recorder {
    pub(in crate::gpu) fn label(&self, name: &str) {
        let Some(debug) = &self.context.debug else {
            return;
        };
        let mut text = [0u8; 64];
        let length = name.len().min(text.len() - 1);
        text[..length].copy_from_slice(&name.as_bytes()[..length]);
        let Ok(text) = std::ffi::CStr::from_bytes_until_nul(&text) else {
            return;
        };
        let info = vk::DebugUtilsLabelEXT::default().label_name(text);
        // SAFETY: the command buffer is recording.
        unsafe { debug.cmd_begin_debug_utils_label(self.command, &info) };
    }

    pub(in crate::gpu) fn unlabel(&self) {
        let Some(debug) = &self.context.debug else {
            return;
        };
        // SAFETY: pairs with `label`.
        unsafe { debug.cmd_end_debug_utils_label(self.command) };
    }
}
