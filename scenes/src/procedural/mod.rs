//! Scenes made by rule from a seed, at any size. The same options always give the same bytes.

mod bad_bounds;
mod balloons;
mod boxes;
mod city_block;
mod detail;
mod factory;
mod fantasy;
mod forest;
mod furniture;
mod jellyfish;
mod lane;
mod monsters;
mod moving_boxes;
mod nature;
mod parts;
mod powerplant;
mod radial_city;
mod random;
mod rooms;
mod satellite;
mod tentacles;
mod terrain;
mod yeahrights;

use crate::camera::{Camera, Pose, Projection};
use crate::model::{Aabb, Building, Mesh, Object, Scene, Surface, Walk};
use detail::Detail;
use glam::{DAffine3, DMat3, DVec3};
use parts::Parts;

pub use detail::MOST_DETAIL;

/// What a procedural scene can be asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneOptions {
    /// How many objects, as a multiple of the scene's standard; above 0. Files ignore it.
    pub scale: f64,
    /// Which of the scenes of this kind. Files ignore it.
    pub seed: u64,
    /// How finely meshes are divided, up to [`MOST_DETAIL`]: each level has about four times the triangles of the one before.
    /// Heeded by the papers' scenes, see [`Entry::by_detail`]; files and the other scenes ignore it.
    pub detail: u32,
}

impl Default for SceneOptions {
    fn default() -> Self {
        SceneOptions { scale: 1.0, seed: 1, detail: Detail::default().level() }
    }
}

/// One kind of procedural scene.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// Name on the command line and in results.
    pub name: &'static str,
    /// The short name in the papers' tables; empty if there is none.
    pub alias: &'static str,
    /// One line for `sightline scene`.
    pub about: &'static str,
    /// [`SceneOptions::detail`] changes it.
    pub by_detail: bool,
    /// Makes it.
    pub make: fn(&SceneOptions) -> Scene,
}

/// All procedural scenes.
pub const SCENES: &[Entry] = &[
    Entry {
        name: "city-block",
        alias: "cb",
        about: "streets between closed house fronts with furnished interiors: 94,000 objects, nearly all hidden",
        by_detail: false,
        make: city_block::make,
    },
    Entry {
        name: "balloons",
        alias: "bl",
        about: "balloons with tiny baskets in the air, many behind one another: 35,000 objects",
        by_detail: true,
        make: balloons::make_still,
    },
    Entry {
        name: "moving-balloons",
        alias: "",
        about: "balloons, all of which drift and turn",
        by_detail: true,
        make: balloons::make_moving,
    },
    Entry {
        name: "powerplant",
        alias: "pp",
        about: "a steel frame full of pipes, girders and gratings: 8,868 objects, heavy and thin",
        by_detail: true,
        make: powerplant::make,
    },
    Entry {
        name: "monsters",
        alias: "mo",
        about: "a camp of monsters in wooded hills, as in a game: 6,300 objects of few triangles",
        by_detail: true,
        make: monsters::make,
    },
    Entry {
        name: "yeahrights",
        alias: "yr",
        about: "60 tangles of tubes with very many triangles each",
        by_detail: true,
        make: yeahrights::make,
    },
    Entry {
        name: "fantasy",
        alias: "fn",
        about: "a walled town with a castle above woods: 7,437 objects",
        by_detail: true,
        make: fantasy::make,
    },
    Entry {
        name: "factory",
        alias: "fc",
        about: "closed halls full of machines along streets: 46,600 objects, nearly all hidden",
        by_detail: true,
        make: factory::make,
    },
    Entry {
        name: "radial-city",
        alias: "rc",
        about: "a city of towers on rings and spokes: 73,812 objects of few triangles",
        by_detail: true,
        make: radial_city::make,
    },
    Entry {
        name: "satellite",
        alias: "st",
        about: "satellites among stones of all sizes: 120,000 objects, heavy and mostly in the open",
        by_detail: true,
        make: satellite::make,
    },
    Entry {
        name: "forest",
        alias: "",
        about: "trees, bushes and ferns of masked leaves, crystals of glass: 12,000 objects",
        by_detail: false,
        make: forest::make,
    },
    Entry {
        name: "rooms",
        alias: "",
        about: "furnished rooms with doorways along corridors: 4,000 objects",
        by_detail: false,
        make: rooms::make,
    },
    Entry {
        name: "boxes",
        alias: "",
        about: "a wall and 400 plain bodies around it, reflected, flat and skewed ones among them",
        by_detail: false,
        make: boxes::make,
    },
    Entry {
        name: "moving-boxes",
        alias: "",
        about: "boxes of which a third orbit, spin or bob",
        by_detail: false,
        make: moving_boxes::make,
    },
    Entry {
        name: "jellyfish",
        alias: "",
        about: "bells that morph targets squeeze, stretch and dent, a third of them on skeletons too, among walls that hide some: 271 objects",
        by_detail: false,
        make: jellyfish::make,
    },
    Entry {
        name: "tentacles",
        alias: "",
        about: "240 swaying columns, bent by skeletons, among walls",
        by_detail: false,
        make: tentacles::make,
    },
    Entry {
        name: "bad-bounds",
        alias: "",
        about: "a street of 2,000 objects, half of whose declared boxes hold the eye, and some are plainly wrong",
        by_detail: false,
        make: bad_bounds::make_bad,
    },
    Entry {
        name: "good-bounds",
        alias: "",
        about: "bad-bounds with the right boxes, to compare",
        by_detail: false,
        make: bad_bounds::make_good,
    },
];

