//! From which cells one looks, and through which portals one sees which others.
//!
//! What a cell is seen through is kept as one rectangle of the picture: the smallest around all ways that lead to it, which grows until no
//! way makes it larger. A portal's rectangle is that of the polygon cut at the near plane, a pixel wider on every side: a
//! pixel shows what is less than that beside the ray through its middle.

use crate::View;
use glam::{DVec2, DVec3, DVec4};
use scenes::{Aabb, Cells, Portal};

/// A rectangle of the picture, in the coordinates of clip space over w.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle {
    /// Least x and y.
    pub min: DVec2,
    /// Largest x and y.
    pub max: DVec2,
}

impl Rectangle {
    /// The picture, and a pixel around it.
    pub fn whole(view: &View) -> Self {
        let reach = 1.0 + pixels(view, 1.0);
        Rectangle { min: -reach, max: reach }
    }

    /// Around a box, so many pixels wider; none if the box reaches before the near plane.
    pub fn around(bounds: &Aabb, view: &View, wider_px: f64) -> Option<Self> {
        let corner = |index: usize| {
            let pick = |axis: usize| if index >> axis & 1 == 0 { bounds.min[axis] } else { bounds.max[axis] };
            clip(view, DVec3::new(pick(0), pick(1), pick(2)))
        };
        let corners: Vec<DVec4> = (0..8).map(corner).collect();
        let in_front = corners.iter().all(|corner| corner.z < corner.w && corner.w > 0.0);
        in_front.then(|| Self::of(&corners, view, wider_px))
    }

    fn of(corners: &[DVec4], view: &View, wider_px: f64) -> Self {
        let wider = pixels(view, wider_px);
        let at = || corners.iter().map(|corner| DVec2::new(corner.x, corner.y) / corner.w);
        Rectangle {
            min: at().fold(DVec2::INFINITY, DVec2::min) - wider,
            max: at().fold(DVec2::NEG_INFINITY, DVec2::max) + wider,
        }
    }

    /// True if they have a point in common.
    pub fn meets(&self, other: &Self) -> bool {
        self.min.cmple(other.max).all() && other.min.cmple(self.max).all()
    }

    fn within(self, other: &Self) -> Option<Self> {
        self.meets(other).then(|| Rectangle { min: self.min.max(other.min), max: self.max.min(other.max) })
    }

    fn joined(self, other: Self) -> Self {
        Rectangle { min: self.min.min(other.min), max: self.max.max(other.max) }
    }
}

fn pixels(view: &View, count: f64) -> DVec2 {
    DVec2::from(view.size.map(|pixels| 2.0 * count / f64::from(pixels)))
}

fn clip(view: &View, at: DVec3) -> DVec4 {
    view.clip_from_relative() * (at - view.pose.position).extend(1.0)
}

/// Where one looks from.
#[derive(Clone, Debug, PartialEq)]
pub enum Start {
    /// From these cells; the number of cells stands for outside.
    In(Vec<usize>),
    /// From a place of which the cells say nothing, for this reason.
    Anywhere(&'static str),
}

/// The cell that the near plane's part in the picture is in, farther from its walls than these are thick; or the two that it is in, if it is
/// in the opening between them. So no wall is cut open, and all rays begin in a cell.
pub fn start(cells: &Cells, view: &View) -> Start {
    let Some(near) = near_plane(view, cells.reach) else { return Start::Anywhere("the near plane is nowhere") };
    let all = cells.cells.iter().enumerate();
    let (mut touched, mut held) = (Vec::new(), 0.0);
    for (index, cell) in all {
        let (low, high) = (near.min.max(cell.bounds.min), near.max.min(cell.bounds.max));
        if low.cmple(high).all() {
            touched.push(index);
            held += (high - low).element_product();
        }
    }
    if touched.is_empty() {
        return Start::In(vec![cells.cells.len()]);
    }
    if held < (near.max - near.min).element_product() * (1.0 - 1e-9) {
        return Start::Anywhere("the eye is at an outer wall");
    }
    let [first, second] = touched[..] else {
        return if touched.len() == 1 { Start::In(touched) } else { Start::Anywhere("the eye is where cells meet") };
    };
    let joins = |portal: &&Portal| {
        portal.cells == [Some(first as u32), Some(second as u32)]
            || portal.cells == [Some(second as u32), Some(first as u32)]
    };
    if cells.portals.iter().filter(joins).any(|portal| is_in_opening(portal, &near)) {
        Start::In(touched)
    } else {
        Start::Anywhere("the eye is at a wall")
    }
}

/// A box around the part of the near plane that is in the picture, so much larger.
fn near_plane(view: &View, by: f64) -> Option<Aabb> {
    let relative_from_clip = view.clip_from_relative().inverse();
    let reach = Rectangle::whole(view).max;
    let corner = |x: f64, y: f64| relative_from_clip.project_point3(DVec3::new(x, y, 1.0)) + view.pose.position;
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| corner(x * reach.x, y * reach.y));
    let around = Aabb::from_points(corners);
    around.is_valid().then(|| Aabb { min: around.min - by, max: around.max + by })
}

