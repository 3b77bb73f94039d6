//! The oracle: which object does the ray through the centre of a pixel meet first? Computed in `f64`, triangle by triangle, without the
//! renderer, so it also finds pictures that are wrong in every method alike.
//!
//! 1. Each edge of a triangle spans a plane through the eye (Olano and Greer 1997). The ray meets the triangle where it is on the inner
//!    side of all three planes. This needs no clipping.
//! 2. A ray that passes within [`Rays::margin_px`] of an edge may or may not meet the triangle: devices move corners to a grid.
//! 3. The nearest hit decides. The pixel is left out if a hit near an edge, or a hit of the same depth within rounding, belongs to
//!    another object.

mod glb;
pub mod model;
pub mod random;
mod scene;

pub use scene::surfaces;

use glam::{DMat3, DVec2, DVec3, DVec4};
use scenes::{Pose, Projection};
use std::rc::Rc;

/// The content of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pixel {
    /// The object of this number.
    Object(u32),
    /// Nothing.
    Nothing,
    /// The pixel is too near an edge, or two surfaces are too near each other, to tell.
    Open,
}

/// A triangle in the world.
#[derive(Clone, Debug)]
pub struct Triangle {
    /// Positions in metres.
    pub corners: [DVec3; 3],
    /// Alpha of the vertices.
    pub alpha: [f64; 3],
    /// The place of the vertices on the texture, (1, 1) being its lower right corner.
    pub coordinates: [DVec2; 3],
}

/// The triangles of an object at one time.
#[derive(Clone, Debug)]
pub struct Surface {
    /// The object's number in its scene.
    pub object: u32,
    /// The triangles, with corners in the order of the file.
    pub triangles: Vec<Triangle>,
    /// Which side shows.
    pub side: Side,
    /// Where the surface has holes; none if it has none.
    pub mask: Option<Mask>,
}

/// Which side of a triangle shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Both.
    Both,
    /// The side on which the corners go round counter-clockwise.
    CounterClockwise,
    /// The side on which the corners go round clockwise: that of mirrored objects.
    Clockwise,
}

/// The alpha test of a surface.
#[derive(Clone, Debug)]
pub struct Mask {
    /// The surface is there where alpha is at least this.
    pub cutoff: f64,
    /// The factor of the whole object's alpha.
    pub factor: f64,
    /// The texture, of which only alpha counts.
    pub texture: Option<Rc<scenes::Texture>>,
}

/// Lines and points cover more than their geometry: pixels near them are left out.
#[derive(Clone, Debug, Default)]
pub struct Wide {
    /// Line segments and points (both ends alike), in the world.
    pub segments: Vec<[DVec3; 2]>,
}

/// The rays of a picture.
#[derive(Clone, Copy, Debug)]
pub struct Rays {
    pose: Pose,
    projection: Projection,
    size: [u32; 2],
    /// Distance from an edge, in pixels, from which on a hit is certain.
    pub margin_px: f64,
}

/// A ray's hit, or near miss, of a triangle.
#[derive(Clone, Copy, Debug)]
struct Hit {
    depth: f64,
    /// Largest error of `depth`.
    slack: f64,
    object: u32,
    certain: bool,
}

/// Relative error of depths that devices compute in `f32`. Positions are rounded three times on their way (to object, camera and clip
/// space), by 2^-22 each for scenes of ordinary size. The interpolation of depth adds as much again.
const DEPTH_ERROR: f64 = 4.0e-6;

impl Rays {
    /// The rays through a picture of this width and height, on a device that moves corners by up to `snap_px` pixels.
    pub fn new(pose: Pose, projection: Projection, size: [u32; 2], snap_px: f64) -> Self {
        Rays { pose, projection, size, margin_px: 2.0 * snap_px + 1.0 / 64.0 }
    }

    /// Casts all rays: a pixel each, row by row from the top.
    pub fn cast(&self, surfaces: &[Surface], wide: &Wide) -> Vec<Pixel> {
        let [width, height] = self.size.map(|side| side as usize);
        let mut hits: Vec<Vec<Hit>> = vec![Vec::new(); width * height];
        for surface in surfaces {
            for triangle in &surface.triangles {
                self.meet(surface, triangle, &mut hits);
            }
        }
        let mut pixels: Vec<Pixel> = hits.iter().map(|hits| first(hits)).collect();
        wide.segments.iter().for_each(|segment| self.leave_out(*segment, &mut pixels));
        pixels
    }

