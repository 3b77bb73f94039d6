//! The names of Vulkan objects that captures and messages show.

use ash::vk;

/// What gives names; nothing where the device cannot.
#[derive(Clone)]
pub(crate) struct Names(pub(crate) Option<ash::ext::debug_utils::Device>);

impl Names {
    /// Gives an object its name.
    pub(crate) fn give<H: vk::Handle>(&self, handle: H, name: &str) {
        let (Some(labels), Ok(name)) = (&self.0, std::ffi::CString::new(name)) else { return };
        let info = vk::DebugUtilsObjectNameInfoEXT::default().object_handle(handle).object_name(&name);
        // SAFETY: the handle was just made from this device. A failing name is no reason to stop.
        let _ = unsafe { labels.set_debug_utils_object_name(&info) };
    }
}
