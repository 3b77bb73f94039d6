//! Node animation: the tracks of all animations of a file, and the part of the node tree that they move.

use super::accessor::{Accessors, Allowed};
use super::document::{Document, NO_NODE};
use super::fault::{broken, element, label, Fault, Outcome};
use super::tree::{matrix, node_label, unit, Tree};
use crate::animation::{AnimatedNode, Interpolate, Interpolation, Local, Track};
use glam::{DAffine3, DQuat, DVec3};
use gltf::json::accessor::Accessor;
use gltf::json::animation::{Interpolation as Between, Property};
use gltf::json::mesh::Primitive;
use gltf::json::validation::Checked::Valid;
use gltf::json::{Animation, Index, Mesh};
use std::collections::HashMap;
use std::sync::Arc;

/// A key of a channel counts as so many elements. Any number of channels may use one sampler, and each channel has a copy of its values
/// (up to 32 bytes each), which is searched for its range.
const KEY_COST: u64 = 16;

/// The tracks on one node.
#[derive(Default)]
struct Tracks {
    translation: Option<Track<DVec3>>,
    rotation: Option<Track<DQuat>>,
    scale: Option<Track<DVec3>>,
    /// One for each morph target of the node's mesh.
    weights: Option<Vec<Track<f64>>>,
}

impl Tracks {
    /// True if some track moves the node itself.
    fn any(&self) -> bool {
        self.translation.is_some() || self.rotation.is_some() || self.scale.is_some()
    }
}

/// Which nodes move, and how. All animations of the file play at once; where two move the same property of a node, the first wins.
pub(super) struct Moving {
    tracks: Vec<Tracks>,
    /// Whether each node moves: by itself or with an ancestor.
    moves: Vec<bool>,
}

impl Moving {
    pub(super) fn read(document: &Document, accessors: &Accessors, tree: &Tree) -> Outcome<Self> {
        let mut tracks: Vec<Tracks> = document.root.nodes.iter().map(|_| Tracks::default()).collect();
        let mut shared = Shared { targets: target_counts(document), times: HashMap::new() };
        for (index, animation) in document.root.animations.iter().enumerate() {
            for at in 0..animation.channels.len() {
                read_channel(document, (accessors, &mut shared), (index, animation), at, &mut tracks).map_err(
                    |fault| {
                        fault.within(|| {
                            format!("{}, channel {at}", label("animation", index, animation.name.as_deref()))
                        })
                    },
                )?;
            }
        }
        let mut moves = vec![false; tracks.len()];
        for &node in &tree.order {
            moves[node] = tracks[node].any() || tree.parents[node].is_some_and(|parent| moves[parent]);
        }
        Ok(Moving { tracks, moves })
    }

    /// The animated weights of the morph targets of the node's mesh; none if nothing animates them.
    pub(super) fn weights(&self, node: usize) -> Option<&[Track<f64>]> {
        self.tracks[node].weights.as_deref()
    }

    /// Whether the node moves: by itself or with an ancestor.
    pub(super) fn moves(&self, node: usize) -> bool {
        self.moves[node]
    }

    /// The moving nodes that carry one of `carriers`, and all `bones`, parents first, and the place of each of the file's nodes in that list.
    pub(super) fn into_nodes(
        mut self,
        document: &Document,
        tree: &Tree,
        (carriers, bones): (&[usize], &[usize]),
    ) -> Outcome<(Vec<AnimatedNode>, Vec<Option<usize>>)> {
        let mut needed = vec![false; self.moves.len()];
        for &bone in bones {
            needed[bone] = true;
        }
        let above_bones = bones.iter().filter_map(|bone| tree.parents[*bone]);
        for carrier in carriers.iter().copied().chain(above_bones) {
            let mut node = Some(carrier);
            while let Some(at) = node.filter(|&at| self.moves[at] && !needed[at]) {
                needed[at] = true;
                node = tree.parents[at];
            }
        }
        let mut places = vec![None; needed.len()];
        let mut nodes = Vec::new();
        for &node in tree.order.iter().filter(|&&node| needed[node]) {
            let parent = tree.parents[node];
            let tracks = std::mem::take(&mut self.tracks[node]);
            let local = if tracks.any() { in_parts(&tree.locals[node]) } else { Ok(tree.locals[node]) };
            let animated = AnimatedNode {
                parent: parent.and_then(|parent| places[parent]),
                world_from_root: parent.map_or(DAffine3::IDENTITY, |parent| tree.world_from_node[parent]),
                local: local.map_err(|fault| fault.within(|| node_label(document, node)))?,
                translation: tracks.translation,
                rotation: tracks.rotation,
                scale: tracks.scale,
            };
            places[node] = Some(nodes.len());
            nodes.push(animated);
        }
        Ok((nodes, places))
    }
}

/// Animated nodes must not have a matrix, but some exporters write one; it is taken apart.
fn in_parts(local: &Local) -> Outcome<Local> {
    if let Local::Parts { .. } = local {
        return Ok(*local);
    }
    let (scale, rotation, translation) = matrix(local).to_scale_rotation_translation();
    if !(scale.is_finite() && rotation.is_finite()) {
        return broken("it is animated, but its matrix cannot be split into rotation and scale; give it these instead");
    }
    Ok(Local::Parts { translation, rotation, scale })
}

/// What the channels of a file have in common.
struct Shared {
    /// The number of morph targets of each mesh.
    targets: Vec<usize>,
    /// Key times in seconds, by accessor. Most files have many tracks with the same times.
    times: HashMap<Index<Accessor>, Arc<[f64]>>,
}

