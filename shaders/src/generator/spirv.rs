//! A SPIR-V module, indexed the way reflection asks.

use rspirv::binary::{Consumer, ParseAction, ParseState};
use rspirv::dr::{Instruction, ModuleHeader, Operand};
use rspirv::spirv::{Decoration, Op};
use std::collections::HashMap;

#[derive(Default)]
struct Globals(Vec<Instruction>);

impl Consumer for Globals {
    fn initialize(&mut self) -> ParseAction {
        ParseAction::Continue
    }

    fn finalize(&mut self) -> ParseAction {
        ParseAction::Continue
    }

    fn consume_header(&mut self, _: ModuleHeader) -> ParseAction {
        ParseAction::Continue
    }

    fn consume_instruction(&mut self, instruction: Instruction) -> ParseAction {
        if instruction.class.opcode == Op::Function {
            return ParseAction::Stop;
        }
        self.0.push(instruction);
        ParseAction::Continue
    }
}

/// A module with its names and decorations by id.
pub struct Words {
    /// Everything before the first function. `rspirv::dr::load_words` does not know OpExecutionModeId.
    globals: Vec<Instruction>,
    by_id: HashMap<u32, usize>,
    names: HashMap<u32, String>,
    member_names: HashMap<(u32, u32), String>,
    decorations: HashMap<(u32, Decoration), Option<u32>>,
    member_decorations: HashMap<(u32, u32, Decoration), Option<u32>>,
}

impl Words {
    /// Reads a module.
    pub fn load(words: &[u32]) -> Result<Self, String> {
        let mut globals = Globals::default();
        match rspirv::binary::parse_words(words, &mut globals) {
            Ok(()) | Err(ParseState::ConsumerStopRequested) => {}
            Err(error) => return Err(format!("SPIR-V: {error}")),
        }
        let globals = globals.0;
        let ids = globals.iter().enumerate();
        let by_id = ids.filter_map(|(index, global)| Some((global.result_id?, index))).collect();
        let mut loaded = Words {
            globals,
            by_id,
            names: HashMap::new(),
            member_names: HashMap::new(),
            decorations: HashMap::new(),
            member_decorations: HashMap::new(),
        };
        loaded.index_names();
        loaded.index_decorations();
        Ok(loaded)
    }

    fn index_names(&mut self) {
        for line in &self.globals {
            match (line.class.opcode, &line.operands[..]) {
                (Op::Name, [Operand::IdRef(id), Operand::LiteralString(name)]) => {
                    self.names.insert(*id, name.clone());
                }
                (Op::MemberName, [Operand::IdRef(id), Operand::LiteralBit32(member), Operand::LiteralString(name)]) => {
                    self.member_names.insert((*id, *member), name.clone());
                }
                _ => {}
            }
        }
    }

    fn index_decorations(&mut self) {
        let value = |rest: &[Operand]| match rest.first() {
            Some(Operand::LiteralBit32(value)) => Some(*value),
            _ => None,
        };
        for line in &self.globals {
            match (line.class.opcode, &line.operands[..]) {
                (Op::Decorate, [Operand::IdRef(id), Operand::Decoration(what), rest @ ..]) => {
                    self.decorations.insert((*id, *what), value(rest));
                }
                (
                    Op::MemberDecorate,
                    [Operand::IdRef(id), Operand::LiteralBit32(member), Operand::Decoration(what), rest @ ..],
                ) => {
                    self.member_decorations.insert((*id, *member, *what), value(rest));
                }
                _ => {}
            }
        }
    }

    /// Every global instruction of one kind, in the module's order.
    pub fn all(&self, op: Op) -> impl Iterator<Item = &Instruction> {
        self.globals.iter().filter(move |global| global.class.opcode == op)
    }

    /// The global instruction that makes `id`.
    pub fn instruction(&self, id: u32) -> Result<&Instruction, String> {
        let index = self.by_id.get(&id).ok_or_else(|| format!("SPIR-V: %{id} is not a global"))?;
        Ok(&self.globals[*index])
    }

    /// The name of `id`; empty if it has none.
    pub fn name(&self, id: u32) -> &str {
        self.names.get(&id).map_or("", String::as_str)
    }

    /// The name of a struct's member; empty if it has none.
    pub fn member_name(&self, id: u32, member: u32) -> &str {
        self.member_names.get(&(id, member)).map_or("", String::as_str)
    }

    /// The value of a decoration that has one.
    pub fn decoration(&self, id: u32, what: Decoration) -> Option<u32> {
        self.decorations.get(&(id, what)).copied().flatten()
    }

    /// The value of a member's decoration that has one.
    pub fn member_decoration(&self, id: u32, member: u32, what: Decoration) -> Option<u32> {
        self.member_decorations.get(&(id, member, what)).copied().flatten()
    }

    /// Whether `id` has the decoration.
    pub fn is_decorated(&self, id: u32, what: Decoration) -> bool {
        self.decorations.contains_key(&(id, what))
    }

    /// Whether the member has the decoration.
    pub fn is_member_decorated(&self, id: u32, member: u32, what: Decoration) -> bool {
        self.member_decorations.contains_key(&(id, member, what))
    }
}
