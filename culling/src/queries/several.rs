//! Several boxes for an object, counted by one query (GPU Gems 29.5.1: the pyramid of figure 29-2).
//!
//! Together they hold all of the object, so it can show no sample where none of them does. They lie within its one box, and few of them
//! hold what many do: where more boxes are asked about, no more samples are counted. Boxes that overlap count a sample each.

use super::place::Place;
use crate::world::BoxesOfMeshes;
use crate::{OptionInfo, Result, Setup, World};
use engine::Buffer;
use scenes::Aabb;
use shaders::types::{Bounds, CullView};
use shaders::BufferRef;
use std::ops::Range;

/// How many boxes an object is asked about by.
pub(super) const BOXES_OPTION: OptionInfo = OptionInfo {
    name: "boxes",
    default: "1",
    values: "1..=8",
    help: "boxes of an object that its query counts, at most: more of them fit closer, and are more to rasterise",
};

/// The boxes of all objects, one object's after the other's.
pub(super) struct SeveralBoxes {
    meshes: BoxesOfMeshes,
    /// Those of object n begin at `firsts[n]` and end before `firsts[n + 1]`.
    firsts: Vec<u32>,
    bounds: Vec<Bounds>,
    on_device: Buffer<Bounds>,
    revision: u64,
}

impl SeveralBoxes {
    /// None if objects are to be asked about by their one box.
    pub(super) fn new(setup: &Setup<'_>) -> Result<Option<Self>> {
        let (most, world) = (setup.options.number(BOXES_OPTION.name), setup.world);
        if most <= 1 {
            return Ok(None);
        }
        let meshes = world.boxes_of_meshes(most)?;
        let (mut firsts, mut bounds) = (vec![0], Vec::new());
        for object in 0..world.len() as u32 {
            bounds.extend(world.gpu_boxes_of_object(object, &meshes));
            firsts.push(bounds.len() as u32);
        }
        let name = format!("{}.boxes", setup.options.method());
        let mut on_device = Buffer::new(setup.gpu, &name, bounds.len(), world.followed_placement())?;
        on_device.write(&bounds)?;
        Ok(Some(SeveralBoxes { meshes, firsts, bounds, on_device, revision: world.revision() }))
    }

    /// Boxes go where their objects are, in every frame anew: however the one box of what moves is had.
    pub(super) fn follow(&mut self, world: &World) -> Result<()> {
        if self.revision == world.revision() {
            return Ok(());
        }
        self.revision = world.revision();
        for (object, _) in world.moving() {
            let places = self.of(object).map(|at| at as usize);
            places.zip(world.gpu_boxes_of_object(object, &self.meshes)).for_each(|(at, box_)| self.bounds[at] = box_);
        }
        Ok(self.on_device.write(&self.bounds)?)
    }

    /// The numbers of an object's boxes.
    pub(super) fn of(&self, object: u32) -> Range<u32> {
        self.firsts[object as usize]..self.firsts[object as usize + 1]
    }

    /// Where an object lies whose one box is in view.
    pub(super) fn place(&self, object: u32, view: &CullView) -> Place {
        let places = self.of(object).map(|at| Place::of(&self.bounds[at as usize], view));
        places.fold(Place::Outside, |one, other| match (one, other) {
            (Place::Near, _) | (_, Place::Near) => Place::Near,
            (Place::Outside, other) => other,
            _ => Place::Testable,
        })
    }

    /// A box as the device has it.
    pub(super) fn bounds(&self, number: u32) -> &Bounds {
        &self.bounds[number as usize]
    }

    /// The same, for pictures.
    pub(super) fn aabb(&self, number: u32) -> Aabb {
        let Bounds { centre_high, centre_low, half_extent, .. } = self.bounds[number as usize];
        let [high, low, half] = [centre_high, centre_low, half_extent].map(|part| glam::Vec3::from(part).as_dvec3());
        Aabb { min: high + low - half, max: high + low + half }
    }

    /// All of them.
    pub(super) fn on_device(&self) -> BufferRef<Bounds> {
        self.on_device.all()
    }
}
