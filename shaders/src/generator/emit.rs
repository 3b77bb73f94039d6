//! Stages as Rust text. `rustfmt` gives it its shape afterwards.

use super::layout::Struct;
use super::reflect::{Binding, Constant, Value};
use super::stages::{Attribute, StageModel};
use super::structs::{emit_struct, PodField, PodStruct};
use super::words::{banner, doc, rust_type};
use crate::contract::VertexFormat;
use crate::sources::Source;
use std::fmt::Write;

/// The file of one family.
pub fn emit_family(family: &str, stages: &[&StageModel]) -> String {
    let mut out = banner(&format!("The stages of `{family}`."));
    let bodies: String = stages.iter().map(|stage| emit_stage(stage)).collect();
    out += "use crate::contract::*;\n";
    if bodies.contains("types::") {
        out += "use super::types;\n";
    }
    out + "\n" + &bodies
}

/// The file that joins all families.
pub fn emit_root(families: &[&str], stages: &[StageModel]) -> String {
    let mut out = banner("Every stage, by family, and the types and constants that GLSL and Rust share.");
    for family in families {
        let _ = writeln!(out, "pub mod {family};");
    }
    out += "pub mod types;\n\n";
    out += "use crate::contract::{Stage, StageInfo};\n\n";
    out += "/// What is fixed about each stage, by name.\npub const STAGES: &[&StageInfo] = &[\n";
    for stage in stages {
        let _ = writeln!(out, "<{}::{} as Stage>::INFO,", stage.family, stage.type_name);
    }
    out + "];\n"
}

fn emit_stage(stage: &StageModel) -> String {
    let mut out = doc(&stage.doc);
    let _ = writeln!(out, "#[derive(Clone, Copy, Debug)]\npub struct {} {{", stage.type_name);
    for (doc_lines, name, ty) in fields(stage) {
        let _ = writeln!(out, "{}pub {name}: {ty},", doc(&doc_lines));
    }
    out += "}\n\n";
    out += &emit_impl(stage);
    if let Some(push) = &stage.push {
        out += &emit_push(stage, push);
    }
    if !stage.constants.is_empty() {
        out += &emit_constants(stage);
    }
    if !stage.vertex.is_empty() {
        out += &emit_attributes(stage, "vertex", "Vertex", &stage.vertex, stage.vertex_stride);
    }
    if !stage.instance.is_empty() {
        out += &emit_attributes(stage, "instance", "Instance", &stage.instance, stage.instance_stride);
    }
    out
}

/// Comment, name and type of each field: bindings, push constants, specialization constants.
fn fields(stage: &StageModel) -> Vec<(Vec<String>, String, String)> {
    let binding = |binding: &Binding| {
        let ty = match &binding.element {
            Some(element) => format!("BufferRef<{}>", rust_type(element, "types::")),
            None => "ImageRef".to_owned(),
        };
        (stage.docs.of(&binding.name, &binding.name), binding.name.clone(), ty)
    };
    let mut fields: Vec<_> = stage.bindings.iter().map(binding).collect();
    if let Some(push) = &stage.push {
        for field in &push.fields {
            let docs = stage.docs.of(&format!("{}.{}", push.name, field.name), &field.name);
            fields.push((docs, field.name.clone(), rust_type(&field.ty, "types::")));
        }
    }
    if !stage.constants.is_empty() {
        let docs = vec!["Specialization constants.".to_owned()];
        fields.push((docs, "constants".to_owned(), format!("{}Constants", stage.type_name)));
    }
    fields
}

fn emit_impl(stage: &StageModel) -> String {
    let name = &stage.type_name;
    let mut out = format!("impl Stage for {name} {{\n");
    out += &emit_info(stage);
    out += "\nfn bind(&self) -> BoundStage {\n";
    let push = match &stage.push {
        Some(push) => {
            let fields = push.fields.iter().map(|field| format!("{0}: self.{0},", field.name));
            let _ = writeln!(out, "let push = {name}Push {{ {} }};", fields.collect::<String>());
            "bytemuck::bytes_of(&push)"
        }
        None => "&[]",
    };
    let resources = stage.bindings.iter().map(|binding| format!("self.{}.into(),", binding.name));
    let constants = stage.constants.iter().map(|constant| raw_bits(constant) + ",");
    let _ = writeln!(
        out,
        "BoundStage::new(Self::INFO, vec![{}], {push}, vec![{}])\n}}\n}}\n",
        resources.collect::<String>(),
        constants.collect::<String>()
    );
    let kind = if stage.is_compute() { "ComputeStage" } else { "GraphicsStage" };
    let _ = writeln!(out, "impl {kind} for {name} {{}}\n");
    out
}

fn raw_bits(constant: &Constant) -> String {
    let field = format!("self.constants.{}", constant.name.to_lowercase());
    match constant.default {
        Value::Bool(_) => format!("u32::from({field})"),
        Value::U32(_) => field,
        Value::I32(_) => format!("{field} as u32"),
        Value::F32(_) => format!("{field}.to_bits()"),
    }
}

