//! RenderDoc captures of single frames, through the library loaded at run time.

use crate::{Error, Gpu, Result};
use ash::vk::Handle;
use renderdoc::{DevicePointer, RenderDoc, V110};
use std::ffi::c_void;
use std::path::{Path, PathBuf};

#[cfg(windows)]
const LIBRARY: &str = "renderdoc.dll";
#[cfg(not(windows))]
const LIBRARY: &str = "librenderdoc.so";

/// The loaded RenderDoc library. Make it before the device: it has to see the instance being made.
pub struct Capture {
    library: RenderDoc<V110>,
}

impl Capture {
    /// Loads RenderDoc and turns its Vulkan layer on for instances made from now on.
    pub fn load() -> Result<Self> {
        std::env::set_var("ENABLE_VULKAN_RENDERDOC_CAPTURE", "1");
        // The crate only finds the library if it is loaded; we load it, and keep it for the life of the process.
        // SAFETY: loading RenderDoc runs its initialisers, which is what a user who asks for a capture wants.
        let loaded = unsafe { libloading::Library::new(LIBRARY) }.map_err(|error| Error::Capture(error.to_string()))?;
        std::mem::forget(loaded);
        let library = RenderDoc::<V110>::new().map_err(|error| Error::Capture(error.to_string()))?;
        Ok(Capture { library })
    }

    /// Starts a capture of all that follows on this device. Its file's name begins with `path`.
    pub fn start(&mut self, gpu: &Gpu, path: &Path) -> Result<()> {
        self.library.set_log_file_path_template(path);
        self.library.start_frame_capture(device_pointer(gpu)?, std::ptr::null());
        Ok(())
    }

    /// Ends the capture and gives its file.
    pub fn end(&mut self, gpu: &Gpu) -> Result<PathBuf> {
        self.library.end_frame_capture(device_pointer(gpu)?, std::ptr::null());
        let last = self.library.get_num_captures().checked_sub(1);
        let file = last.and_then(|index| self.library.get_capture(index)).map(|(file, _)| file);
        file.ok_or_else(|| Error::Capture("it wrote no capture".to_owned()))
    }
}

/// RenderDoc knows a Vulkan device by the first pointer in its instance: the dispatch table.
fn device_pointer(gpu: &Gpu) -> Result<DevicePointer> {
    let instance = gpu.vulkan()?.instance.raw.handle().as_raw() as *const *const c_void;
    // SAFETY: a dispatchable Vulkan handle points to an object that begins with its dispatch table.
    Ok(DevicePointer::from(unsafe { *instance }))
}
