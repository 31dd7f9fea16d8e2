//! A cache of irradiance in world space: cells, created where light paths from the eye meet surfaces, each with the irradiance of the
//! sky and of the bounces on the surfaces in it.
//!
//! A round has four passes. *Seed* traces paths from the eye and claims cells in a hash table; *place* gives them the points from
//! which they look at the scene; *update* adds paths to the cells, which end in the cells as the last round left them; *publish*
//! copies the table to images for lookups. Random numbers depend on the cell, and contests for places are won by the smallest hash:
//! the same seed gives the same light, in whatever order the device runs.
//!
//! Hashed irradiance caches: Gautron 2020, "Real-time ray-traced ambient occlusion of complex scenes using spatial hashing"; the
//! weights of the running mean are this program's own (see `cells_update.comp`).

use std::sync::Arc;

use glam::{DVec3, Vec3};

use crate::daylight::sky::Daylight;
use crate::daylight::sunlight::SUN_ANGULAR_RADIUS;
use crate::gpu::{
    Buffer, BufferKind, Context, Format, Image, ImageDesc, Pass, Pipeline, Recorder, Result,
    Sampler, shaders,
};
use crate::gpu_struct;
use crate::passes::bounces::change::{change, ratio};
use crate::passes::bounces::tree::{Tree, TreeFacts};
use crate::passes::view::{View, ViewBlock};
use crate::passes::{compute, kilo};
use crate::scene::Bounds;

/// Slots of the hash table, as in `include/cell_flags.glsl`.
const SLOTS: u32 = 1 << 17;
/// Slots in a row of the published images, as in `include/cell_flags.glsl`.
const SLOT_COLUMNS: u32 = 512;
/// Points of a cell, its contests, and points of a path, as in `include/cell_table.glsl`.
const POINTS: u32 = 2;
const CONTESTS: u32 = 2;
const PATH_POINTS: u32 = 4;
/// Sizes of the structs there, bytes.
const POINT_BYTES: u32 = 16;
const WALL_BYTES: u32 = 8;
const CANDIDATE_BYTES: u32 = 28;
const SUM_BYTES: u32 = 56;

/// Invocations of a pass over the live cells, each of which takes several cells in turn: how many are live the host does not know. A software
/// device takes a while for each work group that has nothing to do.
const INVOCATIONS: u32 = SLOTS;
const INVOCATIONS_OF_SOFTWARE: u32 = 1 << 11;

/// Most paths from the eye in a round.
const PATHS: u32 = 1 << 12;

/// Paths from the cells in a round, unless there are more cells; and those from cells in view besides.
const UPDATES: u32 = 1 << 13;
const SEEN_UPDATES: u32 = 1 << 12;

/// Paths of a young cell in a round of a moving view.
const YOUNG_PATHS: u32 = 4;
/// The same while all cells are young, after a jump of the light: more would make each of these frames long.
const PATHS_OF_ALL_YOUNG: u32 = 1;
/// Paths up to which a cell is young, as in `include/cell_table.glsl`.
const YOUNG: f32 = 32.0;

/// Edge of the smallest cells, metres, in scenes larger than a room.
const CELL: f32 = 0.25;
/// Smallest number of cells along the diagonal of a scene.
const CELLS_ACROSS: f32 = 40.0;
/// Distance from the eye within which cells are smallest, in their edges; they double with every doubling of the distance.
const NEAR_CELLS: f32 = 24.0;

/// Segments of a path before it ends in a cell.
const SEGMENTS: u32 = 4;
/// The same where surfaces emit light: rooms that lamps light are closed, and in white ones light is reflected often.
const SEGMENTS_OF_LAMPS: u32 = 8;

/// Rounds in which new cells are filled, whatever the budget.
const FIRST_ROUNDS: u32 = 16;

/// Most paths that the old mean of a cell counts for after a small change of the light.
const MOST_KEPT: f64 = 64.0;

/// How often light is reflected from surface to surface before it reaches the one in view.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Bounces {
    /// Without limit.
    #[default]
    All,
    /// At most this often; 0: not at all.
    UpTo(u32),
}

impl Bounces {
    /// Whether there are any.
    pub fn is_any(self) -> bool {
        self != Self::UpTo(0)
    }

    /// The bounces left after one.
    #[must_use]
    pub fn after_one(self) -> Self {
        match self {
            Self::All => Self::All,
            Self::UpTo(count) => Self::UpTo(count.saturating_sub(1)),
        }
    }
}

