//! Barriers derived from what stages declare. One global memory barrier per dependency cut.
//!
//! A cut is needed when a stage touches a resource that was written since the last cut, or writes one that was read.
//! The barrier then orders everything since the last cut before everything after it, so the tracker starts afresh.
//! Plain data: it needs no device, and tests read it as text.

use shaders::ResourceId;
use std::collections::HashMap;
use std::fmt;

/// Where in the pipeline a resource is touched.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Point {
    /// Indirect arguments.
    Indirect,
    /// Vertex and index fetch.
    Vertices,
    /// Shaders of a drawing pipeline.
    Drawing,
    /// Depth attachment.
    Depth,
    /// Colour attachments.
    Colour,
    /// Compute shaders.
    Compute,
    /// Copies, fills and clears.
    Transfer,
}

impl Point {
    pub(crate) const ALL: [Point; 7] = [
        Point::Indirect,
        Point::Vertices,
        Point::Drawing,
        Point::Depth,
        Point::Colour,
        Point::Compute,
        Point::Transfer,
    ];

    pub(crate) fn bit(self) -> u8 {
        1 << self as u8
    }
}

/// One resource touched by one stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Use {
    /// The buffer or image, as a whole: ranges of one buffer are not told apart, so that disjoint ranges are cut as the same range is.
    pub resource: ResourceId,
    /// Where.
    pub point: Point,
    /// It is read.
    pub reads: bool,
    /// It is written.
    pub writes: bool,
}

impl Use {
    /// A read.
    pub fn read(resource: ResourceId, point: Point) -> Self {
        Use { resource, point, reads: true, writes: false }
    }

    /// A write that does not read.
    pub fn write(resource: ResourceId, point: Point) -> Self {
        Use { resource, point, reads: false, writes: true }
    }

    /// A read and a write.
    pub fn both(resource: ResourceId, point: Point) -> Self {
        Use { resource, point, reads: true, writes: true }
    }
}

/// A global memory barrier: everything at `after` since the last one, before everything that follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Barrier {
    /// Points touched since the last cut, as a set of `1 << Point`.
    pub after: u8,
    /// The subset of `after` that wrote.
    pub written: u8,
    /// The resource that forced the cut.
    pub because: ResourceId,
}

impl fmt::Display for Barrier {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut between = "";
        for point in Point::ALL.into_iter().filter(|point| self.after & point.bit() != 0) {
            let did = if self.written & point.bit() != 0 { "wrote" } else { "read" };
            write!(out, "{between}{point:?} {did}")?;
            between = ", ";
        }
        Ok(())
    }
}

#[derive(Clone, Copy, Default)]
struct Since {
    read: bool,
    written: bool,
}

/// Follows a frame's stages and says where it must be cut.
#[derive(Default)]
pub struct BarrierTracker {
    since: HashMap<ResourceId, Since>,
    after: u8,
    written: u8,
}

impl BarrierTracker {
    /// Takes the next stage's uses; returns the barrier to put before it, if one is needed.
    pub fn next(&mut self, uses: &[Use]) -> Option<Barrier> {
        let conflict = uses.iter().find(|next| self.conflicts(next)).map(|next| next.resource);
        let barrier = conflict.map(|because| Barrier { after: self.after, written: self.written, because });
        if barrier.is_some() {
            *self = Self::default();
        }
        for touched in uses {
            let since = self.since.entry(touched.resource).or_default();
            since.read |= touched.reads;
            since.written |= touched.writes;
            self.after |= touched.point.bit();
            self.written |= if touched.writes { touched.point.bit() } else { 0 };
        }
        barrier
    }

    /// Forgets everything: what came before is ordered by other means.
    pub fn cut(&mut self) {
        *self = Self::default();
    }

    fn conflicts(&self, next: &Use) -> bool {
        self.since.get(&next.resource).is_some_and(|since| since.written || (next.writes && since.read))
    }
}

#[cfg(test)]
mod tests;
