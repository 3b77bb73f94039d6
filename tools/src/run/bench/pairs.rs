//! Methods compared with each other rather than with the truth: PSNR between their pictures of the same frames.

use super::Contender;
use crate::measures::metrics::{psnr_between, FrameImages};
use crate::measures::stats;
use crate::results;
use anyhow::{Context, Result};

/// Two methods, by index, and what is between their pictures.
pub(super) struct Pair {
    places: [usize; 2],
    label: String,
    psnr_db: Vec<f64>,
}

impl Pair {
    /// The pairs of an order, by label: the one to compare with first.
    ///
    /// # Errors
    /// A label that no method of the run has.
    pub(super) fn of(order: &[[String; 2]], contenders: &[Contender]) -> Result<Vec<Pair>> {
        let place = |label: &String| {
            let found = contenders.iter().position(|contender| contender.label() == *label);
            found.with_context(|| format!("'{label}' is to be compared, but is not in this run"))
        };
        let pair = |[first, second]: &[String; 2]| {
            Ok(Pair { places: [place(first)?, place(second)?], label: first.clone(), psnr_db: Vec::new() })
        };
        order.iter().map(pair).collect()
    }

    /// True if the pictures of the method with this index are wanted.
    pub(super) fn needs(&self, place: usize) -> bool {
        self.places.contains(&place)
    }

    /// Compares a frame's pictures, by index of the method.
    pub(super) fn compare(&mut self, pictures: &[Option<FrameImages>]) -> Result<()> {
        let [Some(first), Some(second)] = self.places.map(|place| pictures[place].as_ref()) else { return Ok(()) };
        self.psnr_db.extend(psnr_between(first, second)?);
        Ok(())
    }

    /// Puts the mean in the second method's results.
    pub(super) fn report(&self, methods: &mut [results::Method]) {
        let mean = stats::mean(&self.psnr_db);
        methods[self.places[1]].psnr_between_db.insert(self.label.clone(), mean);
    }
}
