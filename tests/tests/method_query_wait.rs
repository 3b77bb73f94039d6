//! The laws of `query-wait`, at its default and at other batches, and what the harness says if queries go wrong.

#[path = "method_query_wait/planted.rs"]
mod planted;
#[path = "method_query_wait/samples.rs"]
mod samples;

harness::exact_method_tests!("query-wait");
harness::skipping_method_tests!("query-wait");

#[test]
fn what_a_wall_hides_is_culled() {
    let gpu = gpu();
    assert_none(&laws::what_a_wall_hides_is_culled(&gpu, &Subject::named("query-wait"), &worlds::walled(400)));
}

#[test]
fn every_batch_is_exact() {
    let gpu = gpu();
    for batch in ["1", "7", "16384"] {
        let subject = Subject::named("query-wait").with("batch", batch);
        for case in [worlds::walled(100), worlds::special::topologies(), worlds::special::ties()] {
            assert_none(&laws::no_visible_object_is_culled(&gpu, &subject, &case));
        }
    }
}

/// The smaller the batches, the more is known of what lies in front, and the more often the host waits.
#[test]
fn small_batches_wait_more_and_draw_less() {
    let gpu = gpu();
    let case = worlds::walled(400);
    let mut lab = harness::Lab::new(&gpu, &case);
    let (_, sets) = lab.truths(&case.shots);
    let mut run = |batch: &str| {
        let mut method = lab.make(&Subject::named("query-wait").with("batch", batch), &sets);
        let take = lab.take(&mut *method, &case.shots[0], 0);
        let stalls = take.report.stages.iter().filter(|stage| stage.label == "frame/wait_for_queries").count();
        let work = method.work().unwrap();
        assert_eq!(work.waits, stalls as u64, "each wait is a stage of its own");
        assert!(work.queries > 0 && work.state_changes > 0);
        (work.waits, take.drawn.objects.iter().filter(|drawn| **drawn).count())
    };
    let (often, few) = run("4");
    let (once, many) = run("16384");
    assert!(often > once && once == 1, "{often} and {once} waits");
    assert!(few < many, "{few} and {many} drawn");
}
