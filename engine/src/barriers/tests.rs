use super::*;

const A: ResourceId = ResourceId(1);
const B: ResourceId = ResourceId(2);

#[test]
fn reads_after_reads_need_no_barrier() {
    let mut tracker = BarrierTracker::default();
    assert_eq!(tracker.next(&[Use::read(A, Point::Compute)]), None);
    assert_eq!(tracker.next(&[Use::read(A, Point::Drawing), Use::write(B, Point::Colour)]), None);
}

#[test]
fn a_read_after_a_write_is_cut() {
    let mut tracker = BarrierTracker::default();
    tracker.next(&[Use::write(A, Point::Compute)]);
    let barrier = tracker.next(&[Use::read(A, Point::Indirect)]).expect("read after write");
    assert_eq!((barrier.after, barrier.written, barrier.because), (Point::Compute.bit(), Point::Compute.bit(), A));
}

#[test]
fn a_write_after_a_read_is_cut() {
    let mut tracker = BarrierTracker::default();
    tracker.next(&[Use::read(A, Point::Indirect)]);
    let barrier = tracker.next(&[Use::write(A, Point::Compute)]).expect("write after read");
    assert_eq!((barrier.after, barrier.written), (Point::Indirect.bit(), 0));
}

#[test]
fn a_cut_covers_every_earlier_write() {
    let mut tracker = BarrierTracker::default();
    tracker.next(&[Use::write(A, Point::Compute)]);
    tracker.next(&[Use::write(B, Point::Transfer)]);
    let barrier = tracker.next(&[Use::read(A, Point::Compute)]).expect("read after write");
    assert_eq!(barrier.written, Point::Compute.bit() | Point::Transfer.bit());
    assert_eq!(tracker.next(&[Use::read(B, Point::Compute)]), None, "the same cut already ordered it");
}

/// The bits are public, and the tests' own checker of hazards reads them.
#[test]
fn each_point_has_a_bit_of_its_own() {
    assert_eq!(Point::ALL.map(Point::bit), [1, 2, 4, 8, 16, 32, 64]);
    assert_eq!((Point::Indirect.bit(), Point::Drawing.bit(), Point::Transfer.bit()), (1, 4, 64));
}

/// How a use touches its resource, in the order of the rows and columns below.
const WAYS: [(&str, bool, bool); 3] = [("read", true, false), ("write", false, true), ("read and write", true, true)];

/// Vulkan, "Execution and Memory Dependencies": two reads need nothing; a write after a read needs an execution dependency, so that the
/// source has no access; all others need the first one's writes to be available. Row: the earlier use; column: the later one.
/// `None`: no barrier. `Some(true)`: the earlier use's writes are made available.
const NEEDED: [[Option<bool>; 3]; 3] =
    [[None, Some(false), Some(false)], [Some(true), Some(true), Some(true)], [Some(true), Some(true), Some(true)]];

/// A use that reads and writes counted as no write, and only golden pictures noticed.
#[test]
fn every_ordered_pair_of_uses_at_every_two_points_is_cut_as_needed() {
    for (row, (first, reads, writes)) in WAYS.into_iter().enumerate() {
        for (column, (second, reads_too, writes_too)) in WAYS.into_iter().enumerate() {
            for (from, to) in Point::ALL.into_iter().flat_map(|from| Point::ALL.map(|to| (from, to))) {
                let mut tracker = BarrierTracker::default();
                let earlier = Use { resource: A, point: from, reads, writes };
                let later = Use { resource: A, point: to, reads: reads_too, writes: writes_too };
                assert_eq!(tracker.next(&[earlier]), None, "the first use of all");
                let expected = NEEDED[row][column].map(|available| Barrier {
                    after: from.bit(),
                    written: if available { from.bit() } else { 0 },
                    because: A,
                });
                assert_eq!(tracker.next(&[later]), expected, "{first} at {from:?}, then {second} at {to:?}");
                // The later use counts from then on, alone or beside the earlier one where nothing was cut.
                let since = if expected.is_some() { 0 } else { from.bit() };
                let written = if writes_too { to.bit() } else { 0 };
                let next = tracker.next(&[Use::both(A, Point::Compute)]);
                assert_eq!(next, Some(Barrier { after: since | to.bit(), written, because: A }), "{first}, {second}");
            }
        }
    }
}