fn emit_info(stage: &StageModel) -> String {
    let module = |source: &Source| {
        let (kind, file) = (source.kind, source.file());
        format!("ShaderModule {{ kind: ShaderKind::{kind:?}, spirv: include_bytes!(\"spirv/{file}.spv\") }},")
    };
    let binding = |item: &Binding| {
        let Binding { name, binding, kind, access, .. } = item;
        format!(
            "BindingInfo {{ name: {name:?}, binding: {binding}, kind: BindingKind::{kind:?}, access: Access::{access:?} }},"
        )
    };
    let constant = |item: &Constant| format!("ConstantInfo {{ name: {:?}, id: {} }},", item.name, item.id);
    let vertex = |item: &Attribute| {
        let Attribute { name, location, format, offset } = item;
        format!(
            "VertexAttribute {{ name: {name:?}, location: {location}, format: VertexFormat::{format:?}, offset: {offset} }},"
        )
    };
    format!(
        "const INFO: &'static StageInfo = &StageInfo {{ name: {:?}, modules: &[{}], bindings: &[{}], push_size: {}, \
         constants: &[{}], local_size: {:?}, vertex: &[{}], vertex_stride: {}, \
         instance: &[{}], instance_stride: {}, outputs: &{:?} }};\n",
        stage.name,
        stage.modules.iter().map(module).collect::<String>(),
        stage.bindings.iter().map(binding).collect::<String>(),
        stage.push.as_ref().map_or(0, Struct::size),
        stage.constants.iter().map(constant).collect::<String>(),
        stage.local_size,
        stage.vertex.iter().map(vertex).collect::<String>(),
        stage.vertex_stride,
        stage.instance.iter().map(vertex).collect::<String>(),
        stage.instance_stride,
        stage.outputs,
    )
}

fn emit_push(stage: &StageModel, push: &Struct) -> String {
    let fields = push.fields.iter().map(|field| PodField {
        doc: Vec::new(),
        name: field.name.clone(),
        ty: rust_type(&field.ty, "types::"),
        offset: field.offset,
    });
    emit_struct(&PodStruct {
        public: false,
        doc: Vec::new(),
        name: format!("{}Push", stage.type_name),
        fields: fields.collect(),
        size: push.size(),
    })
}

fn emit_attributes(stage: &StageModel, one: &str, suffix: &str, attributes: &[Attribute], stride: u32) -> String {
    let field = |attribute: &Attribute| {
        let ty = match attribute.format {
            VertexFormat::Float => "f32",
            VertexFormat::Float2 => "[f32; 2]",
            VertexFormat::Float3 => "[f32; 3]",
            VertexFormat::Float4 => "[f32; 4]",
            VertexFormat::Snorm16x2 => "[i16; 2]",
            VertexFormat::Uint => "u32",
        };
        let declared =
            if suffix == "Instance" { format!("instance_{}", attribute.name) } else { attribute.name.clone() };
        PodField {
            doc: stage.docs.of(&declared, &declared),
            name: attribute.name.clone(),
            ty: ty.to_owned(),
            offset: attribute.offset,
        }
    };
    emit_struct(&PodStruct {
        public: true,
        doc: vec![format!("One {one} of [`{}`].", stage.type_name)],
        name: format!("{}{suffix}", stage.type_name),
        fields: attributes.iter().map(field).collect(),
        size: stride,
    })
}

fn emit_constants(stage: &StageModel) -> String {
    let name = format!("{}Constants", stage.type_name);
    let mut out = format!("/// Specialization constants of [`{}`].\n", stage.type_name);
    let _ = writeln!(out, "#[derive(Clone, Copy, Debug, PartialEq)]\npub struct {name} {{");
    let mut defaults = String::new();
    for constant in &stage.constants {
        let (ty, value) = match constant.default {
            Value::Bool(value) => ("bool", value.to_string()),
            Value::U32(value) => ("u32", value.to_string()),
            Value::I32(value) => ("i32", value.to_string()),
            Value::F32(value) if value.is_finite() => ("f32", format!("{value:?}")),
            Value::F32(value) => ("f32", format!("f32::from_bits({:#x})", value.to_bits())),
        };
        let field = constant.name.to_lowercase();
        let lines = doc(&stage.docs.of(&constant.name, &constant.name));
        let _ = writeln!(out, "{lines}pub {field}: {ty},");
        let _ = write!(defaults, "{field}: {value},");
    }
    out += "}\n\n";
    let _ = writeln!(
        out,
        "impl Default for {name} {{\n/// The values that GLSL gives.\nfn default() -> Self {{ Self {{ {defaults} }} }}\n}}\n"
    );
    out
}

/// Whether a stage's struct would hide a name of the contract.
pub fn hides_contract(stage: &StageModel) -> bool {
    const NAMES: &[&str] = &[
        "Access",
        "BindingInfo",
        "BindingKind",
        "Bound",
        "BoundStage",
        "BufferRef",
        "ComputeStage",
        "ConstantInfo",
        "GraphicsStage",
        "ImageRef",
        "ResourceId",
        "ShaderKind",
        "ShaderModule",
        "Stage",
        "StageInfo",
        "VertexAttribute",
        "VertexFormat",
    ];
    NAMES.contains(&stage.type_name.as_str())
}
