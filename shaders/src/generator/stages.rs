//! From reflected modules to stages: a compute shader is one, a vertex and a fragment shader of one stem are one.

use super::docs::{head, Docs};
use super::layout::{Scalar, Struct, Type};
use super::reflect::{Binding, Constant, Interface, Reflection};
use crate::contract::{Access, ShaderKind, VertexFormat, MAX_PUSH_BYTES};
use crate::sources::Source;

/// One shader, read.
#[derive(Clone, Debug)]
pub struct Shader {
    /// Which file.
    pub source: Source,
    /// The comment at its head.
    pub head: Vec<String>,
    /// The comments in it and in what it includes.
    pub docs: Docs,
    /// What it declares.
    pub reflection: Reflection,
}

impl Shader {
    /// Joins what is known of a shader's text.
    pub fn new(source: Source, text: &str, includes: &Docs, reflection: Reflection) -> Result<Self, String> {
        let mut docs = Docs::read(text);
        docs.add(includes);
        let head = head(text, &source.stage())?;
        Ok(Shader { source, head, docs, reflection })
    }
}

/// One vertex attribute.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Attribute {
    /// The GLSL name.
    pub name: String,
    /// The input location.
    pub location: u32,
    /// How it lies in memory.
    pub format: VertexFormat,
    /// Bytes from the start of the vertex.
    pub offset: u32,
}

/// One stage: what a generated struct says.
#[derive(Clone, Debug)]
pub struct StageModel {
    /// The family's folder.
    pub family: String,
    /// `family/verb_noun`.
    pub name: String,
    /// The Rust struct's name.
    pub type_name: String,
    /// The struct's comment.
    pub doc: Vec<String>,
    /// Comments on the rest.
    pub docs: Docs,
    /// Its shaders.
    pub modules: Vec<Source>,
    /// Bindings by number.
    pub bindings: Vec<Binding>,
    /// Push constants.
    pub push: Option<Struct>,
    /// Specialization constants by id.
    pub constants: Vec<Constant>,
    /// Work-group size.
    pub local_size: [u32; 3],
    /// Vertex attributes by location.
    pub vertex: Vec<Attribute>,
    /// Bytes of a vertex.
    pub vertex_stride: u32,
    /// Attributes that go on once an instance, by location.
    pub instance: Vec<Attribute>,
    /// Bytes of an instance.
    pub instance_stride: u32,
    /// Locations written.
    pub outputs: Vec<u32>,
}

impl StageModel {
    /// Whether it is dispatched, not drawn with.
    pub fn is_compute(&self) -> bool {
        self.modules[0].kind == ShaderKind::Compute
    }
}

/// Joins the shaders of one stage: one compute shader, or a vertex shader and perhaps a fragment shader.
pub fn merge(shaders: &[Shader]) -> Result<StageModel, String> {
    let order = |kind: ShaderKind| shaders.iter().find(|shader| shader.source.kind == kind);
    let compute = order(ShaderKind::Compute);
    let (first, fragment) = match (compute, order(ShaderKind::Vertex), order(ShaderKind::Fragment)) {
        (Some(compute), None, None) => (compute, None),
        (None, Some(vertex), fragment) => (vertex, fragment),
        (Some(_), _, _) => return Err("a compute shader and a pipeline share the name: rename one".to_owned()),
        _ => return Err("a fragment shader needs a vertex shader of the same stem".to_owned()),
    };
    let mut stage = single(first)?;
    if let Some(fragment) = fragment {
        join_fragment(&mut stage, first, fragment)?;
    }
    check_names(&stage)?;
    Ok(stage)
}

fn single(shader: &Shader) -> Result<StageModel, String> {
    let reflection = &shader.reflection;
    let inputs = if shader.source.kind == ShaderKind::Vertex { &reflection.inputs[..] } else { &[] };
    let (of_instance, of_vertex): (Vec<_>, Vec<_>) =
        inputs.iter().cloned().partition(|input| input.name.starts_with(INSTANCE));
    let (vertex, vertex_stride) = attributes(&of_vertex)?;
    let (instance, instance_stride) = attributes(&of_instance)?;
    Ok(StageModel {
        family: shader.source.family.clone(),
        name: shader.source.stage(),
        type_name: upper_camel(&shader.source.stem),
        doc: shader.head.clone(),
        docs: shader.docs.clone(),
        modules: vec![shader.source.clone()],
        bindings: reflection.bindings.clone(),
        push: reflection.push.clone(),
        constants: reflection.constants.clone(),
        local_size: reflection.local_size,
        vertex,
        vertex_stride,
        instance,
        instance_stride,
        outputs: Vec::new(),
    })
}

