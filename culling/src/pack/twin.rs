//! The packing stages in plain Rust: their definition.

use shaders::types::{DrawCommand, MeshRange, PACK_CHUNK};

/// How many flags of each chunk are set. Twin of `pack/count_flags`.
pub fn count_flags(flags: &[u32]) -> Vec<u32> {
    flags.chunks(PACK_CHUNK as usize).map(|chunk| chunk.iter().filter(|flag| **flag != 0).count() as u32).collect()
}

/// Where each chunk's first command goes, and how many commands there are. Twin of `pack/scan_counts`, for one list.
pub fn scan_counts(counts: &[u32]) -> (Vec<u32>, u32) {
    let mut total = 0;
    let mut starts = Vec::with_capacity(counts.len());
    for count in counts {
        starts.push(total);
        total += count;
    }
    (starts, total)
}

/// One command for each flagged object, in object order. Twin of `pack/write_commands`.
pub fn write_commands(flags: &[u32], object_meshes: &[u32], meshes: &[MeshRange]) -> Vec<DrawCommand> {
    let (commands, _) = write_instances(flags, object_meshes, meshes);
    commands.into_iter().filter(|command| command.instance_count > 0).collect()
}

/// One command for each object, in order, of no instance if its flag is 0, and the end of the last that draws something. Twin of
/// `pack/write_instances`; [`scatter`] is what else it does if asked to.
pub fn write_instances(flags: &[u32], object_meshes: &[u32], meshes: &[MeshRange]) -> (Vec<DrawCommand>, u32) {
    let command = |object: usize| {
        let mesh = meshes[object_meshes[object] as usize];
        DrawCommand {
            index_count: mesh.index_count,
            instance_count: u32::from(flags[object] != 0),
            first_index: mesh.first_index,
            vertex_offset: mesh.vertex_offset,
            first_instance: object as u32,
        }
    };
    let end = flags.iter().rposition(|flag| *flag != 0).map_or(0, |last| last as u32 + 1);
    ((0..flags.len()).map(command).collect(), end)
}

/// The indices of flagged objects, in order; their number is the draw's instances. Twin of `pack/write_indices`.
pub fn write_indices(flags: &[u32]) -> Vec<u32> {
    (0..flags.len() as u32).filter(|object| flags[*object as usize] != 0).collect()
}

/// What lies in order, each at its place, and the end of the last that draws something.
pub fn scatter(ordered: &[DrawCommand], places: &[u32]) -> (Vec<DrawCommand>, u32) {
    let mut commands = ordered.to_vec();
    ordered.iter().zip(places).for_each(|(command, place)| commands[*place as usize] = *command);
    let end = commands.iter().rposition(|command| command.instance_count > 0).map_or(0, |last| last as u32 + 1);
    (commands, end)
}
