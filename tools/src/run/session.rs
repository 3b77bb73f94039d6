//! A scene on a device with a camera path: what every command works on.

use crate::run::targets::Targets;
use anyhow::{bail, Context, Result};
use culling::flares::Settings;
use culling::{Shading, View, World};
use engine::{Gpu, GpuOptions};
use scenes::{CameraPath, Fit, MovingBounds, Scene, SceneOptions, Shot};
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};

/// What a session is opened with.
#[derive(Clone, Debug)]
pub struct SessionOptions {
    /// Scene name, or a .glb or .gltf file.
    pub scene: PathBuf,
    /// Multiple of a procedural scene's standard number of objects.
    pub scale: f64,
    /// Seed of a procedural scene.
    pub seed: u64,
    /// How finely a procedural scene's meshes are divided.
    pub detail: u32,
    /// Path name or .json file; none takes the scene's default.
    pub path: Option<PathBuf>,
    /// How many times the path's way the camera goes in a run.
    pub speed: f64,
    /// Spread the whole way over the run, however few frames that has.
    pub whole_path: bool,
    /// Frames of a run, > 0.
    pub frames: usize,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The fit of the rectangle of a file's camera into the picture.
    pub fit: Fit,
    /// What is drawn of materials; none takes what the scene has.
    pub shading: Option<Shading>,
    /// Samples a pixel, 1 or 4.
    pub samples: u32,
    /// How the bounds of what moves are had.
    pub bounds: MovingBounds,
    /// Lens flares over each frame, if any.
    pub flares: Option<Settings>,
}

impl Default for SessionOptions {
    fn default() -> Self {
        SessionOptions {
            scene: "city-block".into(),
            scale: 1.0,
            seed: 1,
            detail: SceneOptions::default().detail,
            path: None,
            speed: 1.0,
            whole_path: false,
            frames: 30,
            size: [1280, 720],
            fit: Fit::default(),
            shading: None,
            samples: 1,
            bounds: MovingBounds::default(),
            flares: None,
        }
    }
}

/// A scene on a device with a camera path.
pub struct Session {
    /// The device.
    pub gpu: Gpu,
    /// The scene as loaded.
    pub scene: Scene,
    /// The scene on the device.
    pub world: World,
    /// What frames are drawn to.
    pub targets: Targets,
    path: CameraPath,
    options: SessionOptions,
}

impl Session {
    /// Opens a device, then a scene on it.
    pub fn open(gpu_options: &GpuOptions, options: SessionOptions) -> Result<Self> {
        Self::on(&Gpu::open(gpu_options)?, options)
    }

    /// Opens a scene on a device.
    pub fn on(gpu: &Gpu, options: SessionOptions) -> Result<Self> {
        let SessionOptions { scale, seed, detail, .. } = options;
        let scene = scenes::open(&options.scene, &SceneOptions { scale, seed, detail })?;
        Self::with_scene(gpu, scene, options)
    }

    /// Puts a scene that is already there on a device. `options.scene` is not looked at.
    pub fn with_scene(gpu: &Gpu, scene: Scene, options: SessionOptions) -> Result<Self> {
        if options.frames == 0 {
            bail!("a run needs at least one frame: give --frames a number above 0");
        }
        let path = path_of(&scene, &options)?;
        if path.widening() > 1.0 {
            let times = path.widening();
            tracing::info!("{}: its camera is made for wider pictures: the view is {times:.2} times as high, so that nothing is cropped (--fit height crops)", scene.name);
        }
        let targets = Targets::with_samples(gpu, options.size, options.samples)?;
        let shading = shading_of(&scene, &options);
        let world = World::with_bounds(gpu, &scene, shading, options.bounds)
            .with_context(|| format!("scene '{}'", scene.name))?;
        Ok(Session { gpu: gpu.clone(), scene, world, targets, path, options })
    }

    /// What the session was opened with.
    pub fn options(&self) -> &SessionOptions {
        &self.options
    }

    /// The camera path.
    pub fn path(&self) -> &CameraPath {
        &self.path
    }

    /// Frames of a run.
    pub fn frames(&self) -> usize {
        self.options.frames
    }

    /// Puts moving objects where they are in a frame, and gives what the frame looks through.
    pub fn look(&mut self, frame: usize) -> Result<View> {
        self.look_through(&self.shot(frame), frame)
    }

    /// The camera and the scene's time in a frame.
    pub fn shot(&self, frame: usize) -> Shot {
        self.path.sample(frame, self.options.frames)
    }

    /// The same through a camera that is on no path; `frame` is what the view is numbered with.
    pub fn look_through(&mut self, shot: &Shot, frame: usize) -> Result<View> {
        self.world.set_time(&self.scene, shot.seconds)?;
        Ok(View::new(shot, self.options.size, frame, self.targets.reach_px(&self.gpu)))
    }

