//! Draws whose stage reads a buffer that it writes, on devices on which each command is a call of its own: a call reads what the one before wrote, as far
//! as synchronization validation can tell, so they are steps of their own, with a barrier between. Elsewhere one call draws all.

use super::{bindings, IndexedIndirect};
use crate::barriers::Point;
use shaders::types::DrawCommand;
use shaders::{Bound, BoundStage};

/// The draw, or one for each of its commands.
pub(crate) fn apart(stage: &BoundStage, draw: IndexedIndirect, several_in_a_call: bool) -> Vec<IndexedIndirect> {
    let Bound::Buffer { id, raw, offset, .. } = draw.commands else { return vec![draw] };
    if several_in_a_call || draw.count.is_some() || !reads_what_it_writes(stage) {
        return vec![draw];
    }
    let size = size_of::<DrawCommand>() as u64;
    let commands = |number: u32| Bound::Buffer { id, raw, offset: offset + u64::from(number) * size, size };
    (0..draw.max_draws).map(|number| IndexedIndirect { commands: commands(number), max_draws: 1, ..draw }).collect()
}

/// True if one of its bindings is only read and another, of the same buffer, written.
fn reads_what_it_writes(stage: &BoundStage) -> bool {
    let uses = bindings(stage, Point::Drawing);
    let only_read = |resource| uses.iter().any(|other| !other.writes && other.resource == resource);
    uses.iter().any(|written| written.writes && only_read(written.resource))
}
