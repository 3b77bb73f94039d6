//! The node tree: parents, order, and world transforms, without recursion, since a file may nest its nodes at any depth.

use super::document::{Document, Place};
use super::fault::{broken, element, label, Outcome};
use crate::animation::Local;
use glam::{DAffine3, DMat3, DQuat, DVec3, DVec4};
use gltf::json::{Index, Node, Root};

/// Largest difference of a matrix's last row from 0 0 0 1: rounding of exporters that work in f32.
const LAST_ROW_TOLERANCE: f64 = 1e-4;

/// The nodes of the scene that is shown.
pub(super) struct Tree {
    /// Each node's parent.
    pub parents: Vec<Option<usize>>,
    /// The topmost ancestor of each node, which may be itself.
    pub roots: Vec<usize>,
    /// The nodes of the scene, parents before children.
    pub order: Vec<usize>,
    /// Parent from node, of each node.
    pub locals: Vec<Local>,
    /// World from node, of each node of the scene, where no animation moves it.
    pub world_from_node: Vec<DAffine3>,
}

impl Tree {
    pub(super) fn new(document: &Document) -> Outcome<Self> {
        let root = &document.root;
        let parents = parents(root)?;
        let roots = roots(&root.nodes, &parents)?;
        let order = order(root, &parents)?;
        let locals = document
            .places
            .iter()
            .enumerate()
            .map(|(index, place)| local(place).map_err(|fault| fault.within(|| node_label(document, index))));
        let locals: Vec<Local> = locals.collect::<Outcome<_>>()?;
        let mut world_from_node = vec![DAffine3::IDENTITY; root.nodes.len()];
        for &node in &order {
            let world_from_parent = parents[node].map_or(DAffine3::IDENTITY, |parent| world_from_node[parent]);
            world_from_node[node] = placed(world_from_parent, matrix(&locals[node]));
        }
        Ok(Tree { parents, roots, order, locals, world_from_node })
    }

    /// World from the camera on a node, where no animation moves it. The node's own scale is ignored (3.10.2).
    pub(super) fn world_from_camera(&self, node: usize) -> DAffine3 {
        let own = match self.locals[node] {
            Local::Matrix(matrix) => matrix,
            Local::Parts { translation, rotation, .. } => DAffine3::from_rotation_translation(rotation, translation),
        };
        placed(self.parents[node].map_or(DAffine3::IDENTITY, |parent| self.world_from_node[parent]), own)
    }
}

pub(super) fn node_label(document: &Document, index: usize) -> String {
    label("node", index, document.root.nodes.get(index).and_then(|node| node.name.as_deref()))
}

/// `outer * inner`, but bit for bit one of them where the other is the identity: a product may flip the sign of a zero.
pub(super) fn placed(outer: DAffine3, inner: DAffine3) -> DAffine3 {
    match (outer == DAffine3::IDENTITY, inner == DAffine3::IDENTITY) {
        (true, _) => inner,
        (_, true) => outer,
        _ => outer * inner,
    }
}

pub(super) fn matrix(local: &Local) -> DAffine3 {
    match *local {
        Local::Matrix(matrix) => matrix,
        Local::Parts { translation, rotation, scale } => {
            DAffine3::from_scale_rotation_translation(scale, rotation, translation)
        }
    }
}

/// The nodes that hang on a node.
fn children(node: &Node) -> impl Iterator<Item = Index<Node>> + '_ {
    node.children.iter().flatten().copied()
}

fn parents(root: &Root) -> Outcome<Vec<Option<usize>>> {
    let mut parents = vec![None; root.nodes.len()];
    for (index, node) in root.nodes.iter().enumerate() {
        for child in children(node) {
            element(root, child, "node").map_err(|fault| fault.within(|| format!("node {index}")))?;
            match parents[child.value()].replace(index) {
                Some(other) if other == index => {
                    return broken(format!("node {index} lists node {child} twice as a child"))
                }
                Some(other) => return broken(format!("node {child} is a child of both node {other} and node {index}")),
                None => {}
            }
        }
    }
    Ok(parents)
}

