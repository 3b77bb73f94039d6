//! The true visible set of each frame of a run.

/// Which objects own at least one pixel, by frame. Bits, in 64-bit words.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct VisibleSets {
    objects: usize,
    words_a_frame: usize,
    words: Vec<u64>,
    frames: usize,
}

/// The visible set of one frame.
#[derive(Clone, Copy, Debug)]
pub struct VisibleSet<'a>(&'a [u64]);

impl VisibleSet<'_> {
    /// True if the object owns a pixel.
    pub fn contains(&self, object: usize) -> bool {
        self.0.get(object / 64).is_some_and(|word| word >> (object % 64) & 1 == 1)
    }

    /// Objects that own a pixel.
    pub fn len(&self) -> usize {
        self.0.iter().map(|word| word.count_ones() as usize).sum()
    }

    /// True if no object owns a pixel.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

impl VisibleSets {
    /// No frames yet, for a world of so many objects.
    pub fn new(objects: usize) -> Self {
        VisibleSets { objects, words_a_frame: objects.div_ceil(64), words: Vec::new(), frames: 0 }
    }

    /// Adds the next frame from its item buffer: every object index that appears in it. Other values count as none.
    pub fn push_items(&mut self, items: &[u32]) {
        let first = self.words.len();
        self.words.resize(first + self.words_a_frame, 0);
        self.frames += 1;
        for object in items.iter().map(|item| *item as usize).filter(|object| *object < self.objects) {
            self.words[first + object / 64] |= 1 << (object % 64);
        }
    }

    /// Frames.
    pub fn len(&self) -> usize {
        self.frames
    }

    /// True if there is no frame.
    pub fn is_empty(&self) -> bool {
        self.frames == 0
    }

    /// Objects of the world.
    pub fn objects(&self) -> usize {
        self.objects
    }

    /// The set of one frame; none past the last.
    pub fn frame(&self, frame: usize) -> Option<VisibleSet<'_>> {
        let first = frame * self.words_a_frame;
        (frame < self.frames).then(|| VisibleSet(&self.words[first..first + self.words_a_frame]))
    }

    pub(super) fn words(&self) -> &[u64] {
        &self.words
    }

    pub(super) fn from_words(objects: usize, frames: usize, words: Vec<u64>) -> Option<Self> {
        let words_a_frame = objects.div_ceil(64);
        (words.len() == words_a_frame * frames).then_some(VisibleSets { objects, words_a_frame, words, frames })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_object_is_visible_in_just_the_frames_that_show_it() {
        let mut sets = VisibleSets::new(130);
        sets.push_items(&[0, 129, u32::MAX, 129, 500]);
        sets.push_items(&[64]);
        let (first, second) = (sets.frame(0).unwrap(), sets.frame(1).unwrap());
        assert_eq!((first.len(), second.len()), (2, 1));
        assert!(first.contains(0) && first.contains(129) && !first.contains(64));
        assert!(second.contains(64) && !second.contains(0) && sets.frame(2).is_none());
    }
}