/// True if a box, seen along the portal's normal, is in its polygon.
fn is_in_opening(portal: &Portal, around: &Aabb) -> bool {
    let (normal, corners) = (portal.normal(), &portal.corners);
    let inside = |point: DVec3| {
        (0..corners.len()).all(|index| {
            let (from, to) = (corners[index], corners[(index + 1) % corners.len()]);
            (to - from).cross(point - from).dot(normal) >= 0.0
        })
    };
    let corner = |index: usize| {
        let pick = |axis: usize| if index >> axis & 1 == 0 { around.min[axis] } else { around.max[axis] };
        DVec3::new(pick(0), pick(1), pick(2))
    };
    (0..8).all(|index| inside(corner(index)))
}

/// What is seen from where.
pub struct Sight<'a> {
    cells: &'a Cells,
    view: &'a View,
    /// None for parallel projections.
    eye: Option<DVec3>,
    /// By cell, and last outside: where in the picture it is seen.
    pub pictures: Vec<Option<Rectangle>>,
}

impl<'a> Sight<'a> {
    /// Nothing is seen yet.
    pub fn new(cells: &'a Cells, view: &'a View) -> Self {
        let eye = crate::boxes::eye_of(&view.clip_from_relative());
        let eye = (eye.w != 0.0 && eye.is_finite()).then(|| view.pose.position + eye.truncate());
        Sight { cells, view, eye, pictures: vec![None; cells.cells.len() + 1] }
    }

    /// Looks around from some cells, and through their portals into others, until nothing new is seen.
    pub fn look(&mut self, from: &[usize]) {
        let whole = Rectangle::whole(self.view);
        let mut open: Vec<usize> = from.to_vec();
        from.iter().for_each(|cell| self.pictures[*cell] = Some(whole));
        let outside = self.cells.cells.len();
        while let Some(cell) = open.pop() {
            let Some(picture) = self.pictures[cell] else { continue };
            for portal in &self.cells.portals {
                let [one, other] = portal.cells.map(|cell| cell.map_or(outside, |cell| cell as usize));
                let beyond = match cell {
                    _ if cell == one => other,
                    _ if cell == other => one,
                    _ => continue,
                };
                let through = self.picture(portal, cell, beyond).and_then(|through| through.within(&picture));
                let Some(through) = through else { continue };
                let grown = self.pictures[beyond].map_or(through, |known| known.joined(through));
                if self.pictures[beyond] != Some(grown) {
                    self.pictures[beyond] = Some(grown);
                    open.push(beyond);
                }
            }
        }
    }

    /// Where in the picture one sees out of a cell through its portal; none if one does not.
    fn picture(&self, portal: &Portal, from: usize, to: usize) -> Option<Rectangle> {
        if self.eye.is_some_and(|eye| self.is_behind(portal, from, to, eye)) {
            return None;
        }
        let corners: Vec<DVec4> = portal.corners.iter().map(|corner| clip(self.view, *corner)).collect();
        let cut = cut_at_near(&corners);
        if cut.iter().any(|corner| corner.w <= 0.0 || !corner.is_finite()) {
            return Some(Rectangle::whole(self.view));
        }
        (!cut.is_empty()).then(|| Rectangle::of(&cut, self.view, 1.0))
    }

    /// True if the eye is beyond the portal already: then no ray leaves the cell by it.
    fn is_behind(&self, portal: &Portal, from: usize, to: usize, eye: DVec3) -> bool {
        let normal = portal.normal();
        let along = |at: DVec3| (at - portal.corners[0]).dot(normal);
        let middle = |cell: usize| self.cells.cells.get(cell).map(|cell| along(cell.bounds.centre()));
        let side = match (middle(from), middle(to)) {
            (Some(from), _) => from,
            (None, Some(to)) => -to,
            (None, None) => return false,
        };
        // Near the plane it may be on either side.
        along(eye) * side.signum() < -self.cells.reach * normal.length()
    }
}

