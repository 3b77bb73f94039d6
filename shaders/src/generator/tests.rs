//! Small GLSL texts through compilation, reflection and emission. Each `refuses_` law is a mistake someone will make.

use super::compile::ShaderCompiler;
use super::docs::{constants, head, Docs};
use super::layout::{Scalar, Type};
use super::reflect::{reflect, Reflection, Value};
use super::stages::{merge, Shader, StageModel};
use super::{differences, generate, write};
use crate::contract::{Access, BindingKind, ShaderKind, VertexFormat};
use crate::sources::{crate_root, Source};
use std::fs;
use std::path::PathBuf;

const COMPUTE: &str = "// test/it: a test.\n#version 460\n#extension GL_EXT_scalar_block_layout : require\n\
    #extension GL_EXT_samplerless_texture_functions : require\nlayout(local_size_x = 8, local_size_y = 4) in;\n";
const GRAPHICS: &str = "// test/it: a test.\n#version 460\n#extension GL_EXT_scalar_block_layout : require\n";

fn shader(kind: ShaderKind, text: &str) -> Result<Shader, String> {
    let source = Source { family: "test".to_owned(), stem: "it".to_owned(), kind };
    let compiled = ShaderCompiler::new(crate_root())?.compile(&source, text)?;
    let reflection = reflect(&compiled.declared, kind)?;
    Shader::new(source, text, &Docs::default(), reflection)
}

fn compute(declarations: &str) -> Result<Reflection, String> {
    let text = format!("{COMPUTE}{declarations}\nvoid main() {{}}\n");
    shader(ShaderKind::Compute, &text).map(|shader| shader.reflection)
}

fn stage(declarations: &str) -> Result<StageModel, String> {
    let text = format!("{COMPUTE}{declarations}\nvoid main() {{}}\n");
    merge(&[shader(ShaderKind::Compute, &text)?])
}

fn pipeline(vertex: &str, fragment: &str) -> Result<StageModel, String> {
    let vertex = shader(ShaderKind::Vertex, &format!("{GRAPHICS}{vertex}"))?;
    let fragment = shader(ShaderKind::Fragment, &format!("{GRAPHICS}{fragment}"))?;
    merge(&[fragment, vertex])
}

#[track_caller]
fn assert_refused<T: std::fmt::Debug>(result: Result<T, String>, why: &str) {
    let error = result.expect_err("must be refused");
    assert!(error.contains(why), "the error {error:?} does not say {why:?}");
}

#[test]
fn scalar_structs_keep_their_order_and_offsets() {
    let read = compute(
        "struct Inner { vec3 a; float b[3]; };
         struct Outer { mat3 turn; Inner inner[2]; ivec2 cell; uint last; };
         layout(set = 0, binding = 3, scalar) readonly buffer All { Outer items[]; } all;",
    )
    .unwrap();
    let offsets: Vec<u32> = read.structs["Outer"].fields.iter().map(|field| field.offset).collect();
    assert_eq!(offsets, [0, 36, 84, 92]);
    assert_eq!(read.structs["Outer"].size(), 96);
    assert_eq!(read.structs["Inner"].fields[1].ty, Type::Array(Box::new(Type::Scalar(Scalar::F32)), 3));
    assert_eq!(read.bindings[0].element, Some(Type::Struct("Outer".to_owned(), 96)));
    assert_eq!(read.local_size, [8, 4, 1]);
}

#[test]
fn unused_bindings_are_read_with_their_access() {
    let read = compute(
        "layout(set = 0, binding = 5, r32ui) uniform uimage2D both;
         layout(set = 0, binding = 4, r32f) writeonly uniform image2D out_image;
         layout(set = 0, binding = 3) uniform utexture2D texels;
         layout(set = 0, binding = 2, scalar) buffer C { vec3 items[]; } c;
         layout(set = 0, binding = 1, scalar) writeonly buffer B { int items[]; } b;
         layout(set = 0, binding = 0, scalar) readonly buffer A { uint count; vec2 size; } a;",
    )
    .unwrap();
    let found: Vec<_> = read.bindings.iter().map(|item| (item.name.as_str(), item.kind, item.access)).collect();
    assert_eq!(
        found,
        [
            ("a", BindingKind::StorageBuffer, Access::Read),
            ("b", BindingKind::StorageBuffer, Access::Write),
            ("c", BindingKind::StorageBuffer, Access::ReadWrite),
            ("texels", BindingKind::SampledImage, Access::Read),
            ("out_image", BindingKind::StorageImage, Access::Write),
            ("both", BindingKind::StorageImage, Access::ReadWrite),
        ]
    );
    assert_eq!(read.bindings[0].element, Some(Type::Struct("A".to_owned(), 12)));
    assert_eq!(read.bindings[2].element, Some(Type::Vector(Scalar::F32, 3)));
    assert!(read.structs.contains_key("A") && !read.structs.contains_key("B"));
}

