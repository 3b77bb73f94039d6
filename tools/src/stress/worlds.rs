//! Small worlds, each hard in one way, with a camera that stands still, moves, turns and jumps.

pub mod chance;
pub mod materials;
pub mod special;

pub use chance::chance;
pub use special::{oblique, special, special_projections};

use crate::stress::Random;
use glam::{DAffine3, DMat3, DVec3, Vec3};
use scenes::{Mesh, Object, Pose, Projection, Scene, Shot, Surface, Topology};

/// A scene, what the camera does in it, and the picture's size.
#[derive(Clone, Debug)]
pub struct Case {
    /// Shown in faults.
    pub name: String,
    /// The scene.
    pub scene: Scene,
    /// One a frame.
    pub shots: Vec<Shot>,
    /// Width and height in pixels.
    pub size: [u32; 2],
}

/// An odd size, so that no level of a pyramid is even.
pub const SIZE: [u32; 2] = [161, 97];

/// The camera of most cases.
pub const PERSPECTIVE: Projection = Projection::Perspective { fov_y: 1.0, near: 0.1, far: Some(200.0) };

/// A scene in the making.
#[derive(Clone, Debug, Default)]
pub struct Maker {
    /// What was made so far.
    pub scene: Scene,
    random: Option<Random>,
}

impl Maker {
    /// An empty scene.
    pub fn new(name: &str) -> Self {
        Maker { scene: Scene { name: name.into(), ..Scene::default() }, random: Some(Random::new(7)) }
    }

    /// Takes a mesh.
    pub fn mesh(&mut self, mesh: Mesh) -> u32 {
        self.scene.meshes.push(mesh);
        (self.scene.meshes.len() - 1) as u32
    }

    /// Places a mesh, in a colour of its own.
    pub fn place(&mut self, mesh: u32, world_from_object: DAffine3) {
        let colour = self
            .random
            .as_mut()
            .map_or([1.0; 4], |random| [random.unit() as f32, random.unit() as f32, random.unit() as f32, 1.0]);
        let name = format!("{} {}", self.scene.meshes[mesh as usize].name, self.scene.objects.len());
        self.scene.objects.push(Object {
            name,
            mesh,
            world_from_object,
            colour,
            dynamic: false,
            translucent: false,
            masked: false,
            surface: Surface::default(),
        });
    }
}

/// A mesh with normals that point away from its middle.
pub fn mesh(name: &str, topology: Topology, positions: Vec<Vec3>, indices: Vec<u32>) -> Mesh {
    let normals = positions.iter().map(|position| position.normalize_or(Vec3::Z)).collect();
    Mesh { name: name.into(), topology, positions, normals, indices, ..Mesh::default() }
}

/// The cube from -1/2 to 1/2.
pub fn cube() -> Mesh {
    let corner = |index: u32| Vec3::new((index & 1) as f32, (index >> 1 & 1) as f32, (index >> 2) as f32) - 0.5;
    let faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
    let indices = faces.iter().flat_map(|[a, b, c, d]| [*a, *b, *c, *a, *c, *d]).collect();
    mesh("cube", Topology::Triangles, (0..8).map(corner).collect(), indices)
}

/// The square from -1/2 to 1/2 in x and y.
pub fn square() -> Mesh {
    let corners = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]].map(|[x, y]| Vec3::new(x, y, 0.0));
    mesh("square", Topology::Triangles, corners.to_vec(), vec![0, 1, 2, 0, 2, 3])
}

/// The edges of the cube.
pub fn wires() -> Mesh {
    let pairs = (0..8u32).flat_map(|from| [1, 2, 4].map(|axis| (from, from | axis)));
    let edges = pairs.filter(|(from, to)| from != to).flat_map(|(from, to)| [from, to]).collect();
    Mesh { name: "wires".into(), topology: Topology::Lines, indices: edges, ..cube() }
}

/// Points in the cube.
pub fn dust(random: &mut Random, count: u32) -> Mesh {
    let positions = (0..count).map(|_| (random.vector() * 0.5).as_vec3()).collect();
    mesh("dust", Topology::Points, positions, (0..count).collect())
}

/// Somewhere, scaled along the axes.
pub fn sized(at: DVec3, size: DVec3) -> DAffine3 {
    DAffine3 { matrix3: DMat3::from_diagonal(size), translation: at }
}

/// Somewhere, scaled and turned by chance.
pub fn turned(random: &mut Random, at: DVec3, size: DVec3) -> DAffine3 {
    DAffine3 { matrix3: DMat3::from_quat(random.turn()) * DMat3::from_diagonal(size), translation: at }
}

/// A shot at time 0.
pub fn shot(eye: DVec3, target: DVec3, projection: Projection) -> Shot {
    Shot { pose: Pose::looking_at(eye, target), projection, seconds: 0.0 }
}

/// A camera that looks, stays, creeps, turns away, comes near, jumps to the other side and back.
pub fn wander(eye: DVec3, target: DVec3, projection: Projection) -> Vec<Shot> {
    let arm = eye - target;
    let at = |eye: DVec3, target: DVec3| shot(eye, target, projection);
    let aside = DVec3::new(0.02, 0.01, 0.0) * arm.length();
    let across = DVec3::new(-arm.z, 0.3 * arm.length(), arm.x);
    vec![
        at(eye, target),
        at(eye, target),
        at(eye + aside, target),
        at(eye + aside, eye + across),
        at(target + 0.4 * arm, target),
        at(target - arm, target),
        at(eye, target),
    ]
}

impl Case {
    /// A case of the standard size.
    pub fn new(name: &str, scene: Scene, shots: Vec<Shot>) -> Self {
        Case { name: name.into(), scene, shots, size: SIZE }
    }

    /// The same case in another size.
    pub fn sized(&self, size: [u32; 2]) -> Self {
        Case { name: format!("{} at {}x{}", self.name, size[0], size[1]), size, ..self.clone() }
    }

    /// The same case with other shots.
    pub fn filmed(&self, shots: Vec<Shot>) -> Self {
        Case { shots, ..self.clone() }
    }
}

/// A wall with bodies behind, beside and before it: something is hidden from everywhere.
pub fn walled(bodies: usize) -> Case {
    let mut maker = Maker::new("walled");
    let mut random = Random::new(3);
    let cube = maker.mesh(cube());
    maker.place(cube, sized(DVec3::ZERO, DVec3::new(9.0, 6.0, 0.4)));
    for body in 0..bodies {
        let depth = if body % 5 == 0 { random.range(0.5, 3.0) } else { random.range(-9.0, -0.5) };
        let at = DVec3::new(random.range(-7.0, 7.0), random.range(-4.0, 4.0), depth);
        let size = random.range(0.1, 0.9);
        let place = turned(&mut random, at, DVec3::splat(size));
        maker.place(cube, place);
    }
    Case::new("walled", maker.scene, wander(DVec3::new(0.7, 0.4, 7.0), DVec3::ZERO, PERSPECTIVE))
}
