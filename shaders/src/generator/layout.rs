//! Types and structs of GLSL blocks, and the check that they lie in memory as Rust would lay them out.
//!
//! Scalar layout is tight, and so is `#[repr(C)]` of 4-byte numbers: the two agree exactly when every offset and stride is
//! the sum of the sizes before it.

use super::spirv::Words;
use rspirv::dr::Instruction;
use rspirv::spirv::{Decoration, Op};
use std::collections::BTreeMap;

/// A number type of 32 bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scalar {
    /// `uint`.
    U32,
    /// `int`.
    I32,
    /// `float`.
    F32,
}

/// A type inside a block.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Type {
    /// One number.
    Scalar(Scalar),
    /// `vecN`, `uvecN`, `ivecN`.
    Vector(Scalar, u32),
    /// `matCxR`: columns, rows.
    Matrix(u32, u32),
    /// `T[n]`.
    Array(Box<Type>, u32),
    /// A struct by name, and its size in bytes.
    Struct(String, u32),
}

impl Type {
    /// Bytes in scalar layout.
    pub fn size(&self) -> u32 {
        match self {
            Type::Scalar(_) => 4,
            Type::Vector(_, count) => 4 * count,
            Type::Matrix(columns, rows) => 4 * columns * rows,
            Type::Array(element, count) => element.size() * count,
            Type::Struct(_, size) => *size,
        }
    }
}

/// One member of a block or struct.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Field {
    /// The GLSL name.
    pub name: String,
    /// Its type.
    pub ty: Type,
    /// The `Offset` decoration.
    pub offset: u32,
}

/// A struct or block of fixed size.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Struct {
    /// The GLSL name.
    pub name: String,
    /// Its members, in order.
    pub fields: Vec<Field>,
}

impl Struct {
    /// Bytes in scalar layout.
    pub fn size(&self) -> u32 {
        self.fields.iter().map(|field| field.ty.size()).sum()
    }
}

/// Reads a struct of fixed size and all structs inside it, which it adds to `structs`.
pub fn read_struct(words: &Words, id: u32, structs: &mut BTreeMap<String, Struct>) -> Result<Struct, String> {
    let name = words.name(id).to_owned();
    let mut fields: Vec<Field> = Vec::new();
    let mut tight = 0;
    for (index, member) in words.instruction(id)?.operands.iter().enumerate() {
        let index = index as u32;
        let field = words.member_name(id, index).to_owned();
        let inside = |error| format!("{name}.{field}: {error}");
        let ty = read_type(words, member.unwrap_id_ref(), structs).map_err(inside)?;
        let offset =
            words.member_decoration(id, index, Decoration::Offset).ok_or_else(|| inside("no offset".to_owned()))?;
        if offset != tight {
            return Err(inside(format!(
                "lies at byte {offset}, but tightly packed it would be {tight}: declare the block with `scalar` layout"
            )));
        }
        check_matrix(words, id, index, &ty).map_err(inside)?;
        tight += ty.size();
        fields.push(Field { name: field, ty, offset });
    }
    let found = Struct { name: name.clone(), fields };
    match structs.insert(name.clone(), found.clone()) {
        Some(other) if other != found => Err(format!("two structs are named `{name}`: rename one")),
        _ => Ok(found),
    }
}

fn check_matrix(words: &Words, id: u32, member: u32, ty: &Type) -> Result<(), String> {
    let mut inner = ty;
    while let Type::Array(element, _) = inner {
        inner = element;
    }
    let Type::Matrix(_, rows) = inner else {
        return Ok(());
    };
    if words.is_member_decorated(id, member, Decoration::RowMajor) {
        return Err("row_major: matrices lie by columns".to_owned());
    }
    match words.member_decoration(id, member, Decoration::MatrixStride) {
        Some(stride) if stride == 4 * rows => Ok(()),
        stride => {
            Err(format!("columns lie {stride:?} bytes apart, not {}: declare the block with `scalar` layout", 4 * rows))
        }
    }
}

/// Refuses an array whose elements are not tightly packed.
pub fn check_stride(words: &Words, array: &Instruction, element: &Type) -> Result<(), String> {
    let stride = words.decoration(array.result_id.unwrap_or_default(), Decoration::ArrayStride);
    match stride {
        Some(stride) if stride == element.size() => Ok(()),
        _ => Err(format!(
            "array elements lie {} bytes apart, not {}: declare the block with `scalar` layout",
            stride.map_or("unknown".to_owned(), |stride| stride.to_string()),
            element.size()
        )),
    }
}

/// Reads a type, adding the structs in it to `structs`.
pub fn read_type(words: &Words, id: u32, structs: &mut BTreeMap<String, Struct>) -> Result<Type, String> {
    let ty = words.instruction(id)?;
    match ty.class.opcode {
        Op::TypeInt | Op::TypeFloat => Ok(Type::Scalar(read_scalar(ty)?)),
        Op::TypeVector => {
            let scalar = read_scalar(words.instruction(ty.operands[0].unwrap_id_ref())?)?;
            Ok(Type::Vector(scalar, ty.operands[1].unwrap_literal_bit32()))
        }
        Op::TypeMatrix => {
            let columns = ty.operands[1].unwrap_literal_bit32();
            match read_type(words, ty.operands[0].unwrap_id_ref(), structs)? {
                Type::Vector(Scalar::F32, rows) => Ok(Type::Matrix(columns, rows)),
                _ => Err("a matrix is of float".to_owned()),
            }
        }
        Op::TypeArray => {
            let element = read_type(words, ty.operands[0].unwrap_id_ref(), structs)?;
            check_stride(words, ty, &element)?;
            let count = words.instruction(ty.operands[1].unwrap_id_ref())?;
            match count.class.opcode {
                Op::Constant => Ok(Type::Array(Box::new(element), count.operands[0].unwrap_literal_bit32())),
                _ => Err("its length is a specialization constant: Rust needs a fixed one".to_owned()),
            }
        }
        Op::TypeStruct => {
            let found = read_struct(words, id, structs)?;
            Ok(Type::Struct(found.name.clone(), found.size()))
        }
        Op::TypeRuntimeArray => Err("a runtime array stands alone in its block".to_owned()),
        other => Err(format!("type {other:?} cannot be shared with Rust")),
    }
}

/// Reads a number type.
pub fn read_scalar(ty: &Instruction) -> Result<Scalar, String> {
    let width = ty.operands[0].unwrap_literal_bit32();
    match (ty.class.opcode, width) {
        (Op::TypeFloat, 32) => Ok(Scalar::F32),
        (Op::TypeInt, 32) => match ty.operands[1].unwrap_literal_bit32() {
            0 => Ok(Scalar::U32),
            _ => Ok(Scalar::I32),
        },
        _ => Err(format!("numbers of {width} bits cannot be shared with Rust: use 32")),
    }
}
