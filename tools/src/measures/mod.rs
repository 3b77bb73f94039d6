//! What is measured: a frame against the truth ([`metrics`]), what samples say together ([`stats`]), and which settings no other one
//! beats ([`pareto`]). Arithmetic alone, without a device or a file.

pub mod metrics;
pub mod pareto;
pub mod stats;
