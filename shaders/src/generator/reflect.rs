//! What a module declares: bindings, push constants, specialization constants, inputs and outputs.
//!
//! Reads the unoptimised module, where everything declared is still there. What the contract cannot express is refused.

use super::layout::{check_stride, read_scalar, read_struct, read_type, Scalar, Struct, Type};
use super::spirv::Words;
use crate::contract::{Access, BindingKind, ShaderKind};
use rspirv::dr::{Instruction, Operand};
use rspirv::spirv::{Decoration, ExecutionMode, Op, StorageClass};
use std::collections::{BTreeMap, BTreeSet};

/// One binding of set 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Binding {
    /// The GLSL instance name.
    pub name: String,
    /// Its number.
    pub binding: u32,
    /// What it is.
    pub kind: BindingKind,
    /// What the shader may do with it.
    pub access: Access,
    /// What a buffer holds; nothing for an image.
    pub element: Option<Type>,
}

/// A specialization constant's default.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// `bool`.
    Bool(bool),
    /// `uint`.
    U32(u32),
    /// `int`.
    I32(i32),
    /// `float`.
    F32(f32),
}

/// One specialization constant.
#[derive(Clone, Debug, PartialEq)]
pub struct Constant {
    /// The GLSL name.
    pub name: String,
    /// The `constant_id`.
    pub id: u32,
    /// The value in GLSL.
    pub default: Value,
}

/// One vertex input, stage output or the like.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Interface {
    /// The GLSL name.
    pub name: String,
    /// Its location.
    pub location: u32,
    /// Its type.
    pub ty: Type,
}

/// Everything a module declares.
#[derive(Clone, Debug, Default)]
pub struct Reflection {
    /// Bindings by number.
    pub bindings: Vec<Binding>,
    /// The push constant block.
    pub push: Option<Struct>,
    /// Specialization constants by id.
    pub constants: Vec<Constant>,
    /// Work-group size; zeros unless compute.
    pub local_size: [u32; 3],
    /// User inputs by location.
    pub inputs: Vec<Interface>,
    /// User outputs by location.
    pub outputs: Vec<Interface>,
    /// Every struct that a block holds, and blocks that are structs themselves, by name.
    pub structs: BTreeMap<String, Struct>,
}

/// Reads a module. Errors name the declaration, not the file.
pub fn reflect(words: &[u32], kind: ShaderKind) -> Result<Reflection, String> {
    let words = Words::load(words)?;
    let mut reflection = Reflection::default();
    for variable in words.all(Op::Variable) {
        let Some(Operand::StorageClass(class)) = variable.operands.first() else {
            continue;
        };
        let id = variable.result_id.unwrap_or_default();
        let pointer = words.instruction(variable.result_type.unwrap_or_default())?;
        let pointee = pointer.operands[1].unwrap_id_ref();
        match class {
            StorageClass::PushConstant => {
                let block = read_struct(&words, pointee, &mut reflection.structs)?;
                reflection.structs.remove(&block.name);
                reflection.push = Some(block);
            }
            StorageClass::Uniform | StorageClass::StorageBuffer | StorageClass::UniformConstant => {
                let binding = read_binding(&words, id, pointee, *class, &mut reflection.structs)?;
                reflection.bindings.push(binding);
            }
            StorageClass::Input => add_interface(&words, id, pointee, &mut reflection.inputs)?,
            StorageClass::Output => add_interface(&words, id, pointee, &mut reflection.outputs)?,
            _ => {}
        }
    }
    reflection.bindings.sort_by_key(|binding| binding.binding);
    for pair in reflection.bindings.windows(2) {
        if pair[0].binding == pair[1].binding {
            return Err(format!(
                "`{}` and `{}` have the same binding {}: give each its own",
                pair[0].name, pair[1].name, pair[0].binding
            ));
        }
    }
    reflection.inputs.sort_by_key(|input| input.location);
    reflection.outputs.sort_by_key(|output| output.location);
    reflection.constants = read_constants(&words)?;
    if kind == ShaderKind::Compute {
        reflection.local_size = read_local_size(&words, &reflection.constants)?;
    }
    Ok(reflection)
}