#[test]
fn specialization_constants_keep_their_defaults() {
    let read = compute(
        "layout(constant_id = 2) const float SCALE = 0.5;
         struct Pair { uint a, b; };  // on one line\n\
         layout(constant_id = 0) const bool LATE = true;
         layout(constant_id = 1) const int STEP = -3;
         layout(constant_id = 3) const uint LANES = 8u;
         layout(local_size_z_id = 3) in;",
    )
    .unwrap();
    let found: Vec<_> = read.constants.iter().map(|item| (item.name.as_str(), item.default)).collect();
    assert_eq!(
        found,
        [("LATE", Value::Bool(true)), ("STEP", Value::I32(-3)), ("SCALE", Value::F32(0.5)), ("LANES", Value::U32(8))]
    );
    assert_eq!(read.local_size, [8, 4, 8]);
}

#[test]
fn refuses_layouts_that_rust_does_not_have() {
    let wide = "struct Wide { vec3 a; vec3 b; };";
    assert_refused(
        compute(&format!("{wide} layout(set = 0, binding = 0, std430) buffer B {{ Wide items[]; }} b;")),
        "scalar",
    );
    assert_refused(
        compute("layout(set = 0, binding = 0, std430) buffer B { vec3 items[]; } b;"),
        "16 bytes apart, not 12",
    );
    assert_refused(
        compute("layout(push_constant, std430) uniform Push { uint a; vec2 b; } push;"),
        "Push.b: lies at byte 8",
    );
    assert_refused(compute("layout(set = 0, binding = 0, std430) buffer B { mat3 turn; } b;"), "scalar");
    assert_refused(compute("layout(set = 0, binding = 0, scalar, row_major) buffer B { mat3 turn; } b;"), "row_major");
    assert_refused(
        compute("layout(set = 0, binding = 0, scalar) buffer B { uint count; uint items[]; } b;"),
        "fixed members and a runtime array",
    );
}

#[test]
fn refuses_resources_outside_the_contract() {
    assert_refused(compute("layout(set = 1, binding = 0, scalar) buffer B { uint items[]; } b;"), "set 1");
    assert_refused(compute("layout(set = 0, binding = 0, scalar) uniform B { uint n; } b;"), "uniform buffer");
    assert_refused(compute("layout(set = 0, binding = 0) uniform sampler s;"), "sampler");
    assert_refused(compute("layout(set = 0, binding = 0) uniform texture2D s[3];"), "array of resources");
    assert_refused(compute("layout(set = 0, binding = 0, scalar) buffer B { uint items[]; };"), "no instance name");
    assert_refused(
        compute("layout(set = 0, binding = 0, scalar) readonly writeonly buffer B { uint items[]; } b;"),
        "drop one",
    );
    let two = "layout(set = 0, binding = 0, scalar) buffer A { uint items[]; } a;
               layout(set = 0, binding = 0, scalar) buffer B { uint items[]; } b;";
    assert_refused(compute(two), "same binding 0");
}

#[test]
fn refuses_names_that_clash_in_rust() {
    let buffer = "layout(set = 0, binding = 0, scalar) buffer B { uint items[]; } count;";
    assert_refused(
        stage(&format!("{buffer} layout(push_constant, scalar) uniform P {{ uint count; }} push;")),
        "`count`",
    );
    assert_refused(stage("layout(push_constant, scalar) uniform P { uint match; } push;"), "word of Rust");
    assert_refused(stage("layout(push_constant, scalar) uniform P { uint Count; } push;"), "lower_snake_case");
    assert_refused(stage("layout(push_constant, scalar) uniform P { mat4 a; mat4 b; uint c; } push;"), "132 bytes");
    assert!(stage("layout(push_constant, scalar) uniform P { mat4 a; mat4 b; } push;").is_ok());
}