fn join_fragment(stage: &mut StageModel, vertex: &Shader, fragment: &Shader) -> Result<(), String> {
    let reflection = &fragment.reflection;
    for binding in &reflection.bindings {
        join_binding(&mut stage.bindings, binding)?;
    }
    stage.bindings.sort_by_key(|binding| binding.binding);
    match (&stage.push, &reflection.push) {
        (Some(ours), Some(theirs)) if ours != theirs => {
            return Err("vertex and fragment shader have different push constants: declare the same block".to_owned());
        }
        (None, Some(theirs)) => stage.push = Some(theirs.clone()),
        _ => {}
    }
    for constant in &reflection.constants {
        match stage.constants.iter().find(|known| known.id == constant.id) {
            Some(known) if known != constant => {
                return Err(format!(
                    "constant_id {} differs between vertex and fragment shader: `{}` and `{}`",
                    constant.id, known.name, constant.name
                ));
            }
            Some(_) => {}
            None => stage.constants.push(constant.clone()),
        }
    }
    stage.constants.sort_by_key(|constant| constant.id);
    for input in &reflection.inputs {
        let given = vertex.reflection.outputs.iter().find(|output| output.location == input.location);
        if given.is_none_or(|given| given.ty != input.ty) {
            let location = input.location;
            return Err(format!(
                "fragment input `{}`: the vertex shader writes no such type at location {location}",
                input.name
            ));
        }
    }
    stage.outputs = reflection.outputs.iter().map(|output| output.location).collect();
    stage.modules.push(fragment.source.clone());
    if fragment.head != stage.doc {
        stage.doc.push(String::new());
        stage.doc.extend(fragment.head.iter().cloned());
    }
    stage.docs.add(&fragment.docs);
    Ok(())
}

fn join_binding(bindings: &mut Vec<Binding>, new: &Binding) -> Result<(), String> {
    let Some(known) = bindings.iter_mut().find(|known| known.binding == new.binding) else {
        bindings.push(new.clone());
        return Ok(());
    };
    if known.name != new.name || known.kind != new.kind || known.element != new.element {
        return Err(format!(
            "binding {} is `{}` in the vertex and `{}` in the fragment shader: same number, same name and type",
            new.binding, known.name, new.name
        ));
    }
    if known.access != new.access {
        known.access = Access::ReadWrite;
    }
    Ok(())
}

/// What an input that goes on once an instance is named with.
const INSTANCE: &str = "instance_";

/// Vertex inputs, laid out tightly in the order of their locations.
fn attributes(inputs: &[Interface]) -> Result<(Vec<Attribute>, u32), String> {
    let mut offset = 0;
    let mut attributes = Vec::new();
    for input in inputs {
        let (format, size) = match input.ty {
            Type::Vector(Scalar::F32, 2) if input.name.ends_with("_snorm16") => (VertexFormat::Snorm16x2, 4),
            Type::Scalar(Scalar::F32) => (VertexFormat::Float, 4),
            Type::Vector(Scalar::F32, 2) => (VertexFormat::Float2, 8),
            Type::Vector(Scalar::F32, 3) => (VertexFormat::Float3, 12),
            Type::Vector(Scalar::F32, 4) => (VertexFormat::Float4, 16),
            Type::Scalar(Scalar::U32) => (VertexFormat::Uint, 4),
            _ => {
                let name = &input.name;
                let takes = "float, vec2, vec3, vec4, uint or a vec2 named …_snorm16";
                return Err(format!("vertex input `{name}`: takes {takes}"));
            }
        };
        let name = input.name.strip_prefix(INSTANCE).unwrap_or(&input.name).to_owned();
        attributes.push(Attribute { name, location: input.location, format, offset });
        offset += size;
    }
    Ok((attributes, offset))
}

/// The fields of the Rust struct must differ, be Rust names, and the push constants must fit.
fn check_names(stage: &StageModel) -> Result<(), String> {
    let push = stage.push.iter().flat_map(|push| &push.fields);
    let mut names: Vec<&str> = stage.bindings.iter().map(|binding| binding.name.as_str()).collect();
    names.extend(push.map(|field| field.name.as_str()));
    names.extend((!stage.constants.is_empty()).then_some("constants"));
    for (index, name) in names.iter().enumerate() {
        check_field_name(name)?;
        if names[..index].contains(name) {
            return Err(format!("two of bindings, push constants and `constants` are named `{name}`: rename one"));
        }
    }
    for attribute in stage.vertex.iter().chain(&stage.instance) {
        check_field_name(&attribute.name)?;
    }
    for constant in &stage.constants {
        check_field_name(&constant.name.to_lowercase())?;
    }
    match &stage.push {
        Some(push) if push.size() as usize > MAX_PUSH_BYTES => Err(format!(
            "push constants take {} bytes: every device has room for {MAX_PUSH_BYTES}; move some to a buffer",
            push.size()
        )),
        _ => Ok(()),
    }
}

/// A field is in lower snake case and no word of Rust.
pub fn check_field_name(name: &str) -> Result<(), String> {
    const WORDS: &[&str] = &[
        "as", "async", "await", "box", "break", "const", "continue", "crate", "dyn", "else", "enum", "extern", "false",
        "fn", "for", "if", "impl", "in", "let", "loop", "match", "mod", "move", "mut", "pub", "ref", "return", "self",
        "static", "struct", "super", "trait", "true", "type", "unsafe", "use", "where", "while", "yield", "gen",
    ];
    let lower = |letter: char| letter.is_ascii_lowercase() || letter.is_ascii_digit() || letter == '_';
    if WORDS.contains(&name) {
        return Err(format!("`{name}` is a word of Rust: rename it"));
    }
    match name.starts_with(|first: char| first.is_ascii_lowercase()) && name.chars().all(lower) {
        true => Ok(()),
        false => Err(format!("`{name}` becomes a Rust field: write it in lower_snake_case")),
    }
}

/// `test_bounds` as `TestBounds`.
pub fn upper_camel(snake: &str) -> String {
    let capital = |word: &str| {
        let mut letters = word.chars();
        let first = letters.next().map(|letter| letter.to_ascii_uppercase());
        first.into_iter().chain(letters).collect::<String>()
    };
    snake.split('_').map(capital).collect()
}
