//! What was dropped while a recorded frame could still name it, until it is freed.

use crate::lock::lock;
use ash::vk;
use gpu_allocator::vulkan::{Allocation, Allocator};
use std::sync::Mutex;

/// What was dropped but may still be named by a recorded frame. Null handles stand for what it does not have.
#[derive(Default)]
pub(crate) struct Retired {
    pub(crate) buffer: vk::Buffer,
    pub(crate) image: vk::Image,
    pub(crate) view: vk::ImageView,
    pub(crate) queries: vk::QueryPool,
    pub(crate) allocation: Option<Allocation>,
}

impl Retired {
    /// Frees it, and says how many bytes of device memory that gave back.
    pub(crate) fn free(self, device: &ash::Device, allocator: &Mutex<Allocator>) -> u64 {
        // SAFETY: its owner is gone, no frame is alive, and the device is idle between frames. Null handles are ignored.
        unsafe {
            device.destroy_image_view(self.view, None);
            device.destroy_image(self.image, None);
            device.destroy_buffer(self.buffer, None);
            device.destroy_query_pool(self.queries, None);
        }
        let Some(allocation) = self.allocation else { return 0 };
        let bytes = allocation.size();
        if let Err(error) = lock(allocator).free(allocation) {
            tracing::warn!(%error, "freeing device memory");
        }
        bytes
    }
}

/// The dropped resources that wait to be freed.
#[derive(Default)]
pub(crate) struct RetiredList(Mutex<Vec<Retired>>);

impl RetiredList {
    pub(crate) fn push(&self, retired: Retired) {
        lock(&self.0).push(retired);
    }

    pub(crate) fn take(&self) -> Vec<Retired> {
        std::mem::take(&mut *lock(&self.0))
    }
}
