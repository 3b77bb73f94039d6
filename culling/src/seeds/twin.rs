//! `seeds/cast_rays` in plain Rust: its definition.

use super::shape::Shapes;
use glam::{IVec3, UVec2, UVec3, Vec2, Vec3};
use shaders::types::*;

/// What rays are cast at.
pub struct Targets<'a> {
    /// The tree over objects.
    pub nodes: &'a [SeedNode],
    /// The shapes of meshes.
    pub shapes: &'a Shapes,
    /// The mesh of each object.
    pub object_meshes: &'a [u32],
    /// Where objects are.
    pub objects: &'a [Object],
}

/// A level of tiles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Level {
    /// 0 is the coarsest.
    pub number: u32,
    /// Pixels a side.
    pub tile_px: u32,
}

/// What comes of a level of rays.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cast {
    /// Objects met, by ray.
    pub met: Vec<u32>,
    /// Corners of the tiles of the next level.
    pub finer: Vec<UVec2>,
}

const MISSED: f32 = 3.0e38;

struct Ray {
    origin: Vec3,
    direction: Vec3,
    from_tree: Vec3,
    inverse: Vec3,
}

/// The corners of the tiles of the first level: all of the picture.
pub fn all_tiles(view: &SeedView, tile_px: u32) -> Vec<UVec2> {
    let across = view.width_px.div_ceil(tile_px);
    let down = view.height_px.div_ceil(tile_px);
    (0..down).flat_map(|y| (0..across).map(move |x| UVec2::new(x, y) * tile_px)).collect()
}

/// Casts a ray through the middle of each tile of a level. `known`: by object, not 0 for what coarser levels have met.
pub fn cast_rays(targets: &Targets<'_>, view: &SeedView, tiles: &[UVec2], level: Level, known: &[u32]) -> Cast {
    let mut cast = Cast::default();
    let Some(root) = targets.nodes.first() else { return cast };
    let mut waiting = Vec::with_capacity(SEED_STACK as usize);
    for corner in tiles {
        let ray = ray_through(view, corner.as_vec2() + 0.5 * level.tile_px as f32);
        let hit = first_hit(targets, view, &ray, &mut waiting);
        cast.met.extend(hit.map(|hit| hit.object));
        // Without a hit it is as far as there is anything.
        let beyond = || through(root.low.into(), root.high.into(), ray.from_tree, ray.inverse).1;
        let (at, across) = hit.map_or_else(|| (beyond(), MISSED), |hit| (hit.at, hit.across));
        let half_px = level.tile_px / 2;
        let is_small = across.min(view.usual_size) * view.px_per_unit < level.tile_px as f32 * at;
        let is_new = hit.map_or(level.number == 0, |hit| known[hit.object as usize] == 0);
        if is_small && is_new && half_px >= view.finest_px {
            let parts = (0..4).map(|part| *corner + half_px * UVec2::new(part & 1, part >> 1));
            cast.finer.extend(parts.filter(|part| part.x < view.width_px && part.y < view.height_px));
        }
    }
    cast
}

fn ray_through(view: &SeedView, px: Vec2) -> Ray {
    let at = px / Vec2::new(view.width_px as f32, view.height_px as f32) * 2.0 - 1.0;
    let along = |vectors: [[f32; 3]; 3]| {
        let [start, x, y] = vectors.map(Vec3::from);
        start + at.x * x + at.y * y
    };
    let (origin, direction) = (along(view.origin), along(view.direction));
    Ray { origin, direction, from_tree: origin + Vec3::from(view.tree_from_camera), inverse: inverse_of(direction) }
}

fn inverse_of(direction: Vec3) -> Vec3 {
    1.0 / direction.map(|part| if part.abs() < 1.0e-30 { 1.0e-30 } else { part })
}

fn through(low: Vec3, high: Vec3, origin: Vec3, inverse: Vec3) -> (f32, f32) {
    let (one, other) = ((low - origin) * inverse, (high - origin) * inverse);
    (one.min(other).max_element().max(0.0), one.max(other).min_element())
}

fn enters(node: &SeedNode, ray: &Ray) -> f32 {
    let (enter, leave) = through(node.low.into(), node.high.into(), ray.from_tree, ray.inverse);
    if enter <= leave {
        enter
    } else {
        MISSED
    }
}

