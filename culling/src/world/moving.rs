//! What moves: where it is at a time, and the bounds that it has there, to where the device reads them.
//!
//! With bounds for each frame, every moving object brings its own. Bounds that hold more than one place (an animation's, or all) are
//! brought only where they change, so that most frames bring transforms alone.

use super::skins::Deformation;
use super::upload::{self, Flat};
use super::World;
use crate::Result;
use engine::{Buffer, Frame, Gpu, Placement};
use glam::{DAffine3, DVec3};
use scenes::{MovingBounds, MovingBoxes, Scene, Shapes};
use shaders::types::{Bounds, MovedObject, MovedTransform};
use shaders::{world, Stage};
use std::sync::atomic::{AtomicBool, Ordering};

/// The moving objects of a world, in the order of [`scenes::Motion::transforms_at`].
pub(super) struct Moving {
    boxes: MovingBoxes,
    /// Those whose bounds change, and those whose bounds stay.
    moves: Buffer<MovedObject>,
    transforms: Option<Buffer<MovedTransform>>,
    counts: [u32; 2],
    bounds: Vec<Bounds>,
    /// Those whose bounds have changed since they were last brought.
    changed: Vec<bool>,
    /// A frame has brought what the last time asks for.
    brought: AtomicBool,
}

impl Moving {
    /// None if nothing moves. Puts the bounds that objects have at time 0 into `flat`.
    pub(super) fn new(
        gpu: &Gpu,
        scene: &Scene,
        (flat, object_of_scene): (&mut Flat, &[u32]),
        mode: MovingBounds,
        transforms: &[(u32, DAffine3)],
    ) -> Result<Option<Self>> {
        let count = scene.motion.dynamic_objects().len();
        if count == 0 {
            return Ok(None);
        }
        let boxes = MovingBoxes::new(scene, &flat.world_bounds, mode);
        // For each frame anew: until the first time is set, objects have the bounds of where they are.
        let known =
            transforms.iter().enumerate().filter(|_| mode != MovingBounds::PerFrame || !scene.deformed.is_empty());
        let shapes = scene.shapes_at(0.0);
        for (place, (scene_object, transform)) in known {
            let object = object_of_scene[*scene_object as usize] as usize;
            let mesh = flat.scene_meshes[object];
            flat.boxes[object] = boxes.at(place, 0.0, &flat.world_bounds, (mesh, transform), &shapes);
            flat.bounds[object] = bounds_of(&boxes, place, &flat.boxes[object], transform, flat.bounds[object].flags);
        }
        let upload = Placement::Upload;
        let alone = mode != MovingBounds::PerFrame;
        Ok(Some(Moving {
            boxes,
            moves: Buffer::new(gpu, "world.moves", count, upload)?,
            transforms: alone.then(|| Buffer::new(gpu, "world.moved_transforms", count, upload)).transpose()?,
            counts: [0; 2],
            bounds: transforms
                .iter()
                .map(|(object, _)| flat.bounds[object_of_scene[*object as usize] as usize])
                .collect(),
            changed: vec![false; count],
            brought: AtomicBool::new(true),
        }))
    }
}

/// Bounds as the device takes them. What holds more than one place must allow for the farthest of them.
fn bounds_of(boxes: &MovingBoxes, place: usize, box_: &scenes::Aabb, at: &DAffine3, flags: u32) -> Bounds {
    match boxes.farthest(place) {
        None => upload::bounds(box_, at, flags),
        Some(farthest) => upload::bounds(box_, &DAffine3::from_translation(DVec3::splat(farthest)), flags),
    }
}

