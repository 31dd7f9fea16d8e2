//! Adaptation of the window's exposure over time.

use crate::daylight::exposure;

/// Settling time, seconds: once the image has been unchanged this long, the last step is taken at once. 1 % is left by then.
const SETTLED_S: f64 = 1.0;

/// Adaptation of automatic exposure: exponential while the image changes, complete at rest.
#[derive(Debug)]
pub(super) struct Adaptation {
    /// Seconds since the image changed; `None` once the exposure has adapted.
    since_change: Option<f64>,
    /// Seconds by which the next frame adapts.
    pending: f64,
    /// Whether the next frame is exposed without adaptation.
    is_cut: bool,
}

impl Default for Adaptation {
    /// The first image is exposed without adaptation.
    fn default() -> Self {
        Self {
            since_change: None,
            pending: 0.0,
            is_cut: true,
        }
    }
}

impl Adaptation {
    /// Restarts adaptation after a change of view or light.
    pub(super) fn restart(&mut self) {
        self.since_change = Some(0.0);
    }

    /// Exposes the next frame without adaptation, for example after a change of the displayed quantity.
    pub(super) fn cut(&mut self) {
        self.is_cut = true;
    }

    /// Advances time by `seconds`.
    pub(super) fn advance(&mut self, seconds: f64) {
        self.pending += seconds;
        if let Some(since) = &mut self.since_change {
            *since += seconds;
        }
    }

    /// Fraction (0..1) of the way to the target exposure for the next frame. `is_last`: the image itself will not change
    /// after this frame.
    pub(super) fn share(&mut self, is_last: bool) -> f64 {
        let seconds = std::mem::take(&mut self.pending);
        let is_settled = self.since_change.is_some_and(|since| since >= SETTLED_S);
        if std::mem::take(&mut self.is_cut) || (is_last && is_settled) {
            self.since_change = None;
        }
        match self.since_change {
            Some(_) => exposure::adaptation(seconds),
            None => 1.0,
        }
    }

    /// Whether the exposure has reached its target.
    pub(super) fn is_done(&self) -> bool {
        self.since_change.is_none()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Remaining fraction of a change, and number of frames until the exposure has adapted.
    fn left(frame_s: f64, frames_of_average: u32) -> (f64, u32) {
        let mut adaptation = Adaptation::default();
        adaptation.restart();
        assert_eq!(adaptation.share(false), 1.0, "the first picture");
        assert!(adaptation.is_done());
        adaptation.restart();
        let (mut left, mut before_last, mut frames) = (1.0, 1.0, 0);
        while !adaptation.is_done() {
            adaptation.advance(frame_s);
            frames += 1;
            before_last = left;
            left *= 1.0 - adaptation.share(frames >= frames_of_average);
        }
        assert_eq!(left, 0.0);
        (before_last, frames)
    }

    #[test]
    fn it_arrives_a_second_after_the_last_change_at_any_frame_rate() {
        for (frame_s, average, expected) in
            [(1.0 / 64.0, 16, 64), (1.0 / 64.0, 128, 128), (0.25, 1, 4)]
        {
            let (before_last, frames) = left(frame_s, average);
            assert_eq!(frames, expected);
            assert!(before_last < 0.04, "{before_last}");
        }
    }
}
