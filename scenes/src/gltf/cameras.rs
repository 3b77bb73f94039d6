//! The cameras of a glTF file.

use super::document::{Camera, Document};
use super::fault::{broken, element, label, Fault, Outcome};
use crate::animation::pose_of;
use crate::camera::{Camera as SceneCamera, Projection};
use glam::DAffine3;
use std::f64::consts::PI;

/// The camera on a node.
pub(super) fn read(
    document: &Document,
    index: usize,
    node_name: Option<&str>,
    world_from_node: DAffine3,
) -> Outcome<SceneCamera> {
    let camera = element(&document.cameras, index, "camera")?;
    let place = || label("camera", index, camera.name.as_deref());
    let projection = projection(camera).map_err(|fault| fault.within(place))?;
    let name = camera.name.as_deref().or(node_name).map_or_else(|| format!("camera {index}"), str::to_owned);
    Ok(SceneCamera { name, pose: pose_of(world_from_node), projection, node: None })
}

/// JSON has no numbers that are not finite, so plain comparisons decide.
fn projection(camera: &Camera) -> Outcome<Projection> {
    match camera.kind.as_str() {
        "perspective" => {
            let lens = present(camera.perspective.as_ref(), "perspective")?;
            if lens.yfov <= 0.0 || lens.yfov >= PI {
                return broken(format!("its yfov {} is not between 0 and pi", lens.yfov));
            }
            if lens.znear <= 0.0 || lens.zfar.is_some_and(|far| far <= lens.znear) {
                return broken("its znear must be above 0, and its zfar above znear");
            }
            Ok(Projection::Perspective { fov_y: lens.yfov, near: lens.znear, far: lens.zfar })
        }
        "orthographic" => {
            let lens = present(camera.orthographic.as_ref(), "orthographic")?;
            if lens.ymag == 0.0 || lens.zfar <= lens.znear {
                return broken("its ymag must not be 0, and its zfar must be above znear");
            }
            // Negative magnifications mirror the picture, which the specification advises against.
            Ok(Projection::Orthographic { half_height: lens.ymag.abs(), near: lens.znear, far: lens.zfar })
        }
        other => broken(format!("its type '{other}' is neither perspective nor orthographic")),
    }
}

fn present<T>(lens: Option<T>, kind: &str) -> Outcome<T> {
    lens.ok_or_else(|| Fault::Broken(format!("it is of type {kind} but has no such property")))
}
