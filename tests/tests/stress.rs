//! Worlds by chance, many of them: what is exact stays exact.
//!
//! `SIGHTLINE_STRESS_CASES` sets how many worlds there are for each option, `SIGHTLINE_STRESS_SEED` where they begin: a fault
//! names both, so that one line shows it again.

use engine::Gpu;
use harness::lab::error_of;
use harness::laws::faults_of;
use harness::{assert_none, gpu, worlds, Case, Lab, Random, Subject};

fn number(variable: &str, default: u64) -> u64 {
    let text = std::env::var(variable).unwrap_or_default();
    if text.is_empty() {
        return default;
    }
    text.parse().unwrap_or_else(|_| panic!("{variable} is '{text}', but must be a whole number"))
}

/// `eovc` in one of its many ways, by seed.
fn eovc(seed: u64, coherent: &str) -> Subject {
    let mut random = Random::new(seed ^ 0x0ddc_0ffe);
    let bvh = ["sah", "middle", "equal"][random.below(3)];
    let commands = ["packed", "zero-instance"][random.below(2)];
    let [of, cr] = [(); 2].map(|()| ["false", "true"][random.below(2)]);
    let subject = Subject::named("eovc").with("coherent", coherent).with("bvh", bvh);
    subject.with("commands", commands).with("of", of).with("cr", cr)
}

/// The faults of a world, with what was lost, and where.
fn faults(gpu: &Gpu, subject: &Subject, case: &Case) -> Vec<String> {
    let mut lab = Lab::new(gpu, case);
    let (truths, sets) = lab.truths(&case.shots);
    let mut method = lab.make(subject, &sets);
    let takes = lab.film(&mut *method, &case.shots);
    let mut faults = Vec::new();
    for (frame, (truth, take)) in truths.iter().zip(&takes).enumerate() {
        let place = format!("{}, {} at {:?}, frame {frame}", subject.options.label(), case.name, case.size);
        let found = faults_of(&place, &error_of(truth, take));
        let items = truth.images().items.iter().enumerate();
        let lost = items.filter(|(_, item)| take.drawn.objects.get(**item as usize) == Some(&false)).take(3);
        let lost: Vec<String> = lost
            .map(|(pixel, item)| {
                let (x, y) = (pixel as u32 % case.size[0], pixel as u32 / case.size[0]);
                format!("object {item} at pixel {x}, {y}, depth {:e}", truth.images().depth[pixel])
            })
            .collect();
        faults.extend(found.iter().map(|fault| format!("{fault}; lost: [{}]", lost.join("; "))));
    }
    faults
}

/// Runs a method through worlds by seed. Pictures of nothing prove nothing, so some must show something.
fn stress(name: &str, subject: impl Fn(u64) -> Subject) {
    let gpu = gpu();
    let (first, count) = (number("SIGHTLINE_STRESS_SEED", 0), number("SIGHTLINE_STRESS_CASES", 25));
    let mut found = Vec::new();
    for seed in first..first + count {
        let again = format!("SIGHTLINE_STRESS_SEED={seed} SIGHTLINE_STRESS_CASES=1 tools/test.sh --test stress {name}");
        let one = faults(&gpu, &subject(seed), &worlds::chance(seed));
        // At once: a long run tells what it finds when it finds it.
        one.iter().for_each(|fault| eprintln!("{again}: {fault}"));
        found.extend(one.into_iter().map(|fault| format!("{again}: {fault}")));
    }
    assert_none(&found);
}

#[test]
fn eovc_by_the_thesis_loses_nothing() {
    stress("eovc_by_the_thesis", |seed| eovc(seed, "false"));
}

#[test]
fn coherent_eovc_loses_nothing() {
    stress("coherent_eovc", |seed| eovc(seed, "true"));
}

#[test]
fn roc_loses_nothing() {
    stress("roc", |_| Subject::named("roc"));
}

#[test]
fn roc_iterative_loses_nothing() {
    stress("roc_iterative", |_| Subject::named("roc-iterative"));
}

#[test]
fn hzb_loses_nothing() {
    stress("hzb", |_| Subject::named("hzb"));
}

/// `woc-exact` in one of its many ways, by seed: most of them careless, so that there is much to repair.
fn woc_exact(seed: u64) -> Subject {
    let mut random = Random::new(seed ^ 0x0a11_ace5);
    let sets: [(&str, &[&str]); 12] = [
        ("size", &["1", "2", "4"]),
        ("structure", &["y-map", "n-buffer", "mip"]),
        ("seeds", &["1", "2", "5"]),
        ("iterations", &["1", "4"]),
        ("steps", &["0", "3"]),
        ("tile", &["1", "4", "16"]),
        ("oriented", &["false", "true"]),
        ("erode", &["footprint", "neighbours", "none"]),
        ("close", &["false", "true"]),
        ("rapid", &["0", "0.005", "0.02", "0.08"]),
        ("hybrid-triangles", &["0", "5", "100000"]),
        ("commands", &["packed", "zero-instance", "shuffled"]),
    ];
    let subject = Subject::named("woc-exact");
    sets.iter().fold(subject, |subject, (option, values)| subject.with(option, values[random.below(values.len())]))
}

#[test]
fn woc_exact_loses_nothing() {
    stress("woc_exact", woc_exact);
}

#[test]
fn hom_loses_nothing() {
    stress("hom", |_| Subject::named("hom"));
}

#[test]
fn worlds_by_chance_show_and_hide_something() {
    let gpu = gpu();
    let (mut shown, mut hidden) = (0, 0);
    for seed in 0..25 {
        let case = worlds::chance(seed);
        let mut lab = Lab::new(&gpu, &case);
        let visible = lab.truth(&case.shots[0]).visible_count();
        shown += usize::from(visible > 0);
        hidden += usize::from(visible < case.scene.objects.len());
        assert_eq!(case.scene.objects, worlds::chance(seed).scene.objects, "the same seed gives the same world");
    }
    assert!(shown >= 15 && hidden >= 15, "{shown} worlds show something, {hidden} hide something, of 25");
}
