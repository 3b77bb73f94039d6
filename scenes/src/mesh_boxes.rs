//! A mesh in a few boxes instead of one (GPU Gems 29.5.1, figure 29-2): together they hold all of every triangle, not only its corners.
//!
//! 1. Triangles are cut in halves until none reaches farther than a cell of a grid over the mesh's box. The pyramid of figure 29-2 has
//!    no triangle that is smaller than it: without cuts, no box could be. Halves are what the whole is, so that what holds all of
//!    them holds the mesh. Lines and points are triangles of fewer corners.
//! 2. What has its middle in one cell goes into one box.
//! 3. Two boxes become one, again and again, as long as there are too many: the two that add least to what all of them cover, summed over the
//!    three axes along which the mesh is looked at. So a table ends as its top and its legs, and the faces of a crate, which
//!    cover all of it from wherever one looks, end as one box.
//! 4. It goes on as long as that adds nothing at all: the fewest boxes that cover as little.
//!
//! The order in which boxes are joined does not depend on how many are asked for. So each of few boxes is the union of some of many.

use crate::bounds::Reach;
use crate::model::{Aabb, Mesh, Topology};
use glam::{DAffine3, DVec3, Vec3};

/// The most boxes that a mesh can be had in.
pub const MOST_BOXES: u32 = 8;

/// Cells of the grid along each axis: a choice. 64 cells hold what a few boxes can tell apart, and every pair of them is soon looked at.
const CELLS: usize = 4;

/// What is covered is told by so many pixels along each axis, so that a word holds a row.
const ROWS: usize = u32::BITS as usize;

/// Halves of halves: edges that reach over the whole mesh are two cuts from [`CELLS`], and a triangle has three. The rest is for edges that
/// grow longer in one axis as others are cut.
const MOST_CUTS: u32 = 16;

/// The boxes of one mesh.
#[derive(Clone, Debug)]
pub struct MeshBoxes {
    reaches: Vec<Reach>,
}

impl Mesh {
    /// The corners of each triangle, line or point; the last corner of a line is there twice, that of a point three times.
    pub fn primitives(&self) -> impl Iterator<Item = [Vec3; 3]> + Clone + '_ {
        primitives(&self.indices, self.topology, |index| self.positions[index as usize])
    }
}

/// The same of any indices.
pub fn primitives<'a>(
    indices: &'a [u32],
    topology: Topology,
    position: impl Fn(u32) -> Vec3 + Clone + 'a,
) -> impl Iterator<Item = [Vec3; 3]> + Clone + 'a {
    let corners = match topology {
        Topology::Triangles => 3,
        Topology::Lines => 2,
        Topology::Points => 1,
    };
    indices
        .chunks_exact(corners)
        .map(move |indices| std::array::from_fn(|corner| position(indices[corner.min(corners - 1)])))
}

impl MeshBoxes {
    /// At most so many boxes around all of some triangles, which must be finite. Of nothing, there is one box: the origin.
    pub fn around(primitives: impl Iterator<Item = [Vec3; 3]> + Clone, most: u32) -> Self {
        let mut whole = Reach::NOTHING;
        primitives.clone().flatten().for_each(|corner| whole.take(corner.as_dvec3()));
        let bounds = whole.in_object_space();
        if !bounds.is_valid() {
            whole = Reach::NOTHING;
            whole.take(DVec3::ZERO);
            return MeshBoxes { reaches: vec![whole] };
        }
        let mut reaches = if most <= 1 { vec![whole.clone()] } else { cells(primitives, &bounds) };
        join(&mut reaches, &bounds, most.max(1) as usize);
        MeshBoxes { reaches: reaches.into_iter().map(|reach| reach.rounded_as(&whole)).collect() }
    }

    /// How many there are, at least one.
    #[allow(clippy::len_without_is_empty, reason = "there is always one")]
    pub fn len(&self) -> usize {
        self.reaches.len()
    }

    /// They in object space.
    pub fn in_object_space(&self) -> impl ExactSizeIterator<Item = Aabb> + '_ {
        self.reaches.iter().map(Reach::in_object_space)
    }

    /// They under a transform: together they hold every point of the mesh where the GPU puts it, as [`crate::WorldBounds`] does.
    pub fn in_world(&self, world_from_object: DAffine3) -> impl ExactSizeIterator<Item = Aabb> + '_ {
        self.reaches.iter().map(move |reach| reach.transformed(&world_from_object))
    }
}

/// What is in each cell that is not empty.
fn cells(primitives: impl Iterator<Item = [Vec3; 3]>, bounds: &Aabb) -> Vec<Reach> {
    let size = (bounds.max - bounds.min) / CELLS as f64;
    // What is flat has one cell across.
    let size = DVec3::select(size.cmpgt(DVec3::ZERO), size, DVec3::INFINITY);
    let mut cells = vec![None; CELLS * CELLS * CELLS];
    for corners in primitives {
        in_halves(corners.map(|corner| corner.as_dvec3()), size, MOST_CUTS, &mut |corners| {
            let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
            let cell = ((middle - bounds.min) / size).to_array().map(|at| (at as usize).min(CELLS - 1));
            let reach = cells[cell[0] + CELLS * (cell[1] + CELLS * cell[2])].get_or_insert(Reach::NOTHING);
            corners.into_iter().for_each(|corner| reach.take(corner));
        });
    }
    cells.into_iter().flatten().collect()
}