gpu_struct! {
    /// The light of a moment and the grid of cells, see `include/scene_light.glsl`.
    pub struct SceneBlock: scene of
        CELLS_SEED_COMP, CELLS_PLACE_COMP, CELLS_UPDATE_COMP, CELLS_PUBLISH_COMP, BOUNCES_GATHER_COMP, CELLS_AMBIENT_FRAG,
        CELLS_AMBIENT_COMP, LOBES_FRAG_CELLS, LOBES_COMP_CELLS {
        eye: Vec3,
        cell: f32,
        near: f32,
        sun_direction: Vec3,
        sun_illuminance: Vec3,
        sun_tan_radius: f32,
        seed: u32,
        frame: u32,
    }
}

gpu_struct! {
    /// Number of paths.
    pub struct SeedPush: push of CELLS_SEED_COMP {
        paths: u32,
    }
}

gpu_struct! {
    /// Number of candidates.
    pub struct PlacePush: push of CELLS_PLACE_COMP {
        candidates: u32,
    }
}

gpu_struct! {
    /// What an update does.
    pub struct UpdatePush: push of CELLS_UPDATE_COMP {
        segments: u32,
        ends_in_cell: u32,
        paths: u32,
        first: u32,
        turns: u32,
        young: u32,
        seen: u32,
        most: f32,
        sky_change: Vec3,
        bounce_change: Vec3,
    }
}

gpu_struct! {
    /// The cells to publish.
    pub struct PublishPush: push of CELLS_PUBLISH_COMP {
        first: u32,
        turns: u32,
    }
}

/// The light that the cells hold.
#[derive(Clone, PartialEq)]
struct Held {
    daylight: Daylight,
    bounces: Bounces,
}

/// The passes of the cells, their table and their published images.
pub struct Cells {
    seed: u32,
    cell: f32,
    claim: Pipeline,
    place: Pipeline,
    update: Pipeline,
    publish: Pipeline,
    table: Buffer,
    places: Buffer,
    contests: Buffer,
    sums: Buffer,
    cells: Image,
    planes: Image,
    /// Of the passes over the live cells.
    invocations: u32,
    held: Option<Held>,
    /// Rounds so far.
    round: u32,
    /// Least number of paths that the mean of a cell counts for, except for cells created since the light jumped.
    grown: f32,
    /// The view of the whole picture for which they were last filled anew.
    filled_for: Option<ViewBlock>,
}

/// The work of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Work {
    /// Forget all cells, then as many rounds as fill new ones.
    Anew,
    /// Rounds in which every cell gets a path, and few cells get several: the same ones in every run.
    Rounds(u32),
    /// A round of about so many paths. If there are more cells, each gets one in turn.
    Paths(u32),
}

/// What a round needs to know about the scene and its light.
#[derive(Clone, Copy)]
pub struct Surroundings<'a> {
    /// The hierarchy of the scene.
    pub tree: &'a Tree,
    /// The view, of which the whole picture counts.
    pub view: &'a View,
    /// Sun and sky.
    pub daylight: &'a Daylight,
    /// Radiance L of sky and ground, kcd/m².
    pub sky_radiance: &'a Image,
}

impl<'a> Surroundings<'a> {
    /// A scene, its view, sun and sky, and the radiance of the sky, kcd/m².
    pub fn new(tree: &'a Tree, view: &'a View, daylight: &'a Daylight, sky: &'a Image) -> Self {
        Self {
            tree,
            view,
            daylight,
            sky_radiance: sky,
        }
    }
}

