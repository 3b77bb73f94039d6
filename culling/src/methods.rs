//! The list of methods. One line a method.

use crate::{auto, eovc, farthest, frustum, horizon, hzb, none, portals, queries, reference, roc, woc};
use crate::{Error, Guarantee, Method, OptionInfo, Options, Result, Setup, World};
use scenes::Scene;

/// A method that can be chosen.
#[derive(Debug)]
pub struct Entry {
    /// Its name on the command line and in results.
    pub id: &'static str,
    /// What it is, in one line.
    pub title: &'static str,
    /// Where it comes from.
    pub source: &'static str,
    /// What it promises.
    pub guarantee: Guarantee,
    /// Its options.
    pub options: &'static [OptionInfo],
    /// Makes it.
    pub make: fn(&Setup<'_>) -> Result<Box<dyn Method>>,
}

impl Entry {
    /// Why it cannot draw pictures of several samples a pixel of a world; none if it can. `stray_px` is how far beside a sample the device
    /// takes its depth, in pixels: no distance at all, but for faults of devices.
    ///
    /// A primitive's depth beside what it covers is that of its plane, and may lie before all of the primitive: by its slope times the distance.
    /// Footprints hold that, as they reach out by their whole range of depth (`include/footprint.glsl`); drawn boxes and rays cannot.
    pub fn needs_one_sample(&self, world: &World, options: &Options, stray_px: f32) -> Option<&'static str> {
        let strays = stray_px > 0.0;
        let has_translucent = world.total() > world.len();
        match self.id {
            "eovc" => Some("it casts one ray through each pixel's centre"),
            "hzb-iterative" => Some("it learns who is seen from the item buffer, which has one object a pixel"),
            "auto" => Some("it chooses among methods that need one sample; name a method"),
            "woc" | "awoc" | "woc-exact" if world.moving().len() > 0 => {
                Some("it warps moving objects by the item buffer, which has one object a pixel")
            }
            _ if world.has_masked() => Some("masked objects are drawn with one sample a pixel"),
            "none" | "ref" | "frustum" | "frustum-bvh" => None,
            "hzb" | "hom" | "woc" | "awoc" | "woc-exact" if strays && has_translucent => {
                Some("this device takes a sample's depth beside it, before the boxes that translucent objects are tested by")
            }
            "woc" | "awoc" | "woc-exact" if strays && woc::tests_boxes(world, options) => {
                Some("this device takes a sample's depth beside it, before the boxes of costly objects; set its option hybrid=0")
            }
            "hzb" | "hom" | "woc" | "awoc" | "woc-exact" => None,
            _ if strays => Some("this device takes a sample's depth beside it, before the box that it is tested by"),
            _ => None,
        }
    }
}