#[test]
fn compiler_findings_name_file_and_line() {
    assert_refused(compute("uint a = misspelt;"), "shaders/glsl/test/it.comp:6:");
    assert_refused(compute("#extension GL_NOT_THERE : warn"), "shaders/glsl/test/it.comp:6:");
    assert_refused(compute("#include \"nowhere.glsl\""), "nowhere.glsl");
}

#[test]
fn a_pipeline_joins_its_shaders() {
    let objects = "layout(set = 0, binding = 0, scalar) readonly buffer O { vec4 items[]; } objects;";
    let counts = "layout(set = 0, binding = 1, scalar) writeonly buffer C { uint items[]; } counts;";
    let push = "layout(push_constant, scalar) uniform Push { uint first; } push;";
    let vertex = format!(
        "layout(location = 1) in vec2 normal_snorm16; layout(location = 0) in vec3 position; layout(location = 2) in uint id;
         layout(location = 3) in vec4 instance_place; layout(location = 4) in float alpha;
         layout(location = 0) flat out uint item; {objects} {push}
         void main() {{ item = id + push.first; gl_Position = objects.items[0] + instance_place * alpha; }}"
    );
    let fragment = |input: &str| {
        format!(
            "layout(location = 0) flat in {input} item; layout(location = 1) out uint owner; {objects} {counts}
             void main() {{ owner = uint(item); }}"
        )
    };
    let joined = pipeline(&vertex, &fragment("uint")).unwrap();
    assert_eq!(joined.bindings.len(), 2);
    assert_eq!(joined.vertex_stride, 24);
    let formats: Vec<_> = joined.vertex.iter().map(|item| (item.format, item.offset)).collect();
    assert_eq!(
        formats,
        [(VertexFormat::Float3, 0), (VertexFormat::Snorm16x2, 12), (VertexFormat::Uint, 16), (VertexFormat::Float, 20)]
    );
    let once_an_instance: Vec<_> = joined.instance.iter().map(|item| (item.name.as_str(), item.offset)).collect();
    assert_eq!((once_an_instance, joined.instance_stride), (vec![("place", 0)], 16));
    assert_eq!(joined.outputs, [1]);
    assert_eq!(joined.modules[0].kind, ShaderKind::Vertex);
    assert_refused(pipeline(&vertex, &fragment("int")), "fragment input `item`");
    let other = fragment("uint")
        .replace(objects, "layout(set = 0, binding = 0, scalar) readonly buffer O { vec4 items[]; } boxes;");
    assert_refused(pipeline(&vertex, &other), "same number, same name");
    let other = fragment("uint").replace(counts, "layout(push_constant, scalar) uniform Push { uint last; } push;");
    assert_refused(pipeline(&vertex, &other), "declare the same block");
}

#[test]
fn comments_reach_what_they_describe() {
    let docs = Docs::read(
        "// a box [m]\nstruct Bounds {\n    vec3 low;   // smallest corner\n    // bits\n    uint flags;\n};\n\n\
         // unrelated\n\nlayout(set = 0, binding = 0) buffer All { Bounds items[]; } bounds;  // of every object\n\
         layout(push_constant) uniform Push {\n    float near_m;  // from the eye\n} push;\n\
         struct Pair { uint a, b; };  // on one line\n\
         layout(constant_id = 0) const bool LATE = false;  // second phase\n",
    );
    assert_eq!(docs.of("Bounds", "Bounds"), ["A box \\[m\\]"]);
    assert_eq!(docs.of("Bounds.low", "low"), ["Smallest corner."]);
    assert_eq!(docs.of("Bounds.flags", "flags"), ["Bits."]);
    assert_eq!(docs.of("bounds", "bounds"), ["Of every object."]);
    assert_eq!(docs.of("Push.near_m", "near_m"), ["From the eye."]);
    assert_eq!(docs.of("LATE", "LATE"), ["Second phase."]);
    assert_eq!(docs.of("Pair", "Pair"), ["On one line."]);
    assert_eq!(docs.of("other", "other"), ["`other` in GLSL."]);
    assert_eq!(head("// a/b: what\n// more\n#version 460\n", "a/b").unwrap(), ["What", "more."]);
    assert_refused(head("// b/a: what\n", "a/b"), "begin with a comment `// a/b:");
}

