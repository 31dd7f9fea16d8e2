//! Loading of OBJ models.

mod lines;
mod map_options;
mod mtl;
mod mtl_material;
mod text;

use std::path::Path;

use glam::{Affine2, DAffine3, DVec3};

use crate::scene::builder::Builder;
use crate::scene::error::SceneError;
use crate::scene::losses::{Losses, shortened};
use crate::scene::material::{MTL_DEFAULT, Material};
use crate::scene::mesh::arena::append_soup;
use crate::scene::mesh::soup::{Dropped, MaterialUse, NONE, Soup};
use crate::scene::obj::mtl::Libraries;
use crate::scene::obj::text::ObjText;
use crate::scene::origin;
use crate::scene::placement::Placement;
use crate::scene::texture::linear_from_srgb;

/// Longest path and list of reasons why there is nothing to draw, characters: what is around them makes a line of 200.
const MAX_REASONS: usize = 150;
/// What is left for the reasons, however long the path is.
const MIN_REASONS: usize = 60;

/// Adds the model at `path` to the scene.
///
/// # Errors
/// When a file cannot be read, a limit is exceeded, or there is nothing to draw.
pub fn append_obj(
    builder: &mut Builder,
    path: &Path,
    placement: &Placement,
) -> Result<(), SceneError> {
    builder.progress.at(0.0, "reading");
    let text = builder.files.read_text(path)?;
    builder.progress.at(0.1, "parsing");
    let world_from_mesh = placement.world_from_mesh;
    let origin = choose_origin(builder, path, &text, world_from_mesh);
    let parsed = text::read(&text, builder.threads, origin);
    drop(text);
    builder.progress.at(0.5, "reading materials");
    let folder = path.parent().unwrap_or(Path::new(""));
    let libraries = Libraries::read(builder, path, folder, &parsed);
    warn_of_undefined(builder, path, &parsed.materials, &libraries);
    let ObjText {
        mut soup,
        materials,
        not_faces,
        dangling,
        sevens,
        losses,
        ..
    } = parsed;
    // Checked before the polygons are split, because a polygon's triangles take few bytes in the file.
    builder.check_triangles(path, soup.count())?;
    soup.triangulate();
    finish_colours(&mut soup, sevens);
    let uses: Vec<MaterialUse> = materials
        .iter()
        .map(|name| material_use(builder, path, &libraries, name, &soup))
        .collect();
    builder.progress.at(0.6, "building the mesh");
    let mut report = ImportReport {
        not_faces,
        dangling,
        losses,
        ..ImportReport::default()
    };
    report.undrawn = drop_undrawn(&mut soup, &uses);
    soup.transform(&builder.scene_from_world(world_from_mesh, origin));
    let (dropped, faces) = soup.drop_unusable();
    report.dropped = dropped;
    report.finish(builder, path, soup.triangles.is_empty())?;
    append_soup(
        &mut builder.scene,
        &soup,
        &faces,
        &uses,
        placement.smooth_deg,
    );
    Ok(())
}

/// The point that the positions of a file are read relative to, in the file's coordinates.
fn choose_origin(
    builder: &mut Builder,
    path: &Path,
    text: &str,
    world_from_mesh: DAffine3,
) -> DVec3 {
    let mut points = text::sample(text);
    points.retain(|point| point.is_finite());
    let origin = origin::middle(&mut points).origin();
    let place = |point: &DVec3| world_from_mesh.transform_point3(*point);
    let mut points: Vec<DVec3> = points.iter().map(place).collect();
    builder.choose_origin(path, &mut points);
    origin
}

/// Counts of elements that are not drawn, or not drawn as specified in the file.
#[derive(Debug, Default)]
pub struct ImportReport {
    pub dropped: Dropped,
    /// Triangles of transparent materials.
    pub undrawn: usize,
    /// Points, lines, curves, and faces with fewer than three corners.
    pub not_faces: usize,
    /// Faces with out-of-range indices.
    pub dangling: usize,
    /// Parts that cannot be read.
    pub losses: Losses,
}

impl ImportReport {
    /// Adds a warning for each nonzero count; fails with them instead if the model is `empty`.
    pub fn finish(
        &self,
        builder: &mut Builder,
        path: &Path,
        empty: bool,
    ) -> Result<(), SceneError> {
        let left_out = self.lines();
        if empty {
            let why = if left_out.is_empty() {
                String::new()
            } else {
                let most = MAX_REASONS.saturating_sub(path.as_os_str().len());
                let reasons = left_out.join("; ");
                format!(" ({})", shortened(&reasons, most.max(MIN_REASONS)))
            };
            return Err(SceneError::NoTriangles {
                path: path.to_owned(),
                why,
            });
        }
        left_out
            .into_iter()
            .for_each(|what| builder.warn(path, &what));
        Ok(())
    }

