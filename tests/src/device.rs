//! Devices for the tests of a process, with validation on, each used by one test at a time.

use crate::replaced;
use engine::{Gpu, GpuOptions};
use std::ops::Deref;
use std::sync::{Condvar, Mutex, MutexGuard};

/// Devices that are used at once, unless `SIGHTLINE_TEST_DEVICES` asks for more. With two, lavapipe (Mesa 22.3.6) spoiled the heap in two of
/// three runs of all tests: one thread made a pipeline, the other found the heap broken in the validation layer's next allocation.
const AT_ONCE: usize = 1;

/// Devices that no test uses now, and how many there are in all. They stay open: opening one takes longer than most tests.
struct Devices {
    idle: Vec<&'static Gpu>,
    opened: usize,
}

static DEVICES: Mutex<Devices> = Mutex::new(Devices { idle: Vec::new(), opened: 0 });
static GIVEN_BACK: Condvar = Condvar::new();

/// A device while it is this test's turn. Tests do not share one at a time, because validation messages belong to the device and not
/// to a test, and because frames of one device share a command pool.
pub struct Device {
    gpu: &'static Gpu,
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

/// A device that no other test of this process uses. Ask once a test: tests that hold some and wait for more could wait forever.
///
/// # Panics
/// Without a device: a test never passes because there is none.
pub fn gpu() -> Device {
    let asked = std::env::var("SIGHTLINE_TEST_DEVICES").ok().and_then(|count| count.parse().ok());
    let at_once = asked.unwrap_or(AT_ONCE).max(1);
    let mut devices = lock();
    loop {
        if let Some(gpu) = devices.idle.pop() {
            let _ = gpu.take_messages();
            return Device { gpu };
        }
        if devices.opened < at_once {
            // Opened under the lock: its self-check times stages, and tests that begin meanwhile would wait anyway.
            let gpu = opened();
            devices.opened += 1;
            return Device { gpu };
        }
        devices = GIVEN_BACK.wait(devices).unwrap_or_else(|poisoned| poisoned.into_inner());
    }
}

/// A test that failed leaves nothing half-done behind: frames wait until they are finished, and the list changes in single steps.
fn lock() -> MutexGuard<'static, Devices> {
    DEVICES.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}

fn opened() -> &'static Gpu {
    match Gpu::open(&options()) {
        Ok(gpu) => {
            let replaced = replaced::from_environment();
            gpu.replace_shaders(&replaced).unwrap_or_else(|error| panic!("{}: {error}", replaced::SHADERS_VARIABLE));
            Box::leak(Box::new(gpu))
        }
        Err(error) => {
            panic!("tests need a Vulkan device with validation layers: {error} (tools/setup.sh installs lavapipe)")
        }
    }
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
        let messages = self.gpu.take_messages();
        lock().idle.push(self.gpu);
        GIVEN_BACK.notify_one();
        if !std::thread::panicking() {
            assert!(messages.is_empty(), "the validation layer said: {messages:#?}");
        }
    }
}
