//! The Vulkan instance: loader, validation, messages.

use crate::error::Named;
use crate::messages::{callback, Messages};
use crate::{Error, Result};
use ash::vk;
use std::ffi::{c_void, CStr};
use std::sync::Arc;

const VALIDATION_LAYER: &CStr = c"VK_LAYER_KHRONOS_validation";

/// What makes windows into surfaces, by window system.
const SURFACES: [&CStr; 6] = [
    ash::khr::surface::NAME,
    ash::khr::xlib_surface::NAME,
    ash::khr::xcb_surface::NAME,
    ash::khr::wayland_surface::NAME,
    ash::khr::win32_surface::NAME,
    ash::ext::metal_surface::NAME,
];

/// An instance with its message collector. Dropped last of all Vulkan objects.
pub(crate) struct Instance {
    pub(crate) raw: ash::Instance,
    pub(crate) messages: Arc<Messages>,
    pub(crate) validating: bool,
    messenger: Option<(ash::ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
    pub(crate) entry: ash::Entry,
}

impl Instance {
    pub(crate) fn new(validation: bool, windows: bool) -> Result<Self> {
        // SAFETY: loading the system's Vulkan loader runs its initialisers; there is no way around trusting it.
        let entry = unsafe { ash::Entry::load() }.map_err(|error| Error::NoLoader(error.to_string()))?;
        // SAFETY: a query without preconditions.
        let layers =
            unsafe { entry.enumerate_instance_layer_properties() }.named("vkEnumerateInstanceLayerProperties")?;
        let has_layer = layers.iter().any(|layer| layer.layer_name_as_c_str() == Ok(VALIDATION_LAYER));
        if validation && !has_layer {
            return Err(Error::NoValidation);
        }
        let messages = Arc::new(Messages::default());
        let raw = create(&entry, validation, windows)?;
        let messenger = if validation { Some(create_messenger(&entry, &raw, &messages)?) } else { None };
        Ok(Instance { raw, messages, validating: validation, messenger, entry })
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        // SAFETY: the device and everything made from it are gone: `Gpu` drops its instance last.
        unsafe {
            if let Some((extension, messenger)) = self.messenger.take() {
                extension.destroy_debug_utils_messenger(messenger, None);
            }
            self.raw.destroy_instance(None);
        }
    }
}

fn create(entry: &ash::Entry, validation: bool, windows: bool) -> Result<ash::Instance> {
    let application = vk::ApplicationInfo::default()
        .application_name(c"sightline")
        .engine_name(c"sightline")
        .api_version(vk::API_VERSION_1_3);
    // SAFETY: a query without preconditions.
    let available = unsafe { entry.enumerate_instance_extension_properties(None) }
        .named("vkEnumerateInstanceExtensionProperties")?;
    let mut extensions = Vec::new();
    // Labels and names are for captures as much as for validation: taken wherever they are to be had.
    let labels = ash::ext::debug_utils::NAME;
    if validation || available.iter().any(|extension| extension.extension_name_as_c_str() == Ok(labels)) {
        extensions.push(labels.as_ptr());
    }
    if windows {
        // All kinds of windows that the loader knows: which one it will be is not known yet.
        let known = |name: &CStr| available.iter().any(|extension| extension.extension_name_as_c_str() == Ok(name));
        extensions.extend(SURFACES.iter().filter(|name| known(name)).map(|name| name.as_ptr()));
    }
    let layers = if validation { vec![VALIDATION_LAYER.as_ptr()] } else { Vec::new() };
    let enabled = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
    let mut features = vk::ValidationFeaturesEXT::default().enabled_validation_features(&enabled);
    let mut info = vk::InstanceCreateInfo::default()
        .application_info(&application)
        .enabled_extension_names(&extensions)
        .enabled_layer_names(&layers);
    if validation {
        info = info.push_next(&mut features);
    }
    // SAFETY: the structure and everything it points to live through the call.
    unsafe { entry.create_instance(&info, None) }.named("vkCreateInstance")
}

fn create_messenger(
    entry: &ash::Entry,
    instance: &ash::Instance,
    messages: &Arc<Messages>,
) -> Result<(ash::ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT)> {
    let extension = ash::ext::debug_utils::Instance::new(entry, instance);
    let info = vk::DebugUtilsMessengerCreateInfoEXT::default()
        .message_severity(vk::DebugUtilsMessageSeverityFlagsEXT::WARNING | vk::DebugUtilsMessageSeverityFlagsEXT::ERROR)
        .message_type(vk::DebugUtilsMessageTypeFlagsEXT::VALIDATION)
        .pfn_user_callback(Some(callback))
        .user_data(Arc::as_ptr(messages) as *mut c_void);
    // SAFETY: the user pointer is kept alive by `Instance::messages` until after the messenger is destroyed.
    let messenger =
        unsafe { extension.create_debug_utils_messenger(&info, None) }.named("vkCreateDebugUtilsMessengerEXT")?;
    Ok((extension, messenger))
}
