use scenes::bvh::*; use scenes::*; use glam::DVec3; use std::time::Instant;
fn main(){
 for n in [1000usize,10_000,100_000] { for copies in [1usize,5,50,n] {
  let boxes: Vec<Aabb> = (0..n).map(|i|{ let k=(i/copies) as u64; let h=|s:u64| ((k.wrapping_mul(6364136223846793005).wrapping_add(s)).wrapping_mul(2862933555777941757)>>40) as f64; let c=DVec3::new(h(1),h(2),h(3)); Aabb{min:c-1.0,max:c+1.0}}).collect();
  let t=Instant::now(); let b=Bvh::build(&boxes,Split::Ploc).unwrap(); println!("{n} x{copies}: {:.1} ms {:?} depth {}", t.elapsed().as_secs_f64()*1e3,b.split(),b.depth());
 }}
}
