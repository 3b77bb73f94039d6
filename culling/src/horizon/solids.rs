//! What of a building surely hides what is behind it.
//!
//! The scene promises that a closed mesh of opaque triangles encloses the box. A ray from outside that mesh therefore meets the mesh before
//! it meets the box, and what lies on the ray beyond is hidden, if the mesh is not cut open: so the building must lie wholly
//! in front of the near plane, which also keeps the eye out of it.
//!
//! That is true of rays. Pixels show what is up to a grid step from the ray through their middle, once for the hidden object and once for
//! the mesh, and depths are rounded. `include/box.glsl` derives by how much a box must grow to hold all pixels and depths of what
//! is in it; here the mesh is the box that has grown, and the rays that count are those that meet the box made smaller by as much: a ball
//! of that radius around each point of it lies in the mesh, so the pixel meets the mesh too, and in front.

use crate::boxes::twin::{crosses_near, growth};
use crate::frustum::twin::clip_from_bounds;
use crate::world::{gpu_bounds, Solid, World};
use glam::{DAffine3, DVec2, DVec3};
use scenes::bvh::Bvh;
use scenes::Aabb;
use shaders::types::{Bounds, CullView, OBJECT_ALWAYS_KEPT};

/// An upright box, made smaller, as seen from an eye: all positions are relative to it.
#[derive(Clone, Debug)]
pub struct Prism {
    /// The building's object.
    pub object: u32,
    /// By how much the solid was made smaller on every side, in metres.
    pub shrunk: f64,
    /// Corners of its plan, counter-clockwise or clockwise.
    pub plan: [DVec2; 4],
    /// Heights of foot and top.
    pub heights: [f64; 2],
    /// It hides nothing nearer than this, in metres along the ground.
    pub from: f64,
    /// The eye is above or below it.
    holds_eye: bool,
    /// Nothing is left of it.
    empty: bool,
}

impl Prism {
    /// None if the building is cut open by the near plane, or has no bounds.
    pub fn new(solid: &Solid, bounds: &Aabb, view: &CullView, eye: DVec3) -> Option<Self> {
        let bounds = gpu_bounds(bounds, &DAffine3::IDENTITY, 0);
        if bounds.flags & OBJECT_ALWAYS_KEPT != 0 {
            return None;
        }
        let by = growth(&clip_from_bounds(&bounds, view), view, 0);
        let grown = Bounds { half_extent: bounds.half_extent.map(|half| half + by), ..bounds };
        if !by.is_finite() || crosses_near(&clip_from_bounds(&grown, view)) {
            return None;
        }
        Some(Self::shrunk(solid, f64::from(by), eye))
    }

    /// The solid made smaller.
    pub fn shrunk(solid: &Solid, by: f64, eye: DVec3) -> Self {
        let axes = solid.axes.map(|axis| axis * (1.0 - by / axis.length()).max(0.0));
        let empty = solid.axes.iter().any(|axis| axis.length() <= by);
        let centre = solid.centre - eye;
        let [x, up, z] = axes;
        let corner = |right: f64, forward: f64| {
            let at = centre + right * x + forward * z;
            DVec2::new(at.x, at.z)
        };
        let plan = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
        let heights = [centre.y - up.y.abs(), centre.y + up.y.abs()];
        let mut prism = Prism { object: solid.object, shrunk: by, plan, heights, from: 0.0, holds_eye: false, empty };
        let sides_that_face = prism.sides().filter(|(_, offset)| *offset < 0.0).count();
        prism.holds_eye = sides_that_face == 0;
        prism.from = prism.nearest_hidden();
        prism
    }

    /// Its sides: outward normal, and how far along it they are. Those that face the eye have a negative offset.
    fn sides(&self) -> impl Iterator<Item = (DVec2, f64)> + '_ {
        let middle = 0.25 * self.plan.iter().sum::<DVec2>();
        (0..4).map(move |side| {
            let (from, to) = (self.plan[side], self.plan[(side + 1) % 4]);
            let normal = (to - from).perp();
            let normal = if normal.dot(from - middle) < 0.0 { -normal } else { normal };
            (normal, normal.dot(from))
        })
    }

    /// True if it can hide something.
    pub fn fills(&self) -> bool {
        !self.empty && !self.holds_eye
    }

    /// 1 over the distance at which a ray in this direction enters its plan; 0 or less if it does not.
    pub fn entry(&self, direction: DVec2) -> f64 {
        let facing = self.sides().filter(|(_, offset)| *offset < 0.0);
        facing.map(|(normal, offset)| normal.dot(direction) / offset).fold(f64::INFINITY, f64::min)
    }

    /// 1 over the distance at which a ray in this direction that enters its plan leaves it.
    pub fn exit(&self, direction: DVec2) -> f64 {
        let averted = self.sides().filter(|(_, offset)| *offset >= 0.0);
        averted.map(|(normal, offset)| normal.dot(direction) / offset).fold(0.0, f64::max)
    }

    /// How far the sides reach at which rays enter; or, if one looks down on it, how far it reaches.
    fn nearest_hidden(&self) -> f64 {
        let seen_from_above = self.heights[1] < 0.0;
        let sides = self.sides().collect::<Vec<_>>();
        let counts = |corner: usize| seen_from_above || sides[corner].1 < 0.0 || sides[(corner + 3) % 4].1 < 0.0;
        let reach = (0..4).filter(|corner| counts(*corner)).map(|corner| self.plan[corner].length());
        reach.fold(0.0, f64::max) * (1.0 + 1e-9)
    }
}

/// In which building an object is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Content {
    /// The building's number.
    pub building: u32,
    /// How far the object's box is from the nearest face of the solid, in metres.
    pub depth: f64,
}

/// By object: the building that it is in, if it stays there. Of several the one that it is deepest in.
pub fn contents(world: &World, bvh: &Bvh) -> Vec<Option<Content>> {
    let mut contents = vec![None; world.len()];
    for (building, solid) in world.solids().iter().enumerate() {
        let reach = solid.axes.iter().map(|axis| axis.abs()).sum::<DVec3>();
        let around = Aabb { min: solid.centre - reach, max: solid.centre + reach };
        let mut open: Vec<u32> = bvh.root().into_iter().collect();
        while let Some(index) = open.pop() {
            let node = &bvh.nodes()[index as usize];
            let apart = node.bounds.min.cmpgt(around.max).any() || node.bounds.max.cmplt(around.min).any();
            if apart {
                continue;
            }
            open.extend(node.children().into_iter().flatten());
            let Some(object) = node.object() else { continue };
            let depth = depth_in(solid, &world.host_bounds()[object as usize]);
            let content: &mut Option<Content> = &mut contents[object as usize];
            if depth >= 0.0 && content.is_none_or(|content| content.depth < depth) {
                *content = Some(Content { building: building as u32, depth });
            }
        }
    }
    world.moving().for_each(|(object, _)| contents[object as usize] = None);
    contents
}

/// How far a box is from the nearest face of the solid that it is in; negative if it reaches out.
pub fn depth_in(solid: &Solid, bounds: &Aabb) -> f64 {
    let (centre, half) = (bounds.centre() - solid.centre, bounds.half_extent());
    let spare = |axis: &DVec3| {
        let length = axis.length();
        let along = *axis / length;
        length - (centre.dot(along).abs() + half.dot(along.abs())) * (1.0 + 1e-12)
    };
    let depth = solid.axes.iter().map(spare).fold(f64::INFINITY, f64::min);
    if depth.is_nan() {
        -1.0
    } else {
        depth
    }
}
