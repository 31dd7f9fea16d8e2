//! Lighting of the surfaces, the background behind them, and read-outs of single pixels.

pub mod background;
pub mod lighting;
pub mod probe;
pub mod stars;
