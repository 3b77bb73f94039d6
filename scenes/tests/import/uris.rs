//! Laws of URIs: which bytes each stands for, and which are refused (RFC 3986, RFC 2397).

use crate::model::{assert_says, Model};
use base64::engine::general_purpose::{STANDARD, STANDARD_NO_PAD, URL_SAFE};
use base64::Engine;
use scenes::{Scene, SceneError};
use std::path::{Path, PathBuf};

/// A folder of its own for each test, with a scene in its folder `in`.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("uris-{name}-{}", std::process::id()));
        std::fs::create_dir_all(folder.join("in/data")).expect("a folder for test files");
        Folder(folder)
    }

    fn put(&self, path: impl AsRef<Path>) {
        std::fs::write(self.0.join(path), &Model::triangle().binary).expect("a test file");
    }

    fn import(&self, uri: &str) -> Result<Scene, SceneError> {
        let mut model = Model::triangle();
        model.json["buffers"][0]["uri"] = uri.into();
        let file = self.0.join("in/scene.gltf");
        std::fs::write(&file, model.json.to_string()).expect("a test file");
        scenes::import(&file)
    }

    fn is_read(&self, uri: &str) {
        let scene = self.import(uri).unwrap_or_else(|error| panic!("{uri}: {error}"));
        assert_eq!(scene.meshes, Model::triangle().scene().meshes, "{uri}");
    }

    fn is_refused(&self, uri: &str, text: &str) {
        let message = self.import(uri).expect_err(uri).to_string();
        assert!(message.contains("scene.gltf: ") && !message.contains('\n'), "{message}");
        assert_says(&message, text);
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// `part%3A1.bin` was decoded first and then taken for a URI of the scheme `part`.
#[test]
fn names_are_decoded_after_the_uri_is_parsed() {
    let folder = Folder::new("names");
    for (name, uris) in [
        ("in/part:1.bin", &["part%3A1.bin", "part%3a1.bin", "./part:1.bin", "./part%3A1.bin"][..]),
        (
            "in/data/a b.bin",
            &[
                "data/a%20b.bin",
                "data/a b.bin",
                "data%2Fa%20b.bin",
                "./data//a%20b.bin",
                "data/../data/a b.bin",
                "data\\a%20b.bin",
            ],
        ),
        ("in/50%25.bin", &["50%2525.bin", "50%25.bin"]),
        ("in/100%.bin", &["100%25.bin", "100%.bin"]),
        ("in/what?#[1]&+;=@!.bin", &["what%3F%23%5B1%5D&+;=@!.bin", "what?#[1]&+;=@!.bin"]),
        ("in/plain.bin", &["plain.bin?version=2", "plain.bin#part", "plain.bin?a#b", "  plain.bin\n", "%70lain.bin"]),
        ("in/größe.bin", &["gr%C3%B6%C3%9Fe.bin", "größe.bin"]),
        ("beside.bin", &["../beside.bin", "%2E%2E/beside.bin", "data/../../beside.bin"]),
        ("in/data:x.bin", &["data%3Ax.bin"]),
        ("in/https:x.bin", &["https%3Ax.bin"]),
    ] {
        folder.put(name);
        uris.iter().for_each(|uri| folder.is_read(uri));
        std::fs::remove_file(folder.0.join(name)).expect("the file made above");
    }
}

/// A name of Latin-1 letters, as old archives have it.
#[cfg(unix)]
#[test]
fn escapes_that_are_not_utf_8_are_bytes_of_a_name() {
    use std::os::unix::ffi::OsStrExt;
    let folder = Folder::new("latin");
    folder.put(Path::new("in").join(std::ffi::OsStr::from_bytes(b"caf\xe9.bin")));
    folder.is_read("caf%E9.bin");
    folder.is_refused("th%E9.bin", "cannot be read");
}

#[test]
fn what_is_not_beside_the_scene_is_refused_with_a_remedy() {
    let folder = Folder::new("remote");
    folder.put("in/plain.bin");
    for uri in [
        "https://example.invalid/a.bin",
        "HTTP://example.invalid/a.bin",
        "//example.invalid/a.bin",
        "file:///etc/hostname",
    ] {
        folder
            .is_refused(uri, &format!("data at '{uri}' is not supported; download the file, put it beside the scene"));
    }
    for uri in ["part:1.bin", "blob:9115d58c", "a+b-c.d:plain.bin"] {
        folder.is_refused(uri, &format!("data at '{uri}' is not supported; put the file beside the scene"));
    }
    let here = folder.0.join("in/plain.bin").display().to_string();
    for uri in [&here, &here.replace('/', "%2F"), "C:\\data\\plain.bin", "c:/data/plain.bin", "\\\\server\\plain.bin"] {
        folder.is_refused(uri, &format!("its data '{uri}' is not given relative to the scene; put the file beside"));
    }
    folder.is_refused("", "its URI is empty");
    folder.is_refused("data/", "is not a plain file");
    folder.is_refused("nul%00byte.bin", "cannot be read");
}

/// Padding written `%3D` was an illegal character.
#[test]
fn data_uris_of_every_spelling_are_read() {
    let folder = Folder::new("data");
    // 40 bytes in all make the text end in "==".
    let mut model = Model::triangle();
    model.view(&[250, 251, 252, 253]);
    let data = &model.binary;
    let (padded, safe) = (STANDARD.encode(data), URL_SAFE.encode(data));
    assert!(padded.ends_with("==") && safe.contains(['-', '_']));
    let escaped = |text: &str| text.replace('=', "%3D").replace('+', "%2B").replace('/', "%2f");
    let lines: String =
        padded.as_bytes().chunks(19).map(|line| format!("{}\r\n", String::from_utf8_lossy(line))).collect();
    let percent: String = data.iter().map(|byte| format!("%{byte:02x}")).collect();
    for uri in [
        format!("data:application/octet-stream;base64,{padded}"),
        format!("data:application/gltf-buffer;base64,{}", escaped(&padded)),
        format!("data:;base64,{}", STANDARD_NO_PAD.encode(data)),
        format!("data:;base64,{safe}"),
        format!("data:;base64,{}", lines),
        format!("data:;base64,{}", lines.replace("\r\n", "%0A")),
        format!("DATA:application/octet-stream;charset=x;Base64,{padded}"),
        format!("data:application/octet-stream; base64,{padded}"),
        format!(" data:base64;base64,{padded}#a fragment"),
        format!("data:application/octet-stream,{percent}"),
        format!("data:,{percent}"),
    ] {
        model.json["buffers"][0]["uri"] = uri.clone().into();
        let file = folder.0.join("in/scene.gltf");
        std::fs::write(&file, model.json.to_string()).expect("a test file");
        let scene = scenes::import(&file).unwrap_or_else(|error| panic!("{uri}: {error}"));
        assert_eq!(scene.objects.len(), 1, "{uri}");
    }
    folder.is_refused("data:;base64,AA*A", "illegal character at 2");
    folder.is_refused("data:;base64", "no comma");
}