impl Cells {
    /// Creates the passes for a scene.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(
        context: &Arc<Context>,
        tree: &TreeFacts,
        bounds: &Bounds,
        seed: u32,
    ) -> Result<Self> {
        let traces = tree.constants();
        let pipeline = |name, shader, constants: &[_]| compute(context, name, shader, constants);
        let buffer = |name, words: u32| {
            Buffer::new(context, name, BufferKind::Storage, 4 * u64::from(words))
        };
        let size = [SLOT_COLUMNS, SLOTS / SLOT_COLUMNS];
        let image = |name| {
            Image::new(
                context,
                &ImageDesc::flat(name, Format::R32G32B32A32_UINT, size).stored(),
            )
        };
        Ok(Self {
            seed,
            cell: CELL.min(bounds.extent().length() / CELLS_ACROSS).max(1e-6),
            claim: pipeline("cells: seed", &shaders::CELLS_SEED_COMP, &traces)?,
            place: pipeline("cells: place", &shaders::CELLS_PLACE_COMP, &traces)?,
            update: pipeline(
                "cells: update",
                &shaders::CELLS_UPDATE_COMP,
                &tree.constants_with_emitters(),
            )?,
            publish: pipeline("cells: publish", &shaders::CELLS_PUBLISH_COMP, &[])?,
            // Prints, stamps, the numbers of cells in view and of live ones, these.
            table: buffer("table of cells", 3 * SLOTS + 2)?,
            places: buffer(
                "points and walls of cells",
                SLOTS * (POINTS * POINT_BYTES + WALL_BYTES) / 4,
            )?,
            contests: buffer(
                "contests of cells",
                SLOTS * CONTESTS + PATHS * PATH_POINTS * CANDIDATE_BYTES / 4,
            )?,
            sums: buffer("sums of cells", SLOTS * SUM_BYTES / 4)?,
            cells: image("cells")?,
            planes: image("cells: walls and gradients")?,
            invocations: if context.summary().is_software() {
                INVOCATIONS_OF_SOFTWARE
            } else {
                INVOCATIONS
            },
            held: None,
            round: 0,
            grown: 0.0,
            filled_for: None,
        })
    }

    /// Empties the table.
    fn clear(&mut self, recorder: &mut Recorder) {
        for buffer in [&self.table, &self.sums] {
            recorder.fill(buffer, 0);
        }
        recorder.fill(&self.contests, u32::MAX);
        for image in [&self.cells, &self.planes] {
            recorder.clear(image, [0.0; 4]);
        }
        (self.round, self.grown) = (0, 0.0);
    }

    /// Records the work of a frame: creates cells in view and beyond, and adds paths to them. Light that has changed starts from the
    /// old one.
    pub fn record(
        &mut self,
        recorder: &mut Recorder,
        around: &Surroundings<'_>,
        bounces: Bounces,
        work: Work,
    ) {
        let held = Held {
            daylight: around.daylight.clone(),
            bounces,
        };
        let view = around.view.whole().block();
        let is_filled = self.filled_for == Some(view) && self.round == FIRST_ROUNDS;
        if work == Work::Anew && is_filled && self.held.as_ref() == Some(&held) {
            // A tile or a layer of the same picture.
            return;
        }
        let is_other = self.held.as_ref().is_none_or(|old| old.bounces != bounces);
        if is_other || work == Work::Anew {
            self.clear(recorder);
            self.held = None;
            self.filled_for = (work == Work::Anew).then_some(view);
        }
        let old = self.held.as_ref();
        let change = old.map_or(0.0, |old| change(&old.daylight, around.daylight));
        let (rounds, seeds, paths) = self.work(work, change > 0.0);
        for _ in 0..rounds {
            let mut update = update_push(self.held.as_ref(), &held, around.tree.is_emissive());
            if let Some(paths) = paths {
                // What is in view is seen itself, in proportion to its share of the picture; the others light it.
                update.seen = paths / 2;
                update.paths = paths - update.seen;
                update.turns = update.paths;
                update.first = self.round.wrapping_mul(update.turns);
                update.young = if self.grown < YOUNG {
                    PATHS_OF_ALL_YOUNG
                } else {
                    YOUNG_PATHS
                };
            }
            self.grown = self.grown.min(update.most) + update.young as f32;
            self.held = Some(held.clone());
            self.seed(recorder, around, seeds);
            self.update(recorder, around, &update);
            self.publish(recorder, around, &update);
            self.round += 1;
        }
    }

    /// Rounds, paths from the eye in each, and paths from the cells unless every cell gets one.
    fn work(&self, work: Work, is_changed: bool) -> (u32, u32, Option<u32>) {
        let seeds = |paths: u32| (paths / PATH_POINTS).clamp(1, PATHS);
        match work {
            Work::Anew => (FIRST_ROUNDS, PATHS, None),
            // What few previews, or none of this light, have begun is filled before it is averaged.
            Work::Rounds(rounds) => {
                let missing = FIRST_ROUNDS.saturating_sub(self.round);
                (rounds.max(missing), PATHS, None)
            }
            // New cells are filled at once.
            Work::Paths(_) if self.round < FIRST_ROUNDS => (1, PATHS, None),
            // All cells follow the light.
            Work::Paths(paths) if is_changed => (1, seeds(paths), None),
            Work::Paths(0) => (0, 0, None),
            Work::Paths(paths) => (1, seeds(paths), Some(paths)),
        }
    }

    /// Rounds since the cells were last cleared.
    pub fn rounds(&self) -> u32 {
        self.round
    }

    /// The shader's block.
    pub(in crate::passes) fn block(&self, view: &View, daylight: &Daylight) -> SceneBlock {
        let direct = daylight.direct_light();
        SceneBlock {
            eye: view.camera.eye,
            cell: self.cell,
            near: self.cell * NEAR_CELLS,
            sun_direction: direct.direction.as_vec3(),
            sun_illuminance: kilo(direct.illuminance),
            sun_tan_radius: SUN_ANGULAR_RADIUS.tan() as f32,
            seed: self.seed,
            frame: self.round,
        }
    }

    /// The published cells, see `include/cells.glsl`.
    pub fn image(&self) -> &Image {
        &self.cells
    }

    /// Binds the published cells to a pass that looks them up.
    pub(in crate::passes) fn bound_to<'r>(&'r self, pass: Pass<'r>) -> Pass<'r> {
        pass.sample("cells", &self.cells, Sampler::Nearest).sample(
            "cell_planes",
            &self.planes,
            Sampler::Nearest,
        )
    }

    fn seed(&self, recorder: &mut Recorder, around: &Surroundings<'_>, paths: u32) {
        let view = around.view.whole();
        let pass = recorder.pass("cells: seed", &self.claim);
        around
            .tree
            .bound_to(pass)
            .uniform("view", &view.block())
            .uniform("scene", &self.block(&view, around.daylight))
            .storage_mut("Table", &self.table)
            .storage_mut("Places", &self.places)
            .storage_mut("Contests", &self.contests)
            .push(&SeedPush { paths })
            .dispatch_over([paths, 1, 1]);
        let candidates = paths * PATH_POINTS;
        let pass = recorder.pass("cells: place", &self.place);
        around
            .tree
            .bound_to(pass)
            .uniform("scene", &self.block(&view, around.daylight))
            .storage_mut("Table", &self.table)
            .storage_mut("Places", &self.places)
            .storage_mut("Contests", &self.contests)
            .storage_mut("Sums", &self.sums)
            .push(&PlacePush { candidates })
            .dispatch_over([candidates, 1, 1]);
    }

    fn update(&self, recorder: &mut Recorder, around: &Surroundings<'_>, push: &UpdatePush) {
        let pass = recorder.pass("cells: update", &self.update);
        let pass = around.tree.bound_with_emitters(pass);
        self.bound_to(pass)
            .uniform("scene", &self.block(around.view, around.daylight))
            .sample("sky_radiance", around.sky_radiance, Sampler::Linear)
            .storage_mut("Table", &self.table)
            .storage_mut("Places", &self.places)
            .storage_mut("Sums", &self.sums)
            .push(push)
            .dispatch_over([self.invocations, 1, 1]);
    }

    fn publish(&self, recorder: &mut Recorder, around: &Surroundings<'_>, update: &UpdatePush) {
        recorder
            .pass("cells: publish", &self.publish)
            .push(&PublishPush {
                first: update.first,
                turns: update.turns,
            })
            .uniform("scene", &self.block(around.view, around.daylight))
            .storage_mut("Table", &self.table)
            .storage_mut("Places", &self.places)
            .storage_mut("Contests", &self.contests)
            .storage_mut("Sums", &self.sums)
            .store("cells", &self.cells)
            .store("cell_planes", &self.planes)
            .dispatch_over([self.invocations, 1, 1]);
    }
}

