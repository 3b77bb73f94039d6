//! Hidden nodes (KHR_node_visibility). A node is hidden if its extension says so, or if its parent is hidden.

use super::tree::Tree;
use gltf::json::{Node, Root};

/// Returns a flag for each hidden node of the file. Cameras on hidden nodes stay.
pub(super) fn hidden(root: &Root, tree: &Tree) -> Vec<bool> {
    let mut hidden = vec![false; root.nodes.len()];
    // Parents come before their children.
    for &node in &tree.order {
        hidden[node] = says_hidden(&root.nodes[node]) || tree.parents[node].is_some_and(|parent| hidden[parent]);
    }
    hidden
}

fn says_hidden(node: &Node) -> bool {
    let visibility = node.extensions.as_ref().and_then(|extensions| extensions.others.get("KHR_node_visibility"));
    visibility.and_then(|visibility| visibility.get("visible")).is_some_and(|visible| visible == false)
}