fn read_binding(
    words: &Words,
    id: u32,
    pointee: u32,
    class: StorageClass,
    structs: &mut BTreeMap<String, Struct>,
) -> Result<Binding, String> {
    let ty = words.instruction(pointee)?;
    let name = match words.name(id) {
        "" => {
            let block = words.name(pointee);
            return Err(format!("block `{block}` has no instance name: write `}} name;` after it"));
        }
        name => name.to_owned(),
    };
    if let Some(set) = words.decoration(id, Decoration::DescriptorSet).filter(|&set| set != 0) {
        return Err(format!("`{name}` is in set {set}: the contract has set 0 only"));
    }
    let binding = words.decoration(id, Decoration::Binding).ok_or_else(|| format!("`{name}` has no binding number"))?;
    let (kind, element) = match (class, ty.class.opcode) {
        (StorageClass::StorageBuffer, Op::TypeStruct) => {
            let element = read_buffer(words, pointee, structs).map_err(|error| format!("`{name}`: {error}"))?;
            (BindingKind::StorageBuffer, Some(element))
        }
        (StorageClass::UniformConstant, Op::TypeImage) => match ty.operands[5] {
            Operand::LiteralBit32(2) => (BindingKind::StorageImage, None),
            _ => (BindingKind::SampledImage, None),
        },
        (StorageClass::UniformConstant, Op::TypeSampledImage) => (BindingKind::GatheredImage, None),
        _ => {
            return Err(format!(
                "`{name}` is a {}: a binding is a storage buffer, a texture or a storage image",
                match (class, ty.class.opcode) {
                    (StorageClass::Uniform, _) => "uniform buffer",
                    (_, Op::TypeSampler) => "sampler",
                    (_, Op::TypeArray | Op::TypeRuntimeArray) => "array of resources",
                    _ => "resource that the contract does not know",
                }
            ))
        }
    };
    let access = match kind {
        BindingKind::SampledImage | BindingKind::GatheredImage => Access::Read,
        _ => read_access(words, id, ty).map_err(|error| format!("`{name}`: {error}"))?,
    };
    Ok(Binding { name, binding, kind, access, element })
}

/// A qualifier holds if the variable has it, or every member of its block.
fn read_access(words: &Words, id: u32, ty: &Instruction) -> Result<Access, String> {
    let has = |decoration| {
        let members = match ty.class.opcode {
            Op::TypeStruct => ty.operands.len() as u32,
            _ => 0,
        };
        let block = ty.result_id.unwrap_or_default();
        words.is_decorated(id, decoration)
            || members > 0 && (0..members).all(|member| words.is_member_decorated(block, member, decoration))
    };
    match (has(Decoration::NonWritable), has(Decoration::NonReadable)) {
        (true, true) => Err("readonly and writeonly at once: drop one".to_owned()),
        (true, false) => Ok(Access::Read),
        (false, true) => Ok(Access::Write),
        (false, false) => Ok(Access::ReadWrite),
    }
}

/// What a buffer block holds: the element of its one runtime array, or the block itself.
fn read_buffer(words: &Words, block: u32, structs: &mut BTreeMap<String, Struct>) -> Result<Type, String> {
    let members = &words.instruction(block)?.operands;
    let is_runtime = |member: &Operand| -> Result<bool, String> {
        Ok(words.instruction(member.unwrap_id_ref())?.class.opcode == Op::TypeRuntimeArray)
    };
    let runtime = members.iter().map(is_runtime).collect::<Result<Vec<_>, _>>()?;
    if !runtime.contains(&true) {
        let whole = read_struct(words, block, structs)?;
        return Ok(Type::Struct(whole.name.clone(), whole.size()));
    }
    if members.len() > 1 {
        let block = words.name(block);
        return Err(format!(
            "block `{block}` has fixed members and a runtime array: make it one runtime array, or fixed members only"
        ));
    }
    let array = words.instruction(members[0].unwrap_id_ref())?;
    let element = read_type(words, array.operands[0].unwrap_id_ref(), structs)?;
    check_stride(words, array, &element)?;
    Ok(element)
}

