//! How the depth buffer keeps depth. Stages compute with reversed depth (1 near, 0 far), however it is kept.

use ash::vk;
use std::fmt;

/// A format of depth buffers, and the way around it is kept. Bounds are derived for the first; the others are there to study what
/// they cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum DepthFormat {
    /// 32-bit float, 1 near and 0 far: floats have their finest steps at 0, where perspective crowds depths.
    #[default]
    ReversedD32,
    /// 32-bit float, 0 near and 1 far.
    StandardD32,
    /// 24-bit fixed point, in 32 bits. Its steps are the same both ways around.
    D24,
    /// 16-bit fixed point.
    D16,
}

impl DepthFormat {
    /// All of them.
    pub const ALL: [DepthFormat; 4] =
        [DepthFormat::ReversedD32, DepthFormat::StandardD32, DepthFormat::D24, DepthFormat::D16];

    /// The name of the Vulkan format, and which way around it is kept where that matters.
    pub fn name(self) -> &'static str {
        match self {
            DepthFormat::ReversedD32 => "D32_SFLOAT (reversed)",
            DepthFormat::StandardD32 => "D32_SFLOAT (standard)",
            DepthFormat::D24 => "X8_D24_UNORM",
            DepthFormat::D16 => "D16_UNORM",
        }
    }

    /// True if 0 is near: who reads the buffer takes what it keeps from 1.
    pub fn is_standard(self) -> bool {
        self == DepthFormat::StandardD32
    }

    pub(crate) fn vulkan(self) -> vk::Format {
        match self {
            DepthFormat::ReversedD32 | DepthFormat::StandardD32 => vk::Format::D32_SFLOAT,
            DepthFormat::D24 => vk::Format::X8_D24_UNORM_PACK32,
            DepthFormat::D16 => vk::Format::D16_UNORM,
        }
    }

    /// Bytes a texel takes in a copy.
    pub(crate) fn texel_bytes(self) -> usize {
        if self == DepthFormat::D16 {
            2
        } else {
            4
        }
    }

    /// What a clip-space depth of 0 and of 1 is kept as. The viewport turns depths around, not the projection.
    pub(crate) fn range(self) -> [f32; 2] {
        if self.is_standard() {
            [1.0, 0.0]
        } else {
            [0.0, 1.0]
        }
    }

    /// The test that the nearer fragment passes, and one as near unless it must be `strictly` nearer.
    pub(crate) fn nearer(self, strictly: bool) -> vk::CompareOp {
        match (self.is_standard(), strictly) {
            (false, false) => vk::CompareOp::GREATER_OR_EQUAL,
            (false, true) => vk::CompareOp::GREATER,
            (true, false) => vk::CompareOp::LESS_OR_EQUAL,
            (true, true) => vk::CompareOp::LESS,
        }
    }

    /// Reversed depths as floats, from what a copy of the buffer holds.
    pub(crate) fn reversed(self, kept: Vec<u8>) -> Vec<u8> {
        let floats: Vec<f32> = match self {
            DepthFormat::ReversedD32 => return kept,
            DepthFormat::StandardD32 => {
                bytemuck::pod_collect_to_vec::<u8, f32>(&kept).into_iter().map(|depth| 1.0 - depth).collect()
            }
            DepthFormat::D24 => {
                let words = bytemuck::pod_collect_to_vec::<u8, u32>(&kept);
                words.into_iter().map(|word| (word & 0xff_ffff) as f32 / 0xff_ffff as f32).collect()
            }
            DepthFormat::D16 => {
                let words = bytemuck::pod_collect_to_vec::<u8, u16>(&kept);
                words.into_iter().map(|word| f32::from(word) / f32::from(u16::MAX)).collect()
            }
        };
        bytemuck::cast_slice(&floats).to_vec()
    }
}

impl fmt::Display for DepthFormat {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(self.name())
    }
}
