//! The order in which a world keeps its objects. Blocks of objects that lie side by side in it are tested as one, so it should put near
//! each other what lies near each other. Most scenes list their objects so; where one does not, they are put in the order of a Morton
//! curve through the middles of their bounds, large ones before small ones: a wall among pebbles would stretch their block, and what is
//! large hides what is drawn after it.

use glam::DVec3;
use scenes::Aabb;
use shaders::types::BLOCK_OBJECTS;

/// How much smaller blocks along the curve must be, in the sum of their surfaces, for the scene's own order to be given up: what it says of
/// meshes that follow each other, and of ties, is worth something too.
const CLEARLY_SMALLER: f64 = 0.5;

/// Bits of a Morton code an axis.
const AXIS_BITS: u32 = 21;

/// What an object is placed by.
pub(super) struct Placed {
    /// Its bounds in the world.
    pub(super) bounds: Aabb,
    /// What it is drawn as: objects of one kind lie side by side, in ascending order.
    pub(super) kind: u32,
    /// It can move. Such objects lie behind the still ones of their kind, so that few blocks hold any.
    pub(super) moves: bool,
}

/// The objects, by number, in the order in which a world keeps them.
pub(super) fn order(objects: &[Placed]) -> Vec<u32> {
    let apart = |object: &u32| (objects[*object as usize].kind, objects[*object as usize].moves);
    let mut listed: Vec<u32> = (0..objects.len() as u32).collect();
    listed.sort_by_key(apart);
    let codes = morton_codes(objects);
    let mut curved = listed.clone();
    curved.sort_by_key(|object| {
        (apart(object), std::cmp::Reverse(size_class(&objects[*object as usize].bounds)), codes[*object as usize])
    });
    if surface(objects, &curved) < CLEARLY_SMALLER * surface(objects, &listed) {
        curved
    } else {
        listed
    }
}

/// How large an object is: a class more is eight times as large. One without a size is the smallest.
fn size_class(bounds: &Aabb) -> i32 {
    let diagonal = (bounds.max - bounds.min).length();
    if diagonal.is_finite() && diagonal > 0.0 {
        (diagonal.log2() / 3.0).floor() as i32
    } else {
        i32::MIN
    }
}

/// By object; those without a place are at the curve's beginning.
fn morton_codes(objects: &[Placed]) -> Vec<u64> {
    let middles: Vec<DVec3> = objects.iter().map(|object| object.bounds.centre()).collect();
    let finite = || middles.iter().copied().filter(|middle| middle.is_finite());
    let (low, high) = (finite().fold(DVec3::INFINITY, DVec3::min), finite().fold(DVec3::NEG_INFINITY, DVec3::max));
    let scale = f64::from((1u32 << AXIS_BITS) - 1) / (high - low).max_element().max(f64::MIN_POSITIVE);
    let code = |middle: &DVec3| {
        if !middle.is_finite() {
            return 0;
        }
        let [x, y, z] = ((*middle - low) * scale).to_array().map(|along| spread(along as u64));
        x | y << 1 | z << 2
    };
    middles.iter().map(code).collect()
}

/// Each of the lowest 21 bits at every third place.
fn spread(bits: u64) -> u64 {
    (0..AXIS_BITS).fold(0, |spread, bit| spread | (bits >> bit & 1) << (3 * bit))
}

/// What the blocks of objects that stay where they are hold beyond the largest of them, as the sum of surfaces: what a ray by chance, or
/// a view, meets of a block without need. (The largest is met anyway: one wall would outweigh all else.)
fn surface(objects: &[Placed], order: &[u32]) -> f64 {
    let nothing = Aabb { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };
    let block = |block: &[u32]| {
        let still = block.iter().map(|object| &objects[*object as usize]).filter(|object| !object.moves);
        let bounds = || {
            still.clone().map(|object| object.bounds).filter(|bounds| bounds.min.is_finite() && bounds.max.is_finite())
        };
        let all = bounds().fold(nothing, |all, one| Aabb { min: all.min.min(one.min), max: all.max.max(one.max) });
        half_surface(&all) - bounds().map(|one| half_surface(&one)).fold(0.0, f64::max)
    };
    order.chunks(BLOCK_OBJECTS as usize).map(block).sum()
}

fn half_surface(bounds: &Aabb) -> f64 {
    let size = (bounds.max - bounds.min).max(DVec3::ZERO);
    size.x * size.y + size.y * size.z + size.z * size.x
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(middle: DVec3, kind: u32, moves: bool) -> Placed {
        Placed { bounds: Aabb { min: middle - 0.4, max: middle + 0.4 }, kind, moves }
    }

    fn in_a_row(place: impl Fn(u32) -> u32) -> Vec<Placed> {
        (0..4096).map(|number| at(DVec3::X * f64::from(place(number)), 0, false)).collect()
    }

    #[test]
    fn a_scene_that_lists_neighbours_together_keeps_its_order() {
        assert_eq!(order(&in_a_row(|number| number)), (0..4096).collect::<Vec<_>>());
        assert!(order(&[]).is_empty());
    }

    #[test]
    fn a_scene_in_any_order_is_put_along_the_curve() {
        let objects = in_a_row(|number| number * 1_021 % 4096);
        let ordered = order(&objects);
        let mut all = ordered.clone();
        all.sort_unstable();
        assert_eq!(all, (0..4096).collect::<Vec<_>>(), "each object once");
        let places = ordered.iter().map(|object| objects[*object as usize].bounds.min.x);
        assert!(places.clone().zip(places.skip(1)).all(|(one, next)| one < next));
    }

    #[test]
    fn kinds_lie_side_by_side_and_what_moves_behind_what_stays() {
        let objects: Vec<_> = (0..1_000)
            .map(|number| at(DVec3::splat(f64::from(number * 7 % 100)), number % 3, number % 5 == 0))
            .collect();
        let apart: Vec<_> = order(&objects)
            .iter()
            .map(|object| (objects[*object as usize].kind, objects[*object as usize].moves))
            .collect();
        assert!(apart.is_sorted());
    }

    #[test]
    fn a_wall_comes_before_the_pebbles_that_it_may_hide() {
        let mut objects = in_a_row(|number| number * 1_021 % 4096);
        objects[77].bounds = Aabb { min: DVec3::splat(-500.0), max: DVec3::splat(4_500.0) };
        assert_eq!(order(&objects)[0], 77);
    }

    #[test]
    fn objects_without_a_place_keep_one_in_the_order() {
        let mut objects = in_a_row(|number| number * 1_021 % 4096);
        objects[5].bounds.min = DVec3::NAN;
        objects[6].bounds.max = DVec3::INFINITY;
        let mut all = order(&objects);
        all.sort_unstable();
        assert_eq!(all, (0..4096).collect::<Vec<_>>());
    }
}
