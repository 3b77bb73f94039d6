//! How far points reach in 26 directions, and the boxes that follow under any transform.

use crate::model::{Aabb, Mesh};
use glam::{DAffine3, DVec3};

/// Largest relative error of one row of `column_x * x + column_y * y + column_z * z` on the GPU, in terms of sum |M| |p|.
///
/// Each term takes at most four roundings to f32, each by a factor within 1 +- u, u = 2^-24: of M on upload, of the
/// product, and of two sums. (1 + u)^4 - 1 < 4u (1 + 2^-16), and the excess over 4u also covers the few roundings of this
/// file in f64 (below 2^-49 together). A fused multiply-add rounds less often.
pub(crate) const TRANSFORM_ERROR: f64 = 4.0 / 16_777_216.0 * (1.0 + 1.0 / 65_536.0);

/// Devices may flush numbers below this to zero: of M, of p, each product, and both sums.
pub(crate) const SMALLEST: f64 = f32::MIN_POSITIVE as f64;

/// How far a mesh reaches in each of the 26 directions, by [`direction_index`]; entry 13 is unused.
#[derive(Clone, Debug)]
pub(crate) struct Reach {
    farthest: [f64; 27],
    /// Largest magnitude of each coordinate.
    pub(crate) largest: [f64; 3],
}

fn direction_index(direction: [i32; 3]) -> usize {
    (13 + direction[0] + 3 * direction[1] + 9 * direction[2]) as usize
}

/// One of each pair of opposite directions, with its index in [`Reach::farthest`]. The index of the other direction is 26 less this.
fn directions() -> impl Iterator<Item = (usize, DVec3)> {
    let part = |index: usize| (index % 3) as f64 - 1.0;
    (14..27).map(move |index| (index, DVec3::new(part(index), part(index / 3), part(index / 9))))
}

impl Reach {
    /// The reach of no point: a union with it changes nothing.
    pub(crate) const NOTHING: Reach = Reach { farthest: [f64::NEG_INFINITY; 27], largest: [0.0; 3] };

    /// The reach of a mesh, or of its declared box if that holds the mesh.
    pub(super) fn of(mesh: &Mesh) -> Self {
        match mesh.honoured_bounds() {
            Some(declared) => Self::of_points(declared.corners().into_iter()),
            None if mesh.positions.is_empty() => Reach { farthest: [0.0; 27], largest: [0.0; 3] },
            None => Self::of_points(mesh.positions.iter().map(|position| position.as_dvec3())),
        }
    }

    fn of_points(points: impl Iterator<Item = DVec3>) -> Self {
        let mut reach = Self::NOTHING;
        points.for_each(|point| reach.take(point));
        reach.with_largest()
    }

    /// Completes the reach once all points are taken.
    pub(crate) fn with_largest(self) -> Self {
        Reach { largest: self.largest_coordinates(), ..self }
    }

    /// Extends the reach to a point.
    pub(crate) fn take(&mut self, point: DVec3) {
        let [x, y, z] = point.to_array();
        self.take_between(|direction| {
            let along = direction.x * x + direction.y * y + direction.z * z;
            [along, along]
        });
    }

    /// Extends the reach to a point whose smallest and largest place along each direction is known.
    pub(crate) fn take_between(&mut self, along: impl Fn(DVec3) -> [f64; 2]) {
        let farthest = &mut self.farthest;
        for (index, direction) in directions() {
            let [least, most] = along(direction);
            // Not f64::max, which forgets NaN: a broken vertex must show in the bounds, and stays once it is there.
            if most > farthest[index] || most.is_nan() {
                farthest[index] = most;
            }
            if -least > farthest[26 - index] || least.is_nan() {
                farthest[26 - index] = -least;
            }
        }
    }

    /// True if a point, whose smallest and largest place along each direction is known, may be as far as this reach along some
    /// direction. True also for NaN.
    pub(crate) fn any_reached(&self, along: impl Fn(DVec3) -> [f64; 2]) -> bool {
        let reaches = |along: f64, farthest: f64| along >= farthest || along.is_nan() || farthest.is_nan();
        directions().any(|(index, direction)| {
            let [least, most] = along(direction);
            reaches(most, self.farthest[index]) || reaches(-least, self.farthest[26 - index])
        })
    }