    /// Clip space with y up, and depth 1 (near) to 0 (far).
    fn clip(&self, world: DVec3) -> DVec4 {
        let view = self.pose.rotation.conjugate() * (world - self.pose.position);
        let aspect = f64::from(self.size[0]) / f64::from(self.size[1]);
        match self.projection {
            Projection::Perspective { fov_y, near, far } => {
                let y = 1.0 / (0.5 * fov_y).tan();
                let depth = far.map_or(near, |far| near * (far + view.z) / (far - near));
                DVec4::new(view.x * y / aspect, view.y * y, depth, -view.z)
            }
            Projection::Orthographic { half_height, near, far } => {
                let (x, y) = (view.x / (half_height * aspect), view.y / half_height);
                DVec4::new(x, y, (view.z + far) / (far - near), 1.0)
            }
            Projection::Custom(matrix) => (matrix * view.extend(1.0)) * DVec4::new(1.0, -1.0, 1.0, 1.0),
        }
    }

    fn meet(&self, surface: &Surface, triangle: &Triangle, hits: &mut [Vec<Hit>]) {
        let clip = triangle.corners.map(|corner| self.clip(corner));
        let [a, b, c] = clip.map(|corner| DVec3::new(corner.x, corner.y, corner.w));
        let determinant = a.dot(b.cross(c));
        let shows = match surface.side {
            Side::Both => determinant != 0.0,
            Side::CounterClockwise => determinant > 0.0,
            Side::Clockwise => determinant < 0.0,
        };
        if !shows || !determinant.is_finite() {
            return;
        }
        // The ray (x, y, 1) meets the triangle where all three products with it are above 0; their sum is 1 / w.
        let inside = [b.cross(c), c.cross(a), a.cross(b)].map(|edge| edge / determinant);
        let depths = clip.map(|corner| corner.z);
        let [width, height] = self.size.map(f64::from);
        let per_px = DVec2::new(2.0 / width, -2.0 / height);
        let slope = |of: DVec3| (of.truncate() * per_px).abs().element_sum();
        let depth_plane = inside[0] * depths[0] + inside[1] * depths[1] + inside[2] * depths[2];
        let margin = self.margin_px + far_out(&clip, self.size);
        for [x, y] in self.pixels_near(&clip, margin) {
            let ray = DVec3::new((f64::from(x) + 0.5) * per_px.x - 1.0, (f64::from(y) + 0.5) * per_px.y + 1.0, 1.0);
            let weights = inside.map(|edge| edge.dot(ray));
            let within =
                (0..3).map(|at| weights[at] / slope(inside[at]).max(f64::MIN_POSITIVE)).fold(f64::MAX, f64::min);
            let depth = depth_plane.dot(ray);
            let slack = DEPTH_ERROR * depth.abs() + 2.0 * margin * slope(depth_plane);
            if within < -margin || depth > 1.0 + slack || depth < -slack {
                continue;
            }
            let clear = within > margin && depth < 1.0 - slack && depth > slack;
            let there =
                surface.mask.as_ref().map_or(Some(true), |mask| mask.is_there(triangle, weights, inside, per_px));
            if there != Some(false) {
                let certain = clear && there == Some(true);
                hits[(y * self.size[0] + x) as usize].push(Hit { depth, slack, object: surface.object, certain });
            }
        }
    }

