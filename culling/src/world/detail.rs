//! Materials on the GPU, for scenes that are drawn with them: texture coordinates and colours beside each vertex, a material for each
//! object, and all textures as one buffer of texels, which every device can read (not every device indexes textures).

mod texels;

use super::draws::{record, MaybeQueried};
use super::upload::Flat;
use super::View;
use crate::Result;
use engine::{Buffer, Frame, Gpu, IndexedIndirect, Placement, Surface, Target};
use scenes::{Scene, Wrap};
use shaders::draw::{MaskedVertex, ObjectsVertex};
use shaders::types::{Material, WRAP_BITS, WRAP_CLAMP, WRAP_MIRROR, WRAP_REPEAT};
use shaders::{draw, BufferRef};
use std::collections::HashMap;
use texels::Texels;

/// What textured stages read beside what all read.
pub(super) struct Detail {
    vertices: Buffer<MaskedVertex>,
    object_materials: Buffer<u32>,
    materials: Buffer<Material>,
    texels: Buffer<u32>,
}

impl Detail {
    /// Beside the vertices and objects of a world.
    pub(super) fn new(gpu: &Gpu, scene: &Scene, flat: &Flat) -> Result<Self> {
        let texels = Texels::new(scene);
        let (object_materials, materials) = materials(scene, &texels, &flat.scene_object);
        let vertices = vertices(scene, &flat.vertices, &flat.mesh_order);
        let storage = Placement::Storage;
        Ok(Detail {
            vertices: Buffer::with_data(gpu, "world.textured_vertices", &vertices, Placement::Geometry)?,
            object_materials: Buffer::with_data(gpu, "world.object_materials", &object_materials, storage)?,
            materials: Buffer::with_data(gpu, "world.materials", &materials, storage)?,
            texels: Buffer::with_data(gpu, "world.texels", &texels.all, storage)?,
        })
    }

    /// Positions and normals are those of all of the world's vertices, and change with them.
    pub(super) fn vertices(&self) -> BufferRef<MaskedVertex> {
        self.vertices.all()
    }

    fn dressed(&self, draw: IndexedIndirect) -> IndexedIndirect {
        IndexedIndirect { vertices: self.vertices.all().into(), ..draw }
    }

    fn parts(&self) -> (BufferRef<u32>, BufferRef<Material>, BufferRef<u32>) {
        (self.object_materials.all(), self.materials.all(), self.texels.all())
    }

    pub(super) fn draw(&self, f: &mut Frame, (draw, queried): MaybeQueried<'_>, view: &View, target: &Target) {
        let (object_materials, materials, texels) = self.parts();
        let (view, is_cut) = (view.gpu(), draw.surface == Surface::Masked);
        let draw = (self.dressed(draw), queried);
        match (is_cut, target.item.is_some()) {
            (false, false) => record(f, draw::Textured { object_materials, materials, texels, view }, draw, target),
            (false, true) => {
                record(f, draw::TexturedAndItems { object_materials, materials, texels, view }, draw, target)
            }
            (true, false) => record(f, draw::Masked { object_materials, materials, texels, view }, draw, target),
            (true, true) => record(f, draw::MaskedAndItems { object_materials, materials, texels, view }, draw, target),
        }
    }

    pub(super) fn draw_flagged(
        &self,
        f: &mut Frame,
        draw: IndexedIndirect,
        visible: BufferRef<u32>,
        view: &View,
        target: &Target,
    ) {
        let (object_materials, materials, texels) = self.parts();
        if draw.surface == Surface::Masked {
            // Colour and depth first, then who of them shows: see draw/masked_flags.
            self.draw(f, (draw, None), view, target);
            let stage = draw::MaskedFlags { object_materials, materials, texels, visible, view: view.gpu() };
            let test = Target { strictly_nearer: false, ..target.test_only() };
            f.draw_unshown(stage, self.dressed(draw), &test);
            return;
        }
        let (view, draw) = (view.gpu(), self.dressed(draw));
        if target.item.is_some() {
            let stage = draw::TexturedItemsAndFlags { object_materials, materials, texels, visible, view };
            f.draw(stage, draw, target);
        } else {
            f.draw(draw::TexturedAndFlags { object_materials, materials, texels, visible, view }, draw, target);
        }
    }

    /// Masked objects on a target that holds counts.
    pub(super) fn draw_counted(&self, f: &mut Frame, (draw, queried): MaybeQueried<'_>, view: &View, target: &Target) {
        let (object_materials, materials, texels) = self.parts();
        let stage = draw::MaskedOverdraw { object_materials, materials, texels, view: view.gpu() };
        record(f, stage, (self.dressed(draw), queried), target);
    }
}

fn vertices(scene: &Scene, plain: &[ObjectsVertex], mesh_order: &[usize]) -> Vec<MaskedVertex> {
    let extras = mesh_order.iter().map(|mesh| &scene.meshes[*mesh]).flat_map(|mesh| {
        (0..mesh.positions.len()).map(|vertex| {
            let at = mesh.texture_coordinates.get(vertex).map_or([0.0; 2], |at| at.to_array());
            (at, mesh.colours.get(vertex).map_or(u32::MAX, |colour| u32::from_le_bytes(*colour)))
        })
    });
    let dressed = |(plain, (coordinates, tint)): (&ObjectsVertex, ([f32; 2], u32))| MaskedVertex {
        position: plain.position,
        normal_snorm16: plain.normal_snorm16,
        coordinates,
        tint,
    };
    plain.iter().zip(extras).map(dressed).collect()
}

/// Each object's material, and all of them.
fn materials(scene: &Scene, texels: &Texels, scene_object: &[u32]) -> (Vec<u32>, Vec<Material>) {
    let mut materials = Vec::new();
    let mut known = HashMap::new();
    let of_object = scene_object.iter().map(|object| {
        let object = &scene.objects[*object as usize];
        let mesh = &scene.meshes[object.mesh as usize];
        // Without coordinates there is nothing to look up.
        let texture = object.surface.texture.filter(|_| !mesh.texture_coordinates.is_empty());
        *known.entry((texture, object.surface.cutoff.to_bits())).or_insert_with(|| {
            let placed = texture.map(|texture| (texels.places[texture as usize], &scene.textures[texture as usize]));
            let cutoff = object.surface.cutoff;
            materials.push(placed.map_or(Material { cutoff, ..Material::default() }, |(place, texture)| {
                let [x, y] = texture.wrap.map(wrap_mode);
                let [width, height] = place.size;
                let (first_texel, levels) = (place.first, place.levels);
                Material { first_texel, width, height, levels, wrap: x | y << WRAP_BITS, cutoff }
            }));
            (materials.len() - 1) as u32
        })
    });
    (of_object.collect(), materials)
}

fn wrap_mode(wrap: Wrap) -> u32 {
    match wrap {
        Wrap::Repeat => WRAP_REPEAT,
        Wrap::Mirror => WRAP_MIRROR,
        Wrap::Clamp => WRAP_CLAMP,
    }
}
