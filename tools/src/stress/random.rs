//! Numbers by chance, the same ones in every run.

use glam::{DQuat, DVec3};

/// SplitMix64 (Steele, Lea & Flood 2014).
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// Starts from a seed.
    pub fn new(seed: u64) -> Self {
        Random(seed)
    }

    /// 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^ (bits >> 31)
    }

    /// From 0 on, below 1.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// From `low` on, below `high`.
    pub fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Between two numbers above 0, as likely in each decade.
    pub fn decade(&mut self, low: f64, high: f64) -> f64 {
        self.range(low.ln(), high.ln()).exp()
    }

    /// Below `count`.
    pub fn below(&mut self, count: usize) -> usize {
        (self.bits() % count as u64) as usize
    }

    /// In the cube from -1 to 1.
    pub fn vector(&mut self) -> DVec3 {
        DVec3::new(self.range(-1.0, 1.0), self.range(-1.0, 1.0), self.range(-1.0, 1.0))
    }

    /// Any turn.
    pub fn turn(&mut self) -> DQuat {
        let axis = self.vector().normalize_or(DVec3::Y);
        DQuat::from_axis_angle(axis, self.range(0.0, std::f64::consts::TAU))
    }

    /// Puts things in any order.
    pub fn shuffle<T>(&mut self, things: &mut [T]) {
        for last in (1..things.len()).rev() {
            things.swap(last, self.below(last + 1));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The reference implementation's first numbers (`splitmix64.c`, Vigna 2015).
    #[test]
    fn bits_are_those_of_splitmix64() {
        let mut random = Random::new(0);
        let bits = [(); 3].map(|()| random.bits());
        assert_eq!(bits, [0xe220_a839_7b1d_cdaf, 0x6e78_9e6a_a1b9_65f4, 0x06c4_5d18_8009_454f]);
        assert_eq!(Random::new(1_234_567).bits(), 0x599e_d017_fb08_fc85);
    }

    #[test]
    fn numbers_lie_in_their_ranges_and_fill_them() {
        let mut random = Random::new(1);
        let mut spread = |draw: fn(&mut Random) -> f64| {
            let numbers: Vec<f64> = (0..4_000).map(|_| draw(&mut random)).collect();
            let (low, high) = (
                numbers.iter().copied().fold(f64::INFINITY, f64::min),
                numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            );
            let below = |limit: f64| numbers.iter().filter(|number| **number < limit).count();
            (low, high, [below(0.0), below(1.0), below(10.0)])
        };
        let (low, high, _) = spread(Random::unit);
        assert!((0.0..0.01).contains(&low) && (0.99..1.0).contains(&high), "{low} to {high}");
        let (low, high, [negative, ..]) = spread(|random| random.range(-3.0, 1.0));
        assert!((-3.0..-2.99).contains(&low) && (0.99..1.0).contains(&high), "{low} to {high}");
        // 3,000 are expected; 200 are 7 standard deviations.
        assert!(negative.abs_diff(3_000) < 200, "{negative} of 4,000 below 0");
        let (low, high, [_, below_1, below_10]) = spread(|random| random.decade(0.1, 100.0));
        assert!((0.1..0.11).contains(&low) && (90.0..100.0).contains(&high), "{low} to {high}");
        // Each decade has a third of them.
        assert!(below_1.abs_diff(1_333) < 210 && below_10.abs_diff(2_667) < 210, "{below_1} and {below_10} of 4,000");
        let (low, high, [negative, ..]) = spread(|random| random.vector().to_array()[random.below(3)]);
        assert!((-1.0..-0.99).contains(&low) && (0.99..1.0).contains(&high), "{low} to {high}");
        assert!(negative.abs_diff(2_000) < 222, "{negative} of 4,000 below 0");
    }

    #[test]
    fn every_order_and_every_index_comes_up() {
        let mut random = Random::new(1);
        let mut orders = std::collections::BTreeMap::<[u8; 3], usize>::new();
        for _ in 0..6_000 {
            let mut things = [1, 2, 3];
            random.shuffle(&mut things);
            *orders.entry(things).or_default() += 1;
        }
        // 1,000 are expected of each order; 200 are 7 standard deviations.
        assert!(orders.len() == 6 && orders.values().all(|count| count.abs_diff(1_000) < 200), "{orders:?}");
        let mut counts = [0usize; 5];
        (0..5_000).for_each(|_| counts[random.below(5)] += 1);
        assert!(counts.iter().all(|count| count.abs_diff(1_000) < 200), "{counts:?}");
    }

    #[test]
    fn turns_go_all_the_way_round_any_axis() {
        let mut random = Random::new(1);
        let turns: Vec<_> = (0..500).map(|_| random.turn()).collect();
        assert!(turns.iter().all(|turn| (turn.length() - 1.0).abs() < 1e-12));
        for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
            let places: Vec<f64> = turns.iter().map(|turn| (*turn * axis).dot(axis)).collect();
            assert!(places.iter().any(|place| *place < -0.9) && places.iter().any(|place| *place > 0.9));
        }
    }
}