/// The topmost ancestor of each node; refuses nodes that are their own ancestors. Each node has one parent at most, so whatever is
/// not below a root is in or below a cycle.
fn roots(nodes: &[Node], parents: &[Option<usize>]) -> Outcome<Vec<usize>> {
    let mut roots = vec![None; nodes.len()];
    let tops = (0..nodes.len()).filter(|&node| parents[node].is_none());
    let mut reached: Vec<(usize, usize)> = tops.map(|node| (node, node)).collect();
    while let Some((node, root)) = reached.pop() {
        roots[node] = Some(root);
        reached.extend(children(&nodes[node]).map(|child| (child.value(), root)));
    }
    let Some(lost) = roots.iter().position(Option::is_none) else {
        return Ok(roots.into_iter().flatten().collect());
    };
    // After as many steps up as there are nodes, one is in the cycle for certain.
    let mut up = std::iter::successors(Some(lost), |&node| parents[node]);
    let inside = up.nth(nodes.len()).unwrap_or(lost);
    broken(format!("node {inside} is its own ancestor, by way of node {}", parents[inside].unwrap_or(inside)))
}

/// The nodes of the shown scene: the default one, or the first.
fn order(root: &Root, parents: &[Option<usize>]) -> Outcome<Vec<usize>> {
    // A file of meshes alone is legal, and some such name a default scene all the same.
    if root.scenes.is_empty() {
        return Ok(Vec::new());
    }
    let index = root.scene.unwrap_or(Index::new(0));
    let scene = element(root, index, "scene").map_err(|fault| fault.within(|| "its default scene".into()))?;
    let mut order = Vec::with_capacity(root.nodes.len());
    let mut listed = vec![false; root.nodes.len()];
    for &top in &scene.nodes {
        element(root, top, "node").map_err(|fault| fault.within(|| format!("scene {index}")))?;
        if let Some(parent) = parents[top.value()] {
            return broken(format!("scene {index} lists node {top}, which is no root but a child of node {parent}"));
        }
        if !std::mem::replace(&mut listed[top.value()], true) {
            order.push(top.value());
        }
    }
    let mut next = 0;
    while next < order.len() {
        order.extend(children(&root.nodes[order[next]]).map(|child| child.value()));
        next += 1;
    }
    Ok(order)
}

fn local(place: &Place) -> Outcome<Local> {
    if let Some(columns) = place.matrix {
        return affine(&columns).map(Local::Matrix);
    }
    let translation = place.translation.map_or(DVec3::ZERO, DVec3::from_array);
    let scale = place.scale.map_or(DVec3::ONE, DVec3::from_array);
    let rotation = place.rotation.map_or(DQuat::IDENTITY, DQuat::from_array);
    if !(translation.is_finite() && scale.is_finite() && rotation.is_finite()) {
        return broken("its translation, rotation or scale has a number that is not finite");
    }
    Ok(Local::Parts { translation, rotation: unit(rotation)?, scale })
}

/// A matrix of four columns.
pub(super) fn affine(columns: &[f64; 16]) -> Outcome<DAffine3> {
    let column = |index: usize| DVec3::from_slice(&columns[4 * index..]);
    let last_row = DVec4::new(columns[3], columns[7], columns[11], columns[15]);
    if !columns.iter().all(|number| number.is_finite()) {
        return broken("its matrix has a number that is not finite");
    }
    if (last_row - DVec4::W).abs().max_element() > LAST_ROW_TOLERANCE {
        return broken(format!(
            "its matrix has the last row {last_row}; only 0, 0, 0, 1 moves objects without distortion"
        ));
    }
    let matrix3 = DMat3::from_cols(column(0), column(1), column(2));
    Ok(DAffine3 { matrix3, translation: column(3) })
}

/// The rotation with unit length, which files only have to the precision of f32.
pub(super) fn unit(rotation: DQuat) -> Outcome<DQuat> {
    match DVec4::from(rotation).try_normalize() {
        Some(unit) => Ok(DQuat::from_vec4(unit)),
        None => broken("a rotation of zero length has no direction"),
    }
}
