//! What the validation layer said, with the stage it said it about.

use ash::vk;
use std::ffi::{c_void, CStr};
use std::sync::Mutex;

/// One message of the validation layer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// The stage being recorded, or empty.
    pub stage: String,
    /// The layer's words.
    pub text: String,
}

/// Collects messages; lives as long as the instance.
#[derive(Default)]
pub(crate) struct Messages {
    said: Mutex<Vec<Message>>,
}

impl Messages {
    pub(crate) fn take(&self) -> Vec<Message> {
        std::mem::take(&mut *self.lock())
    }

    /// Forgets what was said with one of these words.
    pub(crate) fn forget(&self, words: &[&str]) {
        self.lock().retain(|message| !words.iter().any(|word| message.text.contains(word)));
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Vec<Message>> {
        self.said.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }
}

/// What the layer says of itself where its own thread did not get to run for ten seconds, as on a machine with too much to do: it adds that
/// this is most likely its own fault (Vulkan-ValidationLayers 1.3.239). It tells nothing of our calls.
const OF_ITSELF: &str = "UNASSIGNED-VkFence-state-timeout";

/// The debug-utils callback. `user` is the instance's `Messages`.
pub(crate) unsafe extern "system" fn callback(
    severity: vk::DebugUtilsMessageSeverityFlagsEXT,
    _kind: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    user: *mut c_void,
) -> vk::Bool32 {
    if data.is_null() || user.is_null() {
        return vk::FALSE;
    }
    // SAFETY: the layer passes a valid structure, and the user pointer that `instance.rs` gave, which outlives the messenger.
    let (data, messages) = unsafe { (&*data, &*(user as *const Messages)) };
    // SAFETY: the layer's strings are null-terminated or null.
    let text = unsafe { text(data.p_message) };
    let stage = if data.cmd_buf_label_count > 0 && !data.p_cmd_buf_labels.is_null() {
        // SAFETY: the array has `cmd_buf_label_count` > 0 entries; the first is the innermost label.
        unsafe { self::text((*data.p_cmd_buf_labels).p_label_name) }
    } else {
        String::new()
    };
    tracing::debug!(?severity, stage, "{text}");
    if text.contains(OF_ITSELF) {
        return vk::FALSE;
    }
    messages.lock().push(Message { stage, text });
    vk::FALSE
}

/// # Safety
/// `pointer` is null or points to a null-terminated string.
unsafe fn text(pointer: *const std::ffi::c_char) -> String {
    if pointer.is_null() {
        return String::new();
    }
    // SAFETY: not null, and null-terminated by the caller's promise.
    unsafe { CStr::from_ptr(pointer) }.to_string_lossy().into_owned()
}
