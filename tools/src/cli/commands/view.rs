//! `sightline view`.

use crate::cli::ViewArgs;
use crate::run::methods::parse_methods;
use crate::view::{keys, ViewOptions};
use anyhow::Result;

pub fn run(arguments: &ViewArgs) -> Result<()> {
    crate::view::run(ViewOptions {
        session: arguments.flares.of(arguments.scene.session()?),
        gpu: arguments.device.gpu(),
        methods: parse_methods(&arguments.methods.method, &arguments.methods.sets())?,
        keys: arguments.keys.as_deref().map(keys::parse_steps).transpose()?,
        screenshot: arguments.screenshot.clone(),
        capture: arguments.capture,
        out: arguments.out.clone(),
    })
}