/// Adds a user-defined input or output; built-in ones and blocks of them are none.
fn add_interface(words: &Words, id: u32, pointee: u32, list: &mut Vec<Interface>) -> Result<(), String> {
    let Some(location) = words.decoration(id, Decoration::Location) else {
        return Ok(());
    };
    let name = words.name(id).to_owned();
    let ty = read_type(words, pointee, &mut BTreeMap::new()).map_err(|error| format!("`{name}`: {error}"))?;
    list.push(Interface { name, location, ty });
    Ok(())
}

fn read_constants(words: &Words) -> Result<Vec<Constant>, String> {
    let mut constants: Vec<Constant> = Vec::new();
    for op in [Op::SpecConstantTrue, Op::SpecConstantFalse, Op::SpecConstant] {
        for constant in words.all(op) {
            let result = constant.result_id.unwrap_or_default();
            if let Some(id) = words.decoration(result, Decoration::SpecId) {
                let name = words.name(result).to_owned();
                let default = read_default(words, constant).map_err(|error| format!("`{name}`: {error}"))?;
                constants.push(Constant { name, id, default });
            }
        }
    }
    // `local_size_x_id = 0` declares a constant without a name; `constant_id = 0` may name it.
    let named: BTreeSet<u32> = constants.iter().filter(|known| !known.name.is_empty()).map(|known| known.id).collect();
    constants.retain(|constant| !constant.name.is_empty() || !named.contains(&constant.id));
    constants.sort_by_key(|constant| constant.id);
    if let Some(Constant { id, .. }) = constants.iter().find(|constant| constant.name.is_empty()) {
        return Err(format!("constant {id} has no name: add `layout(constant_id = {id}) const uint NAME = 1u;`"));
    }
    match constants.windows(2).find(|pair| pair[0].id == pair[1].id) {
        Some(pair) => Err(format!("`{}` and `{}` have the same constant_id", pair[0].name, pair[1].name)),
        None => Ok(constants),
    }
}

fn read_default(words: &Words, constant: &Instruction) -> Result<Value, String> {
    match constant.class.opcode {
        Op::SpecConstantTrue => return Ok(Value::Bool(true)),
        Op::SpecConstantFalse => return Ok(Value::Bool(false)),
        _ => {}
    }
    let bits = constant.operands[0].unwrap_literal_bit32();
    Ok(match read_scalar(words.instruction(constant.result_type.unwrap_or_default())?)? {
        Scalar::U32 => Value::U32(bits),
        Scalar::I32 => Value::I32(bits as i32),
        Scalar::F32 => Value::F32(f32::from_bits(bits)),
    })
}

/// The work-group size; a dimension that is a specialization constant has the constant's default.
fn read_local_size(words: &Words, constants: &[Constant]) -> Result<[u32; 3], String> {
    for mode in words.all(Op::ExecutionMode).chain(words.all(Op::ExecutionModeId)) {
        let values: Vec<u32> = match mode.operands[1] {
            Operand::ExecutionMode(ExecutionMode::LocalSize) => {
                mode.operands[2..].iter().map(Operand::unwrap_literal_bit32).collect()
            }
            Operand::ExecutionMode(ExecutionMode::LocalSizeId) => {
                let dimension = |id: &Operand| read_dimension(words, id.unwrap_id_ref(), constants);
                mode.operands[2..].iter().map(dimension).collect::<Result<_, _>>()?
            }
            _ => continue,
        };
        if let [x, y, z] = values[..] {
            return Ok([x, y, z]);
        }
    }
    Err("no `layout(local_size_x = …) in;`".to_owned())
}

fn read_dimension(words: &Words, id: u32, constants: &[Constant]) -> Result<u32, String> {
    let spec = words.decoration(id, Decoration::SpecId);
    if let Some(constant) = constants.iter().find(|constant| Some(constant.id) == spec) {
        return match constant.default {
            Value::U32(size) => Ok(size),
            _ => Err(format!("`{}` is a work-group size: make it a uint", constant.name)),
        };
    }
    match words.instruction(id)? {
        constant if constant.class.opcode == Op::Constant => Ok(constant.operands[0].unwrap_literal_bit32()),
        _ => Err("the work-group size is an expression: write a number or a constant".to_owned()),
    }
}
