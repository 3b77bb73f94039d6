//! The pipeline cache on disk: one file a driver and device. A file that does not fit is ignored.

use crate::error::Named;
use crate::{AdapterInfo, Result};
use ash::vk;
use std::path::{Path, PathBuf};

/// Bytes of the header that Vulkan puts before cache data.
const HEADER_BYTES: usize = 32;

/// Where the cache of a device lies in `folder`.
pub(crate) fn file(folder: &Path, info: &AdapterInfo) -> PathBuf {
    folder.join(format!("pipelines-{}.bin", info.cache_key))
}

/// Makes a cache from the file, or an empty one. The driver checks the header; we check that there is one.
pub(crate) fn load(device: &ash::Device, path: Option<&Path>) -> Result<vk::PipelineCache> {
    let stored =
        path.and_then(|path| std::fs::read(path).ok()).filter(|bytes| bytes.len() > HEADER_BYTES).unwrap_or_default();
    let info = vk::PipelineCacheCreateInfo::default().initial_data(&stored);
    // SAFETY: the device is alive; drivers must ignore data that is not theirs.
    match unsafe { device.create_pipeline_cache(&info, None) } {
        Ok(cache) => Ok(cache),
        Err(error) => {
            tracing::warn!(?error, "the stored pipeline cache was refused; starting an empty one");
            let empty = vk::PipelineCacheCreateInfo::default();
            // SAFETY: as above.
            unsafe { device.create_pipeline_cache(&empty, None) }.named("vkCreatePipelineCache")
        }
    }
}

/// Writes the cache beside its place and renames it there, so that a reader never sees half of it.
pub(crate) fn save(device: &ash::Device, cache: vk::PipelineCache, path: &Path) {
    // SAFETY: device and cache are alive.
    let Ok(bytes) = (unsafe { device.get_pipeline_cache_data(cache) }) else { return };
    let beside = path.with_extension(format!("{}.tmp", std::process::id()));
    let written = path.parent().map_or(Ok(()), std::fs::create_dir_all);
    let written = written.and_then(|()| std::fs::write(&beside, bytes)).and_then(|()| std::fs::rename(&beside, path));
    if let Err(error) = written {
        let _ = std::fs::remove_file(&beside);
        tracing::debug!(%error, path = %path.display(), "the pipeline cache was not kept");
    }
}