/// Every method that takes any scene, in the order in which `--method all` runs them.
pub const METHODS: &[Entry] = &[
    Entry {
        id: "none",
        title: "no culling",
        source: "baseline of all papers",
        guarantee: Guarantee::Exact,
        options: none::OPTIONS,
        make: none::make,
    },
    Entry {
        id: "frustum",
        title: "view-frustum culling",
        source: "Zachmann 2008, VFC; GPU Gems 29.6.4; Kim 2015, III.2",
        guarantee: Guarantee::Exact,
        options: frustum::OPTIONS,
        make: frustum::make,
    },
    Entry {
        id: "frustum-bvh",
        title: "hierarchical view-frustum culling, with plane masking and coherence",
        source: "Zachmann 2008, VFC",
        guarantee: Guarantee::Exact,
        options: frustum::bvh::OPTIONS,
        make: frustum::bvh::make,
    },
    Entry {
        id: "hzb",
        title: "two-phase hierarchical-Z culling",
        source: "Haar & Aaltonen 2015; Lee et al. 2018, 5.1",
        guarantee: Guarantee::Exact,
        options: hzb::OPTIONS,
        make: hzb::make,
    },
    Entry {
        id: "hzb-iterative",
        title: "hierarchical-Z culling by depth ranges, near to far, as many as the frame needs",
        source: "Sightline; Haar & Aaltonen 2015, EOVC thesis II.2 and its reference 23",
        guarantee: Guarantee::Exact,
        options: hzb::iterative::OPTIONS,
        make: hzb::iterative::make,
    },
    Entry {
        id: "hom",
        title: "hierarchical occlusion mapping with this frame's depth",
        source: "Lee et al. 2018, figure 14c; Kim 2015, III.2",
        guarantee: Guarantee::Exact,
        options: farthest::hom::OPTIONS,
        make: farthest::hom::make,
    },
    Entry {
        id: "woc",
        title: "warping-based occlusion culling",
        source: "Kim 2015, III-IV; Lee et al. 2018, 5",
        guarantee: Guarantee::Approximate(woc::WARPED),
        options: woc::OPTIONS,
        make: woc::make,
    },
    Entry {
        id: "awoc",
        title: "approximate warping-based culling: holes are filled",
        source: "Lee et al. 2018, 5.3",
        guarantee: Guarantee::Approximate(woc::FILLED),
        options: woc::OPTIONS,
        make: woc::make_approximate,
    },
    Entry {
        id: "woc-exact",
        title: "warping-based culling, repaired against this frame's depth",
        source: "Sightline; its second test is that of Haar & Aaltonen 2015",
        guarantee: Guarantee::Exact,
        options: woc::OPTIONS,
        make: woc::make_exact,
    },
    Entry {
        id: "roc",
        title: "raster occlusion culling",
        source: "EOVC thesis, II.2; Kubisch & Tavenrath 2014",
        guarantee: Guarantee::Exact,
        options: roc::OPTIONS,
        make: roc::make,
    },
    Entry {
        id: "roc-iterative",
        title: "raster occlusion culling by depth ranges, near to far",
        source: "EOVC thesis, II.2 and its reference 23",
        guarantee: Guarantee::Exact,
        options: roc::iterative::OPTIONS,
        make: roc::iterative::make,
    },
    Entry {
        id: "eovc",
        title: "ray-cast occludee groups",
        source: "EOVC thesis, III",
        guarantee: Guarantee::Exact,
        options: eovc::OPTIONS,
        make: eovc::make,
    },
    Entry {
        id: "query-wait",
        title: "occlusion queries in batches, each waited for",
        source: "GPU Gems 29.3; Zachmann 2008, draw-and-wait",
        guarantee: Guarantee::Exact,
        options: queries::wait::OPTIONS,
        make: queries::wait::make,
    },
    Entry {
        id: "query-lag",
        title: "occlusion queries that are read one frame later",
        source: "GPU Gems 29.4",
        guarantee: Guarantee::Approximate(queries::lag::LAGS),
        options: queries::lag::OPTIONS,
        make: queries::lag::make,
    },
    Entry {
        id: "chc",
        title: "coherent hierarchical culling",
        source: "Zachmann 2008; Bittner et al. 2004",
        guarantee: Guarantee::Exact,
        options: queries::chc::OPTIONS,
        make: queries::chc::make,
    },
    Entry {
        id: "chc++",
        title: "coherent hierarchical culling with queues, multiqueries and tight bounds",
        source: "Zachmann 2008; Mattausch et al. 2008",
        guarantee: Guarantee::Exact,
        options: queries::chcpp::OPTIONS,
        make: queries::chcpp::make,
    },
    Entry {
        id: "nohc",
        title: "hierarchical culling that queries where a fitted cost model says that it pays",
        source: "Kim 2015, V; Guthe et al. 2006",
        guarantee: Guarantee::Exact,
        options: queries::nohc::OPTIONS,
        make: queries::nohc::make,
    },
    Entry {
        id: "auto",
        title: "whichever exact method costs least here and now, by measured times",
        source: "Sightline",
        guarantee: Guarantee::Exact,
        options: auto::OPTIONS,
        make: auto::make,
    },
    Entry {
        id: "ref",
        title: "ideal culling: draws the true visible set",
        source: "Kim 2015, V; Lee et al. 2018, 5.3; EOVC, IV",
        guarantee: Guarantee::Exact,
        options: reference::OPTIONS,
        make: reference::make,
    },
];

/// Methods for scenes that say something particular of themselves, and that refuse all others. `--method all` runs them where they run.
pub const PARTICULAR: &[Entry] = &[
    Entry {
        id: "horizon",
        title: "the occlusion horizon of cities",
        source: "Zachmann 2008, culling; Downs, Moeller & Sequin 2001",
        guarantee: Guarantee::Exact,
        options: horizon::OPTIONS,
        make: horizon::make,
    },
    Entry {
        id: "portals",
        title: "cells and portals: what is seen through openings of openings",
        source: "Zachmann 2008, culling; Luebke & Georges 1995",
        guarantee: Guarantee::Exact,
        options: portals::OPTIONS,
        make: portals::make,
    },
];

/// Why a method refuses a scene; none if it takes it.
pub fn refusal(entry: &Entry, scene: &Scene) -> Option<Error> {
    let refused = |method, needs: &str| Some(Error::Missing { method, needs: needs.to_owned() });
    match entry.id {
        "horizon" if scene.buildings.is_empty() => refused("horizon", horizon::NEEDS),
        "portals" if scene.cells.is_none() => refused("portals", portals::NEEDS),
        _ => None,
    }
}

/// The method of that name.
pub fn find(name: &str) -> Result<&'static Entry> {
    METHODS.iter().chain(PARTICULAR).find(|entry| entry.id == name).ok_or_else(|| Error::UnknownMethod {
        name: name.to_owned(),
        choices: METHODS.iter().chain(PARTICULAR).map(|entry| entry.id).collect::<Vec<_>>().join(", "),
    })
}

/// The method to use where nobody says which: `auto`, exact and as fast as any.
pub fn default_method() -> &'static Entry {
    &METHODS[METHODS.iter().position(|entry| entry.id == "auto").unwrap_or(0)]
}

impl Entry {
    /// The method's options, all at their defaults.
    pub fn default_options(&self) -> Options {
        Options::new(self.id, self.options)
    }
}
