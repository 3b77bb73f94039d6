//! Cameras: where they are, what they see, and the reversed-depth projections they use.

use glam::{DMat4, DQuat, DVec3, DVec4};

/// How view space maps to Vulkan clip space, with reversed depth: the near plane is 1, the far plane 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// A pinhole camera.
    Perspective {
        /// Full vertical field of view in radians, in 0..pi.
        fov_y: f64,
        /// Distance of the near plane, > 0.
        near: f64,
        /// Distance of the far plane, > near, or none for an infinite one.
        far: Option<f64>,
    },
    /// A parallel projection.
    Orthographic {
        /// Half the height of the view volume, > 0.
        half_height: f64,
        /// Distance of the near plane (may be negative).
        near: f64,
        /// Distance of the far plane, > near.
        far: f64,
    },
    /// Any other clip-from-view matrix (oblique, off-centre), reversed depth and y down included. The aspect is its own.
    Custom(DMat4),
}

impl Projection {
    /// The clip-from-view matrix for a picture of the given width over height.
    /// View space is right-handed, looks down -z with y up; clip space has y down and depth 1 (near) to 0 (far).
    pub fn clip_from_view(&self, aspect: f64) -> DMat4 {
        match *self {
            Projection::Perspective { fov_y, near, far } => {
                let y = 1.0 / (0.5 * fov_y).tan();
                // Depth is (a z + b) / -z, with depth 1 at z = -near and 0 at z = -far.
                let (a, b) = match far {
                    Some(far) => (near / (far - near), near * far / (far - near)),
                    None => (0.0, near),
                };
                DMat4::from_cols(
                    DVec4::new(y / aspect, 0.0, 0.0, 0.0),
                    DVec4::new(0.0, -y, 0.0, 0.0),
                    DVec4::new(0.0, 0.0, a, -1.0),
                    DVec4::new(0.0, 0.0, b, 0.0),
                )
            }
            Projection::Orthographic { half_height, near, far } => {
                let y = 1.0 / half_height;
                let depth = 1.0 / (far - near);
                DMat4::from_cols(
                    DVec4::new(y / aspect, 0.0, 0.0, 0.0),
                    DVec4::new(0.0, -y, 0.0, 0.0),
                    DVec4::new(0.0, 0.0, depth, 0.0),
                    DVec4::new(0.0, 0.0, far * depth, 1.0),
                )
            }
            Projection::Custom(matrix) => matrix,
        }
    }
}

/// A camera's place and direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// World position in metres.
    pub position: DVec3,
    /// World from view: the camera looks down its own -z with its own y up.
    pub rotation: DQuat,
}

impl Pose {
    /// A camera at `position` that looks at `target`, with +y up unless it looks straight along it.
    pub fn looking_at(position: DVec3, target: DVec3) -> Self {
        let forward = (target - position).normalize_or(DVec3::NEG_Z);
        let up = if forward.cross(DVec3::Y).length_squared() > 1e-12 { DVec3::Y } else { DVec3::Z };
        let right = forward.cross(up).normalize();
        let rotation = DQuat::from_mat3(&glam::DMat3::from_cols(right, right.cross(forward), -forward));
        Pose { position, rotation }
    }

    /// The direction the camera looks in, in the world.
    pub fn forward(&self) -> DVec3 {
        self.rotation * DVec3::NEG_Z
    }
}

/// A named camera of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// Name from the file or generator.
    pub name: String,
    /// Where it stands at time 0.
    pub pose: Pose,
    /// What it sees.
    pub projection: Projection,
    /// The animated node that carries it, if any: an index into the scene's [`crate::Motion`] nodes.
    pub node: Option<usize>,
}
