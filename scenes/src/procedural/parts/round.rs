//! Round parts, smoothly shaded, with as many sides as the level of detail asks for.

use super::Parts;
use glam::Vec3;
use std::f32::consts::{PI, TAU};

/// How far to look along a surface for its normal, as a part of its length.
const STEP: f32 = 2e-3;

impl Parts {
    /// A curved surface over 0..=1 by 0..=1 in `rows` by `columns` pieces, which looks to where du x dv points. Triangles
    /// whose corners coincide, at poles, are left out.
    pub(in crate::procedural) fn sheet(&mut self, rows: usize, columns: usize, point: impl Fn(f32, f32) -> Vec3) {
        let first = self.positions.len();
        for row in 0..=rows {
            for column in 0..=columns {
                let (u, v) = (row as f32 / rows as f32, column as f32 / columns as f32);
                self.positions.push(point(u, v));
                // Not at a pole itself, where all directions along it coincide.
                let near = u.clamp(2.0 * STEP, 1.0 - 2.0 * STEP);
                let du = point(near + STEP, v) - point(near - STEP, v);
                let dv = point(near, v + STEP) - point(near, v - STEP);
                self.normals.push(du.cross(dv).normalize_or(Vec3::Y));
            }
        }
        let at = |row: usize, column: usize| first + row * (columns + 1) + column;
        for row in 0..rows {
            for column in 0..columns {
                let corners = [at(row, column), at(row + 1, column), at(row + 1, column + 1), at(row, column + 1)];
                self.triangle([corners[0], corners[1], corners[2]]);
                self.triangle([corners[0], corners[2], corners[3]]);
            }
        }
    }

    /// Adds a triangle of vertices that are there, unless it is flat.
    fn triangle(&mut self, corners: [usize; 3]) {
        let [a, b, c] = corners.map(|corner| self.positions[corner]);
        if (b - a).cross(c - a) != Vec3::ZERO {
            self.indices.extend(corners.map(|corner| corner as u32));
        }
    }

    /// An ellipsoid with `rows` from pole to pole and `sides` around. `swell` is a factor for the radius in a direction.
    pub(in crate::procedural) fn globe(
        &mut self,
        centre: impl Into<Vec3>,
        radii: impl Into<Vec3>,
        [rows, sides]: [usize; 2],
        swell: impl Fn(Vec3) -> f32,
    ) {
        let (centre, radii): (Vec3, Vec3) = (centre.into(), radii.into());
        self.sheet(self.detail.rows(rows).max(2), self.detail.sides(sides), |u, v| {
            let direction = direction(u, v);
            centre + radii * direction * swell(direction)
        });
    }

    /// A closed body turned about +y from a profile of (radius, height), from below to above: straight pieces with edges.
    pub(in crate::procedural) fn lathe(&mut self, base: impl Into<Vec3>, profile: &[[f32; 2]], sides: usize) {
        let base: Vec3 = base.into();
        for piece in profile.windows(2) {
            let [low, high] = [piece[0], piece[1]];
            self.sheet(self.detail.cuts(), self.detail.sides(sides), |u, v| {
                let (radius, y) = (high[0] + (low[0] - high[0]) * u, high[1] + (low[1] - high[1]) * u);
                base + circle(v) * radius + Vec3::Y * y
            });
        }
    }

    /// A tube of `steps` pieces along a curve over 0..=1; a closed one must come back to where it began.
    pub(in crate::procedural) fn tube(
        &mut self,
        curve: impl Fn(f32) -> Vec3,
        [steps, sides]: [usize; 2],
        radius: f32,
        is_closed: bool,
    ) {
        let (steps, sides) = (self.detail.rows(steps), self.detail.sides(sides));
        let frames = frames(&curve, steps, is_closed);
        let first = self.positions.len();
        for (point, across, aside) in &frames {
            for side in 0..=sides {
                let angle = (side % sides) as f32 / sides as f32 * TAU;
                let normal = *across * angle.cos() + *aside * angle.sin();
                self.positions.push(*point + normal * radius);
                self.normals.push(normal);
            }
        }
        let at = |step: usize, side: usize| first + step * (sides + 1) + side;
        for step in 0..steps {
            for side in 0..sides {
                self.triangle([at(step, side), at(step, side + 1), at(step + 1, side + 1)]);
                self.triangle([at(step, side), at(step + 1, side + 1), at(step + 1, side)]);
            }
        }
        if !is_closed {
            let ring = |step: usize| (0..sides).map(move |side| at(step, side));
            self.cap(frames[0].0, &ring(0).rev().collect::<Vec<_>>());
            self.cap(frames[steps].0, &ring(steps).collect::<Vec<_>>());
        }
    }

