//! Skeletons, and the meshes that they bend, written at rest.

use super::motion::{placed_skins, Trees};
use super::Export;
use crate::animation::Motion;
use crate::error::SceneError;
use crate::model::{Mesh, Scene};
use glam::DAffine3;
use serde_json::{json, Value};
use std::borrow::Cow;

/// The meshes of a scene, deformed ones as they are at rest.
pub(super) fn meshes_at_rest(scene: &Scene) -> Cow<'_, [Mesh]> {
    let mut meshes = Cow::Borrowed(&scene.meshes[..]);
    for deformed in &scene.deformed {
        let mesh = &mut meshes.to_mut()[deformed.mesh as usize];
        (mesh.positions, mesh.normals) = deformed.rest.iter().map(|vertex| (vertex.position, vertex.normal)).unzip();
        mesh.declared_bounds = None;
    }
    meshes
}

impl Export {
    /// Writes the nodes of skinned objects, without a place: their joints give it.
    pub(super) fn bent_objects(&mut self, scene: &Scene) {
        for (index, object) in scene.objects.iter().enumerate() {
            let Some(skin) = scene.deformation_of(object.mesh).and_then(|deformed| deformed.skin) else { continue };
            if let Some(node) = self.nodes[index].as_object_mut() {
                node.remove("matrix");
            }
            self.nodes[index]["skin"] = self.skin_of(scene, index, skin).into();
        }
    }

    /// Returns the file's skin of an object: the scene's skin, or one of its own for an instance that stands elsewhere.
    fn skin_of(&mut self, scene: &Scene, object: usize, skin: u32) -> usize {
        let Motion::Nodes(nodes) = &scene.motion else { return skin as usize };
        let at = nodes.objects().binary_search_by_key(&object, |on| on.object as usize);
        let world_from_tree = at.map_or(DAffine3::IDENTITY, |at| nodes.objects()[at].world_from_tree);
        if world_from_tree == DAffine3::IDENTITY {
            return skin as usize;
        }
        self.placed_skins.push((skin, world_from_tree));
        scene.skins.len() + self.placed_skins.len() - 1
    }

    /// Writes joints and weights of a mesh as attributes of its primitive.
    pub(super) fn influences(&mut self, scene: &Scene, mesh: u32, attributes: &mut Value) -> Result<(), SceneError> {
        let Some(deformed) = scene.deformation_of(mesh).filter(|deformed| deformed.skin.is_some()) else {
            return Ok(());
        };
        let most = deformed.rest.iter().flat_map(|vertex| vertex.joints).max().unwrap_or(0);
        if u16::try_from(most).is_err() {
            let fault = format!("it hangs on joint {most}, and glTF counts joints up to 65535");
            return Err(SceneError::BadObject { object: scene.meshes[mesh as usize].name.clone(), fault });
        }
        let sets = deformed.rest.iter().any(|vertex| vertex.weights[4..].iter().any(|weight| *weight > 0.0));
        for set in 0..if sets { 2 } else { 1 } {
            let four = |at: usize| 4 * set + at;
            let joints = deformed.rest.iter().map(|vertex| std::array::from_fn(|at| vertex.joints[four(at)]));
            let weights = deformed.rest.iter().map(|vertex| std::array::from_fn(|at| vertex.weights[four(at)]));
            attributes[format!("JOINTS_{set}")] = self.binary.joints(joints).into();
            attributes[format!("WEIGHTS_{set}")] = self.binary.vectors::<4>("VEC4", weights).into();
        }
        Ok(())
    }

    /// Writes skins, whose joints are nodes of the animation: those of the scene, then one for each instance that stands elsewhere.
    pub(super) fn skeletons(&mut self, scene: &Scene, written: &Trees) {
        let placed = std::mem::take(&mut self.placed_skins);
        for (skin, world_from_tree) in placed_skins(scene, &placed) {
            let joints = skin.joints().iter().filter_map(|joint| written.at(&world_from_tree, joint.node));
            let joints: Vec<usize> = joints.collect();
            let inverse_binds = skin.joints().iter().map(|joint| {
                let [x, y, z, at] = joint.joint_from_rest.as_affine3a().to_cols_array_2d();
                [x[0], x[1], x[2], 0.0, y[0], y[1], y[2], 0.0, z[0], z[1], z[2], 0.0, at[0], at[1], at[2], 1.0]
            });
            let inverse_binds = self.binary.vectors("MAT4", inverse_binds);
            self.skins.push(json!({ "joints": joints, "inverseBindMatrices": inverse_binds }));
        }
    }
}