    /// Returns the pixels whose centres a triangle may cover: those around its corners' box, or all pixels if a corner is behind the
    /// eye.
    fn pixels_near(&self, clip: &[DVec4; 3], margin: f64) -> impl Iterator<Item = [u32; 2]> {
        let [width, height] = self.size;
        let all = [0..width, 0..height];
        let [columns, rows] = match clip.iter().all(|corner| corner.w > 0.0) {
            false => all,
            true => {
                let places = clip.map(|corner| self.place_px(corner));
                let range = |along: [f64; 3], end: u32| {
                    let low = along.into_iter().fold(f64::INFINITY, f64::min) - margin - 1.0;
                    let high = along.into_iter().fold(f64::NEG_INFINITY, f64::max) + margin + 1.0;
                    // `as` saturates at 0 and at the largest number.
                    (low.max(0.0) as u32).min(end)..(high.max(0.0) as u32).min(end)
                };
                [range(places.map(|place| place.x), width), range(places.map(|place| place.y), height)]
            }
        };
        rows.flat_map(move |y| columns.clone().map(move |x| [x, y]))
    }

    fn place_px(&self, clip: DVec4) -> DVec2 {
        let [width, height] = self.size.map(f64::from);
        DVec2::new((0.5 * clip.x / clip.w + 0.5) * width, (0.5 - 0.5 * clip.y / clip.w) * height)
    }

    /// Leaves out the pixels within two of a line or a point.
    fn leave_out(&self, [from, to]: [DVec3; 2], pixels: &mut [Pixel]) {
        const REACH_PX: f64 = 2.0;
        let clip = [self.clip(from), self.clip(to), self.clip(to)];
        if clip.iter().any(|corner| corner.w <= 0.0) {
            return pixels.fill(Pixel::Open);
        }
        let [from, to, _] = clip.map(|corner| self.place_px(corner));
        for [x, y] in self.pixels_near(&clip, REACH_PX) {
            let centre = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let along = (to - from).normalize_or_zero();
            let t = (centre - from).dot(along).clamp(0.0, (to - from).length());
            if (from + along * t).distance(centre) <= REACH_PX {
                pixels[(y * self.size[0] + x) as usize] = Pixel::Open;
            }
        }
    }
}

/// The rounding error in pixels of corners far outside the picture, which `f32` rounds more coarsely.
fn far_out(clip: &[DVec4; 3], size: [u32; 2]) -> f64 {
    let reach = |corner: &DVec4| corner.x.abs().max(corner.y.abs()).max(corner.w.abs());
    let far = clip.iter().map(reach).fold(0.0, f64::max);
    let near = clip.iter().map(|corner| corner.w.abs()).fold(f64::MAX, f64::min).max(1e-3 * far);
    let half_px = 0.5 * f64::from(size[0].max(size[1]));
    half_px * far / near * 4.0 * f64::from(f32::EPSILON)
}

/// Decides a pixel by its nearest hit.
fn first(hits: &[Hit]) -> Pixel {
    let nearest = hits.iter().filter(|hit| hit.certain).max_by(|a, b| a.depth.total_cmp(&b.depth));
    let Some(nearest) = nearest else {
        return if hits.is_empty() { Pixel::Nothing } else { Pixel::Open };
    };
    let rivals = hits.iter().filter(|hit| hit.object != nearest.object);
    match rivals.clone().any(|hit| hit.depth + hit.slack >= nearest.depth - nearest.slack) {
        true => Pixel::Open,
        false => Pixel::Object(nearest.object),
    }
}

/// Largest error of an alpha that varies and that a device interpolates: see culling/src/world/detail.rs.
const ALPHA_ERROR: f64 = 1.0 / 512.0;
/// Numbers that a file means to be equal differ by the rounding of their formats.
const MEANT_EQUAL: f64 = 1e-6;

impl Mask {
    /// True if the surface is there, false if there is a hole, none if the alpha is too near the cutoff to tell. `weights` are those of
    /// the three corners over w; `inside` gives them for any ray.
    fn is_there(&self, triangle: &Triangle, weights: [f64; 3], inside: [DVec3; 3], per_px: DVec2) -> Option<bool> {
        let sum: f64 = weights.iter().sum();
        let parts = weights.map(|weight| weight / sum);
        let mean = |of: [f64; 3]| (0..3).map(|at| parts[at] * of[at]).sum::<f64>();
        let [low, high] = [f64::min, f64::max].map(|pick| triangle.alpha.into_iter().reduce(pick).unwrap_or(1.0));
        let vertex = mean(triangle.alpha).clamp(low, high);
        let (least, most) = match &self.texture {
            None => (1.0, 1.0),
            Some(texture) => {
                let at = (0..3).map(|corner| triangle.coordinates[corner] * parts[corner]).sum::<DVec2>();
                let step = coordinate_step(triangle, inside, sum, at, per_px);
                alpha_around(texture, at, step)
            }
        };
        let slack = if low < high { ALPHA_ERROR } else { 0.0 };
        let [least, most] = [least, most].map(|texel| self.factor * vertex * texel);
        if least >= self.cutoff - MEANT_EQUAL {
            return if low < high && least < self.cutoff + slack { None } else { Some(true) };
        }
        if most < self.cutoff - MEANT_EQUAL - slack {
            Some(false)
        } else {
            None
        }
    }
}

