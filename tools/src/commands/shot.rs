//! `sightline shot`: one frame as a PNG.

use super::say;
use crate::boxes_view;
use crate::cli::{parse_methods, ShotArgs, Show};
use crate::png_out::{DepthScale, Picture};
use crate::run::{fragment_counts, Contender};
use crate::session::{cache_folder, Session};
use crate::truth::RunTruth;
use anyhow::{bail, Context, Result};
use culling::TestedBoxes;

/// Frames that a method runs before the one shown, so that it has a past.
const LEAD_FRAMES: usize = 2;

/// Renders and writes the picture.
pub fn run(arguments: &ShotArgs) -> Result<()> {
    let mut methods = parse_methods(&arguments.method, &arguments.set)?;
    let (Some((entry, options)), true) = (methods.pop(), methods.is_empty()) else {
        bail!("--method {}: a shot shows one method", arguments.method);
    };
    if arguments.frame >= arguments.scene.frames as usize {
        bail!("--frame {}: the run has only {} frames, counted from 0", arguments.frame, arguments.scene.frames);
    }
    let mut session = Session::open(&arguments.device.gpu(), arguments.scene.session()?)?;
    let visible = match entry.id {
        "ref" => Some(RunTruth::visible_sets(&mut session, cache_folder().as_deref(), || ())?),
        _ => None,
    };
    let mut contender = Contender::new(&session, entry, options, &visible)?;
    for frame in arguments.frame.saturating_sub(LEAD_FRAMES)..arguments.frame {
        contender.timed(&mut session, frame)?;
    }
    let (picture, caption) = picture(&mut session, &mut contender, arguments)?;
    if let Some(folder) = arguments.out.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        std::fs::create_dir_all(folder).with_context(|| format!("{}: cannot make this folder", folder.display()))?;
    }
    picture.write(&arguments.out)?;
    say(&format!("{}{caption}", arguments.out.display()))
}

/// The picture, and what to say of it behind the file's name.
fn picture(session: &mut Session, contender: &mut Contender, arguments: &ShotArgs) -> Result<(Picture, String)> {
    let view = session.look(arguments.frame)?;
    let report = contender.run(session, &view, true)?;
    let images = session.targets.read()?;
    let picture = match arguments.view {
        Show::Colour => Picture::colour(&images),
        Show::Depth => Picture::depth(&images, DepthScale::of(&images.depth)),
        Show::Items => Picture::items(&images),
        Show::Overdraw => {
            let counts = fragment_counts(session, &view, &report)?;
            Picture::overdraw(images.width, images.height, &counts)
        }
        Show::Boxes | Show::BoxesFirstPerson => {
            let boxes = tested_boxes(session, contender)?;
            let caption = format!(": {}", boxes_view::caption(&boxes));
            let picture = match arguments.view {
                Show::Boxes => boxes_view::from_above(session, &view, &boxes)?,
                _ => boxes_view::first_person(&Picture::colour(&images), &view, &boxes),
            };
            return Ok((picture, caption));
        }
    };
    Ok((picture, String::new()))
}

fn tested_boxes(session: &Session, contender: &Contender) -> Result<TestedBoxes> {
    let boxes = contender.method.tested_boxes(&session.world)?;
    boxes.with_context(|| {
        format!(
            "--view boxes: method '{}' rasterises no boxes; choose one that does, such as roc or eovc",
            contender.label()
        )
    })
}