    /// Draws pictures of another size from now on.
    pub fn resize(&mut self, size: [u32; 2]) -> Result<()> {
        if size != self.options.size {
            self.targets = Targets::with_samples(&self.gpu, size, self.options.samples)?;
            self.options.size = size;
            self.path = self.path.clone().fitted(aspect(size), self.options.fit);
        }
        Ok(())
    }

    /// SHA-256 of the scene as loaded, in hexadecimal.
    pub fn scene_hash(&self) -> String {
        hash_of(&self.scene)
    }

    /// How the bounds of what moves are had; none if nothing moves.
    pub fn moving_bounds(&self) -> Option<MovingBounds> {
        (!self.scene.motion.dynamic_objects().is_empty()).then_some(self.options.bounds)
    }

    /// What is drawn of materials.
    pub fn shading(&self) -> Shading {
        shading_of(&self.scene, &self.options)
    }

    /// Says in full what pictures of this run depend on: the key of its visible sets.
    pub fn key(&self) -> String {
        let device = self.gpu.info().map(|info| info.cache_key.clone()).unwrap_or_default();
        picture_key(&self.scene, &self.path, &self.options, [&device, &self.gpu.depth().to_string()])
    }
}

/// The path of the camera through pictures of the session's size.
fn path_of(scene: &Scene, options: &SessionOptions) -> Result<CameraPath> {
    let path = camera_path(scene, options.path.as_deref(), options.speed)?;
    let path = if options.whole_path { path.whole() } else { path };
    Ok(path.fitted(aspect(options.size), options.fit))
}

fn shading_of(scene: &Scene, options: &SessionOptions) -> Shading {
    options.shading.unwrap_or_else(|| Shading::of(scene))
}

/// SHA-256 of a scene as loaded, in hexadecimal.
fn hash_of(scene: &Scene) -> String {
    scene.content_hash().iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The key of a session's pictures. A device with its driver and a depth format may decide otherwise who wins a pixel.
fn picture_key(scene: &Scene, path: &CameraPath, options: &SessionOptions, [device, depth]: [&str; 2]) -> String {
    let (hash, drawing) = (hash_of(scene), drawing());
    let SessionOptions { size: [width, height], samples, frames, .. } = options;
    format!(
        "scene={hash} path={} frames={frames} size={width}x{height}x{samples} device={device} depth={depth} draw={drawing} shading={:?}",
        path.describe(),
        shading_of(scene, options)
    )
}

/// Raised whenever the host decides otherwise what is drawn, so that visible sets of an earlier program are not taken for those of this one.
/// 2: windings of the current transform, uniform alpha, morph targets.
const DRAWING_VERSION: u32 = 2;

/// Returns true for the stages that decide who owns a pixel or is seen through: they draw or move objects, or read samples.
fn decides_pictures(stage: &str) -> bool {
    ["draw/", "world/", "translucent/", "engine/"].iter().any(|folder| stage.starts_with(folder))
}

/// Stands for all that decides pictures beside the scene: the shaders of [`decides_pictures`], byte by byte, and the host's part.
fn drawing() -> String {
    let mut hash = Sha256::new();
    hash.update(DRAWING_VERSION.to_le_bytes());
    let modules = shaders::STAGES.iter().filter(|stage| decides_pictures(stage.name)).flat_map(|stage| stage.modules);
    modules.for_each(|module| hash.update(module.spirv));
    hash.finalize().iter().take(8).map(|byte| format!("{byte:02x}")).collect()
}

/// Width over height.
fn aspect([width, height]: [u32; 2]) -> f64 {
    f64::from(width) / f64::from(height)
}

/// Opens a path by name, or from a file whose name ends with .json; without a name, the scene's default.
///
/// # Errors
/// An unknown name, a speed out of range, or a file that cannot be read.
pub fn camera_path(scene: &Scene, name_or_file: Option<&Path>, speed: f64) -> Result<CameraPath> {
    let is_file = |path: &&Path| path.as_os_str().as_encoded_bytes().ends_with(b".json");
    Ok(match name_or_file.filter(is_file) {
        Some(file) => CameraPath::from_file(file, speed)?,
        None => CameraPath::named(scene, name_or_file.map(Path::to_string_lossy).as_deref(), speed)?,
    })
}

/// Where caches lie: `SIGHTLINE_CACHE`, else `XDG_CACHE_HOME/sightline`, else `~/.cache/sightline`, else none.
pub fn cache_folder() -> Option<PathBuf> {
    let named = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    named("SIGHTLINE_CACHE")
        .or_else(|| named("XDG_CACHE_HOME").map(|folder| folder.join("sightline")))
        .or_else(|| named("HOME").map(|folder| folder.join(".cache/sightline")))
}

#[cfg(test)]
mod tests;
