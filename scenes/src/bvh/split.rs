//! Where to cut a set of objects in two: surface area heuristic, middle, equal counts.
//!
//! Cuts look at the centres of boxes. They only order work: wherever a cut falls, the tree's bounds are right.

use super::Split;
use crate::model::Aabb;
use glam::DVec3;

/// An object on its way into a tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct Item {
    pub(super) bounds: Aabb,
    pub(super) object: u32,
}

impl Item {
    fn centre(&self) -> DVec3 {
        self.bounds.centre()
    }
}

/// Bins an axis for more objects than this; the exact cut for as many or fewer.
const BINS: usize = 16;

/// Reorders two or more objects so that those of the first child come first, and says how many: at least one, and not all.
pub(super) fn cut(items: &mut [Item], split: Split) -> usize {
    if items.len() == 2 {
        return 1;
    }
    let centres = Aabb::from_points(items.iter().map(Item::centre));
    let cut = match split {
        Split::Middle => middle(items, &centres),
        Split::Sah | Split::Ploc if items.len() <= BINS => exact_sah(items, &centres),
        Split::Sah | Split::Ploc => binned_sah(items, &centres),
        Split::EqualCount => None,
    };
    cut.unwrap_or_else(|| equal_count(items, &centres))
}

fn longest_axis(bounds: &Aabb) -> usize {
    bounds.half_extent().max_position()
}

/// Objects at one point are halved in the order they are in, so a heap of them makes a balanced tree.
fn equal_count(items: &mut [Item], centres: &Aabb) -> usize {
    let middle = items.len() / 2;
    if centres.min != centres.max {
        let axis = longest_axis(centres);
        items.select_nth_unstable_by(middle, |a, b| along(axis, a, b));
    }
    middle
}

/// By centre along an axis; equal centres by object, so that the order is total and the tree the same on each run.
fn along(axis: usize, a: &Item, b: &Item) -> std::cmp::Ordering {
    a.centre()[axis].total_cmp(&b.centre()[axis]).then(a.object.cmp(&b.object))
}

/// None where all centres are at one point, or too close together to have a number between them.
fn middle(items: &mut [Item], centres: &Aabb) -> Option<usize> {
    let axis = longest_axis(centres);
    let middle = centres.centre()[axis];
    proper(partition(items, |item| item.centre()[axis] < middle), items.len())
}

fn proper(left: usize, count: usize) -> Option<usize> {
    (0 < left && left < count).then_some(left)
}

/// Moves the objects that go left before the others, in place, and counts them.
fn partition(items: &mut [Item], goes_left: impl Fn(&Item) -> bool) -> usize {
    let (mut left, mut right) = (0, items.len());
    loop {
        while left < right && goes_left(&items[left]) {
            left += 1;
        }
        while left < right && !goes_left(&items[right - 1]) {
            right -= 1;
        }
        if left == right {
            return left;
        }
        items.swap(left, right - 1);
    }
}

/// A place to cut. The less, the better; of equal costs, as of points on a line, the one that balances better.
#[derive(Clone, Copy)]
struct Candidate {
    cost: f64,
    imbalance: usize,
    axis: usize,
    /// The first object or bin that goes right.
    place: usize,
}

impl Candidate {
    /// Expected tests of a random ray that hits the parent, up to a factor and a constant (MacDonald & Booth 1990).
    fn new(axis: usize, place: usize, left: &Aabb, left_count: usize, right: &Aabb, right_count: usize) -> Self {
        let cost = half_area(left) * left_count as f64 + half_area(right) * right_count as f64;
        Candidate { cost, imbalance: left_count.abs_diff(right_count), axis, place }
    }

    /// A cost beyond `f64`, infinite or NaN, is better than nothing only.
    fn or_better(best: Option<Self>, other: Self) -> Option<Self> {
        let better = match best {
            _ if !other.cost.is_finite() => false,
            None => true,
            Some(best) => (other.cost, other.imbalance) < (best.cost, best.imbalance),
        };
        if better {
            Some(other)
        } else {
            best
        }
    }
}

fn half_area(bounds: &Aabb) -> f64 {
    let size = bounds.max - bounds.min;
    size.x * size.y + size.y * size.z + size.z * size.x
}

/// Tries each cut of each axis. For few objects only: it sorts them by each axis.
fn exact_sah(items: &mut [Item], centres: &Aabb) -> Option<usize> {
    let mut best = None;
    let mut right = [Aabb::EMPTY; BINS];
    let mut sorted_by = None;
    for axis in (0..3).filter(|axis| centres.min[*axis] < centres.max[*axis]) {
        items.sort_unstable_by(|a, b| along(axis, a, b));
        sorted_by = Some(axis);
        let mut bounds = Aabb::EMPTY;
        for (place, item) in items.iter().enumerate().rev() {
            bounds = bounds.union(item.bounds);
            right[place] = bounds;
        }
        let mut left = Aabb::EMPTY;
        for place in 1..items.len() {
            left = left.union(items[place - 1].bounds);
            let cut = Candidate::new(axis, place, &left, place, &right[place], items.len() - place);
            best = Candidate::or_better(best, cut);
        }
    }
    let best = best?;
    if sorted_by != Some(best.axis) {
        items.sort_unstable_by(|a, b| along(best.axis, a, b));
    }
    Some(best.place)
}

/// What a bin holds.
#[derive(Clone, Copy)]
struct Bin {
    bounds: Aabb,
    count: usize,
}

impl Bin {
    const EMPTY: Bin = Bin { bounds: Aabb::EMPTY, count: 0 };

    fn add(&mut self, bounds: Aabb, count: usize) {
        self.bounds = self.bounds.union(bounds);
        self.count += count;
    }
}

/// Wald 2007, *On fast construction of SAH-based bounding volume hierarchies*: objects are counted in bins of equal width,
/// and only the cuts between bins are tried.
fn binned_sah(items: &mut [Item], centres: &Aabb) -> Option<usize> {
    // A scale of infinity or zero, from an extent that f64 can hardly hold, puts all objects in one bin: no cut is found.
    let scale = BINS as f64 / (centres.max - centres.min);
    let first = centres.min;
    // `as` takes NaN, of an axis without extent, to 0, and what is too large to the largest number.
    let bin_along = |centre: DVec3, axis: usize| (((centre - first) * scale)[axis] as usize).min(BINS - 1);
    let mut bins = [[Bin::EMPTY; BINS]; 3];
    for item in items.iter() {
        let places = ((item.centre() - first) * scale).to_array();
        for (bins, place) in bins.iter_mut().zip(places) {
            bins[(place as usize).min(BINS - 1)].add(item.bounds, 1);
        }
    }
    let mut best = None;
    for (axis, bins) in bins.iter().enumerate() {
        best = best_of_bins(best, axis, bins);
    }
    let Candidate { axis, place, .. } = best?;
    proper(partition(items, |item| bin_along(item.centre(), axis) < place), items.len())
}

fn best_of_bins(mut best: Option<Candidate>, axis: usize, bins: &[Bin; BINS]) -> Option<Candidate> {
    let mut right = [Bin::EMPTY; BINS];
    let mut sum = Bin::EMPTY;
    for place in (1..BINS).rev() {
        sum.add(bins[place].bounds, bins[place].count);
        right[place] = sum;
    }
    let mut left = Bin::EMPTY;
    for place in 1..BINS {
        left.add(bins[place - 1].bounds, bins[place - 1].count);
        let Bin { bounds, count } = right[place];
        if left.count > 0 && count > 0 {
            best = Candidate::or_better(best, Candidate::new(axis, place, &left.bounds, left.count, &bounds, count));
        }
    }
    best
}
