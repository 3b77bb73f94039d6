//! Pictures of the boxes that a frame tested: over the whole scene from above, as in the EOVC thesis' figure 9, and over the
//! frame itself.

use crate::pictures::lines::{corners, draw, draw_edges, Pen};
use crate::pictures::png_out::Picture;
use crate::run::session::Session;
use anyhow::{Context, Result};
use culling::{TestedBoxes, View};
use glam::DVec3;
use scenes::{Aabb, Pose, Projection, Shot};

const SINGLE: Pen = Pen { colour: [60, 190, 255], cover: 0.35, width: 1 };
const GROUP: Pen = Pen { colour: [255, 150, 0], cover: 0.7, width: 1 };
const VOLUME: Pen = Pen { colour: [255; 3], cover: 0.3, width: 1 };
const MIDDLE: Pen = Pen { colour: [255; 3], cover: 1.0, width: 2 };

/// How steeply the camera in the sky looks down, in degrees: steep enough to see between houses, and not so steep that boxes
/// lose their height.
const PITCH_DEGREES: f64 = 55.0;

/// Its full vertical field of view, in degrees.
const FOV_DEGREES: f64 = 35.0;

/// How many boxes there are, and which colour means what.
pub fn caption(boxes: &TestedBoxes) -> String {
    format!(
        "{} boxes of groups (orange) and {} of single objects (blue) were tested",
        boxes.groups.len(),
        boxes.singles.len()
    )
}

/// The scene from above, dimmed, as much of it as nearly all objects take; on it the boxes, and the view volume of `view` in white. The picture's up is where
/// `view` looks. Everything is where the session's last look put it.
pub fn from_above(session: &Session, view: &View, boxes: &TestedBoxes) -> Result<Picture> {
    let bounds = populated(session.world.host_bounds());
    let sky = sky_view(session, view, &bounds);
    let target = session.targets.with_items();
    let mut f = session.gpu.frame();
    session.world.update(&mut f);
    f.clear(&target);
    session.world.draw_all(&mut f, &sky, &target);
    f.finish().context("drawing the scene from above")?;
    let mut picture = dimmed(&Picture::colour(&session.targets.read()?));
    draw_boxes(&mut picture, &sky, boxes);
    draw_volume(&mut picture, &sky, &view_volume(view, &bounds));
    Ok(picture)
}

/// The frame's own picture, dimmed, with the boxes.
pub fn first_person(picture: &Picture, view: &View, boxes: &TestedBoxes) -> Picture {
    let mut picture = dimmed(picture);
    draw_boxes(&mut picture, view, boxes);
    picture
}

/// Draws what a camera could see, as lines over what another sees.
pub(crate) fn draw_view(picture: &mut Picture, session: &Session, eye: &View, seen: &View) {
    let bounds = populated(session.world.host_bounds());
    draw_volume(picture, eye, &view_volume(seen, &bounds));
}

fn draw_boxes(picture: &mut Picture, view: &View, boxes: &TestedBoxes) {
    boxes.singles.iter().for_each(|box_| draw_edges(picture, view, &corners(box_), SINGLE));
    boxes.groups.iter().for_each(|box_| draw_edges(picture, view, &corners(box_), GROUP));
}

/// The view volume thinly, and boldly its section half-way up the picture: from above, that is what lies left and right of it.
fn draw_volume(picture: &mut Picture, sky: &View, volume: &[DVec3; 8]) {
    draw_edges(picture, sky, volume, VOLUME);
    let middle = |corner: usize| 0.5 * (volume[corner] + volume[corner + 2]);
    for (from, to) in [(0, 4), (1, 5), (4, 5)] {
        draw(picture, sky, middle(from), middle(to), MIDDLE);
    }
}

/// Grey and dark, so that only lines have colour.
pub(crate) fn dimmed(picture: &Picture) -> Picture {
    let grey = |&[red, green, blue]: &[u8; 3]| {
        let sum = u16::from(red) + 2 * u16::from(green) + u16::from(blue);
        [(sum / 4 / 2) as u8; 3]
    };
    Picture { pixels: picture.pixels.iter().map(grey).collect(), ..*picture }
}

/// Where nearly all objects are: on each side a hundredth of them may lie outside, so that a ground plane that goes on to the
/// horizon does not make everything on it small.
fn populated(boxes: &[Aabb]) -> Aabb {
    let valid: Vec<&Aabb> = boxes.iter().filter(|box_| box_.is_valid()).collect();
    if valid.is_empty() {
        return Aabb { min: DVec3::ZERO, max: DVec3::ZERO };
    }
    let rank = valid.len() / 100;
    let ranked = |of: &dyn Fn(&Aabb) -> f64| {
        let mut values: Vec<f64> = valid.iter().map(|box_| of(box_)).collect();
        *values.select_nth_unstable_by(rank, f64::total_cmp).1
    };
    let min = DVec3::from_array([0, 1, 2].map(|axis| ranked(&|box_| box_.min[axis])));
    let max = DVec3::from_array([0, 1, 2].map(|axis| -ranked(&|box_| -box_.max[axis])));
    Aabb { min: min.min(max), max: max.max(min) }
}

