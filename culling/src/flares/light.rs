//! Where a flare's light is: in the world, and on the screen.

use crate::View;
use glam::{DVec2, DVec3, DVec4, Vec4Swizzles};
use shaders::types::{FlareBlock, FLARE_BLOCK_PX, LIGHT_X, LIGHT_Y, LIGHT_Z};

/// A light that makes flares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Light {
    /// Infinitely far away, in this direction: behind all that is drawn.
    Towards(DVec3),
    /// At this place in the world, in metres.
    At(DVec3),
}

impl Default for Light {
    /// The light that surfaces are shaded by.
    fn default() -> Self {
        // As the words say it, not as floats round it: results name it.
        let decimal = |part: f32| (f64::from(part) * 1e6).round() / 1e6;
        Light::Towards(DVec3::new(decimal(LIGHT_X), decimal(LIGHT_Y), decimal(LIGHT_Z)))
    }
}

impl std::fmt::Display for Light {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (word, DVec3 { x, y, z }) = match self {
            Light::Towards(direction) => ("towards", direction),
            Light::At(place) => ("at", place),
        };
        write!(out, "{word} {x},{y},{z}")
    }
}

/// Where a light is on the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// The part of its block that is on the screen; never empty.
    pub block: FlareBlock,
    /// Its middle, x and y from -1 to 1 over the screen, or beyond it.
    pub light: DVec2,
}

impl Light {
    /// Where it is in a view; none if it is behind the eye, if its block is beside the screen, or if its depth is in front of the near or
    /// behind the far plane. A light in a direction has the depth of what nothing was drawn over, and no place in a parallel
    /// projection.
    pub fn place(&self, view: &View) -> Option<Place> {
        let (clip, depth) = match self {
            Light::Towards(direction) => (view.clip_from_relative() * direction.extend(0.0), 0.0),
            Light::At(place) => {
                let clip = view.clip_from_relative() * (*place - view.pose.position).extend(1.0);
                (clip, clip.z / clip.w)
            }
        };
        let is_seen = is_in_front(clip) && (0.0..=1.0).contains(&depth);
        let light = clip.xy() / clip.w;
        let ([from_x, to_x], [from_y, to_y]) = (side(light.x, view.size[0])?, side(light.y, view.size[1])?);
        let block =
            FlareBlock { from_px: [from_x, from_y], to_px: [to_x, to_y], size_px: view.size, depth: depth as f32 };
        is_seen.then_some(Place { block, light })
    }
}

/// False for what is not a number, too.
fn is_in_front(clip: DVec4) -> bool {
    clip.w > 0.0
}

/// The pixels of the block along one side of the picture: as many on each side of the edge of pixels that is nearest the light. None if none of
/// them is in the picture.
fn side(light: f64, size_px: u32) -> Option<[u32; 2]> {
    let first = ((light + 1.0) * 0.5 * f64::from(size_px)).round() - f64::from(FLARE_BLOCK_PX / 2);
    let from = first.max(0.0);
    let to = (first + f64::from(FLARE_BLOCK_PX)).min(f64::from(size_px));
    (from < to).then_some([from as u32, to as u32])
}

#[cfg(test)]
mod tests {
    use super::*;
    use scenes::{Pose, Projection, Shot};

    fn view(projection: Projection) -> View {
        View::new(
            &Shot { pose: Pose::looking_at(DVec3::ZERO, DVec3::NEG_Z), seconds: 0.0, projection },
            [200, 100],
            0,
            1.0 / 256.0,
        )
    }

    /// A quarter turn from top to bottom, looking along -z.
    fn wide() -> View {
        view(Projection::Perspective { fov_y: std::f64::consts::FRAC_PI_2, near: 0.1, far: Some(100.0) })
    }

    fn block(light: Light) -> Option<[[u32; 2]; 2]> {
        light.place(&wide()).map(|place| [place.block.from_px, place.block.to_px])
    }

    #[test]
    fn a_block_lies_around_its_light() {
        let ahead = Light::Towards(DVec3::NEG_Z);
        assert_eq!(block(ahead), Some([[92, 42], [108, 58]]));
        assert_eq!(
            ahead.place(&wide()).map(|place| place.block.depth),
            Some(0.0),
            "as far as what nothing was drawn over"
        );
        // Half way up from the middle is a quarter of 100 pixels from the top.
        assert_eq!(block(Light::Towards(DVec3::new(0.0, 0.5, -1.0))), Some([[92, 17], [108, 33]]));
        assert_eq!(block(Light::At(DVec3::new(0.0, 1.0, -2.0))), block(Light::Towards(DVec3::new(0.0, 0.5, -1.0))));
    }

    #[test]
    fn at_the_edge_a_part_of_the_block_is_left_and_beyond_it_nothing() {
        let right = |x: f64| block(Light::Towards(DVec3::new(x, 0.0, -1.0)));
        assert_eq!(right(2.0), Some([[192, 42], [200, 58]]), "the light is on the edge");
        assert_eq!(right(2.14), Some([[199, 42], [200, 58]]), "it is beyond the edge");
        assert_eq!((right(2.16), right(-2.2), right(1e300)), (None, None, None));
        assert_eq!(right(-2.0), Some([[0, 42], [8, 58]]));
        let corner = block(Light::Towards(DVec3::new(-2.0, -1.0, -1.0)));
        assert_eq!(corner, Some([[0, 92], [8, 100]]));
    }

    #[test]
    fn what_is_behind_the_eye_or_beyond_the_planes_has_no_place() {
        for light in [
            Light::Towards(DVec3::Z),
            Light::Towards(DVec3::X),
            Light::Towards(DVec3::ZERO),
            Light::Towards(DVec3::splat(f64::NAN)),
            Light::At(DVec3::Z),
            Light::At(DVec3::ZERO),
            Light::At(DVec3::new(0.0, 0.0, -0.05)),
            Light::At(DVec3::new(0.0, 0.0, -101.0)),
        ] {
            assert_eq!(light.place(&wide()), None, "{light}");
        }
        let parallel = view(Projection::Orthographic { half_height: 1.0, near: 0.0, far: 10.0 });
        assert_eq!(Light::Towards(DVec3::NEG_Z).place(&parallel), None);
        assert!(Light::At(DVec3::new(0.0, 0.0, -5.0)).place(&parallel).is_some());
    }

    #[test]
    fn the_light_of_the_shading_is_named_as_it_is_written() {
        assert_eq!(Light::default().to_string(), "towards 0.4,0.82,0.41");
    }
}
