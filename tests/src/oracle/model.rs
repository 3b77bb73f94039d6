//! A glTF file as the oracle evaluates it: nodes, tracks, skins and morph targets, in `f64`, straight from the specification, without
//! the crates that import and draw it.

use super::{mirrors, Mask, Side, Surface, Triangle};
use glam::{DAffine3, DMat3, DQuat, DVec2, DVec3};
use std::rc::Rc;

/// The interpolation between the keys of a track (glTF 2.0, appendix C).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// Holds each value until the next key.
    Step,
    /// Straight lines, and along the shorter arc for rotations.
    Linear,
    /// Hermite splines.
    Cubic,
}

/// The property of a node that a track animates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// Three numbers, metres.
    Translation,
    /// A unit quaternion: x, y, z, w.
    Rotation,
    /// Three factors.
    Scale,
    /// A number for each morph target.
    Weights,
}

/// An animated property of a node.
#[derive(Clone, Debug)]
pub struct Track {
    /// The animated property.
    pub target: Target,
    /// The interpolation between keys.
    pub interpolation: Interpolation,
    /// Seconds, ascending.
    pub times: Vec<f32>,
    /// A value for each key; for splines an in-tangent, a value and an out-tangent.
    pub values: Vec<Vec<f32>>,
}

/// A node. Its parent comes before it.
#[derive(Clone, Debug)]
pub struct Node {
    /// The node it hangs on.
    pub parent: Option<usize>,
    /// Translation, rotation and scale where no track says otherwise.
    pub place: (DVec3, DQuat, DVec3),
    /// The mesh that it shows.
    pub mesh: Option<usize>,
    /// The skin that deforms the mesh.
    pub skin: Option<usize>,
    /// Animated properties.
    pub tracks: Vec<Track>,
}

/// A mesh of one primitive.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Positions of vertices.
    pub positions: Vec<[f32; 3]>,
    /// Three a triangle.
    pub indices: Vec<u32>,
    /// For each morph target, how far each vertex moves.
    pub targets: Vec<Vec<[f32; 3]>>,
    /// For skinned meshes: joints of each vertex, and their weights, which add up to 1.
    pub influences: Vec<([u8; 4], [f32; 4])>,
    /// Alpha of each vertex in 1/255; empty for 255.
    pub alpha: Vec<u8>,
    /// Places on the texture.
    pub coordinates: Vec<[f32; 2]>,
    /// Its material.
    pub material: Material,
}

/// The material properties that decide where a surface shows.
#[derive(Clone, Debug, Default)]
pub struct Material {
    /// Both sides show.
    pub double_sided: bool,
    /// Alpha-tested: where alpha is at least this.
    pub cutoff: Option<f32>,
    /// The factor of its alpha.
    pub alpha: f32,
    /// The texels of a side of its square texture, and their alpha.
    pub texture: Option<(u32, Vec<u8>)>,
}

/// A skin: joints as nodes, and their inverse bind matrices.
#[derive(Clone, Debug)]
pub struct Skin {
    /// Nodes.
    pub joints: Vec<usize>,
    /// For each joint: the joint from the mesh at rest.
    pub inverse_binds: Vec<DAffine3>,
}

/// A file.
#[derive(Clone, Debug, Default)]
pub struct Model {
    /// Nodes, parents before children.
    pub nodes: Vec<Node>,
    /// Meshes.
    pub meshes: Vec<Mesh>,
    /// Skins.
    pub skins: Vec<Skin>,
}

impl Track {
    /// Returns its value at a time.
    fn at(&self, seconds: f64) -> Vec<f64> {
        let count = self.times.len();
        let time = |key: usize| f64::from(self.times[key]);
        let value = |place: usize| self.values[place].iter().map(|part| f64::from(*part)).collect::<Vec<f64>>();
        let at_key = |key: usize| value(if self.interpolation == Interpolation::Cubic { 3 * key + 1 } else { key });
        let after = (0..count).filter(|key| time(*key) <= seconds).count();
        if after == 0 || after == count || self.interpolation == Interpolation::Step {
            return at_key(after.saturating_sub(1));
        }
        let (length, key) = (time(after) - time(after - 1), after - 1);
        let t = (seconds - time(key)) / length;
        let (from, to) = (at_key(key), at_key(after));
        let sum = |parts: &[(f64, &[f64])]| {
            (0..from.len()).map(|at| parts.iter().map(|(weight, of)| weight * of[at]).sum()).collect::<Vec<f64>>()
        };
        match self.interpolation {
            Interpolation::Linear if self.target == Target::Rotation => {
                DQuat::from_slice(&from).normalize().slerp(DQuat::from_slice(&to).normalize(), t).to_array().to_vec()
            }
            Interpolation::Linear => sum(&[(1.0 - t, &from), (t, &to)]),
            _ => {
                let (leaves, arrives) = (value(3 * key + 2), value(3 * after));
                let (t2, t3) = (t * t, t * t * t);
                sum(&[
                    (2.0 * t3 - 3.0 * t2 + 1.0, &from),
                    (length * (t3 - 2.0 * t2 + t), &leaves),
                    (3.0 * t2 - 2.0 * t3, &to),
                    (length * (t3 - t2), &arrives),
                ])
            }
        }
    }
}