    /// A straight closed tube.
    pub(in crate::procedural) fn rod(&mut self, from: impl Into<Vec3>, to: impl Into<Vec3>, radius: f32, sides: usize) {
        let (from, to): (Vec3, Vec3) = (from.into(), to.into());
        self.tube(|u| from.lerp(to, u), [1, sides], radius, false);
    }

    /// A pipe with a ball at each bend and a flange at each end.
    pub(in crate::procedural) fn pipe(&mut self, corners: &[Vec3], radius: f32, sides: usize) {
        for piece in corners.windows(2) {
            self.rod(piece[0], piece[1], radius, sides);
        }
        for bend in corners.iter().skip(1).take(corners.len().saturating_sub(2)) {
            self.globe(*bend, Vec3::splat(1.15 * radius), [sides.div_ceil(3), sides], |_| 1.0);
        }
        let ends = [[0, 1], [corners.len() - 1, corners.len() - 2]];
        for [end, next] in ends {
            let inward = (corners[next] - corners[end]).normalize_or(Vec3::Y);
            self.rod(corners[end], corners[end] + inward * radius, 1.4 * radius, sides);
        }
    }

    /// A flat end: the ring is counter-clockwise from outside.
    fn cap(&mut self, middle: Vec3, ring: &[usize]) {
        let corner = |index: usize| self.positions[ring[index % ring.len()]];
        let normal = (corner(0) - middle).cross(corner(1) - middle).normalize_or(Vec3::Y);
        let corners: Vec<Vec3> = (0..ring.len()).map(corner).collect();
        let first = self.positions.len() as u32;
        let count = corners.len() as u32;
        self.positions.push(middle);
        self.positions.extend(corners);
        self.normals.extend((0..=count).map(|_| normal));
        for side in 0..count {
            self.indices.extend([first, first + 1 + side, first + 1 + (side + 1) % count]);
        }
    }
}

/// A unit direction: `u` from the top pole to the lower one, `v` around. The poles are exact.
fn direction(u: f32, v: f32) -> Vec3 {
    let across = if u == 0.0 || u == 1.0 { 0.0 } else { (PI * u).sin() };
    circle(v) * across + Vec3::Y * (PI * u).cos()
}

/// A point on the unit circle about +y, counter-clockwise from above. It closes exactly.
fn circle(v: f32) -> Vec3 {
    let angle = TAU * if v == 1.0 { 0.0 } else { v };
    Vec3::new(angle.cos(), 0.0, -angle.sin())
}

/// Points along a curve with two directions across it, carried along with as little turning as may be. On a closed curve the
/// turn that is left over at the end is spread over all of it.
fn frames(curve: &impl Fn(f32) -> Vec3, steps: usize, is_closed: bool) -> Vec<(Vec3, Vec3, Vec3)> {
    let at = |step: usize| curve(if is_closed { step % steps } else { step } as f32 / steps as f32);
    let tangent = |step: usize| {
        let (before, after) = match (is_closed, step) {
            (true, _) => (at((step + steps - 1) % steps), at((step + 1) % steps)),
            (false, _) => (at(step.saturating_sub(1)), at((step + 1).min(steps))),
        };
        (after - before).normalize_or(Vec3::X)
    };
    let mut across = tangent(0).any_orthonormal_vector();
    let mut found = Vec::with_capacity(steps + 1);
    for step in 0..=steps {
        let along = tangent(step);
        across = (across - along * across.dot(along)).normalize_or(along.any_orthonormal_vector());
        found.push((at(step), across, along));
    }
    let (first, last) = (found[0], found[steps]);
    let turn = match is_closed {
        true => last.1.cross(first.1).dot(first.2).atan2(last.1.dot(first.1)),
        false => 0.0,
    };
    let turned = |(step, (point, across, along)): (usize, (Vec3, Vec3, Vec3))| {
        let (sin, cos) = (turn * step as f32 / steps as f32).sin_cos();
        let across = across * cos + along.cross(across) * sin;
        (point, across, along.cross(across))
    };
    found.into_iter().enumerate().map(turned).collect()
}
