//! City block (CB): a grid of streets between closed house fronts, after the scene of the same name in Kim 2015 and in
//! Lee et al. 2018, which has about 94,000 objects.
//!
//! What is seen from a street are the fronts along it; interiors, courtyards and the other streets are hidden, well over
//! 95 % of all objects. +y is up, the road is at y = 0. Things that would lie in one plane are offset by centimetres, so that
//! equal depths stay rare.

mod building;
mod meshes;
mod street;

use super::furniture::Furniture;
use super::random::Random;
use super::{sized, Assembly, SceneOptions};
use crate::camera::{Camera, Pose, Projection};
use crate::model::{Scene, Walk};
use glam::DVec3;
use meshes::Meshes;

/// Objects at scale 1.
const OBJECTS: f64 = 94_000.0;
/// One block's streets and house shells: less is no city.
const LEAST_OBJECTS: usize = 150;
/// About how many objects a block has; decides how wide the city is for its count.
const OBJECTS_A_BLOCK: f64 = 1030.0;
/// A block with its pavements, in metres.
const BLOCK: [f64; 2] = [64.0, 40.0];
/// Width of the streets in metres.
const STREET: f64 = 10.0;
const PITCH: [f64; 2] = [BLOCK[0] + STREET, BLOCK[1] + STREET];
const EYE: f64 = 1.7;
/// How far the walk goes at speed 1, in metres.
const WALK: f64 = 160.0;

/// The builder's hands: where things go, what there is to place, and chance.
struct Builder {
    assembly: Assembly,
    meshes: Meshes,
    furniture: Furniture,
    random: Random,
}

/// The city at any scale: as many blocks as it takes, row after row, the last one cut off at the count.
pub(super) fn make(options: &SceneOptions) -> Scene {
    let target = ((OBJECTS * options.scale).round() as usize).clamp(LEAST_OBJECTS, crate::check::MOST_OBJECTS);
    let blocks = (target as f64 / OBJECTS_A_BLOCK).ceil();
    let columns = (blocks * PITCH[1] / PITCH[0]).sqrt().round().max(1.0) as usize;
    let rows = (blocks / columns as f64).ceil().max(1.0);
    // The middle of the city is the origin.
    let corner = -0.5 * DVec3::new(columns as f64 * PITCH[0] - STREET, 0.0, rows * PITCH[1] - STREET);

    let mut assembly = Assembly::new("city-block");
    let meshes = Meshes::new(&mut assembly);
    let furniture = Furniture::new(&mut assembly);
    let mut builder = Builder { assembly, meshes, furniture, random: Random::new(options.seed, 0) };
    builder.assembly.scene.objects.reserve(target + 4096);
    builder.plain(columns as f64 * PITCH[0], rows * PITCH[1]);
    let mut block = 0;
    while builder.assembly.len() < target {
        let (column, row) = (block % columns, block / columns);
        builder.random = Random::new(options.seed, 1 + block as u64);
        let at = corner + DVec3::new(column as f64 * PITCH[0], 0.0, row as f64 * PITCH[1]);
        builder.streets(at, column == 0, row == 0);
        builder.houses(at);
        block += 1;
    }
    builder.assembly.cut_off(target);
    let mut scene = builder.assembly.scene;
    let walk = street_walk(corner, columns, (block / columns).max(1));
    scene.cameras = vec![street_camera(&walk)];
    scene.walk = Some(walk);
    scene
}

impl Builder {
    /// The land around and under the city.
    fn plain(&mut self, width: f64, depth: f64) {
        let size = DVec3::new(width + 200.0, 1.0, depth + 200.0);
        self.assembly.place(self.meshes.tile, [0.33, 0.36, 0.28], sized(DVec3::new(0.0, -0.3, 0.0), size));
    }
}

/// A loop around at most 3 by 3 blocks in the middle of the city, along the middle of the road and not along the city's
/// edge if there is another street. It starts 50 m before a corner.
fn street_walk(corner: DVec3, columns: usize, rows: usize) -> Walk {
    let line = |pitch: f64, count: usize| {
        let around = count.saturating_sub(2).clamp(1, 3);
        let first = (count - around) / 2;
        (first as f64 * pitch - 0.5 * STREET, (first + around) as f64 * pitch - 0.5 * STREET)
    };
    let ((x0, x1), (z0, z1)) = (line(PITCH[0], columns), line(PITCH[1], rows));
    let start = x1 - 50.0;
    let plan = [(start, z0), (x1, z0), (x1, z1), (x0, z1), (x0, z0), (start, z0)];
    let points = plan.map(|(x, z)| corner + DVec3::new(x, EYE, z)).to_vec();
    Walk { points, length: WALK, clearance: 2.0 }
}

fn street_camera(walk: &Walk) -> Camera {
    Camera {
        name: "street".into(),
        pose: Pose::looking_at(walk.points[0], walk.points[1]),
        projection: Projection::Perspective { fov_y: 60f64.to_radians(), near: 0.1, far: Some(2000.0) },
        aspect: None,
        node: None,
    }
}
