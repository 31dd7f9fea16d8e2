//! What one pixel of the newest frame shows.

use super::Frame;
use crate::daylight::sky::Daylight;
use crate::gpu::{Recorder, Result};
use crate::passes::light::lighting::Light;
use crate::passes::light::probe::{Probe, Reading};

impl Frame {
    /// Records the question what one pixel of the newest frame shows; [`Frame::reading`] has the answer when the work is
    /// done. Without a frame, or outside of it, nothing is asked.
    ///
    /// # Errors
    /// When the device has no memory left.
    pub fn ask(&mut self, rec: &mut Recorder, daylight: &Daylight, pixel: [u32; 2]) -> Result<()> {
        let size = self.settings.size.to_array();
        let Some(drawn) = self
            .drawn
            .filter(|_| pixel[0] < size[0] && pixel[1] < size[1])
        else {
            return Ok(());
        };
        let mut probe = match self.probe.take() {
            Some(probe) => probe,
            None => Probe::new(&self.context, size, self.settings.lighting)?,
        };
        let light = Light {
            daylight,
            sun_direction: drawn.sun_direction,
            sun_views: &drawn.sun_views,
            shadow_map: self.shadow.image(),
            sky_irradiance: self.irradiance.image(),
            sky_radiance: self.sky_cube.image(),
        };
        let (surfaces, occlusion) = (self.gbuffer.surfaces(), self.ssao.image());
        let materials = self.geometry.materials();
        let shown = (self.radiance(), self.settings.lighting.show);
        let near = drawn.view.camera.near;
        probe.record(rec, pixel, shown, surfaces, near, |lighting, rec| {
            lighting.record_pixel(
                rec,
                surfaces,
                materials,
                occlusion,
                &light,
                &drawn.view,
                pixel,
            );
        });
        self.probe = Some(probe);
        Ok(())
    }

    /// The answer to the last [`Frame::ask`], once.
    pub fn reading(&mut self) -> Option<Reading> {
        let geometry = &self.geometry;
        self.probe
            .as_mut()?
            .reading(|material| geometry.diffuse(material))
    }
}