/// Cuts a triangle at the middle of the edge that reaches over most cells, and its halves, until all fit into a cell. Rounding of the middle
/// moves it by 2^-52 of the mesh; [`crate::WorldBounds`]' rounding for the GPU has 2^-38 to spare.
fn in_halves(corners: [DVec3; 3], cell: DVec3, most: u32, found: &mut impl FnMut([DVec3; 3])) {
    let [a, b, c] = corners;
    let reach = |from: DVec3, to: DVec3| ((to - from).abs() / cell).max_element();
    let edges = [(reach(a, b), [a, b, c]), (reach(b, c), [b, c, a]), (reach(c, a), [c, a, b])];
    let (longest, [from, to, apex]) =
        edges.into_iter().fold(edges[0], |one, other| if other.0 > one.0 { other } else { one });
    if longest <= 1.0 || most == 0 {
        return found(corners);
    }
    let middle = 0.5 * from + 0.5 * to;
    in_halves([from, middle, apex], cell, most - 1, found);
    in_halves([middle, to, apex], cell, most - 1, found);
}

/// What a box covers of the mesh's own, along each axis.
type Silhouettes = [[u32; ROWS]; 3];

/// Joins boxes until there are few enough, and on as long as that covers nothing more.
fn join(reaches: &mut Vec<Reach>, bounds: &Aabb, most: usize) {
    let size = bounds.max - bounds.min;
    let weights = [size.y * size.z, size.z * size.x, size.x * size.y];
    let mut covered: Silhouettes = [[0; ROWS]; 3];
    reaches.iter().for_each(|reach| cover(&mut covered, &silhouettes(&reach.in_object_space(), bounds)));
    let mut boxes: Vec<Aabb> = reaches.iter().map(Reach::in_object_space).collect();
    while let Some((added, one, other)) = least_added(&boxes, &covered, weights, bounds) {
        if boxes.len() <= most && added > 0.0 {
            return;
        }
        let gone = reaches.remove(other);
        reaches[one] = reaches[one].union(&gone);
        boxes.remove(other);
        boxes[one] = reaches[one].in_object_space();
        cover(&mut covered, &silhouettes(&boxes[one], bounds));
    }
}

/// The two boxes that, as one, add least to what is covered; of several such pairs the one that makes the smallest box. None of a single box.
fn least_added(boxes: &[Aabb], covered: &Silhouettes, weights: [f64; 3], bounds: &Aabb) -> Option<(f64, usize, usize)> {
    let mut best: Option<((f64, f64), usize, usize)> = None;
    for one in 0..boxes.len() {
        for other in one + 1..boxes.len() {
            let joined = boxes[one].union(boxes[other]);
            let size = joined.max - joined.min;
            let cost = (added(covered, &silhouettes(&joined, bounds), weights), size.length_squared());
            if best.is_none_or(|(least, ..)| cost < least) {
                best = Some((cost, one, other));
            }
        }
    }
    best.map(|((added, _), one, other)| (added, one, other))
}

fn silhouettes(box_: &Aabb, bounds: &Aabb) -> Silhouettes {
    let size = bounds.max - bounds.min;
    let pixels = |axis: usize| {
        let scale = if size[axis] > 0.0 { ROWS as f64 / size[axis] } else { 0.0 };
        let at = |value: f64| (value - bounds.min[axis]) * scale;
        let first = (at(box_.min[axis]).floor() as usize).min(ROWS - 1);
        (first, (at(box_.max[axis]).ceil() as usize).clamp(first + 1, ROWS))
    };
    let along = [pixels(0), pixels(1), pixels(2)];
    std::array::from_fn(|axis| {
        let ((left, right), (bottom, top)) = (along[(axis + 1) % 3], along[(axis + 2) % 3]);
        let row = (u32::MAX >> (ROWS - (right - left))) << left;
        std::array::from_fn(|y| if (bottom..top).contains(&y) { row } else { 0 })
    })
}

fn cover(covered: &mut Silhouettes, by: &Silhouettes) {
    let rows = covered.iter_mut().flatten().zip(by.iter().flatten());
    rows.for_each(|(covered, by)| *covered |= by);
}

/// How much more than `covered` something covers: an area, times a constant.
fn added(covered: &Silhouettes, by: &Silhouettes, weights: [f64; 3]) -> f64 {
    let pixels = |axis: usize| {
        covered[axis].iter().zip(&by[axis]).map(|(covered, by)| (by & !covered).count_ones()).sum::<u32>()
    };
    (0..3).map(|axis| weights[axis] * f64::from(pixels(axis))).sum()
}
