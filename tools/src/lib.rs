//! The `sightline` program as a library, a room for each step of the way from a command line to what is shown. A room uses those
//! below it in this list, and none above.
//!
//! | room | what happens to data there |
//! |---|---|
//! | [`cli`] | a command line becomes flags, and flags become a command's work |
//! | [`view`] | a window shows a scene under any method |
//! | [`tables`] | a paper's table is run, and stands beside what was published |
//! | [`compare`] | two results say what became faster or wrong |
//! | [`stress`] | worst cases go through every exact method |
//! | [`report`] | results become a page |
//! | [`pictures`] | a frame becomes pictures |
//! | [`run`] | methods run through a scene's frames: for the clock, and for the truth |
//! | [`results`] | what was measured becomes files and tables of text |
//! | [`measures`] | frames are measured against the truth |

pub mod cli;
pub mod compare;
pub mod measures;
pub mod pictures;
pub mod report;
pub mod results;
pub mod run;
pub mod stress;
pub mod tables;
pub mod view;
