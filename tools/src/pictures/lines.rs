//! Lines of the world drawn over a picture, on the host: clipped to the view, blended, whatever lies in front of them.

use crate::pictures::png_out::Picture;
use culling::View;
use glam::{DVec3, DVec4};
use scenes::Aabb;

/// How a line looks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pen {
    /// Red, green, blue.
    pub(crate) colour: [u8; 3],
    /// How much it covers what is below, 0 to 1.
    pub(crate) cover: f32,
    /// Pixels across, > 0.
    pub(crate) width: i32,
}

/// The eight corners; bit 0 of the index chooses the side in x, bit 1 in y, bit 2 in z.
pub(crate) fn corners(box_: &Aabb) -> [DVec3; 8] {
    std::array::from_fn(|corner| {
        let side = |axis: usize| if corner >> axis & 1 == 0 { box_.min[axis] } else { box_.max[axis] };
        DVec3::new(side(0), side(1), side(2))
    })
}

/// The ends of the twelve edges between eight points that are numbered as [`corners`] are.
pub(crate) fn edges() -> impl Iterator<Item = (usize, usize)> {
    let from = |axis: usize| (0..8usize).filter(move |corner| corner >> axis & 1 == 0);
    (0..3).flat_map(move |axis| from(axis).map(move |corner| (corner, corner | 1 << axis)))
}

/// Draws the twelve edges between eight points that are numbered as [`corners`] are.
pub(crate) fn draw_edges(picture: &mut Picture, view: &View, points: &[DVec3; 8], pen: Pen) {
    edges().for_each(|(from, to)| draw(picture, view, points[from], points[to], pen));
}

/// Draws the part of a line that the view shows. The view's size is the picture's.
pub(crate) fn draw(picture: &mut Picture, view: &View, from: DVec3, to: DVec3, pen: Pen) {
    let Some([mut from, mut to]) = project(view, from, to) else { return };
    let major = usize::from((to[1] - from[1]).abs() > (to[0] - from[0]).abs());
    if from[major] > to[major] {
        std::mem::swap(&mut from, &mut to);
    }
    // One pixel for each centre that the line passes; the end belongs to the next line, so that corners are not blended twice.
    let (first, end) = ((from[major] - 0.5).ceil() as i32, (to[major] - 0.5).ceil() as i32);
    if first >= end {
        // Too short to pass a centre, but still to be seen.
        return dab(picture, from[0].floor() as i32, from[1].floor() as i32, pen);
    }
    let slope = (to[1 - major] - from[1 - major]) / (to[major] - from[major]);
    for along in first..end {
        let across = (from[1 - major] + slope * (f64::from(along) + 0.5 - from[major])).floor() as i32;
        let [x, y] = if major == 0 { [along, across] } else { [across, along] };
        dab(picture, x, y, pen);
    }
}

/// The ends in pixels of the part that the view shows, if any.
fn project(view: &View, from: DVec3, to: DVec3) -> Option<[[f64; 2]; 2]> {
    let clip = |point: DVec3| view.clip_from_relative() * (point - view.pose.position).extend(1.0);
    let (start, end) = (clip(from), clip(to));
    let (mut first, mut last) = (0.0f64, 1.0f64);
    // In front of the near plane (depth 1), and between the four sides; each distance is linear along the line.
    let distances =
        |point: DVec4| [point.w - point.z, point.w + point.x, point.w - point.x, point.w + point.y, point.w - point.y];
    for (at_start, at_end) in distances(start).into_iter().zip(distances(end)) {
        let crossing = at_start / (at_start - at_end);
        match (at_start >= 0.0, at_end >= 0.0) {
            (true, true) => {}
            (false, false) => return None,
            (true, false) => last = last.min(crossing),
            (false, true) => first = first.max(crossing),
        }
    }
    let [width, height] = view.size.map(f64::from);
    let pixel = |t: f64| {
        let point = start + (end - start) * t;
        [(point.x / point.w * 0.5 + 0.5) * width, (point.y / point.w * 0.5 + 0.5) * height]
    };
    let ends = [pixel(first), pixel(last)];
    (first <= last && ends.as_flattened().iter().all(|value| value.is_finite())).then_some(ends)
}

