//! `sightline view` in a window of a virtual display, through the same handlers as real keys, with validation on.
//!
//! Needs Xvfb and import (`tools/setup.sh --windows`, which `tools/test.sh` runs).

mod display;

use display::Display;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const PROGRAM: &str = env!("CARGO_BIN_EXE_sightline");

/// All views of the key V, by the names of their screenshots.
const VIEWS: [&str; 10] =
    ["colour", "depth", "farthest", "items", "overdraw", "motion", "warp-error", "groups", "boxes", "false-positives"];

struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("view-{name}"));
        let _ = std::fs::remove_dir_all(&folder);
        std::fs::create_dir_all(&folder).unwrap();
        Folder(folder)
    }

    fn file(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    /// The pixels of a picture.
    fn picture(&self, name: &str) -> image::RgbImage {
        let file = self.file(name);
        image::open(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display())).to_rgb8()
    }
}

/// Runs the program in a virtual display.
fn view(folder: &Folder, arguments: &str, keys: &str) -> Output {
    let display = Display::open("1280x800");
    let mut program = display.command(PROGRAM);
    program.args(["view", "--validation", "--out"]).arg(&folder.0).args(arguments.split(' ')).args(["--keys", keys]);
    program.output().expect("the program starts")
}

fn assert_good(output: &Output) {
    let (out, err) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{}\n{out}\n{err}", output.status);
    assert!(
        !["XSETTINGS", "XRandR", "XDG_RUNTIME_DIR"].iter().any(|word| err.contains(word)),
        "what the window system says helps nobody: {err}"
    );
}

/// Pixels that differ where no text stands: the middle of the picture.
fn differing(one: &image::RgbImage, other: &image::RgbImage) -> usize {
    let (width, height) = one.dimensions();
    let middle = (height * 2 / 5..height * 3 / 5).flat_map(|y| (width / 2..width * 3 / 4).map(move |x| (x, y)));
    middle.filter(|(x, y)| one.get_pixel(*x, *y) != other.get_pixel(*x, *y)).count()
}

#[test]
fn without_a_display_one_line_says_what_to_do() {
    for display in ["", ":4711"] {
        let output = Command::new(PROGRAM)
            .arg("view")
            .env_remove("WAYLAND_DISPLAY")
            .env_remove("WAYLAND_SOCKET")
            .env("DISPLAY", display)
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{said}");
        assert_eq!(said.trim().lines().count(), 1, "{said}");
        assert!(said.contains("no display") && said.contains("xvfb-run"), "{said}");
    }
}

#[test]
fn steps_that_are_none_are_refused_before_a_window_opens() {
    let output = Command::new(PROGRAM).args(["view", "--keys", "Tab,Z"]).env("DISPLAY", "").output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(!output.status.success() && said.contains("'Z' is no step"), "{said}");
}

#[test]
fn every_view_of_every_kind_of_method_is_shown_without_a_message() {
    for method in ["hzb", "eovc", "woc", "hzb-iterative", "chc"] {
        let folder = Folder::new(&format!("views-{method}"));
        let shots: Vec<String> = VIEWS.iter().map(|view| format!("2,shot={view}.png,V")).collect();
        let keys = format!("H,+W,3,-W,Space,2,{},F,look=150:10,2,shot=frozen.png", shots.join(","));
        let arguments = format!("--scene city-block --scale 0.02 --size 640x360 --method {method} --frames 70");
        assert_good(&view(&folder, &arguments, &keys));
        let pictures: Vec<_> = VIEWS.iter().map(|view| folder.picture(&format!("{view}.png"))).collect();
        for (view, picture) in VIEWS.iter().zip(&pictures) {
            assert_eq!(picture.dimensions(), (640, 360), "{view}");
            // Groups and boxes are not there in every method, and are told so over the picture itself.
            if !["colour", "groups", "boxes"].contains(view) {
                assert!(differing(&pictures[0], picture) > 1000, "{method}: {view} is as the picture");
            }
        }
        if method == "eovc" {
            assert!(differing(&pictures[0], &pictures[8]) > 1000, "eovc tests boxes");
        }
    }
}

#[test]
fn all_keys_resize_and_lost_surfaces_leave_no_message() {
    let folder = Folder::new("keys");
    let keys = "Tab,2,Tab,2,C,2,C,T,2,F,+D,2,-D,F,L,V,V,L,2,V,V,V,V,V,V,V,V,B,+W,+Shift,3,-Shift,-W,+E,-E,+Q,-Q,+A,-A,+S,-S,\
        wheel=3,look=20:-9,B,P,+W,+Shift,size=500x400,4,shot=small.png,-Shift,-W,size=900x300,4,shot=wide.png,minimise,2,restore,2,surface,2,R,G,2,H,H,\
        F12,Space,3,Tab,2,F,size=320x180,4";
    let arguments = "--scene moving-boxes --size 640x360 --method none,hzb,ref --frames 140";
    assert_good(&view(&folder, arguments, keys));
    assert_eq!(folder.picture("small.png").dimensions(), (500, 400));
    assert_eq!(folder.picture("wide.png").dimensions(), (900, 300));
    assert_eq!(folder.picture("screenshot-001.png").dimensions(), (900, 300));
    for file in ["camera-001.json", "recording-001.json"] {
        let path = scenes::CameraPath::from_file(&folder.file(file), 1.0).unwrap();
        assert!(path.sample(0, 30).pose.position.is_finite(), "{file}");
    }
}

