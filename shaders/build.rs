//! Lets the crate build before anything is generated, so that `cargo shaders` can start from an empty `generated/`.

fn main() {
    println!("cargo::rustc-check-cfg=cfg(generated)");
    println!("cargo::rerun-if-changed=generated/mod.rs");
    if std::path::Path::new("generated/mod.rs").exists() {
        println!("cargo::rustc-cfg=generated");
    }
}
