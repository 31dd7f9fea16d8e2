//! Progress of loading: a fraction and a stage name.

/// Receives the completed fraction, 0..=1 and never decreasing, and the name of the stage. It is called often, on the loading
/// thread, so it should be fast: store the value for another thread to read.
pub type Progress<'p> = &'p (dyn Fn(f32, &'static str) + Sync);

/// Maps the progress of one part of the work to a range of the whole.
#[derive(Clone, Copy)]
pub(super) struct Reporter<'p> {
    report: Progress<'p>,
    from: f32,
    to: f32,
}

impl std::fmt::Debug for Reporter<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Reporter({}..{})", self.from, self.to)
    }
}

impl<'p> Reporter<'p> {
    /// Covers the whole work.
    pub fn new(report: Progress<'p>) -> Self {
        Self {
            report,
            from: 0.0,
            to: 1.0,
        }
    }

    /// Covers the first `share` of the work, 0..=1.
    pub fn up_to(self, share: f32) -> Self {
        let to = self.from + (self.to - self.from) * share;
        Self { to, ..self }
    }

    /// Covers part `index` of `count` equal parts.
    pub fn part(self, index: usize, count: usize) -> Self {
        let at = |i: usize| self.from + (self.to - self.from) * i as f32 / count.max(1) as f32;
        Self {
            from: at(index),
            to: at(index + 1),
            ..self
        }
    }

    /// Reports that the fraction `share` of the part, 0..=1, is done, and which stage comes next.
    pub fn at(&self, share: f32, stage: &'static str) {
        (self.report)(self.from + (self.to - self.from) * share, stage);
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;

    use super::*;

    #[test]
    fn parts_fill_the_whole_in_order() {
        let told = Mutex::new(Vec::new());
        let tell = |share: f32, _: &'static str| told.lock().expect("one thread").push(share);
        let whole = Reporter::new(&tell);
        for i in 0..4 {
            whole.part(i, 4).at(0.5, "half a part");
        }
        whole.at(1.0, "done");
        assert_eq!(
            *told.lock().expect("one thread"),
            [0.125, 0.375, 0.625, 0.875, 1.0]
        );
    }
}