#[test]
fn uses_of_two_resources_need_no_barrier_whatever_they_are() {
    for (earlier, later) in WAYS.into_iter().flat_map(|earlier| WAYS.map(|later| (earlier, later))) {
        let mut tracker = BarrierTracker::default();
        let made = |resource, (_, reads, writes)| Use { resource, point: Point::Compute, reads, writes };
        assert_eq!(tracker.next(&[made(A, earlier)]), None);
        assert_eq!(tracker.next(&[made(B, later)]), None, "{} and {}", earlier.0, later.0);
    }
}

/// A read of one binding and a write of another are one stage: what the stage itself does at once is the shader's business.
#[test]
fn uses_of_one_stage_are_not_cut_from_each_other() {
    let mut tracker = BarrierTracker::default();
    assert_eq!(tracker.next(&[Use::read(A, Point::Indirect), Use::write(A, Point::Drawing)]), None);
    let next = tracker.next(&[Use::read(A, Point::Compute)]).expect("read after write");
    let (read, wrote) = (Point::Indirect.bit(), Point::Drawing.bit());
    assert_eq!((next.after, next.written), (read | wrote, wrote), "the point that read is in the barrier too");
}

/// A resource that was read, and then read and written with the same stage's other uses in between: the order of uses does not matter.
#[test]
fn what_a_resource_was_used_for_adds_up() {
    for uses in [
        [Use::read(A, Point::Vertices), Use::write(A, Point::Colour)],
        [Use::write(A, Point::Colour), Use::read(A, Point::Vertices)],
    ] {
        let mut tracker = BarrierTracker::default();
        tracker.next(&uses);
        let barrier = tracker.next(&[Use::read(A, Point::Depth)]).expect("it was written");
        assert_eq!(barrier.written, Point::Colour.bit());
    }
}

#[test]
fn a_barrier_names_the_first_resource_that_needs_it() {
    let mut tracker = BarrierTracker::default();
    tracker.next(&[Use::write(A, Point::Compute), Use::write(B, Point::Compute)]);
    let barrier = tracker.next(&[
        Use::read(ResourceId(3), Point::Compute),
        Use::read(B, Point::Compute),
        Use::read(A, Point::Compute),
    ]);
    assert_eq!(barrier.map(|barrier| barrier.because), Some(B));
}

#[test]
fn after_a_cut_nothing_is_known_of_what_came_before() {
    let mut tracker = BarrierTracker::default();
    tracker.next(&[Use::both(A, Point::Compute)]);
    tracker.cut();
    assert_eq!(tracker.next(&[Use::both(A, Point::Transfer)]), None);
    let barrier = tracker.next(&[Use::read(A, Point::Compute)]).expect("read after write");
    assert_eq!((barrier.after, barrier.written), (Point::Transfer.bit(), Point::Transfer.bit()));
}

#[test]
fn a_barrier_is_told_as_the_points_that_read_and_those_that_wrote() {
    let all = Barrier { after: 0b111_1111, written: 0b101_0100, because: A };
    let told = "Indirect read, Vertices read, Drawing wrote, Depth read, Colour wrote, Compute read, Transfer wrote";
    assert_eq!(all.to_string(), told);
    assert_eq!(Barrier { after: 0b10_0000, written: 0b10_0000, because: A }.to_string(), "Compute wrote");
    assert_eq!(Barrier { after: 0b1001, written: 0, because: A }.to_string(), "Indirect read, Depth read");
}
