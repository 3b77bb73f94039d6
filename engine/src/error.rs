//! What can go wrong with a device, each with the remedy.

use ash::vk;

/// Why the engine could not do what it was asked. Every message is one line.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The Vulkan loader or driver is missing.
    #[error("no Vulkan loader found ({0}); install libvulkan1 and a driver (lavapipe: mesa-vulkan-drivers), or run tools/setup.sh")]
    NoLoader(String),
    /// Validation was asked for, but the layer is missing.
    #[error("validation was asked for but VK_LAYER_KHRONOS_validation is not installed; install vulkan-validationlayers, or leave --validation out")]
    NoValidation,
    /// The loader found no device at all.
    #[error("Vulkan found no device; install a driver (a CPU one: mesa-vulkan-drivers), or check VK_DRIVER_FILES")]
    NoDevice,
    /// No device of the asked name or index.
    #[error("no Vulkan device matches '{wanted}'; there are: {found}")]
    NoSuchDevice {
        /// What `--device` said.
        wanted: String,
        /// The devices, separated by commas.
        found: String,
    },
    /// The device lacks something every method needs.
    #[error("device '{device}' lacks {missing}; choose another with --device (see `sightline info`)")]
    MissingFeatures {
        /// The device's name.
        device: String,
        /// Features and extensions, separated by commas.
        missing: String,
    },
    /// `--without` named nothing that can be turned off.
    #[error("no feature is called '{wanted}'; --without takes {known}")]
    NoSuchFeature {
        /// What `--without` said.
        wanted: String,
        /// What it takes, separated by commas.
        known: String,
    },
    /// A resource is larger than the device allows.
    #[error("{what} needs {wanted}, but device '{device}' allows {limit}; {remedy}")]
    TooLarge {
        /// The resource.
        what: String,
        /// How much it needs.
        wanted: String,
        /// The device's limit.
        limit: String,
        /// The device's name.
        device: String,
        /// What to do.
        remedy: String,
    },
    /// Memory ran out.
    #[error("no device memory for '{what}' ({mib:.1} MiB): {source}; use a smaller --scale or --size")]
    OutOfMemory {
        /// The resource.
        what: String,
        /// Its size in MiB.
        mib: f64,
        /// What the allocator said.
        source: gpu_allocator::AllocationError,
    },
    /// The device stopped answering.
    #[error("the device was lost while running stage '{stage}'; update the driver, or run with --validation to find the cause")]
    DeviceLost {
        /// The last stage that started, or the stages of the submission.
        stage: String,
    },
    /// The validation layer objected.
    #[error("validation, stage '{stage}': {text}")]
    Validation {
        /// The stage being recorded or run.
        stage: String,
        /// The layer's words.
        text: String,
    },
    /// A list on the GPU was too short for what a stage put in it.
    #[error("stage '{stage}' overflowed its list: {count} entries for {capacity}; this frame's picture is not valid (please report it)")]
    Overflow {
        /// The stage that overflowed.
        stage: String,
        /// Entries it wanted.
        count: u32,
        /// Entries there is room for.
        capacity: u32,
    },
    /// Any other failing Vulkan call.
    #[error("{call} failed: {result}")]
    Vulkan {
        /// The call.
        call: &'static str,
        /// What it returned.
        result: vk::Result,
    },
    /// There is no device: the engine records only.
    #[error("this engine only records frames (it was made without a device)")]
    RecordingOnly,
    /// The device or the loader cannot show pictures in this window.
    #[error("device '{device}' cannot show pictures in this window: {why}; choose another device with --device (see `sightline info`), or use `sightline shot`")]
    Window {
        /// The device's name.
        device: String,
        /// What is missing.
        why: String,
    },
    /// A shader cannot take the place of the one built in.
    #[error("stage '{stage}': {fault}; what runs stays as it was")]
    NewShader {
        /// The stage it is for.
        stage: String,
        /// What is wrong with it.
        fault: String,
    },
    /// A frame capture could not be made.
    #[error("RenderDoc: {0}; install renderdoc and run again, or leave --capture out")]
    Capture(String),
}

/// Names the call in a failing Vulkan result.
pub(crate) trait Named<T> {
    /// Turns a Vulkan result into an engine one.
    fn named(self, call: &'static str) -> Result<T, Error>;
}

impl<T> Named<T> for Result<T, vk::Result> {
    fn named(self, call: &'static str) -> Result<T, Error> {
        self.map_err(|result| Error::Vulkan { call, result })
    }
}