/// What a ray meets first.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Hit {
    object: u32,
    /// In lengths of the ray's direction.
    at: f32,
    /// The middle one of the sides of its box, metres.
    across: f32,
}

/// Goes down the hierarchy, nearer children first.
fn first_hit(targets: &Targets<'_>, view: &SeedView, ray: &Ray, waiting: &mut Vec<(u32, f32)>) -> Option<Hit> {
    let (mut hit, mut nearest) = (None, MISSED);
    waiting.clear();
    waiting.push((0, enters(&targets.nodes[0], ray)));
    for _ in 0..SEED_VISITS {
        let Some((node, from)) = waiting.pop() else { break };
        if from >= nearest {
            continue;
        }
        let here = &targets.nodes[node as usize];
        if here.is_leaf != 0 {
            let at = meets(targets, view, here.first, ray, nearest);
            if at < nearest {
                nearest = at;
                let [x, y, z] = (Vec3::from(here.high) - Vec3::from(here.low)).to_array();
                hit = Some(Hit { object: here.first, at, across: x.min(y).max(x.max(y).min(z)) });
            }
            continue;
        }
        let child = |child: u32| (child, enters(&targets.nodes[child as usize], ray));
        let (one, other) = (child(here.first), child(here.first + 1));
        let (near, far) = if other.1 < one.1 { (other, one) } else { (one, other) };
        if far.1 < nearest && waiting.len() + 1 < SEED_STACK as usize {
            waiting.push(far);
        }
        if near.1 < nearest && waiting.len() < SEED_STACK as usize {
            waiting.push(near);
        }
    }
    hit
}