/// The largest change of texture coordinates within a pixel, in each direction.
fn coordinate_step(triangle: &Triangle, inside: [DVec3; 3], sum: f64, at: DVec2, per_px: DVec2) -> DVec2 {
    let along = |axis: usize| {
        let slopes = inside.map(|edge| edge[axis] * per_px[axis]);
        let total: f64 = slopes.iter().sum();
        let weighted: DVec2 = (0..3).map(|corner| triangle.coordinates[corner] * slopes[corner]).sum();
        ((weighted - at * total) / sum).abs()
    };
    along(0) + along(1)
}

/// The least and the most alpha of the texels that a device may read: those of a footprint of two pixels, and one more around them.
fn alpha_around(texture: &scenes::Texture, at: DVec2, step: DVec2) -> (f64, f64) {
    let size = DVec2::new(f64::from(texture.size[0]), f64::from(texture.size[1]));
    // Coarser levels hold means of 2 x 2 texels: a level of texels as large as pixels reaches two of its own texels farther.
    let reach = (step * size * 4.0).max(DVec2::ONE) + 0.5;
    let (low, high) = ((at * size - 0.5 - reach).floor(), (at * size - 0.5 + reach).ceil());
    let mut range = (f64::MAX, f64::MIN);
    let span = |axis: usize| {
        // Twice the texture's size covers every texel.
        let count = (high[axis] - low[axis]).min(2.0 * size[axis]);
        (0..=count as i64).map(move |step| low[axis] as i64 + step)
    };
    for y in span(1) {
        for x in span(0) {
            let texel = [wrapped(x, texture.size[0], texture.wrap[0]), wrapped(y, texture.size[1], texture.wrap[1])];
            let alpha = f64::from(texture.texels[(texel[1] * texture.size[0] + texel[0]) as usize][3]) / 255.0;
            range = (range.0.min(alpha), range.1.max(alpha));
        }
    }
    range
}

fn wrapped(texel: i64, size: u32, wrap: scenes::Wrap) -> u32 {
    let size = i64::from(size);
    let wrapped = match wrap {
        scenes::Wrap::Repeat => texel.rem_euclid(size),
        scenes::Wrap::Clamp => texel.clamp(0, size - 1),
        scenes::Wrap::Mirror => {
            let around = texel.rem_euclid(2 * size);
            if around < size {
                around
            } else {
                2 * size - 1 - around
            }
        }
    };
    wrapped as u32
}

/// True if a transform mirrors.
pub fn mirrors(matrix: &DMat3) -> bool {
    matrix.determinant() < 0.0
}

/// Returns a line for each pixel in which a picture and the oracle disagree. `items` are objects of the scene; none where the picture
/// shows nothing.
pub fn faults(place: &str, pixels: &[Pixel], items: &[Option<u32>], width: u32) -> Vec<String> {
    let wrong = pixels.iter().zip(items).enumerate().filter(|(_, (pixel, item))| match pixel {
        Pixel::Open => false,
        Pixel::Nothing => item.is_some(),
        Pixel::Object(object) => **item != Some(*object),
    });
    let line = |(at, (pixel, item)): (usize, (&Pixel, &Option<u32>))| {
        let (x, y) = (at as u32 % width, at as u32 / width);
        format!("{place}: pixel ({x}, {y}) shows {item:?}, but its ray meets {pixel:?} first")
    };
    wrong.map(line).collect()
}