/// A camera above that sees all of `bounds` and the camera of `view`.
fn sky_view(session: &Session, view: &View, bounds: &Aabb) -> View {
    let eye = view.pose.position;
    let all = bounds.union(Aabb { min: eye, max: eye });
    let forward = view.pose.forward();
    let level = DVec3::new(forward.x, 0.0, forward.z).normalize_or(DVec3::NEG_Z);
    let (down, along) = PITCH_DEGREES.to_radians().sin_cos();
    let centre = all.centre();
    let rotation = Pose::looking_at(centre - level * along + DVec3::Y * down, centre).rotation;
    let fov_y = FOV_DEGREES.to_radians();
    let tangent = (0.5 * fov_y).tan();
    let aspect = f64::from(view.size[0]) / f64::from(view.size[1]);
    // Each corner must lie inside the sides; 5 % more leaves a border.
    let seen = corners(&all).map(|corner| rotation.inverse() * (corner - centre));
    let needed =
        seen.map(|corner| corner.z + 1.05 * (corner.x.abs() / (tangent * aspect)).max(corner.y.abs() / tangent));
    let distance = needed.into_iter().fold(f64::MIN_POSITIVE, f64::max);
    let position = centre + rotation * DVec3::Z * distance;
    let closest = seen.iter().map(|corner| distance - corner.z).fold(distance, f64::min);
    // Nothing is nearer than the nearest corner; where that is at the eye, a thousandth of the way will do.
    let near = (0.5 * closest).max(1e-3 * distance);
    let shot = Shot {
        pose: Pose { position, rotation },
        projection: Projection::Perspective { fov_y, near, far: None },
        seconds: 0.0,
    };
    View::new(&shot, view.size, view.frame, session.gpu.snap_px())
}

/// The corners of what a view can see, out to where `bounds` ends or its far plane is: nearer ends first, numbered as a box's.
fn view_volume(view: &View, bounds: &Aabb) -> [DVec3; 8] {
    let inverse = view.clip_from_relative().inverse();
    let forward = view.pose.forward();
    let eye = view.pose.position;
    let ahead = corners(bounds).map(|corner| (corner - eye).dot(forward)).into_iter().fold(0.0, f64::max);
    let depth_of_volume = if ahead > 0.0 { ahead } else { bounds.half_extent().length() };
    std::array::from_fn(|corner| {
        let side = |axis: usize| if corner >> axis & 1 == 0 { -1.0 } else { 1.0 };
        let at = |depth: f64| inverse.project_point3(DVec3::new(side(0), side(1), depth));
        let (near, beyond) = (at(1.0), at(0.5));
        if corner < 4 {
            return eye + near;
        }
        let direction = (beyond - near).normalize_or(forward);
        let to_end = (depth_of_volume - near.dot(forward)) / direction.dot(forward);
        // An infinite far plane is no point, and so no limit.
        let to_far = (at(0.0) - near).length();
        eye + near + direction * if to_far.is_finite() { to_end.min(to_far) } else { to_end }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;

    fn view(far: Option<f64>) -> View {
        let projection = Projection::Perspective { fov_y: std::f64::consts::FRAC_PI_2, near: 1.0, far };
        let pose = Pose { position: DVec3::new(0.0, 2.0, 0.0), rotation: DQuat::IDENTITY };
        View::new(&Shot { pose, projection, seconds: 0.0 }, [100, 100], 0, 1.0 / 256.0)
    }

    #[test]
    fn the_view_volume_ends_with_the_scene_or_at_the_far_plane() {
        let bounds = Aabb { min: DVec3::splat(-30.0), max: DVec3::splat(30.0) };
        for (far, depth) in [(None, 30.0), (Some(100.0), 30.0), (Some(10.0), 10.0)] {
            let found = view_volume(&view(far), &bounds);
            let near = DVec3::new(-1.0, 3.0, -1.0);
            assert!(found[0].distance(near) < 1e-9, "{found:?}");
            let end = DVec3::new(depth, 2.0 - depth, -depth);
            assert!(found[7].distance(end) < 1e-6, "{far:?}: {found:?}");
        }
    }

    #[test]
    fn a_ground_plane_does_not_make_the_scene_small() {
        let at = |x: f64| Aabb { min: DVec3::new(x, 0.0, 0.0), max: DVec3::new(x + 1.0, 2.0, 1.0) };
        let mut boxes: Vec<Aabb> = (0..300).map(|index| at(f64::from(index % 10))).collect();
        let all = populated(&boxes);
        assert_eq!((all.min, all.max), (DVec3::ZERO, DVec3::new(10.0, 2.0, 1.0)));
        boxes.push(Aabb { min: DVec3::splat(-1e6), max: DVec3::new(1e6, 0.0, 1e6) });
        boxes.push(Aabb::EMPTY);
        assert_eq!(populated(&boxes), all);
        assert_eq!(populated(&boxes[..1]), boxes[0]);
        assert_eq!(populated(&[]).half_extent(), DVec3::ZERO);
    }

    #[test]
    fn a_dimmed_picture_is_grey_and_dark() {
        let picture = Picture { width: 2, height: 1, pixels: vec![[255; 3], [200, 100, 0]] };
        assert_eq!(dimmed(&picture).pixels, [[127; 3], [50; 3]]);
    }

    #[test]
    fn the_caption_counts() {
        let box_ = Aabb { min: DVec3::ZERO, max: DVec3::ONE };
        let text = caption(&TestedBoxes { groups: vec![box_; 2], singles: vec![box_; 7] });
        assert!(text.contains("2 boxes of groups") && text.contains("7 of single objects"), "{text}");
    }
}
