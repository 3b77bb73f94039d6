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

/// How the rectangle that a camera was made for goes into a picture of another aspect.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Fit {
    /// All of the rectangle is in the picture. A picture that is too narrow for it shows more above and below (glTF 2.0, 3.10.3: a
    /// camera should not crop).
    #[default]
    Inside,
    /// The rectangle is as high as the picture. A picture that is too narrow for it crops both sides.
    Height,
}

impl Fit {
    /// All ways, the default first.
    pub const ALL: [Fit; 2] = [Fit::Inside, Fit::Height];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Fit::Inside => "inside",
            Fit::Height => "height",
        }
    }

    /// Returns the factor, 1 or more, by which a view volume must grow to fit a camera's rectangle into a picture. Both arguments are
    /// width over height.
    pub fn widening(self, camera: Option<f64>, picture: f64) -> f64 {
        match (self, camera) {
            (Fit::Inside, Some(camera)) => (camera / picture).max(1.0),
            _ => 1.0,
        }
    }
}

impl Projection {
    /// Returns a projection whose view volume is `factor` times as high and as wide at every distance, `factor` > 0. A custom
    /// projection stays as it is.
    pub fn widened(self, factor: f64) -> Projection {
        match self {
            // The tangent and its inverse may miss the same angle by a rounding.
            _ if factor == 1.0 => self,
            Projection::Perspective { fov_y, near, far } => {
                Projection::Perspective { fov_y: 2.0 * (factor * (0.5 * fov_y).tan()).atan(), near, far }
            }
            Projection::Orthographic { half_height, near, far } => {
                Projection::Orthographic { half_height: half_height * factor, near, far }
            }
            Projection::Custom(_) => self,
        }
    }

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
    /// Width over height of the rectangle that the camera was made for; none for any rectangle.
    pub aspect: Option<f64>,
    /// The animated node that carries it, if any: an index into the scene's [`crate::Motion`] nodes.
    pub node: Option<usize>,
}
