//! The route of full-screen passes on a device: given, or by a measurement that is kept beside the pipeline cache.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use crate::gpu::device::context::Context;
use crate::gpu::device::optional::Optional;
use crate::gpu::device::select::DeviceSummary;
use crate::gpu::pipeline::cache::{Key, write};
use crate::gpu::record::screen::Route;

/// First word of the file; the digit is the format version.
const MAGIC: &str = "skylight-route-1";
/// Longer files are not of this program.
const MAX_BYTES: u64 = 256;
/// Fraction of the fragments' time below which compute is worth it: where both are equal, the depth test does the selecting for nothing.
const WORTH: f64 = 0.9;
/// Fragments' time over that of compute from which on a device is short of raster units: 13 on a card of a data centre, a little above or below 1 on
/// others.
const SHORT: f64 = 4.0;

/// Times of the same work by both routes, milliseconds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RouteTimes {
    /// By fragments.
    pub fragment: f64,
    /// By a compute shader.
    pub compute: f64,
}

impl RouteTimes {
    /// The faster route.
    pub fn faster(self) -> Route {
        if self.compute < WORTH * self.fragment {
            Route::Compute
        } else {
            Route::Fragment
        }
    }

    /// Whether the device is short of raster units, as cards of data centres are.
    pub fn is_short_of_raster_units(self) -> bool {
        self.fragment > SHORT * self.compute
    }

    fn encode(self, key: &Key) -> String {
        let Self { fragment, compute } = self;
        format!("{MAGIC} {} {fragment} {compute}\n", key.text())
    }

    /// The times in a file, if they are of this device and driver.
    fn decode(key: &Key, text: &str) -> Option<Self> {
        let mut words = text.split_whitespace();
        let is_known = words.next() == Some(MAGIC) && words.next() == Some(&key.text());
        let mut time = || words.next()?.parse().ok().filter(|t: &f64| *t >= 0.0);
        let times = Self {
            fragment: time()?,
            compute: time()?,
        };
        (is_known && words.next().is_none()).then_some(times)
    }
}

/// A route, and the times by which it was chosen; `None` if it was asked for, or there is no other.
#[derive(Clone, Copy)]
struct Chosen {
    route: Route,
    times: Option<RouteTimes>,
}

impl From<RouteTimes> for Chosen {
    fn from(times: RouteTimes) -> Self {
        Self {
            route: times.faster(),
            times: Some(times),
        }
    }
}

impl From<Route> for Chosen {
    fn from(route: Route) -> Self {
        Self { route, times: None }
    }
}

/// The route of a device, once it is known.
pub(in crate::gpu) struct DeviceRoute {
    chosen: OnceLock<Chosen>,
    path: Option<PathBuf>,
    key: Key,
}

impl DeviceRoute {
    /// The route that is asked for; without one, that of the file in `folder`, if there is one. Software devices take fragments, whose depth
    /// test saves them the pixels that do not count.
    pub(in crate::gpu) fn new(
        device: &DeviceSummary,
        key: Key,
        folder: Option<&Path>,
        asked: Option<Route>,
    ) -> Self {
        let path = folder.map(|folder| folder.join(key.route_file()));
        let can_store = device.has(Optional::StoredPictures);
        let kept = || path.as_deref().and_then(|path| read(path, &key));
        let chosen = if !can_store || (asked.is_none() && device.is_software()) {
            Some(Route::Fragment.into())
        } else {
            asked.map(Chosen::from).or_else(|| Some(kept()?.into()))
        };
        Self {
            chosen: chosen.map_or_else(OnceLock::new, OnceLock::from),
            path,
            key,
        }
    }
}

fn read(path: &Path, key: &Key) -> Option<RouteTimes> {
    let about = fs::metadata(path).ok()?;
    let is_short = about.is_file() && about.len() <= MAX_BYTES;
    let text = is_short.then(|| fs::read_to_string(path).ok())??;
    RouteTimes::decode(key, &text)
}

impl Context {
    /// How full-screen passes are computed: as asked for in [`crate::gpu::ContextOptions::route`], or the faster way once it is known.
    pub fn route(&self) -> Route {
        let chosen = self.route.chosen.get();
        chosen.map_or_else(Route::default, |chosen| chosen.route)
    }

    /// Whether the device was measured to be short of raster units, see [`RouteTimes::is_short_of_raster_units`].
    pub fn is_short_of_raster_units(&self) -> bool {
        let times = self.route.chosen.get().and_then(|chosen| chosen.times);
        times.is_some_and(RouteTimes::is_short_of_raster_units)
    }

    /// Whether [`Context::route`] does not change any more; otherwise [`Context::settle_route`] sets it.
    pub fn is_route_settled(&self) -> bool {
        self.route.chosen.get().is_some()
    }

    /// Sets the route by times that were measured, and keeps them for later runs. Nothing happens if it is settled.
    pub fn settle_route(&self, times: RouteTimes) {
        if self.route.chosen.set(times.into()).is_ok()
            && let Some(path) = &self.route.path
        {
            // Without the file the next run measures again.
            let _ = write(path, times.encode(&self.route.key).as_bytes());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_faster_route_wins_if_the_difference_is_worth_it() {
        let route = |fragment, compute| RouteTimes { fragment, compute }.faster();
        assert_eq!(route(0.22, 0.02), Route::Compute);
        assert_eq!(route(1.0, 0.95), Route::Fragment);
        assert_eq!(route(1.0, 1.7), Route::Fragment);
        let is_short =
            |fragment, compute| RouteTimes { fragment, compute }.is_short_of_raster_units();
        assert!(is_short(0.22, 0.02) && !is_short(1.3, 1.0));
    }

    #[test]
    fn times_are_kept_for_their_device_and_driver_alone() {
        let (key, other) = (Key::of_numbers(1, 2, 3), Key::of_numbers(1, 2, 4));
        let times = RouteTimes {
            fragment: 0.22,
            compute: 0.017,
        };
        let text = times.encode(&key);
        assert_eq!(RouteTimes::decode(&key, &text), Some(times));
        assert_eq!(RouteTimes::decode(&other, &text), None);
        let bad = [
            "",
            "skylight-route-1",
            text.trim_end_matches("0.017\n"),
            &text.replace("0.017", "nan"),
            &text.replace("0.017", "-1"),
            &format!("{text} 1"),
        ];
        for bad in bad {
            assert_eq!(RouteTimes::decode(&key, bad), None, "{bad}");
        }
    }
}
