use super::*;
use shaders::{BindingInfo, BindingKind, StageInfo};
use std::marker::PhantomData;

static STAGE: StageInfo = StageInfo {
    name: "test/stage",
    modules: &[],
    bindings: &[
        BindingInfo { name: "read", binding: 0, kind: BindingKind::StorageBuffer, access: Access::Read },
        BindingInfo { name: "made", binding: 1, kind: BindingKind::StorageBuffer, access: Access::Write },
    ],
    push_size: 0,
    constants: &[],
    local_size: [64, 1, 1],
    vertex: &[],
    vertex_stride: 0,
    instance: &[],
    instance_stride: 0,
    outputs: &[],
};

fn buffer(id: u32) -> Bound {
    Bound::Buffer { id: ResourceId(id), raw: 0, offset: 0, size: 4 }
}

fn dispatch(read: u32, made: u32) -> Op {
    Op::Dispatch { stage: BoundStage::new(&STAGE, vec![buffer(read), buffer(made)], &[], Vec::new()), groups: [1, 1] }
}

#[test]
fn labels_carry_the_part_that_was_named_last() {
    let mut recorder = Recorder::default();
    recorder.push("test/stage", dispatch(1, 2));
    recorder.part("late");
    recorder.push("test/stage", dispatch(1, 2));
    assert_eq!(recorder.label("test/other"), "test/other:late");
    recorder.part("");
    recorder.push("test/stage", dispatch(1, 2));
    let labels: Vec<_> = recorder.ops.iter().map(|recorded| recorded.label.as_str()).collect();
    assert_eq!(labels, ["test/stage", "test/stage:late", "test/stage"]);
}

/// The submission orders what is taken before what follows.
#[test]
fn what_follows_a_submission_needs_no_barrier_for_what_came_before_it() {
    let mut recorder = Recorder::default();
    recorder.push("test/stage", dispatch(1, 2));
    assert_eq!(recorder.take().len(), 1);
    assert!(recorder.ops.is_empty());
    recorder.push("test/stage", dispatch(2, 1));
    assert_eq!(recorder.ops[0].barrier, None);
    recorder.push("test/stage", dispatch(1, 3));
    assert_eq!(recorder.ops[1].barrier.map(|barrier| barrier.because), Some(ResourceId(1)));
}

/// A chain of stages, each of which reads the one before: a barrier between each two, and none where a stage touches nothing new.
#[test]
fn a_chain_is_cut_at_each_link_and_nowhere_else() {
    let mut recorder = Recorder::default();
    for (read, made) in [(1, 2), (1, 3), (2, 4), (3, 5), (4, 6), (1, 7)] {
        recorder.push("test/stage", dispatch(read, made));
    }
    let because: Vec<_> = recorder.ops.iter().map(|op| op.barrier.map(|barrier| barrier.because.0)).collect();
    assert_eq!(because, [None, None, Some(2), None, Some(4), None]);
}

#[test]
fn a_frame_as_text_names_stages_bindings_and_barriers() {
    let mut recorder = Recorder::default();
    recorder.push("test/stage", dispatch(1, 2));
    recorder.push("test/fill", Op::Fill { buffer: buffer(2), value: 9 });
    let groups = BufferRef { id: ResourceId(2), raw: 0, offset: 0, size: 12, element: PhantomData };
    let stage = BoundStage::new(&STAGE, vec![buffer(1), buffer(3)], &[], Vec::new());
    recorder.push("test/stage", Op::DispatchIndirect { stage, groups });
    let text = recorder.text(|id| format!("r{}", id.0));
    let expected =
        "test/stage [1 groups] read=r1(Read) made=r2(Write)\n  barrier after Compute wrote; for r2\ntest/fill r2=9\n  \
                    barrier after Transfer wrote; for r2\ntest/stage [groups from r2] read=r1(Read) made=r3(Write)\n";
    assert_eq!(text, expected);
}
