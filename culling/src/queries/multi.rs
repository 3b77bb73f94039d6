//! Multiqueries (Zachmann 2008; Mattausch et al. 2008): nodes that have long been hidden are asked about together.

/// The visibility persistence p(t): the chance that what was hidden for `t` frames is hidden in the next.
pub fn persistence(hidden_for: u64) -> f64 {
    0.99 - 0.7 * (-(hidden_for as f64)).exp()
}

/// The value V(M) of a multiquery: its use, the number of nodes, over its cost: the query, and one more for each node if it fails.
pub fn value(all_hidden: f64, nodes: usize) -> f64 {
    let nodes = nodes as f64;
    nodes / (1.0 + (1.0 - all_hidden) * nodes)
}

/// Cuts a batch into multiqueries. Nodes come with how long they have been hidden; the longest first, and of those the prefix of
/// greatest value makes the next query.
pub fn group(mut nodes: Vec<(u32, u64)>) -> Vec<Vec<u32>> {
    nodes.sort_by(|one, other| other.1.cmp(&one.1).then(one.0.cmp(&other.0)));
    let mut groups = Vec::new();
    let mut rest = &nodes[..];
    while !rest.is_empty() {
        let (first, others) = rest.split_at(best_prefix(rest));
        groups.push(first.iter().map(|(node, _)| *node).collect());
        rest = others;
    }
    groups
}

/// How many of the nodes make the query of the greatest value, at least one.
fn best_prefix(nodes: &[(u32, u64)]) -> usize {
    let (mut all_hidden, mut best, mut most) = (1.0, 1, 0.0);
    for (index, (_, hidden_for)) in nodes.iter().enumerate() {
        all_hidden *= persistence(*hidden_for);
        let value = value(all_hidden, index + 1);
        if value > most {
            (best, most) = (index + 1, value);
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn persistence_rises_to_its_limit() {
        assert!((persistence(0) - 0.29).abs() < 1e-12);
        assert!((0..20).all(|t| persistence(t) < persistence(t + 1)));
        assert!(persistence(1_000_000) <= 0.99);
    }

    /// The lecture's value of ten that were just hidden is 10 / 11, that of one 1 / 1.71: it counts that a node asked about alone is
    /// asked again if it shows, so that even these are asked about together.
    #[test]
    fn what_has_just_been_hidden_is_asked_about_together_too() {
        assert!((value(persistence(0), 1) - 1.0 / 1.71).abs() < 1e-12);
        let groups = group((0..10).map(|node| (node, 0)).collect());
        assert_eq!(groups.len(), 1, "{groups:?}");
    }

    #[test]
    fn what_has_long_been_hidden_is_asked_about_together() {
        let nodes: Vec<_> = (0..50).map(|node| (node, if node < 40 { 100 } else { 0 })).collect();
        let groups = group(nodes);
        assert!(groups[0].len() >= 10, "{groups:?}");
        assert!(groups[0].iter().all(|node| *node < 40));
        let mut all: Vec<u32> = groups.concat();
        all.sort_unstable();
        assert_eq!(all, (0..50).collect::<Vec<_>>(), "each node is in one query");
    }

    #[test]
    fn a_query_is_the_prefix_of_greatest_value() {
        let mut seed = 7u64;
        for _ in 0..200 {
            let nodes: Vec<(u32, u64)> = (0..20)
                .map(|node| {
                    seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                    (node, seed >> 60)
                })
                .collect();
            let mut times: Vec<u64> = nodes.iter().map(|(_, time)| *time).collect();
            times.sort_unstable_by(|one, other| other.cmp(one));
            let of = |count: usize| value(times[..count].iter().map(|time| persistence(*time)).product(), count);
            let first = group(nodes).first().map_or(0, Vec::len);
            assert!((1..=20).all(|count| of(count) <= of(first) + 1e-12), "{first} of {times:?}");
        }
    }
}