#[test]
fn shared_constants_are_evaluated() {
    let text = "const uint A = 5u;\nconst uint ALL = 0xffffffffu;\nconst float E = 32.0 / 16777216.0;\n\
                const int LOW = -7;\nconst uint BIT = 1u << 3;\nconst uint B = A * 2u;  // doubled\n\
                const float BAD = sqrt(2.0);\nconst vec3 UP = vec3(0.0);\nconst uint NEGATIVE = 1u - 2u;\n";
    let (known, skipped) = constants(text);
    let known: Vec<String> = known.iter().map(|item| format!("{}: {}", item.name, item.rust)).collect();
    assert_eq!(
        known,
        [
            "A: u32 = 5",
            "ALL: u32 = 0xffffffff",
            "E: f32 = 1.9073486e-6",
            "LOW: i32 = -7",
            "BIT: u32 = 8",
            "B: u32 = 10"
        ]
    );
    assert_eq!(skipped, ["BAD", "NEGATIVE"]);
}

/// A copy of what the generator reads, in a folder of its own, with one small stage.
fn small_crate(name: &str) -> PathBuf {
    let root = std::env::temp_dir().join(format!("sightline-{name}-{}", std::process::id()));
    let _ = fs::remove_dir_all(&root);
    for folder in ["glsl/include", "glsl/test", "src/bin", "src/generator"] {
        fs::create_dir_all(root.join(folder)).unwrap();
    }
    fs::write(root.join("src/bin/shader-compiler.rs"), "").unwrap();
    fs::write(root.join("src/contract.rs"), "").unwrap();
    fs::write(root.join("glsl/include/shared.glsl"), "const uint CHUNK = 4u;\nstruct Item { uint n; };\n").unwrap();
    let text = "#extension GL_GOOGLE_include_directive : require\n#include \"shared.glsl\"\n\
                layout(set = 0, binding = 0, scalar) buffer All { Item items[]; } all;\n\
                void main() { all.items[0].n = CHUNK; }\n";
    fs::write(root.join("glsl/test/it.comp"), format!("{COMPUTE}{text}")).unwrap();
    root
}

#[test]
fn generation_is_written_once_and_stale_files_go() {
    let root = small_crate("write");
    let output = generate(&root).unwrap();
    assert_eq!(output.stages, ["test/it"]);
    assert_eq!(differences(&root, &output).unwrap().len(), output.files.len());
    assert_eq!(write(&root, &output).unwrap(), output.files.len());
    assert_eq!(write(&root, &generate(&root).unwrap()).unwrap(), 0, "the second run changes nothing");
    let rust = String::from_utf8(output.files["test.rs"].clone()).unwrap();
    assert!(rust.contains("pub all: BufferRef<types::Item>,"), "{rust}");
    fs::rename(root.join("glsl/test/it.comp"), root.join("glsl/test/them.comp")).unwrap();
    let errors = generate(&root).unwrap_err();
    assert!(errors[0].contains("begin with a comment `// test/them:"), "{errors:?}");
    fs::remove_file(root.join("glsl/test/them.comp")).unwrap();
    let empty = generate(&root).unwrap();
    write(&root, &empty).unwrap();
    assert!(differences(&root, &empty).unwrap().is_empty());
    assert!(!root.join("generated/spirv").exists(), "empty folders go too");
    fs::remove_dir_all(&root).unwrap();
}

#[test]
fn every_error_is_listed() {
    let root = small_crate("errors");
    fs::write(root.join("glsl/test/bad.comp"), COMPUTE.to_owned() + "void main() { nothing(); also(); }\n").unwrap();
    fs::write(root.join("glsl/test/worse.comp"), "void main() {}\n").unwrap();
    let errors = generate(&root).unwrap_err().join("\n");
    assert!(errors.contains("bad.comp:6: error: 'nothing'") && errors.contains("worse.comp"), "{errors}");
    fs::remove_dir_all(&root).unwrap();
}

#[test]
fn same_struct_name_with_another_layout_is_refused() {
    let root = small_crate("structs");
    let text = "// test/other: a test.\n#version 460\n#extension GL_EXT_scalar_block_layout : require\n\
                layout(local_size_x = 1) in; struct Item { float n; };\n\
                layout(set = 0, binding = 0, scalar) buffer All { Item items[]; } all; void main() {}\n";
    fs::write(root.join("glsl/test/other.comp"), text).unwrap();
    let errors = generate(&root).unwrap_err().join("\n");
    assert!(errors.contains("struct `Item` differs from the one in shaders/glsl/test/it.comp"), "{errors}");
    fs::remove_dir_all(&root).unwrap();
}