/// Where a ray first meets a filled cell of an object's mesh, if before `nearest`.
fn meets(targets: &Targets<'_>, view: &SeedView, index: u32, ray: &Ray, nearest: f32) -> f32 {
    let object = &targets.objects[index as usize];
    let mesh = targets.object_meshes[index as usize] as usize;
    let high = Vec3::from(object.origin_high) - Vec3::from(view.camera_high);
    let low = Vec3::from(object.origin_low) - Vec3::from(view.camera_low);
    let from = ray.origin - (high + low);
    let [x, y, z] = [object.column_x, object.column_y, object.column_z].map(Vec3::from);
    let rows = [y.cross(z), z.cross(x), x.cross(y)];
    let determinant = x.dot(rows[0]);
    if determinant == 0.0 {
        return MISSED;
    }
    let local = |vector: Vec3| Vec3::from(rows.map(|row| row.dot(vector))) / determinant;
    let shape = &targets.shapes.meshes[mesh];
    let count = UVec3::from(shape.cells);
    let cells = count.as_vec3() / Vec3::from(shape.size);
    let origin = (local(from) - Vec3::from(shape.low)) * cells;
    let direction = local(ray.direction) * cells;
    let inverse = inverse_of(direction);
    let (mut at, leave) = through(Vec3::ZERO, count.as_vec3(), origin, inverse);
    let last = leave.min(nearest);
    let mut cell = (origin + direction * at).floor().as_ivec3().clamp(IVec3::ZERO, count.as_ivec3() - 1);
    let step = inverse.map(|part| if part >= 0.0 { 1.0 } else { -1.0 }).as_ivec3();
    let mut next = ((cell + step.max(IVec3::ZERO)).as_vec3() - origin) * inverse;
    while at <= last {
        let bit = cell.x as u32 + count.x * (cell.y as u32 + count.y * cell.z as u32);
        if at > 0.0 && targets.shapes.filled[mesh * SHAPE_WORDS as usize + bit as usize / 32] >> (bit % 32) & 1 != 0 {
            return at;
        }
        at = next.min_element();
        let axis = if next.x == at {
            0
        } else if next.y == at {
            1
        } else {
            2
        };
        cell[axis] += step[axis];
        next[axis] += inverse[axis].abs();
        if cell[axis] as u32 >= count[axis] {
            break;
        }
    }
    MISSED
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seeds::{flatten, view_of};
    use crate::world::View;
    use glam::{DAffine3, DMat3, DQuat, DVec3};
    use scenes::bvh::{Bvh, Split};
    use scenes::{Aabb, Pose, Projection, Shot};

    const SIZE: [u32; 2] = [160, 90];

    /// Numbers by chance, -1 to 1.
    struct Chance(u64);

    impl Chance {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (self.0 >> 33) as f64 / (1u64 << 30) as f64 - 1.0
        }

        fn vector(&mut self) -> DVec3 {
            DVec3::new(self.next(), self.next(), self.next())
        }
    }

    /// Meshes of a few triangles each, placed, turned and stretched by chance around the origin.
    struct Soup {
        corners: Vec<Vec<Vec3>>,
        shapes: Shapes,
        meshes: Vec<u32>,
        places: Vec<DAffine3>,
        objects: Vec<Object>,
        nodes: Vec<SeedNode>,
    }

    impl Soup {
        fn new(chance: &mut Chance, objects: usize) -> Self {
            let mut shapes = Shapes::default();
            let mut soup: Vec<Vec<Vec3>> = Vec::new();
            for mesh in 0..20 {
                // Thin ones, flat ones and round ones.
                let stretch = [Vec3::ONE, Vec3::new(1.0, 0.0, 1.0), Vec3::new(9.0, 0.3, 0.3)][mesh % 3];
                let corners: Vec<Vec3> = (0..3 * (1 + mesh)).map(|_| chance.vector().as_vec3() * stretch).collect();
                let (shape, filled) = crate::seeds::shape::shape_of(&corners);
                shapes.meshes.push(shape);
                shapes.filled.extend(filled);
                soup.push(corners);
            }
            let meshes: Vec<u32> = (0..objects).map(|object| object as u32 % 20).collect();
            let place = |_| {
                let turn = DQuat::from_axis_angle(chance.vector().normalize(), 3.0 * chance.next());
                let stretch = DMat3::from_diagonal(DVec3::new(0.3, 0.5, 0.4) + 0.2 * chance.vector());
                let at = 8.0 * chance.vector();
                DAffine3 { matrix3: DMat3::from_quat(turn) * stretch, translation: at }
            };
            let places: Vec<DAffine3> = (0..objects).map(place).collect();
            let bounds: Vec<Aabb> = places
                .iter()
                .zip(&meshes)
                .map(|(place, mesh)| {
                    let corners =
                        || soup[*mesh as usize].iter().map(|corner| place.transform_point3(corner.as_dvec3()));
                    let min = corners().fold(DVec3::INFINITY, DVec3::min);
                    Aabb { min, max: corners().fold(DVec3::NEG_INFINITY, DVec3::max) }
                })
                .collect();
            let gpu_object = |place: &DAffine3| {
                let (origin_high, origin_low) = crate::world::split(place.translation);
                let [column_x, column_y, column_z] =
                    place.matrix3.to_cols_array_2d().map(|column| column.map(|part| part as f32));
                Object { column_x, column_y, column_z, origin_high, origin_low, colour: 0 }
            };
            let bvh = Bvh::build(&bounds, Split::Sah).unwrap();
            let nodes = flatten(&bvh, DVec3::ZERO);
            Soup { corners: soup, shapes, meshes, objects: places.iter().map(gpu_object).collect(), places, nodes }
        }

        fn targets(&self) -> Targets<'_> {
            let Soup { nodes, shapes, meshes, objects, .. } = self;
            Targets { nodes, shapes, object_meshes: meshes, objects }
        }

        /// Where a ray meets the first triangle, in f64: the oracle.
        fn first_triangle(&self, origin: DVec3, direction: DVec3) -> Option<f64> {
            let mut first: Option<f64> = None;
            for (place, mesh) in self.places.iter().zip(&self.meshes) {
                for triangle in self.corners[*mesh as usize].chunks_exact(3) {
                    let [a, b, c] = [0, 1, 2].map(|corner| place.transform_point3(triangle[corner].as_dvec3()));
                    let across = DMat3::from_cols(b - a, c - a, -direction);
                    if across.determinant().abs() < 1e-12 {
                        continue;
                    }
                    let at = across.inverse() * (origin - a);
                    if at.x >= 0.0 && at.y >= 0.0 && at.x + at.y <= 1.0 && at.z > 0.0 {
                        first = Some(first.map_or(at.z, |first| first.min(at.z)));
                    }
                }
            }
            first
        }
    }

    fn shot(chance: &mut Chance, projection: Projection) -> View {
        let eye = 40.0 * chance.vector().normalize();
        View::new(&Shot { pose: Pose::looking_at(eye, chance.vector()), projection, seconds: 0.0 }, SIZE, 0, 0.0)
    }

    #[test]
    fn no_ray_passes_through_a_triangle() {
        let mut chance = Chance(5);
        let soup = Soup::new(&mut chance, 300);
        let perspective = Projection::Perspective { fov_y: 0.5, near: 0.1, far: None };
        let parallel = Projection::Orthographic { half_height: 7.0, near: 0.1, far: 200.0 };
        let (mut hits, mut misses, mut early) = (0, 0, 0);
        for projection in [perspective, parallel, perspective, parallel] {
            let view = shot(&mut chance, projection);
            let seed_view = view_of(&view, DVec3::ZERO, 1.0);
            let mut waiting = Vec::new();
            for tile in all_tiles(&seed_view, 4) {
                let ray = ray_through(&seed_view, tile.as_vec2() + 2.0);
                let origin = ray.origin.as_dvec3() + view.pose.position;
                let truth = soup.first_triangle(origin, ray.direction.as_dvec3());
                let hit = first_hit(&soup.targets(), &seed_view, &ray, &mut waiting);
                match (truth, hit) {
                    (Some(truth), Some(hit)) => {
                        assert!(f64::from(hit.at) <= truth * 1.001, "{hit:?} behind the triangle at {truth}");
                        hits += 1;
                        early += usize::from(f64::from(hit.at) < truth * 0.99);
                    }
                    (Some(truth), None) => panic!("passed through a triangle at {truth}"),
                    (None, None) => misses += 1,
                    (None, Some(_)) => early += 1,
                }
            }
        }
        println!("{hits} hits, {misses} misses, {early} too early");
        assert!(hits > 300 && misses > 300 && early < hits, "{hits} hits, {misses} misses, {early} too early");
    }

    #[test]
    fn a_ray_goes_through_a_door() {
        // A wall of two by two metres with an opening in its middle, as strips of triangles around it.
        let corner = |x: f32, y: f32| Vec3::new(x, y, 0.0);
        let quad = |x: [f32; 2], y: [f32; 2]| {
            let [a, b, c, d] = [corner(x[0], y[0]), corner(x[1], y[0]), corner(x[1], y[1]), corner(x[0], y[1])];
            [a, b, c, a, c, d]
        };
        let wall: Vec<Vec3> = [
            quad([-1.0, -0.3], [-1.0, 1.0]),
            quad([0.3, 1.0], [-1.0, 1.0]),
            quad([-0.3, 0.3], [-1.0, -0.3]),
            quad([-0.3, 0.3], [0.3, 1.0]),
        ]
        .concat();
        let (shape, filled) = crate::seeds::shape::shape_of(&wall);
        let shapes = Shapes { meshes: vec![shape], filled: filled.to_vec() };
        let place = |z: f32| Object {
            column_x: [1.0, 0.0, 0.0],
            column_y: [0.0, 1.0, 0.0],
            column_z: [0.0, 0.0, 1.0],
            origin_high: [0.0, 0.0, z],
            ..Object::default()
        };
        // The second wall stands behind the first, half a metre lower and to the side.
        let mut behind = place(-3.0);
        behind.origin_high = [0.6, -0.6, -3.0];
        let objects = [place(0.0), behind];
        let bounds = [DVec3::ZERO, DVec3::new(0.6, -0.6, -3.0)]
            .map(|at| Aabb { min: at - DVec3::new(1.0, 1.0, 0.0), max: at + DVec3::new(1.0, 1.0, 0.0) });
        let nodes = flatten(&Bvh::build(&bounds, Split::Sah).unwrap(), DVec3::ZERO);
        let targets = Targets { nodes: &nodes, shapes: &shapes, object_meshes: &[0, 0], objects: &objects };
        let pose = Pose::looking_at(DVec3::new(0.0, 0.0, 5.0), DVec3::ZERO);
        let projection = Projection::Perspective { fov_y: 0.5, near: 0.1, far: None };
        let view = view_of(&View::new(&Shot { pose, projection, seconds: 0.0 }, SIZE, 0, 0.0), DVec3::ZERO, 1.0);
        let hit = |px: Vec2| first_hit(&targets, &view, &ray_through(&view, px), &mut Vec::new()).map(|hit| hit.object);
        assert_eq!(hit(Vec2::new(80.0, 45.0)), Some(1), "through the opening");
        assert_eq!(hit(Vec2::new(80.0 + 15.0, 45.0)), Some(0), "beside it");
        assert_eq!(hit(Vec2::new(2.0, 2.0)), None, "past the wall");
    }
}
