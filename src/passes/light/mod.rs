//! Lighting of the surfaces, the background behind them, panes of glass before them, and read-outs of single pixels.

pub mod background;
pub mod lighting;
pub mod panes;
pub mod probe;
pub mod stars;
