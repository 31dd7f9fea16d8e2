//! The physics of daylight in `f64`, without a device.