impl World {
    /// Puts moving objects where they are at a time in the scene; the next frames upload it. Cheap if nothing moves.
    pub fn set_time(&mut self, scene: &Scene, seconds: f64) -> Result<()> {
        let Some(moving) = &mut self.moving else { return Ok(()) };
        if self.host.seconds == Some(seconds) {
            return Ok(());
        }
        let host = &mut self.host;
        scene.motion.transforms_at(seconds, &mut host.transforms);
        if let Some(deformation) = &mut self.deformation {
            deformation.set_time(scene, seconds)?;
        }
        let none = Shapes::default();
        let shapes = self.deformation.as_ref().map_or(&none, Deformation::shapes);
        if let Some(turning) = &mut self.turning {
            turning.set_time(&host.transforms, &shapes.joints, &mut host.object_meshes)?;
        }
        if moving.brought.swap(false, Ordering::Relaxed) {
            moving.changed.fill(false);
        }
        let (mut moved, mut alone, mut any) = (Vec::new(), Vec::new(), false);
        for (place, (scene_object, transform)) in host.transforms.iter().enumerate() {
            let index = host.object_of_scene[*scene_object as usize];
            let at = index as usize;
            let object = upload::object(transform, host.objects[at].colour);
            host.objects[at] = object;
            host.boxes[at] = moving.boxes.at(place, seconds, &host.bounds, (host.scene_meshes[at], transform), shapes);
            let bounds = bounds_of(&moving.boxes, place, &host.boxes[at], transform, host.flags[at]);
            let changes = moving.boxes.mode() == MovingBounds::PerFrame || bounds != moving.bounds[place];
            any |= changes;
            moving.changed[place] |= changes;
            moving.bounds[place] = bounds;
            match moving.changed[place] {
                true => moved.push(MovedObject { index, object, bounds }),
                false => alone.push(MovedTransform { index, object }),
            }
        }
        moving.moves.write(&moved)?;
        moving.transforms.as_mut().map_or(Ok(()), |transforms| transforms.write(&alone))?;
        moving.counts = [moved.len() as u32, alone.len() as u32];
        host.seconds = Some(seconds);
        host.revision += 1;
        host.bounds_revision += u64::from(any);
        Ok(())
    }

    /// First step of every frame: moving objects take their places, and deformed ones their shapes.
    pub fn update(&self, f: &mut Frame) {
        match &self.moving {
            Some(moving) => self.update_moving(f, moving),
            None => f.skip(world::MoveObjects::INFO.name, "no dynamic objects"),
        }
        self.deform(f);
        self.turn(f);
    }

    fn update_moving(&self, f: &mut Frame, moving: &Moving) {
        moving.brought.store(true, Ordering::Relaxed);
        let (objects, [moved, alone]) = (self.objects.all(), moving.counts);
        match &moving.transforms {
            Some(_) if moved == 0 => {
                f.skip(world::MoveObjects::INFO.name, "bounds hold every place of their animation")
            }
            _ => {
                let (moves, bounds) = (moving.moves.all(), self.bounds.all());
                f.dispatch(world::MoveObjects { moves, objects, bounds, move_count: moved }, moved);
            }
        }
        match &moving.transforms {
            Some(transforms) if alone > 0 => {
                f.dispatch(world::MoveTransforms { moves: transforms.all(), objects, move_count: alone }, alone);
            }
            Some(_) => f.skip(world::MoveTransforms::INFO.name, "the bounds of all that moves change"),
            None => (),
        }
    }

    /// Bounds that frames at this time bring to the device.
    pub fn bounds_brought(&self) -> u64 {
        self.moving.as_ref().map_or(0, |moving| u64::from(moving.counts[0]))
    }

    /// Objects that can move, of those that culling methods see, and where the last call of [`World::set_time`] put them, in an order that never changes.
    pub fn moving(&self) -> impl ExactSizeIterator<Item = (u32, DAffine3)> + '_ {
        let object = |scene_object: u32| self.host.object_of_scene[scene_object as usize];
        let moved = |at: &usize| self.host.transforms[*at];
        self.host.solid_moves.iter().map(moved).map(move |(scene_object, transform)| (object(scene_object), transform))
    }

    /// Where a buffer lies that follows objects: the host writes it each frame where some can move, and never again where none can.
    pub(crate) fn followed_placement(&self) -> Placement {
        match self.host.solid_moves.is_empty() {
            true => Placement::Storage,
            false => Placement::Upload,
        }
    }

    /// The same objects, in the same order, with their bounds as the device has them once [`World::update`] has run.
    pub fn moving_bounds(&self) -> impl Iterator<Item = (u32, Bounds)> + '_ {
        let bounds = self.moving.iter().flat_map(|moving| self.host.solid_moves.iter().map(|at| moving.bounds[*at]));
        self.moving().map(|(object, _)| object).zip(bounds)
    }
}
