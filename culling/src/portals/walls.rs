//! Whether a cell's walls are thick enough: a pixel shows what is up to some grid steps beside the ray through its middle, and depths are
//! rounded. A ball around each point of a face must lie in what closes the face: then what is beyond is behind it in every pixel, as it is on
//! every ray.
//!
//! The ball must hold, for each shift s on the screen of [`BOX_PAD_SNAPS`] grid steps at most (`include/box.glsl` says why), a step v that
//! moves its middle by s. A step across the matrix's row of w leaves w as it is, and A v = s w then, where A are the rows of x and y
//! without their parts along that of w, times half the picture's sides. The shortest such step is |s| w / a at most, a being A's lesser
//! singular value. (Boxes grow by twice that, and by the length of the rows alone: they have a moment for each.)

use crate::boxes::twin::depth_growth;
use crate::frustum::twin::{clip_from_bounds, grid_px};
use crate::world::gpu_bounds;
use crate::View;
use glam::{DAffine3, DVec2, DVec3};
use scenes::{Aabb, Cells};
use shaders::types::{BOX_PAD_SNAPS, OBJECT_ALWAYS_KEPT};

/// True if what closes a cell closes it in every pixel.
pub fn is_closed(cells: &Cells, cell: usize, view: &View) -> bool {
    let Aabb { min, max } = cells.cells[cell].bounds;
    let bounds = gpu_bounds(&Aabb { min: min - cells.reach, max: max + cells.reach }, &DAffine3::IDENTITY, 0);
    let cull = view.cull();
    let clip = clip_from_bounds(&bounds, &cull);
    let w_max = clip.centre.w + clip.axes.iter().map(|axis| axis.w.abs()).sum::<f32>() + clip.error.w;
    let shift_px = f64::from(BOX_PAD_SNAPS * grid_px(&cull));
    let needed = step(view, shift_px, f64::from(w_max)) + f64::from(depth_growth(&clip, &cull, w_max));
    bounds.flags & OBJECT_ALWAYS_KEPT == 0 && needed <= cells.half_wall
}

/// The shortest step that moves any point at clip w by any shift of so many pixels, w left as it is; infinite if none does.
fn step(view: &View, shift_px: f64, w: f64) -> f64 {
    let [x, y] = across(view);
    // The lesser eigenvalue of A times its transpose.
    let (sum, difference, both) =
        (x.length_squared() + y.length_squared(), x.length_squared() - y.length_squared(), x.dot(y));
    let least = 0.5 * (sum - DVec2::new(difference, 2.0 * both).length());
    if least > 0.0 {
        shift_px * w / least.sqrt()
    } else {
        f64::INFINITY
    }
}

/// What a step across the row of w moves a point at w = 1 by, in pixels along x and y.
fn across(view: &View) -> [DVec3; 2] {
    let clip = view.clip_from_relative();
    let row = |row: usize| clip.row(row).truncate();
    let along_w = row(3).normalize_or_zero();
    [0, 1].map(|axis| 0.5 * f64::from(view.size[axis]) * (row(axis) - along_w * along_w.dot(row(axis))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DMat4, DQuat, DVec4};
    use scenes::{Pose, Projection, Shot};

    const SIZE: [u32; 2] = [320, 180];
    const SHIFT_PX: f64 = 0.25;

    fn views() -> Vec<View> {
        let perspective = Projection::Perspective { fov_y: 1.0, near: 0.1, far: Some(200.0) };
        let parallel = Projection::Orthographic { half_height: 5.0, near: 0.0, far: 50.0 };
        let mut sheared = perspective.clip_from_view(1.6);
        sheared.z_axis += DVec4::new(0.7, -0.4, 0.0, 0.0);
        sheared.y_axis.x += 0.6;
        let rotation = DQuat::from_euler(glam::EulerRot::YXZ, 0.8, -0.3, 0.2);
        let pose = Pose { position: DVec3::new(3.0, 1.6, -2.0), rotation };
        let shots = [perspective, parallel, Projection::Custom(sheared)].map(|projection| Shot {
            pose,
            projection,
            seconds: 0.0,
        });
        shots.iter().map(|shot| View::new(shot, SIZE, 0, 1.0 / 16.0)).collect()
    }

    /// Where a point relative to the camera is, in pixels.
    fn pixel(clip: &DMat4, at: DVec3) -> DVec2 {
        let clip = *clip * at.extend(1.0);
        DVec2::new(clip.x, clip.y) / clip.w * 0.5 * DVec2::from(SIZE.map(f64::from))
    }

    /// Each shift has a step as long as derived, or shorter; and one of them needs all of it.
    #[test]
    fn every_shift_has_a_step_within_what_walls_must_have() {
        for view in views() {
            let clip = view.clip_from_relative();
            let at = clip.inverse().project_point3(DVec3::new(0.6, -0.8, 0.01));
            let w = (clip * at.extend(1.0)).w;
            let allowed = step(&view, SHIFT_PX, w);
            let [x, y] = across(&view);
            let mut longest = 0.0f64;
            for turn in 0..720 {
                let shift = SHIFT_PX * DVec2::from_angle(f64::from(turn).to_radians() * 0.5);
                // The shortest step is made of the two rows; how much of each, by Cramer's rule.
                let (xx, xy, yy) = (x.dot(x), x.dot(y), y.dot(y));
                let of =
                    DVec2::new(shift.x * yy - shift.y * xy, shift.y * xx - shift.x * xy) * (w / (xx * yy - xy * xy));
                let by = x * of.x + y * of.y;
                let shifted = pixel(&clip, at + by) - pixel(&clip, at);
                assert!((shifted - shift).length() < 1e-9 * SHIFT_PX, "{view:?}: {shifted} is not {shift}");
                assert!(by.length() <= allowed * (1.0 + 1e-9), "{view:?}: {} of {allowed}", by.length());
                longest = longest.max(by.length());
            }
            assert!(longest > 0.9999 * allowed, "{view:?}: {longest} would do, not {allowed}");
        }
    }

    #[test]
    fn a_view_without_width_closes_nothing() {
        let pose = Pose { position: DVec3::ZERO, rotation: DQuat::IDENTITY };
        let flat = Shot {
            pose,
            projection: Projection::Custom(DMat4::from_diagonal(DVec4::new(1.0, 0.0, 1.0, 1.0))),
            seconds: 0.0,
        };
        assert_eq!(step(&View::new(&flat, SIZE, 0, 1.0 / 16.0), SHIFT_PX, 1.0), f64::INFINITY);
    }
}
