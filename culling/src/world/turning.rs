//! Objects that turn inside out. A scale that goes through zero, an animated mirrored parent or a joint that mirrors changes the sign
//! of an object's determinant, and with it the front side of its triangles (glTF 2.0, 3.7.4).
//!
//! The order of a triangle's corners on the screen decides its facing. So an object that can turn has two index ranges of the same
//! triangles, one in each order, and `world/turn_objects` switches between them before anything is drawn. Bounds, vertices and the
//! number of indices are the same in both.

use super::upload::{command, Turnable};
use super::World;
use crate::Result;
use engine::{Buffer, Frame, Gpu, Placement};
use glam::DAffine3;
use scenes::{JointPlaces, Windings};
use shaders::types::{DrawCommand, TurnedObject};
use shaders::{world, Stage};
use std::sync::atomic::{AtomicBool, Ordering};

/// The objects of a world that can turn.
pub(super) struct Turning {
    windings: Windings,
    objects: Vec<Turnable>,
    /// The mesh of each of `objects` at the current time.
    turned: Buffer<TurnedObject>,
    /// Some object has turned since `turned` was last used by a frame.
    changed: bool,
    /// A frame has recorded the stage since the last call of `set_time`.
    recorded: AtomicBool,
    /// Counts the times at which some object turned.
    revision: u64,
}

impl Turning {
    /// None if no object of the scene can turn.
    pub(super) fn new(gpu: &Gpu, windings: Windings, objects: Vec<Turnable>) -> Result<Option<Self>> {
        if objects.is_empty() {
            return Ok(None);
        }
        let turned = Buffer::new(gpu, "world.turned_objects", objects.len(), Placement::Upload)?;
        let recorded = AtomicBool::new(false);
        Ok(Some(Turning { windings, objects, turned, changed: false, recorded, revision: 0 }))
    }

    /// Switches the meshes of objects that are mirrored now and were not, or the other way round. `transforms` are those of all moving
    /// objects of the scene, by ascending object.
    pub(super) fn set_time(
        &mut self,
        transforms: &[(u32, DAffine3)],
        joints: &JointPlaces,
        object_meshes: &mut [u32],
    ) -> Result<()> {
        if self.recorded.swap(false, Ordering::Relaxed) {
            self.changed = false;
        }
        let mut any = false;
        for it in &self.objects {
            let Ok(at) = transforms.binary_search_by_key(&it.scene_object, |(object, _)| *object) else { continue };
            let mirrored = self.windings.is_mirrored(it.scene_object, &transforms[at].1, joints);
            let mesh = it.meshes[usize::from(mirrored)];
            any |= std::mem::replace(&mut object_meshes[it.object as usize], mesh) != mesh;
        }
        if any {
            let now = |it: &Turnable| TurnedObject { object: it.object, mesh: object_meshes[it.object as usize] };
            self.turned.write(&self.objects.iter().map(now).collect::<Vec<_>>())?;
            self.changed = true;
            self.revision += 1;
        }
        Ok(())
    }

    /// Pairs of an object that can turn and a mesh that it is drawn from, now or at another time.
    pub(super) fn other_meshes(&self) -> impl Iterator<Item = (u32, u32)> + '_ {
        self.objects.iter().flat_map(|it| it.meshes.map(|mesh| (it.object, mesh)))
    }
}

impl World {
    /// Switches index ranges on the device where objects have turned inside out.
    pub(super) fn turn(&self, f: &mut Frame) {
        let name = world::TurnObjects::INFO.name;
        let Some(turning) = &self.turning else { return f.skip(name, "no object can turn inside out") };
        turning.recorded.store(true, Ordering::Relaxed);
        if !turning.changed {
            return f.skip(name, "no object has turned inside out");
        }
        let object_count = turning.objects.len() as u32;
        let (object_meshes, all_commands) = (self.object_meshes.all(), self.all_commands.all());
        let (turned, meshes) = (turning.turned.all(), self.meshes.all());
        f.dispatch(world::TurnObjects { turned, meshes, object_meshes, all_commands, object_count }, object_count);
    }

    /// Changes whenever an object turns inside out. Commands that were written before then draw the wrong side of it.
    pub fn winding_revision(&self) -> u64 {
        self.turning.as_ref().map_or(0, |turning| turning.revision)
    }

    /// Returns the current draw command of every object that culling methods see, in object order.
    pub fn commands(&self) -> Vec<DrawCommand> {
        (0..self.len() as u32).map(|object| self.command(object)).collect()
    }

    /// Returns the current draw command of an object.
    pub fn command(&self, object: u32) -> DrawCommand {
        command(self.host.meshes[self.host.object_meshes[object as usize] as usize], object)
    }
}
