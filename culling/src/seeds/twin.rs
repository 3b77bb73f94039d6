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
#[derive(Clone, Copy, Debug)]
struct Hit {
    object: u32,
    at: f32,
    /// The middle one of the sides of its box.
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
