//! The sky of an [`Atmosphere`] under one sun.

use std::fmt;
use std::sync::{Arc, OnceLock};

use glam::DVec3;

use super::Atmosphere;
use super::sky_view::SkyView;

/// The sky of an atmosphere under one sun; the table of its view is made when it is first looked at.
#[derive(Clone)]
pub struct ScatteredSky {
    /// The atmosphere.
    pub atmosphere: Atmosphere,
    /// Unit vector toward the true sun.
    pub sun: DVec3,
    view: Arc<OnceLock<SkyView>>,
}

impl ScatteredSky {
    /// The sky under the true sun in the unit direction `sun`.
    pub fn new(atmosphere: Atmosphere, sun: DVec3) -> Self {
        Self {
            atmosphere,
            sun,
            view: Arc::default(),
        }
    }

    /// The whole view.
    pub fn view(&self) -> &SkyView {
        self.view
            .get_or_init(|| SkyView::new(&self.atmosphere, self.sun))
    }

    /// Radiance in a unit direction, above the horizon or below, linear BT.709 RGB, cd/m², not clipped.
    pub fn radiance(&self, dir: DVec3) -> DVec3 {
        self.view().radiance(dir)
    }
}

/// Of the same air under the same sun.
impl PartialEq for ScatteredSky {
    fn eq(&self, other: &Self) -> bool {
        self.atmosphere.air == other.atmosphere.air && self.sun == other.sun
    }
}

impl fmt::Debug for ScatteredSky {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ScatteredSky")
            .field("air", &self.atmosphere.air)
            .field("sun", &self.sun)
            .finish_non_exhaustive()
    }
}
