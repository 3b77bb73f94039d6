//! Morph targets and their animated weights.

use super::motion::Sample;
use super::Export;
use crate::animation::Motion;
use crate::model::Scene;
use crate::morph::{Deformed, Displacement, MorphTarget};
use glam::Vec3;
use serde_json::{json, Value};

impl Export {
    /// Writes the morph targets of a mesh; null if there are none.
    pub(super) fn targets(&mut self, scene: &Scene, mesh: u32) -> Value {
        let Some(Deformed { targets, rest, .. }) = scene.deformation_of(mesh) else { return Value::Null };
        let target = |target: &MorphTarget| {
            let mut all = vec![[Vec3::ZERO; 2]; rest.len()];
            for Displacement { vertex, position, normal } in &target.displacements {
                all[*vertex as usize] = [*position, *normal];
            }
            let normals = self.binary.vectors("VEC3", all.iter().map(|[_, normal]| normal.to_array()));
            let positions: Vec<Vec3> = all.iter().map(|[position, _]| *position).collect();
            json!({ "POSITION": self.binary.positions(&positions, None), "NORMAL": normals })
        };
        let targets: Vec<Value> = targets.iter().map(target).collect();
        if targets.is_empty() {
            Value::Null
        } else {
            targets.into()
        }
    }

    /// Writes the weights of each object whose mesh has targets, at every sample.
    pub(super) fn weights(&mut self, scene: &Scene, samples: &[Sample]) {
        let Motion::Nodes(nodes) = &scene.motion else { return };
        if samples.is_empty() || nodes.weights().is_empty() {
            return;
        }
        let times = self.times(samples);
        for (index, object) in scene.objects.iter().enumerate() {
            let Some(deformed) = scene.deformation_of(object.mesh).filter(|it| !it.targets.is_empty()) else {
                continue;
            };
            let tracks = deformed.targets.iter().map(|target| &nodes.weights()[target.weight as usize]);
            let tracks: Vec<_> = tracks.collect();
            let values = samples.iter().flat_map(|sample| tracks.iter().map(|track| [track.at(sample.seconds) as f32]));
            let output = self.binary.vectors("SCALAR", values);
            self.channel(index, "weights", times, output);
        }
    }
}
