//! The table of glTF extensions: which are drawn, ignored or refused. scenes/README.md has the same list; a test compares the two.

use super::fault::{one_line, Fault, Outcome};

/// How the import treats an extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Support {
    /// Changes fragments or their base colour, and is implemented.
    Drawn,
    /// Changes neither fragments nor their base colour. Ignored.
    Invisible,
    /// Adds a texture format that is not read. The import leaves out each such texture and warns.
    Textures,
    /// Changes fragments and is not implemented. Refused when required; a warning when used.
    Refused,
}

use Support::{Drawn, Invisible, Refused, Textures};

/// Ratified and archived extensions of Khronos, then common extensions of vendors by prefix.
const TABLE: &[(&str, Support)] = &[
    ("KHR_accessor_float64", Refused),
    ("KHR_animation_pointer", Refused),
    ("KHR_audio_emitter", Invisible),
    ("KHR_draco_mesh_compression", Drawn),
    ("KHR_gaussian_splatting", Refused),
    ("KHR_gaussian_splatting_compression_spz", Refused),
    ("KHR_gaussian_splatting_compression_spz_2", Refused),
    ("KHR_interactivity", Refused),
    ("KHR_lights_punctual", Invisible),
    ("KHR_materials_anisotropy", Invisible),
    ("KHR_materials_clearcoat", Invisible),
    ("KHR_materials_diffuse_transmission", Invisible),
    ("KHR_materials_dispersion", Invisible),
    ("KHR_materials_emissive_strength", Invisible),
    ("KHR_materials_ior", Invisible),
    ("KHR_materials_iridescence", Invisible),
    ("KHR_materials_pbrSpecularGlossiness", Drawn),
    ("KHR_materials_sheen", Invisible),
    ("KHR_materials_specular", Invisible),
    ("KHR_materials_transmission", Drawn),
    ("KHR_materials_unlit", Invisible),
    ("KHR_materials_variants", Invisible),
    ("KHR_materials_volume", Invisible),
    ("KHR_materials_volume_scatter", Invisible),
    ("KHR_mesh_quantization", Drawn),
    ("KHR_meshopt_compression", Drawn),
    ("KHR_node_hoverability", Invisible),
    ("KHR_node_selectability", Invisible),
    ("KHR_node_visibility", Drawn),
    ("KHR_physics_rigid_bodies", Refused),
    ("KHR_implicit_shapes", Invisible),
    ("KHR_technique_webgl", Refused),
    ("KHR_techniques_webgl", Refused),
    ("KHR_texture_basisu", Textures),
    ("KHR_texture_transform", Drawn),
    ("KHR_xmp", Invisible),
    ("KHR_xmp_json_ld", Invisible),
    ("EXT_feature_metadata", Invisible),
    ("EXT_instance_features", Invisible),
    ("EXT_lights_ies", Invisible),
    ("EXT_lights_image_based", Invisible),
    ("EXT_materials_bump", Invisible),
    ("EXT_materials_specular_edge_color", Invisible),
    ("EXT_mesh_features", Invisible),
    ("EXT_mesh_gpu_instancing", Drawn),
    ("EXT_mesh_manifold", Invisible),
    ("EXT_mesh_polygon", Invisible),
    ("EXT_mesh_primitive_edge_visibility", Invisible),
    ("EXT_mesh_primitive_restart", Refused),
    ("EXT_meshopt_compression", Drawn),
    ("EXT_primitive_voxels", Refused),
    ("EXT_property_animation", Refused),
    ("EXT_structural_metadata", Invisible),
    ("EXT_texture_astc", Textures),
    ("EXT_texture_avif", Textures),
    ("EXT_texture_webp", Drawn),
    ("ADOBE_materials_clearcoat_specular", Invisible),
    ("ADOBE_materials_clearcoat_tint", Invisible),
    ("ADOBE_materials_thin_transparency", Drawn),
    ("AGI_articulations", Invisible),
    ("AGI_stk_metadata", Invisible),
    ("CESIUM_primitive_outline", Invisible),
    ("CESIUM_RTC", Refused),
    ("FB_geometry_metadata", Invisible),
    ("FB_ngon_encoding", Invisible),
    ("GODOT_single_root", Invisible),
    ("GRIFFEL_bim_data", Invisible),
    ("HUBS_components", Refused),
    ("MOZ_hubs_components", Refused),
    ("MOZ_lightmap", Invisible),
    ("MOZ_texture_rgbe", Textures),
    ("MPEG_accessor_timed", Refused),
    ("MPEG_animation_timing", Refused),
    ("MPEG_audio_spatial", Invisible),
    ("MPEG_buffer_circular", Refused),
    ("MPEG_media", Refused),
    ("MPEG_scene_dynamic", Refused),
    ("MPEG_texture_video", Refused),
    ("MSFT_audio_emitter", Invisible),
    ("MSFT_lod", Invisible),
    ("MSFT_packing_normalRoughnessMetallic", Invisible),
    ("MSFT_packing_occlusionRoughnessMetallic", Invisible),
    ("MSFT_texture_dds", Textures),
    ("NEEDLE_progressive", Refused),
    ("NV_materials_mdl", Refused),
    ("OMI_collider", Invisible),
    ("OMI_link", Invisible),
    ("OMI_physics_body", Refused),
    ("OMI_physics_shape", Invisible),
    ("OMI_seat", Invisible),
    ("OMI_spawn_point", Invisible),
    ("VRM", Invisible),
    ("VRMC_materials_hdr_emissiveMultiplier", Invisible),
    ("VRMC_materials_mtoon", Invisible),
    ("VRMC_node_constraint", Refused),
    ("VRMC_springBone", Refused),
    ("VRMC_vrm", Invisible),
    ("WEB3D_quantized_attributes", Refused),
];