    /// Returns the reach with more room along each axis.
    pub(crate) fn widened(mut self, by: DVec3) -> Self {
        for (index, direction) in directions() {
            let by = direction.abs().dot(by);
            self.farthest[index] += by;
            self.farthest[26 - index] += by;
        }
        self
    }

    /// The most padding for rounding under any transform that stretches vectors by at most `stretch`. A row of the transform times the
    /// mesh's largest coordinates is at most the product of their lengths.
    pub(crate) fn most_padding(&self, stretch: f64) -> f64 {
        let largest = DVec3::from_array(self.largest);
        TRANSFORM_ERROR * stretch * largest.length() + SMALLEST * (3.0 * stretch + largest.element_sum() + 6.0)
    }

    /// Returns the reach of both sets of points.
    pub(crate) fn union(&self, other: &Reach) -> Reach {
        Reach { farthest: std::array::from_fn(|index| self.farthest[index].max(other.farthest[index])), ..*self }
    }

    /// Returns the same reach with the rounding of `whole`. Points on a triangle are as uncertain as the triangle's corners, however
    /// small the part of the triangle is.
    pub(crate) fn rounded_as(self, whole: &Reach) -> Reach {
        Reach { largest: whole.largest_coordinates(), ..self }
    }

    fn largest_coordinates(&self) -> [f64; 3] {
        [14, 16, 22].map(|positive| self.farthest[positive].max(self.farthest[26 - positive]))
    }

    /// The smallest box around the points.
    pub(crate) fn in_object_space(&self) -> Aabb {
        let along = |axis: usize, sign: i32| {
            let mut direction = [0; 3];
            direction[axis] = sign;
            self.farthest[direction_index(direction)]
        };
        let ends = |sign: i32| DVec3::new(along(0, sign), along(1, sign), along(2, sign));
        Aabb { min: -ends(-1), max: ends(1) }
    }

    /// An upper bound of `row . p` over the vertices.
    fn along(&self, row: [f64; 3]) -> f64 {
        let mut order = [0, 1, 2];
        order.sort_by(|&a, &b| row[b].abs().total_cmp(&row[a].abs()));
        let mut direction = [0; 3];
        let mut sum = 0.0;
        for (place, &axis) in order.iter().enumerate() {
            direction[axis] = if row[axis] < 0.0 { -1 } else { 1 };
            let next = order.get(place + 1).map_or(0.0, |&axis| row[axis].abs());
            let weight = row[axis].abs() - next;
            if weight != 0.0 {
                sum += weight * self.farthest[direction_index(direction)];
            }
        }
        sum
    }

    pub(crate) fn transformed(&self, world_from_object: &DAffine3) -> Aabb {
        self.padded(world_from_object, |axis, row| self.padding(row, world_from_object.translation[axis]))
    }

    /// The box without room for rounding.
    pub(crate) fn placed(&self, world_from_object: &DAffine3) -> Aabb {
        self.padded(world_from_object, |_, _| 0.0)
    }

    /// The box under a transform, with padding along each world axis.
    pub(crate) fn padded(&self, world_from_object: &DAffine3, pad: impl Fn(usize, [f64; 3]) -> f64) -> Aabb {
        let columns = world_from_object.matrix3;
        let translation = world_from_object.translation.to_array();
        let (mut min, mut max) = ([0.0; 3], [0.0; 3]);
        for axis in 0..3 {
            let row = [columns.x_axis[axis], columns.y_axis[axis], columns.z_axis[axis]];
            let pad = pad(axis, row);
            min[axis] = translation[axis] + (-self.along(row.map(|weight| -weight)) - pad);
            max[axis] = translation[axis] + (self.along(row) + pad);
        }
        Aabb { min: min.into(), max: max.into() }
    }

    /// How far a vertex may be off along one world axis. Zero where the row is: then the GPU's result is exact.
    fn padding(&self, row: [f64; 3], translation: f64) -> f64 {
        let mut size = 0.0;
        let mut flushed = 0.0;
        for (weight, largest) in row.map(f64::abs).into_iter().zip(self.largest) {
            if weight != 0.0 && largest != 0.0 {
                size += weight * largest;
                flushed += SMALLEST * (weight + largest + 2.0);
            }
        }
        if flushed == 0.0 {
            return 0.0;
        }
        // The last term: adding the translation rounds once more, in f64.
        TRANSFORM_ERROR * size + flushed + f64::EPSILON * translation.abs()
    }
}