fn dab(picture: &mut Picture, x: i32, y: i32, pen: Pen) {
    let before = pen.width / 2;
    for (dx, dy) in (0..pen.width).flat_map(|dx| (0..pen.width).map(move |dy| (dx - before, dy - before))) {
        let (Ok(x), Ok(y)) = (u32::try_from(x + dx), u32::try_from(y + dy)) else { continue };
        if x < picture.width && y < picture.height {
            let pixel = &mut picture.pixels[y as usize * picture.width as usize + x as usize];
            for (channel, colour) in pixel.iter_mut().zip(pen.colour) {
                let (below, above) = (f32::from(*channel), f32::from(colour));
                *channel = (below + pen.cover * (above - below)).round() as u8;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;
    use scenes::{Pose, Projection, Shot};

    /// A square picture of 90 degrees at the origin, looking down -z, near plane at 1 m.
    fn view() -> View {
        let projection = Projection::Perspective { fov_y: std::f64::consts::FRAC_PI_2, near: 1.0, far: None };
        let pose = Pose { position: DVec3::ZERO, rotation: DQuat::IDENTITY };
        View::new(&Shot { pose, projection, seconds: 0.0 }, [100, 100], 0, 1.0 / 256.0)
    }

    fn close(found: Option<[[f64; 2]; 2]>, expected: [[f64; 2]; 2]) -> bool {
        let found = found.unwrap_or([[f64::NAN; 2]; 2]);
        found.as_flattened().iter().zip(expected.as_flattened()).all(|(a, b)| (a - b).abs() < 1e-9)
    }

    #[test]
    fn the_edges_of_a_known_box_fall_on_known_pixels() {
        let box_ = Aabb { min: DVec3::new(-1.0, -1.0, -10.0), max: DVec3::new(1.0, 1.0, -2.0) };
        let corners = corners(&box_);
        let found: Vec<_> = edges().map(|(from, to)| project(&view(), corners[from], corners[to])).collect();
        assert_eq!(found.len(), 12);
        // Half a metre per metre away is a quarter of the picture; up in the world is up in the picture.
        assert!(close(project(&view(), corners[4], corners[5]), [[25.0, 75.0], [75.0, 75.0]]));
        assert!(close(project(&view(), corners[6], corners[2]), [[25.0, 25.0], [45.0, 45.0]]));
        assert!(found.iter().all(Option::is_some));
    }

    #[test]
    fn lines_end_at_the_near_plane_and_at_the_border() {
        let line = |from: [f64; 3], to: [f64; 3]| project(&view(), from.into(), to.into());
        // From behind the camera: cut at 1 m, where 0.5 m up is a quarter of the picture.
        assert!(close(line([0.0, 0.5, 10.0], [0.0, 0.5, -5.0]), [[50.0, 25.0], [50.0, 45.0]]));
        assert!(close(line([0.0, 0.0, -2.0], [100.0, 0.0, -2.0]), [[50.0, 50.0], [100.0, 50.0]]));
        assert_eq!(line([0.0, 0.0, 1.0], [0.0, 0.0, 9.0]), None, "behind");
        assert_eq!(line([5.0, 0.0, -2.0], [9.0, 0.0, -2.0]), None, "beside");
    }

    #[test]
    fn a_line_covers_one_pixel_a_column_and_blends() {
        let mut picture = Picture { width: 100, height: 100, pixels: vec![[100; 3]; 10_000] };
        let pen = Pen { colour: [200, 0, 100], cover: 0.5, width: 1 };
        draw(&mut picture, &view(), DVec3::new(-9.0, 0.1, -2.0), DVec3::new(9.0, 0.1, -2.0), pen);
        let drawn: Vec<_> = (0..10_000).filter(|&pixel| picture.pixels[pixel] != [100; 3]).collect();
        assert_eq!(drawn, (4700..4800).collect::<Vec<_>>());
        assert!(drawn.iter().all(|&pixel| picture.pixels[pixel] == [150, 50, 100]));
    }
}
