//! A small software rasteriser: which objects does one camera see? Plain and slow; the reference for scenes without a GPU.

use glam::{DMat4, DVec4};
use scenes::{Pose, Projection, Scene, Shot, Topology};

/// No object.
pub const NOTHING: u32 = u32::MAX;

/// Object index and depth of each pixel, row by row from the top.
pub struct ItemBuffer {
    pub width: usize,
    pub height: usize,
    pub items: Vec<u32>,
    /// Depth in clip space, near 1 and far 0; 0 where nothing is.
    pub depths: Vec<f64>,
}

impl ItemBuffer {
    /// Draws all triangles of a scene at time 0.
    pub fn draw(scene: &Scene, shot: &Shot, width: usize, height: usize) -> Self {
        let size = width * height;
        let mut buffer = ItemBuffer { width, height, items: vec![NOTHING; size], depths: vec![0.0; size] };
        let clip_from_world = clip_from_world(&shot.pose, &shot.projection, width as f64 / height as f64);
        let mut corners = Vec::new();
        for (index, object) in scene.objects.iter().enumerate() {
            let mesh = &scene.meshes[object.mesh as usize];
            if mesh.topology != Topology::Triangles {
                continue;
            }
            let clip_from_object = clip_from_world * DMat4::from(object.world_from_object);
            corners.clear();
            corners.extend(mesh.positions.iter().map(|position| clip_from_object * position.as_dvec3().extend(1.0)));
            if outside(&corners) {
                continue;
            }
            for triangle in mesh.indices.chunks_exact(3) {
                let [a, b, c] = [0, 1, 2].map(|corner| corners[triangle[corner] as usize]);
                buffer.clipped([a, b, c], index as u32);
            }
        }
        buffer
    }

    /// How many different objects own a pixel.
    pub fn visible(&self) -> usize {
        let mut items: Vec<u32> = self.items.iter().copied().filter(|&item| item != NOTHING).collect();
        items.sort_unstable();
        items.dedup();
        items.len()
    }

    /// The part of the pixels that show an object, in 0..=1.
    pub fn covered(&self) -> f64 {
        self.items.iter().filter(|&&item| item != NOTHING).count() as f64 / self.items.len() as f64
    }

    /// Cuts a triangle at the near plane, z = w, and draws what is left.
    fn clipped(&mut self, triangle: [DVec4; 3], item: u32) {
        let mut kept: Vec<DVec4> = Vec::with_capacity(4);
        for side in 0..3 {
            let (from, to) = (triangle[side], triangle[(side + 1) % 3]);
            let (inside_from, inside_to) = (from.w - from.z, to.w - to.z);
            if inside_from >= 0.0 {
                kept.push(from);
            }
            if (inside_from >= 0.0) != (inside_to >= 0.0) {
                kept.push(from.lerp(to, inside_from / (inside_from - inside_to)));
            }
        }
        for corner in 2..kept.len() {
            self.fill([kept[0], kept[corner - 1], kept[corner]], item);
        }
    }

    fn fill(&mut self, triangle: [DVec4; 3], item: u32) {
        let size = (self.width as f64, self.height as f64);
        let points = triangle.map(|corner| {
            let (x, y) = (corner.x / corner.w, corner.y / corner.w);
            ((0.5 * x + 0.5) * size.0, (0.5 * y + 0.5) * size.1, corner.z / corner.w)
        });
        let [a, b, c] = points;
        let area = (b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0);
        if area.is_nan() || area.abs() <= 1e-12 {
            return;
        }
        let range = |values: [f64; 3], end: usize| {
            let low = values.into_iter().fold(f64::INFINITY, f64::min).floor().max(0.0) as usize;
            let high = values.into_iter().fold(f64::NEG_INFINITY, f64::max).ceil().max(0.0) as usize;
            low..high.min(end)
        };
        for y in range([a.1, b.1, c.1], self.height) {
            for x in range([a.0, b.0, c.0], self.width) {
                let (px, py) = (x as f64 + 0.5, y as f64 + 0.5);
                let weight = |p: (f64, f64, f64), q: (f64, f64, f64)| {
                    ((q.0 - p.0) * (py - p.1) - (q.1 - p.1) * (px - p.0)) / area
                };
                let (wa, wb, wc) = (weight(b, c), weight(c, a), weight(a, b));
                let depth = wa * a.2 + wb * b.2 + wc * c.2;
                let pixel = y * self.width + x;
                if wa >= 0.0 && wb >= 0.0 && wc >= 0.0 && depth > self.depths[pixel] {
                    (self.depths[pixel], self.items[pixel]) = (depth, item);
                }
            }
        }
    }
}

/// World to clip space for a picture of the given width over height.
pub fn clip_from_world(pose: &Pose, projection: &Projection, aspect: f64) -> DMat4 {
    projection.clip_from_view(aspect) * DMat4::from_rotation_translation(pose.rotation, pose.position).inverse()
}

/// All corners are beyond one plane of the view volume.
pub fn outside(corners: &[DVec4]) -> bool {
    let planes: [fn(&DVec4) -> bool; 6] =
        [|c| c.x > c.w, |c| c.x < -c.w, |c| c.y > c.w, |c| c.y < -c.w, |c| c.z > c.w, |c| c.z < 0.0];
    planes.iter().any(|beyond| corners.iter().all(beyond))
}