impl Node {
    fn animated(&self, target: Target, seconds: f64) -> Option<Vec<f64>> {
        self.tracks.iter().find(|track| track.target == target).map(|track| track.at(seconds))
    }

    fn parent_from_node(&self, seconds: f64) -> DAffine3 {
        let (translation, rotation, scale) = self.place;
        let three = |target, still| self.animated(target, seconds).map_or(still, |at| DVec3::from_slice(&at));
        let rotation =
            self.animated(Target::Rotation, seconds).map_or(rotation, |at| DQuat::from_slice(&at).normalize());
        let linear = DMat3::from_quat(rotation) * DMat3::from_diagonal(three(Target::Scale, scale));
        DAffine3 { matrix3: linear, translation: three(Target::Translation, translation) }
    }
}

impl Model {
    fn world_from_nodes(&self, seconds: f64) -> Vec<DAffine3> {
        let mut world: Vec<DAffine3> = Vec::new();
        for node in &self.nodes {
            let parent = node.parent.map_or(DAffine3::IDENTITY, |parent| world[parent]);
            world.push(parent * node.parent_from_node(seconds));
        }
        world
    }

    /// The surfaces of the scene at a time: an object for each node that has a mesh, in the order of nodes.
    pub fn surfaces(&self, seconds: f64) -> Vec<Surface> {
        let world = self.world_from_nodes(seconds);
        let shown = self.nodes.iter().enumerate().filter_map(|(number, node)| Some((number, node, node.mesh?)));
        let surface = |(object, (number, node, mesh)): (usize, (usize, &Node, usize))| {
            let mesh = &self.meshes[mesh];
            let morphed = mesh.morphed(&node.animated(Target::Weights, seconds).unwrap_or_default());
            let (positions, mirrored) = match node.skin {
                None => {
                    let place = |position: &DVec3| world[number].transform_point3(*position);
                    (morphed.iter().map(place).collect(), mirrors(&world[number].matrix3))
                }
                Some(skin) => self.skins[skin].skinned(mesh, &morphed, &world),
            };
            mesh.surface(object as u32, &positions, mirrored)
        };
        shown.enumerate().map(surface).collect()
    }
}

impl Skin {
    /// Returns the vertices in the world, and whether the mesh is mirrored. A skinned mesh goes where its joints are, wherever its own
    /// node is (glTF 2.0, 3.7.3.3). It is mirrored if most of its weight is on joints that mirror.
    fn skinned(&self, mesh: &Mesh, morphed: &[DVec3], world: &[DAffine3]) -> (Vec<DVec3>, bool) {
        let joints: Vec<DAffine3> =
            self.joints.iter().zip(&self.inverse_binds).map(|(joint, bind)| world[*joint] * *bind).collect();
        let (mut positions, mut vote) = (Vec::new(), 0.0);
        for (position, (carriers, weights)) in morphed.iter().zip(&mesh.influences) {
            let mut place = DVec3::ZERO;
            for (carrier, weight) in carriers.iter().zip(weights) {
                let joint = &joints[*carrier as usize];
                place += f64::from(*weight) * joint.transform_point3(*position);
                vote += f64::from(*weight) * joint.matrix3.determinant().signum();
            }
            positions.push(place);
        }
        (positions, vote < 0.0)
    }
}

impl Mesh {
    fn morphed(&self, weights: &[f64]) -> Vec<DVec3> {
        let vertex = |(number, position): (usize, &[f32; 3])| {
            let moved = self.targets.iter().zip(weights);
            let moved = moved.map(|(target, weight)| *weight * DVec3::from(target[number].map(f64::from)));
            DVec3::from(position.map(f64::from)) + moved.sum::<DVec3>()
        };
        self.positions.iter().enumerate().map(vertex).collect()
    }

    fn surface(&self, object: u32, positions: &[DVec3], mirrored: bool) -> Surface {
        let triangle = |corners: &[u32]| {
            let corners = [0, 1, 2].map(|at| corners[at] as usize);
            Triangle {
                corners: corners.map(|vertex| positions[vertex]),
                alpha: corners.map(|vertex| self.alpha.get(vertex).map_or(1.0, |alpha| f64::from(*alpha) / 255.0)),
                coordinates: corners.map(|vertex| {
                    self.coordinates.get(vertex).map_or(DVec2::ZERO, |at| DVec2::from(at.map(f64::from)))
                }),
            }
        };
        let texture = self.material.texture.as_ref().map(|(side, alpha)| scenes::Texture {
            size: [*side; 2],
            texels: alpha.iter().map(|alpha| [255, 255, 255, *alpha]).collect(),
            ..scenes::Texture::default()
        });
        Surface {
            object,
            triangles: self.indices.chunks_exact(3).map(triangle).collect(),
            side: match (self.material.double_sided, mirrored) {
                (true, _) => Side::Both,
                (false, true) => Side::Clockwise,
                (false, false) => Side::CounterClockwise,
            },
            mask: self.material.cutoff.map(|cutoff| Mask {
                cutoff: f64::from(cutoff),
                factor: f64::from(self.material.alpha),
                texture: texture.map(Rc::new),
            }),
        }
    }
}
