//! What one frame looks through, in the forms that stages take.

use glam::{DMat4, DVec3};
use scenes::{Pose, Projection, Shot};
use shaders::types;

/// One frame's camera, target size and place in its run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Where the camera stands and looks.
    pub pose: Pose,
    /// What it sees.
    pub projection: Projection,
    /// The target's width and height in pixels.
    pub size: [u32; 2],
    /// The frame's number in its run, for what is precomputed by frame.
    pub frame: usize,
    clip_from_relative: DMat4,
    snap_px: f32,
    detail_px: f32,
}

impl View {
    /// The view of a path's shot in a picture of `size`; `snap_px` is the device's vertex grid, and
    /// [`shaders::types::SAMPLE_REACH_PX`] more where pixels have several samples, and more where the device takes their depths beside them.
    pub fn new(shot: &Shot, size: [u32; 2], frame: usize, snap_px: f32) -> Self {
        let aspect = f64::from(size[0]) / f64::from(size[1]);
        let view_from_relative = DMat4::from_quat(shot.pose.rotation.conjugate());
        let clip_from_relative = shot.projection.clip_from_view(aspect) * view_from_relative;
        View { pose: shot.pose, projection: shot.projection, size, frame, clip_from_relative, snap_px, detail_px: 0.0 }
    }

    /// The same, of which methods leave out what is smaller on the screen than so many pixels a side: detail culling (Zachmann 2008).
    /// 0 leaves out nothing. Methods that go on drawing what they saw leave it out from when it is seen no more.
    pub fn without_details(self, smaller_than_px: f32) -> Self {
        View { detail_px: smaller_than_px, ..self }
    }

    /// What is smaller on the screen, in pixels, is left out.
    pub fn detail_px(&self) -> f32 {
        self.detail_px
    }

    /// Clip space from world positions relative to the camera, as computed on the host.
    pub fn clip_from_relative(&self) -> DMat4 {
        self.clip_from_relative
    }

    /// True if it shows the same picture of the same objects: all but the frame's number.
    pub fn same(&self, other: &View) -> bool {
        View { frame: 0, ..*self } == View { frame: 0, ..*other }
    }

    /// As drawing stages take it.
    pub fn gpu(&self) -> types::View {
        let (camera_high, camera_low) = split(self.pose.position);
        types::View {
            clip_from_relative: self.clip_from_relative.as_mat4().to_cols_array_2d(),
            camera_high,
            camera_low,
        }
    }

    /// As bounds tests take it.
    pub fn cull(&self) -> types::CullView {
        let types::View { clip_from_relative, camera_high, camera_low } = self.gpu();
        let [width_px, height_px] = self.size;
        let View { snap_px, detail_px, .. } = *self;
        types::CullView { clip_from_relative, camera_high, camera_low, width_px, height_px, snap_px, detail_px }
    }
}

/// A position as two floats that add up to it within 2^-48 of its size.
pub fn split(position: DVec3) -> ([f32; 3], [f32; 3]) {
    let high = position.as_vec3();
    let low = (position - high.as_dvec3()).as_vec3();
    (high.to_array(), low.to_array())
}