impl Shared {
    /// Reads key times, or finds those read before.
    fn times(&mut self, accessors: &Accessors, index: Index<Accessor>) -> Outcome<Arc<[f64]>> {
        if let Some(times) = self.times.get(&index) {
            return Ok(times.clone());
        }
        let times = keys::<1>(accessors, index, Allowed::Floats)?;
        let times: Arc<[f64]> = times.into_iter().map(|[time]| f64::from(time)).collect();
        self.times.insert(index, times.clone());
        Ok(times)
    }
}

/// Reads the times or values of keys. They count as more than other elements.
fn keys<const N: usize>(accessors: &Accessors, index: Index<Accessor>, allowed: Allowed) -> Outcome<Vec<[f32; N]>> {
    let keys = accessors.vectors(index, allowed)?;
    accessors.spend((KEY_COST - 1) * keys.len() as u64)?;
    Ok(keys)
}

fn read_channel(
    document: &Document,
    (accessors, shared): (&Accessors, &mut Shared),
    (index, animation): (usize, &Animation),
    at: usize,
    tracks: &mut [Tracks],
) -> Outcome<()> {
    let said = |property: &str| document.said(&format!("/animations/{index}/{property}"));
    let (of_file, target) = (animation.channels[at].sampler.value(), &animation.channels[at].target);
    let Some(sampler) = animation.samplers.get(of_file) else {
        return broken(format!("it refers to sampler {of_file}, but the animation has {}", animation.samplers.len()));
    };
    let node = target.node;
    if node == Index::new(NO_NODE) {
        return Ok(());
    }
    element(&document.root, node, "node")?;
    let interpolation = match sampler.interpolation {
        Valid(Between::Linear) => Interpolation::Linear,
        Valid(Between::Step) => Interpolation::Step,
        Valid(Between::CubicSpline) => Interpolation::CubicSpline,
        _ => {
            let other = said(&format!("samplers/{of_file}/interpolation"));
            return broken(format!("its interpolation '{other}' is none of LINEAR, STEP and CUBICSPLINE"));
        }
    };
    let vectors = || -> Outcome<Vec<DVec3>> {
        let values = keys::<3>(accessors, sampler.output, Allowed::Floats)?;
        Ok(values.into_iter().map(|value| DVec3::from_array(value.map(f64::from))).collect())
    };
    let tracks = &mut tracks[node.value()];
    match target.path {
        Valid(Property::Translation) if tracks.translation.is_none() => {
            tracks.translation = Some(track(interpolation, shared.times(accessors, sampler.input)?, vectors()?)?)
        }
        Valid(Property::Scale) if tracks.scale.is_none() => {
            tracks.scale = Some(track(interpolation, shared.times(accessors, sampler.input)?, vectors()?)?)
        }
        Valid(Property::Rotation) if tracks.rotation.is_none() => {
            let values = keys::<4>(accessors, sampler.output, Allowed::Normalized)?;
            let values = values.into_iter().map(|value| DQuat::from_array(value.map(f64::from)));
            // Tangents of splines are no rotations: only values get unit length.
            let values = if interpolation == Interpolation::CubicSpline {
                values
                    .enumerate()
                    .map(|(at, value)| if at % 3 == 1 { unit(value) } else { Ok(value) })
                    .collect::<Outcome<_>>()?
            } else {
                values.map(unit).collect::<Outcome<_>>()?
            };
            tracks.rotation = Some(track(interpolation, shared.times(accessors, sampler.input)?, values)?);
        }
        Valid(Property::MorphTargetWeights) if tracks.weights.is_none() => {
            let mesh = document.root.nodes[node.value()].mesh;
            let targets = mesh.and_then(|mesh| shared.targets.get(mesh.value())).copied().unwrap_or(0);
            if targets > 0 {
                let values = keys::<1>(accessors, sampler.output, Allowed::Normalized)?;
                let read = weights(interpolation, shared.times(accessors, sampler.input)?, &values, targets);
                tracks.weights = Some(read.map_err(|fault| fault.within(|| node_label(document, node.value())))?);
            }
        }
        Valid(_) => {}
        _ => {
            let other = said(&format!("channels/{at}/target/path"));
            return broken(format!("its path '{other}' is none of translation, rotation, scale and weights"));
        }
    }
    Ok(())
}

/// Counts the morph targets of each mesh.
fn target_counts(document: &Document) -> Vec<usize> {
    let of_primitive = |primitive: &Primitive| primitive.targets.as_ref().map_or(0, Vec::len);
    let of_mesh = |mesh: &Mesh| mesh.primitives.iter().map(of_primitive).max().unwrap_or(0);
    document.root.meshes.iter().map(of_mesh).collect()
}

/// Makes a track for each target. Each key has the weights of all targets; a key of a spline has all in-tangents, then all weights,
/// then all out-tangents (glTF 2.0, section 3.11).
fn weights(
    interpolation: Interpolation,
    times: Arc<[f64]>,
    values: &[[f32; 1]],
    targets: usize,
) -> Outcome<Vec<Track<f64>>> {
    let each = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    if times.len().checked_mul(each).and_then(|count| count.checked_mul(targets)) != Some(values.len()) {
        return broken(format!(
            "{} weights for {} keys of {targets} morph targets, which need {each} each",
            values.len(),
            times.len()
        ));
    }
    let of_target = |target: usize| {
        let values = values.chunks_exact(targets).map(|weights| f64::from(weights[target][0]));
        track(interpolation, times.clone(), values.collect())
    };
    (0..targets).map(of_target).collect()
}

fn track<T: Interpolate>(interpolation: Interpolation, times: Arc<[f64]>, values: Vec<T>) -> Outcome<Track<T>> {
    Track::with_times(interpolation, times, values).map_err(Fault::Broken)
}
