//! Lighting of the surfaces, light in the lobes of rough ones, the background behind them, panes of glass before them, and read-outs of single pixels.

pub mod background;
pub mod lighting;
pub mod lobes;
pub mod panes;
pub mod probe;
pub mod rough;
pub mod stars;