/// Looks an extension up. None if the table does not have it.
fn support(extension: &str) -> Option<Support> {
    TABLE.iter().find(|(name, _)| *name == extension).map(|(_, support)| *support)
}

/// Refuses a file that requires an extension which is not implemented. Warns once of used extensions that change fragments.
pub(super) fn check(used: &[String], required: &[String]) -> Outcome<()> {
    for extension in required {
        if !matches!(support(extension), Some(Drawn | Invisible | Textures)) {
            return Err(Fault::Unsupported {
                what: format!("the required extension {}", one_line(extension, 100)),
                remedy: remedy(extension).into(),
            });
        }
    }
    let undone = used.iter().filter(|extension| support(extension) == Some(Refused));
    let mut undone: Vec<&str> = undone.map(String::as_str).collect();
    undone.sort_unstable();
    undone.dedup();
    if !undone.is_empty() {
        tracing::warn!(
            "it uses extensions that change the visible geometry and are not supported: {}",
            undone.join(", ")
        );
    }
    Ok(())
}

fn remedy(extension: &str) -> &'static str {
    match extension {
        "KHR_technique_webgl" | "KHR_techniques_webgl" => {
            "it describes shaders of WebGL 1: export the scene again with PBR materials"
        }
        "KHR_animation_pointer" => "export animations of translation, rotation and scale alone",
        "NV_materials_mdl" => "export the scene with PBR materials",
        _ => "export the scene without it",
    }
}

#[cfg(test)]
mod tests {
    use super::{Drawn, Invisible, Refused, Textures, TABLE};
    use std::collections::BTreeSet;

    /// The names in the README's paragraph that begins with a title.
    fn of_readme(title: &str) -> BTreeSet<&'static str> {
        let readme = include_str!("../../README.md");
        let paragraph = readme.split("\n\n").find(|text| text.starts_with(&format!("**{title}**:")));
        paragraph.expect("a paragraph of that title").split('`').skip(1).step_by(2).collect()
    }

    #[test]
    fn the_readme_has_the_same_list() {
        for (title, support) in [
            ("drawn", Drawn),
            ("without effect on visibility", Invisible),
            ("textures left out with a warning", Textures),
            ("refused by name", Refused),
        ] {
            let of_code = TABLE.iter().filter(|(_, other)| *other == support).map(|(name, _)| *name);
            assert_eq!(of_code.collect::<BTreeSet<_>>(), of_readme(title), "{title}");
        }
        let names: BTreeSet<&str> = TABLE.iter().map(|(name, _)| *name).collect();
        assert_eq!(names.len(), TABLE.len(), "an extension stands in the table twice");
    }
}