/// The part of a polygon beyond the near plane (Sutherland & Hodgman 1974).
fn cut_at_near(corners: &[DVec4]) -> Vec<DVec4> {
    // Beyond it z is less than w; what is a rounding before it stays.
    let beyond = |corner: &DVec4| corner.w - corner.z + 1e-12 * (corner.w.abs() + corner.z.abs());
    let mut cut = Vec::new();
    for (index, to) in corners.iter().enumerate() {
        let from = &corners[(index + corners.len() - 1) % corners.len()];
        let (before, after) = (beyond(from), beyond(to));
        if (before < 0.0) != (after < 0.0) {
            cut.push(*from + (*to - *from) * (before / (before - after)));
        }
        if after >= 0.0 {
            cut.push(*to);
        }
    }
    cut
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;
    use scenes::{Cell, Pose, Projection, Shot};

    /// An opening 2 m wide and high at a depth before the first eye's plane, with its middle at `x`.
    fn opening(cells: [Option<u32>; 2], x: f64, z: f64) -> Portal {
        let corner = |dx: f64, dy: f64| DVec3::new(x + dx, dy, z);
        Portal { cells, corners: vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)] }
    }

    /// Three rooms in a row, 10 m deep each. The opening into the third has its middle at `x`.
    fn rooms(x: f64) -> Cells {
        let cell = |number: i32| {
            let far = -10.0 * f64::from(number + 1);
            let bounds = Aabb { min: DVec3::new(-5.0, -5.0, far), max: DVec3::new(5.0, 5.0, far + 10.0) };
            Cell { name: format!("room {number}"), bounds }
        };
        let portals = vec![opening([Some(0), Some(1)], 0.0, -10.0), opening([Some(1), Some(2)], x, -20.0)];
        Cells { half_wall: 0.05, reach: 0.1, cells: (0..3).map(cell).collect(), portals }
    }

    /// In the first room, 8 m before its opening, looking at it or to the other side.
    fn look(towards: f64) -> View {
        let pose = Pose {
            position: DVec3::new(0.0, 0.0, -2.0),
            rotation: DQuat::from_rotation_y(if towards < 0.0 { 0.0 } else { std::f64::consts::PI }),
        };
        let projection = Projection::Perspective { fov_y: 1.2, near: 0.1, far: Some(100.0) };
        View::new(&Shot { pose, projection, seconds: 0.0 }, [200, 200], 0, 0.0)
    }

    fn seen(cells: &Cells, view: &View) -> Vec<Option<Rectangle>> {
        let Start::In(from) = start(cells, view) else { panic!("the eye is in a room") };
        assert_eq!(from, [0]);
        let mut sight = Sight::new(cells, view);
        sight.look(&from);
        sight.pictures
    }

    #[test]
    fn portals_one_behind_the_other_show_three_rooms_and_portals_set_apart_show_two() {
        let view = look(-1.0);
        let count = |x: f64| seen(&rooms(x), &view).iter().flatten().count();
        // Through the first opening the eye sees 18/8 = 2.25 m to each side in the plane of the second, whose near edge is at x - 1.
        assert_eq!([0.0, 2.0, 3.0, 3.6, 4.0].map(count), [3, 3, 3, 2, 2]);
        assert_eq!([-3.0, -3.6].map(count), [3, 2]);
        assert_eq!(seen(&rooms(0.0), &look(1.0)).iter().flatten().count(), 1, "it looks away");
    }

    #[test]
    fn each_portal_narrows_the_picture_of_what_lies_beyond() {
        let view = look(-1.0);
        let pictures = seen(&rooms(2.0), &view);
        let [first, second, third] = [0, 1, 2].map(|cell| pictures[cell].unwrap());
        assert_eq!(first, Rectangle::whole(&view));
        // A metre at a distance d lies 1 / (d tan 0.6) from the middle of the picture; pixels are 0.01 wide, and each side is a pixel wider.
        let at = |metres: f64, distance: f64| metres / (distance * 0.6f64.tan());
        let near = |one: f64, other: f64| (one - other).abs() < 1e-9;
        assert!(near(second.max.x, at(1.0, 8.0) + 0.01) && near(second.min.y, -at(1.0, 8.0) - 0.01), "{second:?}");
        assert!(near(third.min.x, at(1.0, 18.0) - 0.01) && near(third.max.x, second.max.x), "{third:?}");
        assert!(near(third.max.y, at(1.0, 18.0) + 0.01), "{third:?}");
    }

    /// The cut of a portal at the near plane keeps what lies beyond it.
    #[test]
    fn a_portal_across_the_near_plane_is_cut_there() {
        let corner = |x: f64, z: f64| DVec4::new(x, 0.0, z, 1.0);
        assert_eq!(cut_at_near(&[corner(0.0, 0.5), corner(1.0, 0.5), corner(1.0, 0.0)]).len(), 3, "all beyond");
        assert!(cut_at_near(&[corner(0.0, 1.5), corner(1.0, 1.5), corner(1.0, 2.0)]).is_empty(), "all before");
        let cut = cut_at_near(&[corner(0.0, 0.5), corner(4.0, 0.5), corner(4.0, 1.5)]);
        assert_eq!(cut.len(), 4);
        // The plane is taken a rounding nearer: 1e-12 of w and of z, both about 1 here.
        let is_at_the_plane = |corner: &&DVec4| (corner.z - 1.0).abs() < 1e-11;
        let ends: Vec<f64> = cut.iter().filter(is_at_the_plane).map(|corner| corner.x).collect();
        assert!(ends.len() == 2 && (ends[0] - 2.0).abs() < 1e-10 && ends[1] == 4.0, "{cut:?}");
    }
}