    fn lines(&self) -> Vec<String> {
        let rows = [
            (
                self.dropped.not_finite,
                "triangles with infinite, NaN or very large coordinates dropped",
            ),
            (self.dropped.degenerate, "triangles without area dropped"),
            (
                self.undrawn,
                "triangles of transparent materials (d < 0.5) not drawn",
            ),
            (
                self.not_faces,
                "points, lines, curves and faces of fewer than three corners skipped",
            ),
            (
                self.dangling,
                "faces refer to normals or texture coordinates that do not exist; computed instead",
            ),
        ];
        let counted = rows.into_iter().filter(|(n, _)| *n > 0);
        let counted = counted.map(|(n, what)| format!("{n} {what}"));
        self.losses.lines().chain(counted).collect()
    }
}

/// Looks up a material by name; its index is [`NONE`] if it is not drawn.
fn material_use(
    builder: &mut Builder,
    path: &Path,
    libraries: &Libraries,
    name: &str,
    soup: &Soup,
) -> MaterialUse {
    let defined = libraries.material(builder, path, name);
    let (material, texture_from_mesh) =
        defined.unwrap_or_else(|| (default_material(soup), Affine2::IDENTITY));
    MaterialUse {
        has_normal_map: material.normal_texture.is_some(),
        index: if material.is_drawn() {
            builder.add_material(material)
        } else {
            NONE
        },
        texture_from_mesh,
    }
}

/// Grey, or white if the vertices have colours.
fn default_material(soup: &Soup) -> Material {
    let mut material = MTL_DEFAULT.clone();
    if !soup.colours.is_empty() {
        material.diffuse = [1.0; 3];
    }
    material
}

fn drop_undrawn(soup: &mut Soup, uses: &[MaterialUse]) -> usize {
    let before = soup.triangles.len();
    soup.triangles
        .retain(|t| uses[t.material as usize].index != NONE);
    before - soup.triangles.len()
}

/// Converts vertex colours to linear light. OBJ does not define their encoding; in practice files contain sRGB, 0..1 (or 0..255
/// if any value exceeds 1). Colours that are all white are dropped.
///
/// Of four numbers behind a position (`sevens` vertices have them), the first three are the colour and the last its opacity, which
/// is not used. If the first is 1 everywhere and the last is not, the first is a weight and the others are the colour.
fn finish_colours(soup: &mut Soup, sevens: usize) {
    let is_weight = |c: &[f32; 4]| c[0] == 1.0;
    if sevens > 0 && soup.colours.iter().all(is_weight) && soup.colours.iter().any(|c| c[3] != 1.0)
    {
        soup.colours.iter_mut().for_each(|c| c.rotate_left(1));
    }
    let rgb = |c: &[f32; 4]| [c[0], c[1], c[2]];
    if soup.colours.iter().all(|c| rgb(c) == [1.0; 3]) {
        soup.colours = Vec::new();
        return;
    }
    let largest = soup.colours.iter().flat_map(rgb).fold(0.0, f32::max);
    let scale = if largest > 1.0 { 1.0 / 255.0 } else { 1.0 };
    for colour in &mut soup.colours {
        let [r, g, b] = rgb(colour).map(|v| linear_from_srgb((v * scale).clamp(0.0, 1.0)));
        *colour = [r, g, b, 1.0];
    }
}

/// Names are told in one line, whatever is in them.
fn warn_of_undefined(
    builder: &mut Builder,
    path: &Path,
    materials: &[String],
    libraries: &Libraries,
) {
    let names = materials.iter().map(String::as_str);
    let mut undefined: Vec<&str> = names
        .filter(|n| !n.is_empty() && !libraries.has(n))
        .collect();
    undefined.sort_unstable();
    if let [first, rest @ ..] = undefined.as_slice() {
        let more = if rest.is_empty() {
            String::new()
        } else {
            format!(" and {} more", rest.len())
        };
        let first = shortened(first, 60);
        let what = format!("material \"{first}\"{more} not defined; drawn grey");
        builder.warn(path, &what);
    }
}
