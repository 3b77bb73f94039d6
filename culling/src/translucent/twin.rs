//! The stages of translucent objects in plain Rust: their definition.

use crate::roc::twin::selection;
use shaders::types::{Bounds, CullView, DrawCommand, MeshRange, SELECT_NONE, SELECT_TESTED};

/// Which objects show without a test, and which are listed to be tested. Twin of `translucent/select_boxes`, whose list may have
/// another order.
pub fn select_boxes(bounds: &[Bounds], view: &CullView, test_boxes: bool) -> (Vec<u32>, Vec<u32>) {
    let (mut shown, mut listed) = (Vec::new(), Vec::new());
    for (object, bound) in (0..).zip(bounds) {
        let selected = selection(bound, 0, view);
        let tested = test_boxes && selected == SELECT_TESTED;
        shown.push(u32::from(!tested && selected != SELECT_NONE));
        if tested {
            listed.push(object);
        }
    }
    (shown, listed)
}

/// The commands of objects in an order, of no instances for those that do not show. Twin of `translucent/write_commands`.
pub fn write_commands(order: &[u32], shown: &[u32], object_meshes: &[u32], meshes: &[MeshRange]) -> Vec<DrawCommand> {
    let command = |object: &u32| {
        let mesh = meshes[object_meshes[*object as usize] as usize];
        DrawCommand {
            index_count: mesh.index_count,
            instance_count: u32::from(shown[*object as usize] != 0),
            first_index: mesh.first_index,
            vertex_offset: mesh.vertex_offset,
            first_instance: *object,
        }
    };
    order.iter().map(command).collect()
}
