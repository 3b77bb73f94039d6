//! Where things are: whether a place is within an object's solid, and whether a box may be in view.

use crate::support::{clip_from_world, outside, ItemBuffer};
use glam::{DAffine3, DVec2, DVec3, DVec4};
use scenes::{Aabb, Scene, Shot, WorldBounds};

/// The boxes of all objects: most of them do not hold a place, and need no closer look.
pub struct InsideTest<'a> {
    scene: &'a Scene,
    bounds: WorldBounds,
    still: Vec<(usize, Aabb)>,
}

impl<'a> InsideTest<'a> {
    pub fn new(scene: &'a Scene) -> Self {
        let bounds = WorldBounds::new(scene);
        let of = |object: &scenes::Object| bounds.of(object.mesh, &object.world_from_object);
        let still = scene.objects.iter().enumerate().filter(|(_, object)| !object.dynamic);
        let still = still.map(|(index, object)| (index, of(object))).collect();
        InsideTest { scene, bounds, still }
    }

    /// An object that has the place within its solid at a time.
    pub fn solid_around(&self, at: DVec3, seconds: f64) -> Option<usize> {
        let objects = &self.scene.objects;
        let mut moved = Vec::new();
        self.scene.motion.transforms_at(seconds, &mut moved);
        let moving = moved.iter().map(|(object, place)| (*object as usize, *place));
        let moving = moving.filter(|(object, place)| self.bounds.of(objects[*object].mesh, place).contains(at));
        let still = self.still.iter().filter(|(_, bounds)| bounds.contains(at));
        let still = still.map(|(object, _)| (*object, objects[*object].world_from_object));
        moving.chain(still).find(|(object, place)| is_inside(self.scene, *object, place, at)).map(|(object, _)| object)
    }
}

/// Crossings outward minus crossings inward along a ray: above 0 within one closed part at least.
fn is_inside(scene: &Scene, object: usize, world_from_object: &DAffine3, at: DVec3) -> bool {
    let mesh = &scene.meshes[scene.objects[object].mesh as usize];
    let from = world_from_object.inverse().transform_point3(at);
    // Aslant, so that it meets no edge of what stands upright.
    let along = DVec3::new(0.314, 0.859, 0.403);
    let crossing = |triangle: &[u32]| {
        let [a, b, c] = [0, 1, 2].map(|corner| mesh.positions[triangle[corner] as usize].as_dvec3() - from);
        let sides = [a.cross(b).dot(along), b.cross(c).dot(along), c.cross(a).dot(along)];
        let ahead = a.dot((b - a).cross(c - a)) * along.dot((b - a).cross(c - a)) > 0.0;
        match (sides.iter().all(|&side| side > 0.0), sides.iter().all(|&side| side < 0.0)) {
            (true, _) if ahead => 1,
            (_, true) if ahead => -1,
            _ => 0,
        }
    };
    mesh.indices.chunks_exact(3).map(crossing).sum::<i32>() > 0
}

/// False if a box is beyond one plane of the view.
pub fn may_be_in_view(bounds: &Aabb, shot: &Shot, aspect: f64) -> bool {
    let clip_from_world = clip_from_world(&shot.pose, &shot.projection, aspect);
    let corner = |number: usize| {
        let pick = |axis: usize| if number >> axis & 1 == 0 { bounds.min[axis] } else { bounds.max[axis] };
        clip_from_world * DVec3::new(pick(0), pick(1), pick(2)).extend(1.0)
    };
    !outside(&[0, 1, 2, 3, 4, 5, 6, 7].map(corner))
}

/// The farthest way, in pixels of 1920x1080, that a point seen in a frame has gone since the frame before, if only the camera
/// moves.
pub fn farthest_motion_px(scene: &Scene, before: &Shot, now: &Shot) -> f64 {
    const SIZE: DVec2 = DVec2::new(1920.0, 1080.0);
    let aspect = SIZE.x / SIZE.y;
    let picture = ItemBuffer::draw(scene, now, 160, 90);
    let clip = |shot: &Shot| clip_from_world(&shot.pose, &shot.projection, aspect);
    let before_from_now = clip(before) * clip(now).inverse();
    let motion = |pixel: usize| {
        let at = DVec2::new((pixel % 160) as f64 + 0.5, (pixel / 160) as f64 + 0.5) / DVec2::new(160.0, 90.0);
        let at = 2.0 * at - DVec2::ONE;
        let was = before_from_now * DVec4::new(at.x, at.y, picture.depths[pixel], 1.0);
        (at - was.truncate().truncate() / was.w) * 0.5 * SIZE
    };
    let seen = (0..picture.depths.len()).filter(|&pixel| picture.depths[pixel] > 0.0);
    seen.map(|pixel| motion(pixel).length()).fold(0.0, f64::max)
}
