//! Skeletons: their joints as nodes of their own, and what they bend as it is at rest.

use super::motion::Sample;
use super::{matrix, Export};
use crate::animation::Motion;
use crate::bend::turn_round;
use crate::error::SceneError;
use crate::model::{Mesh, Scene};
use glam::DAffine3;
use serde_json::json;
use std::borrow::Cow;

/// The meshes of a scene, bent ones as they are at rest.
pub(super) fn meshes_at_rest(scene: &Scene) -> Cow<'_, [Mesh]> {
    let mut meshes = Cow::Borrowed(&scene.meshes[..]);
    let joints = scene.joints_at(0.0);
    for skinned in &scene.skinned {
        let mesh = &mut meshes.to_mut()[scene.objects[skinned.object as usize].mesh as usize];
        (mesh.positions, mesh.normals) = skinned.rest.iter().map(|vertex| (vertex.position, vertex.normal)).unzip();
        mesh.declared_bounds = None;
        turn_round(mesh, joints.of(skinned.skin));
    }
    meshes
}

impl Export {
    /// Joints and weights of what skeletons bend, on nodes that are nowhere: joints say where it is.
    pub(super) fn bent_objects(&mut self, scene: &Scene) -> Result<(), SceneError> {
        for skinned in &scene.skinned {
            let most = skinned.rest.iter().flat_map(|vertex| vertex.joints).max().unwrap_or(0);
            if u16::try_from(most).is_err() {
                let fault = format!("it hangs on joint {most}, and glTF counts joints up to 65535");
                return Err(SceneError::BadObject {
                    object: scene.objects[skinned.object as usize].name.clone(),
                    fault,
                });
            }
            let node = &mut self.nodes[skinned.object as usize];
            if let Some(node) = node.as_object_mut() {
                node.remove("matrix");
            }
            node["skin"] = skinned.skin.into();
            let joints = self.binary.joints(skinned.rest.iter().map(|vertex| vertex.joints));
            let weights = self.binary.vectors("VEC4", skinned.rest.iter().map(|vertex| vertex.weights));
            // An object without a mesh in glTF has no vertices.
            if let Some(mesh) = self.nodes[skinned.object as usize]["mesh"].as_u64() {
                let attributes = &mut self.meshes[mesh as usize]["primitives"][0]["attributes"];
                attributes["JOINTS_0"] = joints.into();
                attributes["WEIGHTS_0"] = weights.into();
            }
        }
        Ok(())
    }

    /// The nodes of each skin, and their keys.
    pub(super) fn skeletons(&mut self, scene: &Scene, samples: &[Sample]) {
        let Motion::Nodes(nodes) = &scene.motion else { return };
        let times = if samples.is_empty() || scene.skins.is_empty() { None } else { Some(self.times(samples)) };
        for (index, skin) in scene.skins.iter().enumerate() {
            let anchor = self.nodes.len();
            let world_from_anchor = |seconds: f64| nodes.world_from_node(skin.anchor(), seconds).unwrap_or_default();
            self.bone(format!("skin {index}").into(), samples, times, &world_from_anchor);
            self.roots.push(anchor);
            for bone in skin.bones() {
                let node = self.nodes.len();
                self.bone(None, samples, times, &|seconds| nodes.nodes()[bone.node].parent_from_node(seconds));
                let parent = bone.parent.map_or(anchor, |parent| anchor + 1 + parent);
                match self.nodes[parent]["children"].as_array_mut() {
                    Some(children) => children.push(node.into()),
                    None => self.nodes[parent]["children"] = json!([node]),
                }
            }
            let joints: Vec<usize> =
                skin.joints().iter().map(|joint| joint.bone.map_or(anchor, |bone| anchor + 1 + bone)).collect();
            let inverse_binds = skin.joints().iter().map(|joint| {
                let [x, y, z, at] = joint.joint_from_rest.as_affine3a().to_cols_array_2d();
                [x[0], x[1], x[2], 0.0, y[0], y[1], y[2], 0.0, z[0], z[1], z[2], 0.0, at[0], at[1], at[2], 1.0]
            });
            let inverse_binds = self.binary.vectors("MAT4", inverse_binds);
            self.skins.push(json!({ "joints": joints, "inverseBindMatrices": inverse_binds }));
        }
    }

    /// A node that is somewhere in its parent at each time.
    fn bone(
        &mut self,
        name: Option<String>,
        samples: &[Sample],
        times: Option<usize>,
        place: &dyn Fn(f64) -> DAffine3,
    ) {
        let node = self.nodes.len();
        self.nodes.push(json!({ "matrix": matrix(&place(0.0)) }));
        if let Some(name) = name {
            self.nodes[node]["name"] = name.into();
        }
        let keys: Vec<DAffine3> = samples.iter().map(|sample| place(sample.seconds)).collect();
        if let Some(times) = times.filter(|_| keys.iter().any(|key| *key != keys[0])) {
            self.parts(node, times, &keys);
        }
    }
}
