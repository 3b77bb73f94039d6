//! The cameras of a glTF file.

use super::document::{Document, Lens};
use super::fault::{broken, element, label, Fault, Outcome};
use crate::animation::pose_of;
use crate::camera::{Camera as SceneCamera, Projection};
use glam::DAffine3;
use gltf::json::camera::{Camera, Type};
use gltf::json::validation::Checked;
use gltf::json::Index;
use std::f64::consts::PI;

/// The camera on a node.
pub(super) fn read(
    document: &Document,
    index: Index<Camera>,
    node_name: Option<&str>,
    world_from_node: DAffine3,
) -> Outcome<SceneCamera> {
    let camera = element(&document.root, index, "camera")?;
    let place = || label("camera", index.value(), camera.name.as_deref());
    let said_type = || document.said(&format!("/cameras/{index}/type"));
    let lens = &document.lenses[index.value()];
    let projection = projection(camera.type_, lens, said_type).map_err(|fault| fault.within(place))?;
    let name = camera.name.as_deref().or(node_name).map_or_else(|| format!("camera {index}"), str::to_owned);
    let aspect = aspect(lens).filter(|aspect| ASPECTS.contains(aspect));
    Ok(SceneCamera { name, pose: pose_of(world_from_node), projection, aspect, node: None })
}

/// Aspects of rectangles that a picture can be made for. A view that is widened for others leaves the range of `f32`; they are ignored.
const ASPECTS: std::ops::RangeInclusive<f64> = 1e-4..=1e4;

/// Width over height of the rectangle that a camera was made for, as the file says.
fn aspect(lens: &Lens) -> Option<f64> {
    match (&lens.perspective, &lens.orthographic) {
        (Some(perspective), None) => perspective.aspect_ratio,
        (None, Some(orthographic)) => Some((orthographic.xmag? / orthographic.ymag).abs()),
        _ => None,
    }
}

/// JSON has no numbers that are not finite, so plain comparisons decide.
fn projection(kind: Checked<Type>, lens: &Lens, said_type: impl FnOnce() -> String) -> Outcome<Projection> {
    match kind {
        Checked::Valid(Type::Perspective) => {
            let lens = present(lens.perspective.as_ref(), "perspective")?;
            if lens.yfov <= 0.0 || lens.yfov >= PI {
                return broken(format!("its yfov {} is not between 0 and pi", lens.yfov));
            }
            if lens.znear <= 0.0 || lens.zfar.is_some_and(|far| far <= lens.znear) {
                return broken("its znear must be above 0, and its zfar above znear");
            }
            Ok(Projection::Perspective { fov_y: lens.yfov, near: lens.znear, far: lens.zfar })
        }
        Checked::Valid(Type::Orthographic) => {
            let lens = present(lens.orthographic.as_ref(), "orthographic")?;
            if lens.ymag == 0.0 || lens.zfar <= lens.znear {
                return broken("its ymag must not be 0, and its zfar must be above znear");
            }
            // Negative magnifications mirror the picture, which the specification advises against.
            Ok(Projection::Orthographic { half_height: lens.ymag.abs(), near: lens.znear, far: lens.zfar })
        }
        Checked::Invalid => broken(format!("its type '{}' is neither perspective nor orthographic", said_type())),
    }
}

fn present<T>(lens: Option<T>, kind: &str) -> Outcome<T> {
    lens.ok_or_else(|| Fault::Broken(format!("it is of type {kind} but has no such property")))
}