/// A scene in the making.
#[derive(Default)]
struct Assembly {
    scene: Scene,
}

impl Assembly {
    fn new(name: &str) -> Self {
        Assembly { scene: Scene { name: name.into(), ..Scene::default() } }
    }

    /// Takes a mesh and returns its index.
    fn mesh(&mut self, mesh: Mesh) -> u32 {
        self.scene.meshes.push(mesh);
        (self.scene.meshes.len() - 1) as u32
    }

    /// Places a mesh, opaque, under its own name. The transform is rounded to `f32`: what the GPU draws and what glTF tools
    /// read is then exactly what is meant. Zero gets a plus sign, which multiplication by an identity would give it anyway.
    fn place(&mut self, mesh: u32, colour: [f32; 3], world_from_object: DAffine3) {
        let rounded = world_from_object.to_cols_array().map(|part| f64::from(part as f32) + 0.0);
        self.scene.objects.push(Object {
            name: self.scene.meshes[mesh as usize].name.clone(),
            mesh,
            world_from_object: DAffine3::from_cols_array(&rounded),
            colour: [colour[0], colour[1], colour[2], 1.0],
            dynamic: false,
            translucent: false,
            masked: false,
            surface: Surface::default(),
        });
    }

    /// The object placed last is a building, solid between two corners in object space.
    fn solid(&mut self, min: [f64; 3], max: [f64; 3]) {
        let solid = Aabb { min: min.into(), max: max.into() };
        let object = (self.scene.objects.len() - 1) as u32;
        self.scene.buildings.push(Building { object, solid });
    }

    /// No more objects than so many, and no buildings of others.
    fn cut_off(&mut self, objects: usize) {
        self.scene.objects.truncate(objects);
        self.scene.buildings.retain(|building| (building.object as usize) < objects);
    }

    /// Makes a mesh at a level of detail and returns its index.
    fn built(&mut self, name: &str, detail: Detail, build: impl FnOnce(&mut Parts)) -> u32 {
        let mut parts = Parts::at(detail);
        build(&mut parts);
        self.mesh(parts.mesh(name))
    }

    fn len(&self) -> usize {
        self.scene.objects.len()
    }
}

/// A turn about +y by quarter turns, without rounding: boxes stay exactly on the axes.
fn quarter_turns(turns: i32) -> DMat3 {
    let (cos, sin) = match turns.rem_euclid(4) {
        0 => (1.0, 0.0),
        1 => (0.0, 1.0),
        2 => (-1.0, 0.0),
        _ => (0.0, -1.0),
    };
    DMat3::from_cols(DVec3::new(cos, 0.0, -sin), DVec3::Y, DVec3::new(sin, 0.0, cos))
}

/// Somewhere, turned by quarter turns.
fn standing(at: DVec3, turns: i32) -> DAffine3 {
    DAffine3 { matrix3: quarter_turns(turns), translation: at }
}

/// Somewhere, turned by any angle in radians about +y.
fn turned(at: DVec3, angle: f64) -> DAffine3 {
    DAffine3 { matrix3: DMat3::from_rotation_y(angle), translation: at }
}

/// Somewhere, scaled along the world's axes.
fn sized(at: DVec3, size: DVec3) -> DAffine3 {
    DAffine3 { matrix3: DMat3::from_diagonal(size), translation: at }
}

/// Somewhere, scaled along its own axes and then turned by an angle in radians about +y.
fn posed(at: DVec3, angle: f64, size: DVec3) -> DAffine3 {
    DAffine3 { matrix3: DMat3::from_rotation_y(angle) * DMat3::from_diagonal(size), translation: at }
}

/// How many objects a scene of `standard` objects has at a scale; not fewer than `least`.
fn count(standard: usize, scale: f64, least: usize) -> usize {
    let (wanted, most) = ((standard as f64 * scale).round() as usize, crate::check::MOST_OBJECTS);
    if wanted > most {
        tracing::warn!(
            "scale {scale} asks for {wanted} objects; the scene is made with {most}, the most that there can be"
        );
    }
    wanted.clamp(least, most)
}

/// A camera of 60 degrees that looks along the first part of a walk.
fn camera(name: &str, walk: &Walk, near: f64, far: f64) -> Camera {
    Camera {
        name: name.into(),
        pose: Pose::looking_at(walk.points[0], walk.points[1]),
        projection: Projection::Perspective { fov_y: 60f64.to_radians(), near, far: Some(far) },
        aspect: None,
        node: None,
    }
}

/// A colour within `spread` of another, in one of five steps: in glTF each colour of a mesh is a mesh of its own, so a scene
/// should not have more of them than the eye needs.
fn shade(random: &mut random::Random, colour: [f32; 3], spread: f64) -> [f32; 3] {
    let factor = (1.0 + spread * (random.below(5) as f64 - 2.0) / 2.0) as f32;
    colour.map(|part| (part * factor).clamp(0.0, 1.0))
}
