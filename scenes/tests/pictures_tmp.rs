mod support;
use scenes::*;
use std::io::Write;
#[test]
fn pictures() {
    let list = std::env::var("PICTURES").unwrap();
    for entry in list.split_whitespace() {
        let p: Vec<&str> = entry.split('@').collect(); // scene@scale@path@frame@frames@out
        let t = std::time::Instant::now();
        let scene = open(p[0], &SceneOptions { scale: p[1].parse().unwrap(), seed: 1 }).unwrap();
        let made = t.elapsed();
        let path = CameraPath::named(&scene, Some(p[2]), 1.0).unwrap();
        let shot = path.sample(p[3].parse().unwrap(), p[4].parse().unwrap());
        let (w, h) = (640, 360);
        let b = support::ItemBuffer::draw(&scene, &shot, w, h);
        println!("{entry}: {} objects {} meshes {} triangles made {made:?}; visible {} covered {:.3} bounds {:?} pos {:?}", scene.objects.len(), scene.meshes.len(), scene.triangles(), b.visible(), b.covered(), scene.bounds(), shot.pose.position);
        let mut f = std::fs::File::create(p[5]).unwrap();
        write!(f, "P6 {w} {h} 255\n").unwrap();
        let mut out = vec![];
        for y in 0..h { for x in 0..w {
            let i = b.items[y*w+x];
            let c = if i == support::NOTHING { [0.5,0.7,0.9,1.0] } else { scene.objects[i as usize].colour };
            let n = if i == support::NOTHING { 1.0 } else { 0.8 + 0.2 * ((i.wrapping_mul(2654435761) >> 24) as f32 / 255.0) };
            out.extend(c[..3].iter().map(|v| ((v*n).powf(1.0/2.2)*255.0) as u8));
        }}
        f.write_all(&out).unwrap();
    }
}
