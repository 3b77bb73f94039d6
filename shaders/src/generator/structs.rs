//! Structs that GLSL and Rust share, and the file `types.rs` that holds them with the shared constants.

use super::docs::{constants, Docs};
use super::layout::{Struct, Type};
use super::stages::check_field_name;
use super::words::{banner, doc, rust_type};
use std::collections::BTreeMap;
use std::fmt::Write;

/// A struct to write with its checks.
pub struct PodStruct {
    /// Whether others see it.
    pub public: bool,
    /// Its comment.
    pub doc: Vec<String>,
    /// Its Rust name.
    pub name: String,
    /// Its fields in order.
    pub fields: Vec<PodField>,
    /// Bytes in GLSL.
    pub size: u32,
}

/// One field of a [`PodStruct`].
pub struct PodField {
    /// Its comment.
    pub doc: Vec<String>,
    /// Its name.
    pub name: String,
    /// Its Rust type.
    pub ty: String,
    /// Where GLSL has it.
    pub offset: u32,
}

/// Writes a struct and the assertions that it lies in memory as in GLSL.
pub fn emit_struct(item: &PodStruct) -> String {
    let visible = if item.public { "pub " } else { "" };
    let derives = match item.public {
        true => "Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable",
        false => "Clone, Copy, bytemuck::Pod, bytemuck::Zeroable",
    };
    let mut out = doc(&item.doc);
    let _ = writeln!(out, "#[repr(C)]\n#[derive({derives})]\n{visible}struct {} {{", item.name);
    for field in &item.fields {
        let _ = writeln!(out, "{}{visible}{}: {},", doc(&field.doc), field.name, field.ty);
    }
    out += "}\n\nconst _: () = {\n";
    for field in &item.fields {
        let _ = writeln!(out, "assert!(std::mem::offset_of!({}, {}) == {});", item.name, field.name, field.offset);
    }
    let _ = writeln!(out, "assert!(size_of::<{}>() == {});\n}};\n", item.name, item.size);
    out
}

/// Every shared struct by name, each found the same wherever it is declared.
#[derive(Default)]
pub struct SharedStructs {
    found: BTreeMap<String, (Struct, String)>,
}

impl SharedStructs {
    /// Adds the structs of the shader in `file`. An error if one differs from a struct of that name seen before.
    pub fn add(&mut self, file: &str, structs: &BTreeMap<String, Struct>) -> Result<(), String> {
        for (name, item) in structs {
            check_struct(item)?;
            match self.found.get(name) {
                Some((known, other)) if known != item => {
                    return Err(format!(
                        "struct `{name}` differs from the one in {other}: put it in glsl/include, or rename one"
                    ));
                }
                Some(_) => {}
                None => {
                    self.found.insert(name.clone(), (item.clone(), file.to_owned()));
                }
            }
        }
        Ok(())
    }

    fn emit(&self, docs: &Docs) -> String {
        self.found.values().map(|(item, _)| emit_shared(item, docs)).collect()
    }
}

fn check_struct(item: &Struct) -> Result<(), String> {
    let name = &item.name;
    let camel = name.starts_with(|first: char| first.is_ascii_uppercase()) && !name.contains('_');
    if !camel {
        return Err(format!("struct `{name}` becomes a Rust struct: write it in UpperCamelCase"));
    }
    for field in &item.fields {
        check_field_name(&field.name).map_err(|error| format!("struct `{name}`: {error}"))?;
        if longest_array(&field.ty) > 32 {
            return Err(format!("struct `{name}`: `{}` has more than 32 elements: use a buffer", field.name));
        }
    }
    Ok(())
}

/// Rust gives `Default` to arrays of at most 32 elements.
fn longest_array(ty: &Type) -> u32 {
    match ty {
        Type::Array(element, count) => longest_array(element).max(*count),
        _ => 0,
    }
}

fn emit_shared(item: &Struct, docs: &Docs) -> String {
    let fields = item.fields.iter().map(|field| PodField {
        doc: docs.of(&format!("{}.{}", item.name, field.name), &field.name),
        name: field.name.clone(),
        ty: rust_type(&field.ty, ""),
        offset: field.offset,
    });
    emit_struct(&PodStruct {
        public: true,
        doc: docs.of(&item.name, &item.name),
        name: item.name.clone(),
        fields: fields.collect(),
        size: item.size(),
    })
}

/// What `types.rs` says, and a note for each constant that it leaves out.
pub fn emit_types(
    structs: &SharedStructs,
    docs: &Docs,
    includes: &BTreeMap<String, String>,
) -> Result<(String, Vec<String>), String> {
    let mut out = banner("Structs that buffers and push constants hold, and the constants that GLSL and Rust share.");
    let mut notes = Vec::new();
    let mut seen: BTreeMap<String, &str> = BTreeMap::new();
    for (file, text) in includes {
        let (known, skipped) = constants(text);
        for constant in known {
            if let Some(other) = seen.insert(constant.name.clone(), file) {
                return Err(format!("constant `{}` is in {other} and in {file}: keep one", constant.name));
            }
            let lines = doc(&docs.of(&constant.name, &constant.name));
            let _ = writeln!(out, "{lines}pub const {}: {};\n", constant.name, constant.rust);
        }
        let why = "not a literal or two joined by an operator, so Rust does not get it";
        notes.extend(skipped.iter().map(|name| format!("shaders/glsl/include/{file}: `{name}` is {why}")));
    }
    out += &structs.emit(docs);
    Ok((out, notes))
}
