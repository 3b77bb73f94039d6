//! Opening devices, and the pipeline cache.

use engine::{Buffer, Error, Gpu, GpuOptions, Placement, TimerMode};
use harness::{gpu, options};
use std::path::{Path, PathBuf};

/// A folder that goes when the test ends.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("sightline-engine-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        Folder(folder)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn works(gpu: &Gpu) {
    let words = Buffer::with_data(gpu, "test.words", &[1u32; 100], Placement::Storage).unwrap();
    let mut f = gpu.frame();
    f.dispatch(shaders::engine::SpinWords { words: words.all(), word_count: 100 }, 100);
    f.finish().unwrap();
    assert!(words.read().unwrap().iter().all(|word| *word == super::frames::spun(1)));
}

#[test]
fn an_unknown_device_is_refused_and_the_known_ones_named() {
    let gpu = gpu();
    let name = gpu.info().unwrap().name.clone();
    for wanted in ["no such device", "99"] {
        let found = Gpu::open(&GpuOptions { device: Some(wanted.into()), ..GpuOptions::default() });
        let Err(error) = found else { panic!("'{wanted}' was opened") };
        assert!(matches!(error, Error::NoSuchDevice { .. }), "{error}");
        assert!(error.to_string().contains(&name) && error.to_string().contains(wanted), "{error}");
    }
}

#[test]
fn a_device_is_found_by_index_and_by_part_of_its_name() {
    let gpu = gpu();
    let name = gpu.info().unwrap().name.clone();
    let index = engine::adapters().unwrap().iter().position(|adapter| adapter.name == name).unwrap();
    for wanted in [index.to_string(), name[1..name.len().min(7)].to_uppercase()] {
        let timer = Some(TimerMode::Split);
        let opened = Gpu::open(&GpuOptions { device: Some(wanted), timer, ..GpuOptions::default() }).unwrap();
        assert_eq!(opened.info().unwrap().name, name);
    }
}

fn open_with_cache(folder: &Path) -> Gpu {
    Gpu::open(&GpuOptions { timer: Some(TimerMode::Split), cache_dir: Some(folder.into()), ..options() }).unwrap()
}

fn cache_files(folder: &Path) -> Vec<PathBuf> {
    std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect()
}

#[test]
fn a_damaged_pipeline_cache_is_ignored() {
    let _gpu = gpu();
    let folder = Folder::new("cache");
    let first = open_with_cache(&folder.0);
    works(&first);
    first.save_pipeline_cache();
    let files = cache_files(&folder.0);
    assert_eq!(files.len(), 1, "one file a device, nothing left beside it: {files:?}");
    let good = std::fs::read(&files[0]).unwrap();
    let damaged = [
        Vec::new(),
        good[..good.len() / 2].to_vec(),
        good.iter().map(|byte| byte ^ 0xff).collect(),
        vec![0x5a; 10_000],
        [&good[..16], &[0; 4096]].concat(),
    ];
    for bytes in damaged {
        std::fs::write(&files[0], &bytes).unwrap();
        let gpu = open_with_cache(&folder.0);
        works(&gpu);
        assert_eq!(gpu.take_messages(), [], "{} bytes", bytes.len());
    }
    // A cache that cannot be written is no error either.
    let nowhere = open_with_cache(&files[0].join("not a folder"));
    works(&nowhere);
    nowhere.save_pipeline_cache();
}

#[test]
fn subgroups_and_the_vertex_grid_are_known() {
    let gpu = gpu();
    assert!(gpu.subgroup_size().is_power_of_two());
    assert!((1.0 / 65_536.0..=1.0 / 16.0).contains(&gpu.snap_px()), "{}", gpu.snap_px());
    assert!(gpu.info().unwrap().missing.is_empty());
}
