//! Node animation: the tracks of all animations of a file, and the part of the node tree that they move.

use super::accessor::{Accessors, Allowed};
use super::document::{Document, NO_NODE};
use super::fault::{broken, element, label, Fault, Outcome};
use super::tree::{matrix, node_label, unit, Tree};
use crate::animation::{AnimatedNode, Interpolate, Interpolation, Local, Track};
use glam::{DAffine3, DQuat, DVec3};
use gltf::json::animation::{Interpolation as Between, Property};
use gltf::json::validation::Checked::Valid;
use gltf::json::{Animation, Index};

/// The tracks on one node.
#[derive(Default)]
struct Tracks {
    translation: Option<Track<DVec3>>,
    rotation: Option<Track<DQuat>>,
    scale: Option<Track<DVec3>>,
}

impl Tracks {
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
        for (index, animation) in document.root.animations.iter().enumerate() {
            for at in 0..animation.channels.len() {
                read_channel(document, accessors, (index, animation), at, &mut tracks).map_err(|fault| {
                    fault.within(|| format!("{}, channel {at}", label("animation", index, animation.name.as_deref())))
                })?;
            }
        }
        let mut moves = vec![false; tracks.len()];
        for &node in &tree.order {
            moves[node] = tracks[node].any() || tree.parents[node].is_some_and(|parent| moves[parent]);
        }
        Ok(Moving { tracks, moves })
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

fn read_channel(
    document: &Document,
    accessors: &Accessors,
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
    let inputs = || -> Outcome<Vec<f64>> {
        let times = accessors.vectors::<1>(sampler.input, Allowed::Floats)?;
        Ok(times.into_iter().map(|[time]| f64::from(time)).collect())
    };
    let vectors = || -> Outcome<Vec<DVec3>> {
        let values = accessors.vectors::<3>(sampler.output, Allowed::Floats)?;
        Ok(values.into_iter().map(|value| DVec3::from_array(value.map(f64::from))).collect())
    };
    let tracks = &mut tracks[node.value()];
    match target.path {
        Valid(Property::Translation) if tracks.translation.is_none() => {
            tracks.translation = Some(track(interpolation, inputs()?, vectors()?)?)
        }
        Valid(Property::Scale) if tracks.scale.is_none() => {
            tracks.scale = Some(track(interpolation, inputs()?, vectors()?)?)
        }
        Valid(Property::Rotation) if tracks.rotation.is_none() => {
            let values = accessors.vectors::<4>(sampler.output, Allowed::Normalized)?;
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
            tracks.rotation = Some(track(interpolation, inputs()?, values)?);
        }
        Valid(_) => {}
        _ => {
            let other = said(&format!("channels/{at}/target/path"));
            return broken(format!("its path '{other}' is none of translation, rotation, scale and weights"));
        }
    }
    Ok(())
}

fn track<T: Interpolate>(interpolation: Interpolation, times: Vec<f64>, values: Vec<T>) -> Outcome<Track<T>> {
    Track::new(interpolation, times, values).map_err(Fault::Broken)
}
