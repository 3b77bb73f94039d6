//! Shaders that take the place of those built in, while the program runs.

use super::{Key, Pipeline, Pipelines};
use crate::error::Named;
use crate::lock::lock;
use crate::{Error, Gpu, Result};
use ash::vk;
use shaders::reload::NewShader;
use shaders::{ShaderKind, ShaderModule, StageInfo, STAGES};

/// The first word of SPIR-V.
const MAGIC: u32 = 0x0723_0203;

/// Which shaders are used in place of those built in.
#[derive(Clone, Default)]
pub(super) struct Replaced(Vec<NewShader>);

impl Replaced {
    /// The words to use for a shader, if they are not those built in.
    pub(super) fn words(&self, stage: &str, kind: ShaderKind) -> Option<Vec<u32>> {
        let found = self.0.iter().find(|shader| shader.stage == stage && shader.kind == kind)?;
        Some(found.words.clone())
    }

    /// The last shader of a name and kind counts.
    fn with(mut self, new: &[NewShader]) -> Self {
        let is_new = |shader: &NewShader| new.iter().any(|new| (&new.stage, new.kind) == (&shader.stage, shader.kind));
        self.0.retain(|shader| !is_new(shader));
        self.0.extend_from_slice(new);
        self
    }
}

impl Gpu {
    /// Uses these shaders from now on in place of those that were built in, or that an earlier call gave. Pipelines that are there are
    /// made anew; if one cannot be, or the validation layer objects, all stay as they were. Between frames only.
    ///
    /// The words must be SPIR-V made of the stage's source, with what Rust sees of it unchanged (`shaders::reload::Reloader` compiles such):
    /// what a driver does with others is not known.
    ///
    /// # Errors
    /// A shader that the program does not have, words that are no SPIR-V, or a pipeline that cannot be made.
    pub fn replace_shaders(&self, new: &[NewShader]) -> Result<()> {
        for shader in new {
            let fault = match STAGES.iter().find(|stage| stage.name == shader.stage) {
                None => "no stage of this name was built in",
                Some(stage) if stage.modules.iter().all(|module| module.kind != shader.kind) => "it has no such shader",
                Some(_) if shader.words.first() != Some(&MAGIC) => "its new shader is no SPIR-V",
                Some(_) => continue,
            };
            return Err(Error::NewShader { stage: shader.stage.clone(), fault: fault.to_owned() });
        }
        let vulkan = self.vulkan()?;
        // SAFETY: the device is alive, and frames are run one at a time: nobody submits meanwhile.
        unsafe { vulkan.device.device_wait_idle() }.named("vkDeviceWaitIdle")?;
        vulkan.pipelines.replace(&vulkan.device, new, || match self.take_messages().into_iter().next() {
            None => Ok(()),
            Some(message) => Err(Error::Validation { stage: message.stage, text: message.text }),
        })
    }
}

impl Pipelines {
    /// A module of a shader: the one to use now.
    pub(super) fn shader(
        &self,
        device: &ash::Device,
        stage: &StageInfo,
        module: &ShaderModule,
    ) -> Result<vk::ShaderModule> {
        let built_in = || {
            module.spirv.chunks_exact(4).map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]])).collect()
        };
        let words: Vec<u32> = lock(&self.replaced).words(stage.name, module.kind).unwrap_or_else(built_in);
        let info = vk::ShaderModuleCreateInfo::default().code(&words);
        // SAFETY: the words are SPIR-V that the generator compiled and a test holds to its sources, or what `Gpu::replace_shaders` was
        // given, whose callers promise the same.
        let made = unsafe { device.create_shader_module(&info, None) }.named("vkCreateShaderModule")?;
        self.names.give(made, stage.name);
        Ok(made)
    }

    /// Makes all pipelines of these shaders anew, and keeps them if `check` finds no fault. The device is idle.
    fn replace(&self, device: &ash::Device, new: &[NewShader], check: impl FnOnce() -> Result<()>) -> Result<()> {
        let before = lock(&self.replaced).clone();
        *lock(&self.replaced) = before.clone().with(new);
        let keys: Vec<Key> = lock(&self.made).keys().filter(|key| is_of(key, new)).cloned().collect();
        let mut fresh: Vec<(Key, Pipeline)> = Vec::new();
        let made = keys.into_iter().try_for_each(|key| {
            let pipeline = self.make(device, info(key.0)?, &key)?;
            fresh.push((key, pipeline));
            Ok(())
        });
        let done = made.and_then(|()| check());
        if done.is_err() {
            *lock(&self.replaced) = before;
        }
        for (key, pipeline) in fresh {
            let unused = match done {
                Ok(()) => lock(&self.made).insert(key, pipeline),
                Err(_) => Some(pipeline),
            };
            if let Some(unused) = unused {
                // SAFETY: the device is idle, and no one finds this pipeline any more.
                unsafe { device.destroy_pipeline(unused.raw, None) };
            }
        }
        done
    }
}

fn is_of(key: &Key, new: &[NewShader]) -> bool {
    new.iter().any(|shader| shader.stage == key.0)
}

fn info(name: &'static str) -> Result<&'static StageInfo> {
    let found = STAGES.iter().find(|stage| stage.name == name).copied();
    found.ok_or_else(|| Error::NewShader {
        stage: name.to_owned(),
        fault: "no stage of this name was built in".to_owned(),
    })
}