#[test]
fn escape_closes_the_window_whatever_is_held_or_to_come() {
    let folder = Folder::new("escape");
    assert_good(&view(&folder, "--scene boxes --size 320x180 --frames 100000", "V,+W,+Shift,2,Esc,2,shot=never.png"));
    assert!(!folder.file("never.png").exists());
}

#[test]
fn what_the_screen_shows_is_what_a_screenshot_saves() {
    let folder = Folder::new("screen");
    // The camera stands still and the window stays until the picture of the whole screen is taken.
    let script = format!(
        "'{PROGRAM}' view --validation --scene city-block --scale 0.02 --size 640x360 --method hzb --path still --frames 100000 \
         --out '{0}' --keys 'H,20,shot=saved.png,90000' & view=$!; until [ -e '{0}/saved.png' ]; do kill -0 $view || exit 1; sleep 0.1; done; \
         sleep 1; import -window root '{0}/screen.png'; kill $view",
        folder.0.display()
    );
    let display = Display::open("640x360");
    let output = display.command("bash").args(["-c", &script]).output().expect("bash starts");
    assert_good(&output);
    let (saved, screen) = (folder.picture("saved.png"), folder.picture("screen.png"));
    assert_eq!(saved.dimensions(), screen.dimensions());
    assert_eq!(differing(&saved, &screen), 0);
    let colours: std::collections::HashSet<_> = saved.pixels().collect();
    assert!(colours.len() > 100, "a picture of a city has more than {} colours", colours.len());
}

/// Does to the program's window what window systems do: covers it, says that it is minimised, destroys it. Prints how many hundredths of a
/// second of processor time the program then took in a second.
const WINDOW_SYSTEM: &str = r#"
import ctypes, subprocess, sys, time
x = ctypes.CDLL("libX11.so.6")
for name in ["XOpenDisplay", "XDefaultRootWindow", "XCreateSimpleWindow", "XInternAtom"]:
    getattr(x, name).restype = ctypes.c_void_p
program = subprocess.Popen(sys.argv[1:])
display = ctypes.c_void_p(x.XOpenDisplay(None))
root = ctypes.c_void_p(x.XDefaultRootWindow(display))

def windows():
    first, second, found, count = ctypes.c_ulong(), ctypes.c_ulong(), ctypes.POINTER(ctypes.c_ulong)(), ctypes.c_uint()
    x.XQueryTree(display, root, *(ctypes.byref(one) for one in (first, second, found, count)))
    names = {}
    for window in found[:count.value]:
        name = ctypes.c_char_p()
        x.XFetchName(display, ctypes.c_ulong(window), ctypes.byref(name))
        names[name.value or b""] = ctypes.c_void_p(window)
    return [window for name, window in names.items() if name.startswith(b"sightline")]

def took():
    with open(f"/proc/{program.pid}/stat") as file:
        fields = file.read().rsplit(")", 1)[1].split()
    return int(fields[11]) + int(fields[12])

def measure(what, enough=None):
    time.sleep(0.7)
    before = took()
    time.sleep(1)
    for _ in range(200):
        if enough is None or took() - before >= enough:
            break
        time.sleep(0.1)
    print(what, took() - before, flush=True)

def hidden(atoms):
    values = (ctypes.c_ulong * 1)(x.XInternAtom(display, b"_NET_WM_STATE_HIDDEN", 0))
    state, kind = (ctypes.c_void_p(x.XInternAtom(display, name, 0)) for name in (b"_NET_WM_STATE", b"ATOM"))
    x.XChangeProperty(display, window, state, kind, 32, 0, values, atoms)
    x.XSync(display, 0)

while not windows():
    assert program.poll() is None
    time.sleep(0.1)
[window] = windows()
measure("shown", 50)
cover = ctypes.c_void_p(x.XCreateSimpleWindow(display, root, 0, 0, 2000, 2000, 0, 0, 0))
x.XMapRaised(display, cover)
x.XSync(display, 0)
measure("covered")
x.XDestroyWindow(display, cover)
x.XSync(display, 0)
measure("uncovered", 20)
hidden(1)
measure("minimised")
hidden(0)
measure("restored", 20)
x.XDestroyWindow(display, window)
x.XSync(display, 0)
sys.exit(program.wait())
"#;

/// A window that was destroyed by another program once ended in a panic, and a minimised one was drawn on.
#[test]
fn a_window_out_of_sight_rests_and_one_that_is_destroyed_ends_the_program_in_one_line() {
    let folder = Folder::new("out-of-sight");
    let display = Display::open("640x360");
    let mut window_system = display.command("/usr/bin/python3");
    window_system.args(["-c", WINDOW_SYSTEM, PROGRAM]);
    window_system
        .args("view --validation --scene city-block --scale 0.02 --size 320x180 --method hzb --out".split(' '));
    let output = window_system.arg(&folder.0).output().expect("Python starts");
    let (out, err) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert_eq!(output.status.code(), Some(1), "{out}\n{err}");
    assert!(err.lines().count() == 1 && err.contains("the window system took the window away"), "{err}");
    let took: Vec<(&str, u32)> =
        out.lines().filter_map(|line| line.split_once(' ')).map(|(what, took)| (what, took.parse().unwrap())).collect();
    assert_eq!(took.len(), 5, "{out}");
    for (what, took) in took {
        assert!(took < 10 || !["covered", "minimised"].contains(&what), "a {what} window takes {took} % of a core");
    }
}
