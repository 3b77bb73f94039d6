//! temporary
use sightline::{run::Contender, session::*, truth::RunTruth};
fn main() -> anyhow::Result<()> {
    let arguments: Vec<String> = std::env::args().collect();
    let gpu = engine::Gpu::open(&engine::GpuOptions { validation: arguments.get(3).is_some(), ..Default::default() })?;
    println!("{} timers {}", gpu.info().unwrap(), gpu.timer_mode());
    let start = std::time::Instant::now();
    let options = SessionOptions { scene: arguments[1].clone(), scale: arguments[2].parse()?, frames: 10, ..Default::default() };
    let mut session = Session::on(&gpu, options)?;
    println!("{} objects {} triangles, loaded in {:?}, {} MiB", session.world.len(), session.world.triangles(), start.elapsed(), gpu.memory_mib());
    let truth = RunTruth::draw(&mut session, || ())?;
    let visible = Some(truth.sets.clone());
    let mut contenders: Vec<Contender> = culling::METHODS.iter().map(|entry| Contender::new(&session, entry, entry.default_options(), &visible)).collect::<anyhow::Result<_>>()?;
    for frame in 0..10 {
        for contender in &mut contenders {
            let report = contender.timed(&mut session, frame)?;
            let stages: Vec<String> = report.stages.iter().map(|stage| format!("{} {:.2}", stage.label, stage.ms)).collect();
            println!("{frame} {} {:.2} ms host {:.3} sum {:.2} [{}]", contender.label(), report.frame_ms, report.host_ms, report.stages.iter().map(|s| s.ms).sum::<f64>(), stages.join(", "));
        }
    }
    for contender in &mut contenders { contender.method.forget()?; }
    for frame in 0..10 {
        let truth = truth.frame(&mut session, frame)?;
        for contender in &mut contenders {
            let measured = contender.measured(&mut session, frame, &truth)?;
            println!("{frame} {} drawn {} visible {} fn {} diff {} ties {} psnr {:?} fragments {:?}", contender.label(), measured.error.drawn, measured.error.ref_visible, measured.error.false_negatives, measured.error.differing_pixels, measured.error.tied_pixels, measured.error.psnr_db, measured.fragments);
            if frame == 5 { sightline::png_out::Picture::colour(&measured.images).write(std::path::Path::new(&format!("/tmp/{}.png", contender.label())))?; }
        }
    }
    Ok(())
}
