//! One device for all tests of a process, with validation on, used by one test at a time.

use engine::{Gpu, GpuOptions};
use std::ops::Deref;
use std::sync::{Mutex, MutexGuard, OnceLock};

static GPU: OnceLock<Gpu> = OnceLock::new();
static TURN: Mutex<()> = Mutex::new(());

/// The device while it is this test's turn. Tests take turns because validation messages belong to the device and not to
/// a test, and because frames of one device share a command pool.
pub struct Device {
    gpu: &'static Gpu,
    _turn: MutexGuard<'static, ()>,
}

/// How tests open devices: validation on; `SIGHTLINE_TEST_DEVICE` is an index or a part of the name, and "any" leaves the
/// choice to the engine. `SIGHTLINE_TEST_WITHOUT` names features that tests do without.
pub fn options() -> GpuOptions {
    let wanted = std::env::var("SIGHTLINE_TEST_DEVICE").ok();
    let device = wanted.filter(|name| !name.is_empty() && name != "any");
    let without = std::env::var("SIGHTLINE_TEST_WITHOUT").unwrap_or_default();
    let without = without.split(',').filter(|name| !name.is_empty()).map(str::to_owned).collect();
    GpuOptions { device, validation: true, without, ..GpuOptions::default() }
}

/// The device, when other tests of this process are done with it. Ask once a test: a second call in one test waits forever.
///
/// # Panics
/// Without a device: a test never passes because there is none.
pub fn gpu() -> Device {
    // A test that failed leaves nothing half-done behind on the device: frames wait until they are finished.
    let turn = TURN.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    let gpu = GPU.get_or_init(|| match Gpu::open(&options()) {
        Ok(gpu) => gpu,
        Err(error) => {
            panic!("tests need a Vulkan device with validation layers: {error} (tools/setup.sh installs lavapipe)")
        }
    });
    let _ = gpu.take_messages();
    Device { gpu, _turn: turn }
}

impl Deref for Device {
    type Target = Gpu;

    fn deref(&self) -> &Gpu {
        self.gpu
    }
}

impl Drop for Device {
    /// Messages outside frames, of making pipelines and resources, fail the test too.
    fn drop(&mut self) {
        if !std::thread::panicking() {
            let messages = self.gpu.take_messages();
            assert!(messages.is_empty(), "the validation layer said: {messages:#?}");
        }
    }
}
