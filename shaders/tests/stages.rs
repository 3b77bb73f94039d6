//! What the generated stages promise the engine and RenderDoc. Offsets are asserted where the structs are declared.

use shaders::{pack, sources, Bound, BufferRef, ResourceId, ShaderModule, Stage, STAGES};
use std::collections::{BTreeMap, BTreeSet};
use std::marker::PhantomData;

const OP_NAME: u32 = 5;
const OP_DECORATE: u32 = 71;
const DECORATION_BINDING: u32 = 33;

/// Each instruction of a module: its opcode and operands.
fn instructions(module: &ShaderModule) -> Vec<(u32, Vec<u32>)> {
    let words = module.spirv.chunks_exact(4).map(|word| u32::from_le_bytes(word.try_into().unwrap()));
    let words: Vec<u32> = words.collect();
    let mut rest = &words[5..];
    let mut found = Vec::new();
    while let [head, ..] = rest {
        let length = (head >> 16) as usize;
        found.push((head & 0xffff, rest[1..length].to_vec()));
        rest = &rest[length..];
    }
    found
}

/// A literal string: UTF-8, ended by a zero, in little-endian words.
fn string(words: &[u32]) -> String {
    let bytes = words.iter().flat_map(|word| word.to_le_bytes());
    String::from_utf8(bytes.take_while(|byte| *byte != 0).collect()).unwrap()
}

/// The names that a module still has for its bindings, by binding number.
fn names_of_bindings(module: &ShaderModule) -> BTreeMap<u32, String> {
    let (mut names, mut bindings) = (BTreeMap::new(), Vec::new());
    for (opcode, operands) in instructions(module) {
        match (opcode, &operands[..]) {
            (OP_NAME, [id, text @ ..]) => drop(names.insert(*id, string(text))),
            (OP_DECORATE, [id, DECORATION_BINDING, binding]) => bindings.push((*id, *binding)),
            _ => {}
        }
    }
    bindings.into_iter().map(|(id, binding)| (binding, names.get(&id).cloned().unwrap_or_default())).collect()
}

#[test]
fn stages_are_named_by_their_paths() {
    let sources = sources::list(sources::crate_root()).unwrap();
    let paths: BTreeSet<String> = sources.iter().map(|source| source.stage()).collect();
    let names: Vec<String> = STAGES.iter().map(|stage| stage.name.to_owned()).collect();
    assert_eq!(names, paths.into_iter().collect::<Vec<_>>(), "run `cargo shaders`");
}

#[test]
fn shipped_modules_keep_the_names_of_their_bindings() {
    for stage in STAGES {
        let declared: BTreeMap<u32, &str> = stage.bindings.iter().map(|item| (item.binding, item.name)).collect();
        for module in stage.modules {
            for (binding, name) in names_of_bindings(module) {
                assert_eq!(declared.get(&binding), Some(&name.as_str()), "{} binding {binding}", stage.name);
            }
        }
    }
}

#[test]
fn every_binding_is_used() {
    for stage in STAGES {
        let modules = stage.modules.iter();
        let used: BTreeSet<u32> = modules.flat_map(|module| names_of_bindings(module).into_keys()).collect();
        for item in stage.bindings {
            assert!(used.contains(&item.binding), "{}: `{}` is declared and never used", stage.name, item.name);
        }
    }
}

#[test]
fn stages_hold_to_the_contract() {
    for stage in STAGES {
        let name = stage.name;
        assert!(stage.push_size as usize <= shaders::MAX_PUSH_BYTES && stage.push_size % 4 == 0, "{name}");
        assert!(stage.bindings.windows(2).all(|pair| pair[0].binding < pair[1].binding), "{name}");
        assert!(stage.vertex.windows(2).all(|pair| pair[0].location < pair[1].location), "{name}");
        assert!(stage.constants.windows(2).all(|pair| pair[0].id < pair[1].id), "{name}");
        assert_eq!(stage.vertex.is_empty(), stage.vertex_stride == 0, "{name}");
        assert_eq!(stage.modules[0].kind == shaders::ShaderKind::Compute, stage.local_size != [0; 3], "{name}");
    }
}

fn buffer(id: u32) -> BufferRef<u32> {
    BufferRef { id: ResourceId(id), raw: u64::from(id), offset: 0, size: 4, element: PhantomData }
}

#[test]
fn binding_puts_everything_in_its_place() {
    let stage = pack::ScanCounts {
        total: buffer(2),
        starts: buffer(1),
        counts: buffer(0),
        chunk_count: 0x0403_0201,
        constants: pack::ScanCountsConstants { subgroup_size: 32 },
    };
    let bound = stage.bind();
    let id = |resource: &Bound| match resource {
        Bound::Buffer { id, .. } => id.0,
        Bound::Image(image) => image.id.0,
    };
    assert_eq!(bound.resources.iter().map(id).collect::<Vec<_>>(), [0, 1, 2]);
    assert_eq!(bound.info.name, "pack/scan_counts");
    assert_eq!(bound.push[..bound.info.push_size as usize], [1, 2, 3, 4]);
    assert_eq!(bound.constants, [32]);
}