/// Paths that the old mean of a cell counts for after a change of the light, above 0.
fn kept(change: f64) -> f32 {
    (1.0 / change - 1.0).clamp(0.0, MOST_KEPT) as f32
}

/// The update that brings cells from the light that they hold to a new one. `is_emissive`: lamps light the scene, and their light
/// does not follow that of the sky.
fn update_push(old: Option<&Held>, new: &Held, is_emissive: bool) -> UpdatePush {
    let (segments, ends_in_cell) = match new.bounces {
        Bounces::All if is_emissive => (SEGMENTS_OF_LAMPS, 1),
        Bounces::All => (SEGMENTS, 1),
        Bounces::UpTo(count) => (count, 0),
    };
    let changed = old.filter(|old| old.daylight != new.daylight);
    let factor = |of: fn(&Daylight) -> DVec3| {
        changed.map_or(Vec3::ONE, |old| ratio(of(&new.daylight), of(&old.daylight)))
    };
    let kept = changed.map(|old| kept(change(&old.daylight, &new.daylight)));
    UpdatePush {
        segments,
        ends_in_cell,
        paths: UPDATES,
        first: 0,
        turns: u32::MAX,
        // A round of all cells is one of many.
        young: 1,
        seen: SEEN_UPDATES,
        most: kept.unwrap_or(f32::MAX),
        sky_change: factor(|day| day.sky_irradiance_up),
        bounce_change: if is_emissive {
            Vec3::ONE
        } else {
            factor(Daylight::horizontal)
        },
    }
}
