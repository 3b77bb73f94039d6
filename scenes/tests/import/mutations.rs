//! The law that nothing in a file makes the import panic.

use crate::corpus;
use crate::model::{import, joined, parts};
use proptest::prelude::*;
use std::sync::LazyLock;

static SEEDS: LazyLock<Vec<(&str, Vec<u8>)>> = LazyLock::new(corpus::all);

fn check(file: &[u8]) {
    match import(file) {
        Ok(scene) => {
            let mut places = Vec::new();
            scene.motion.transforms_at(0.3, &mut places);
            assert!(scene.check().is_ok());
            let meshes = scene.meshes_at(0.3);
            for deformed in &scene.deformed {
                assert_eq!(meshes[deformed.mesh as usize].positions.len(), deformed.rest.len());
            }
            for object in &scene.objects {
                assert!((object.mesh as usize) < scene.meshes.len() && object.world_from_object.is_finite());
            }
            for mesh in &scene.meshes {
                assert_eq!(mesh.positions.len(), mesh.normals.len());
                assert!(mesh.indices.iter().all(|&index| (index as usize) < mesh.positions.len()));
                assert!(mesh.positions.iter().chain(&mesh.normals).all(|vector| vector.is_finite()));
                assert!([0, mesh.positions.len()].contains(&mesh.texture_coordinates.len()));
                assert!([0, mesh.positions.len()].contains(&mesh.colours.len()));
            }
            for texture in &scene.textures {
                assert_eq!(texture.texels.len(), texture.size[0] as usize * texture.size[1] as usize);
            }
            let textures = scene.objects.iter().filter_map(|object| object.surface.texture);
            assert!(textures.into_iter().all(|texture| (texture as usize) < scene.textures.len()));
        }
        Err(error) => assert!(!error.to_string().contains('\n')),
    }
}

/// A refused seed would test nothing behind the refusal.
#[test]
fn every_seed_is_legal_and_has_something_to_draw() {
    for (name, file) in corpus::all() {
        let scene = import(&file).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(!scene.objects.is_empty(), "{name}");
        let textured = scene.objects.iter().any(|object| object.surface.texture.is_some());
        assert_eq!(textured, name.starts_with("webp") || name == "rich", "{name}");
        check(&file);
    }
}

#[test]
fn the_rich_seed_has_all_that_it_should() {
    let scene = corpus::rich().scene();
    // Two places of a mesh of two materials, and a skin that bends it.
    assert_eq!((scene.objects.len(), scene.cameras.len(), scene.motion.dynamic_objects().len()), (6, 1, 6));
    assert_eq!((scene.skins.len(), scene.deformed.len()), (1, 4));
    let count = |of: fn(&scenes::Object) -> bool| scene.objects.iter().filter(|object| of(object)).count();
    let counts = (count(|o| o.masked), count(|o| o.translucent), count(|o| o.surface.texture.is_some()));
    assert_eq!(counts, (3, 3, 6), "masked, translucent, textured");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_changed_or_cut_byte_makes_it_panic(
        seed in any::<prop::sample::Index>(),
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..8), length in any::<prop::sample::Index>(), cut in prop::bool::weighted(0.1),
    ) {
        let mut file = seed.get(&SEEDS).1.clone();
        for (at, byte) in changes {
            let at = at.index(file.len());
            file[at] = byte;
        }
        if cut {
            file.truncate(length.index(file.len()));
        }
        check(&file);
    }

    /// Most changed bytes break the JSON; changed numbers reach what is behind it.
    #[test]
    fn no_changed_number_makes_it_panic(
        seed in any::<prop::sample::Index>(),
        changes in prop::collection::vec((any::<prop::sample::Index>(), prop_oneof![
            (0_u64..8).prop_map(|number| number.to_string()), (5119_u64..5128).prop_map(|number| number.to_string()),
            any::<u64>().prop_map(|number| number.to_string()), any::<f64>().prop_map(|number| format!("{number:e}")),
        ]), 1..4),
    ) {
        let (_, file) = seed.get(&SEEDS);
        let (mut json, data) = parts(file);
        for (at, number) in changes {
            let bounds: Vec<(usize, usize)> = numbers(&json);
            let (start, end) = bounds[at.index(bounds.len())];
            json.replace_range(start..end, &number);
        }
        check(&joined(&json, data));
    }
}

/// Start and end of each number in the text.
fn numbers(text: &str) -> Vec<(usize, usize)> {
    let part = |byte: u8| byte.is_ascii_digit() || b"+-.eE".contains(&byte);
    let bytes = text.as_bytes();
    let starts = (1..bytes.len()).filter(|&at| bytes[at].is_ascii_digit() && b":[,".contains(&bytes[at - 1]));
    starts.map(|start| (start, start + bytes[start..].iter().take_while(|&&byte| part(byte)).count())).collect()
}
