//! OBJ files as parts of a scene.

mod lines;
mod map_options;
mod mtl;
mod text;

use std::path::Path;

use glam::{Affine2, Affine3A};

use crate::scene::builder::Builder;
use crate::scene::error::SceneError;
use crate::scene::material::{MTL_DEFAULT, Material};
use crate::scene::mesh::arena::append_soup;
use crate::scene::mesh::soup::{Dropped, NONE, Soup, Use};
use crate::scene::obj::mtl::{Libraries, Placed};
use crate::scene::obj::text::ObjText;
use crate::scene::texture::light;

/// How a mesh stands in the world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::scene) struct Placement {
    pub world_from_mesh: Affine3A,
    /// Smooths corners without a normal below this crease angle, degrees.
    pub smooth_deg: Option<f32>,
}

/// Adds the model of `path` to the scene.
///
/// # Errors
/// A file that cannot be read, a line that makes no sense, or nothing to draw.
pub(in crate::scene) fn append_obj(
    builder: &mut Builder,
    path: &Path,
    placement: &Placement,
) -> Result<(), SceneError> {
    builder.progress.at(0.0, "reading");
    let text = builder.files.read_text(path)?;
    builder.progress.at(0.1, "parsing");
    let read = text::read(&text, builder.threads).map_err(|e| SceneError::Malformed {
        path: path.to_owned(),
        line: e.line,
        what: e.what,
    })?;
    drop(text);
    builder.progress.at(0.5, "reading materials");
    let folder = path.parent().unwrap_or(Path::new(""));
    let libraries = Libraries::read(builder, path, folder, &read.libraries);
    warn_of_unknown(builder, path, &read.materials, &libraries);
    let ObjText {
        mut soup,
        materials,
        not_faces,
        dangling,
        ..
    } = read;
    // Before they are made: a polygon has few bytes for each of its triangles.
    builder.check_room(path, soup.count())?;
    soup.triangulate();
    finish_colours(&mut soup);
    let uses: Vec<Use> = materials
        .iter()
        .map(|name| use_of(builder, path, &libraries, name, &soup))
        .collect();
    builder.progress.at(0.6, "building the mesh");
    let mut odd = Odd {
        not_faces,
        dangling,
        ..Odd::default()
    };
    odd.undrawn = drop_undrawn(&mut soup, &uses);
    soup.transform(&placement.world_from_mesh);
    let (dropped, faces) = soup.sweep();
    odd.dropped = dropped;
    odd.report(builder, path, soup.triangles.is_empty())?;
    append_soup(
        &mut builder.scene,
        &soup,
        &faces,
        &uses,
        placement.smooth_deg,
    );
    Ok(())
}

/// What is not drawn, or not as the file says.
#[derive(Debug, Default, Clone, Copy)]
pub(in crate::scene) struct Odd {
    pub dropped: Dropped,
    /// Triangles of materials that nobody would see.
    pub undrawn: usize,
    /// Points, lines and the like.
    pub not_faces: usize,
    /// Faces with numbers that lead nowhere.
    pub dangling: usize,
}

impl Odd {
    /// Warns of it, or fails with it where nothing is left to draw.
    pub fn report(
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
                format!(" ({})", left_out.join("; "))
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
                "triangles with infinite, NaN or absurdly large positions dropped",
            ),
            (self.dropped.degenerate, "triangles without area dropped"),
            (
                self.undrawn,
                "triangles of transparent materials (d < 0.5) left undrawn",
            ),
            (
                self.not_faces,
                "points, lines and faces of fewer than three corners skipped",
            ),
            (
                self.dangling,
                "faces name normals or texture coordinates that do not exist; computed instead",
            ),
        ];
        rows.into_iter()
            .filter(|(n, _)| *n > 0)
            .map(|(n, what)| format!("{n} {what}"))
            .collect()
    }
}

/// The scene's material of this name, made at first use; the number is [`NONE`] if it is not drawn.
fn use_of(
    builder: &mut Builder,
    path: &Path,
    libraries: &Libraries,
    name: &str,
    soup: &Soup,
) -> Use {
    let placed = libraries.material(builder, path, name);
    let Placed {
        material,
        texture_from_mesh,
    } = placed.unwrap_or_else(|| Placed {
        material: without_material(soup),
        texture_from_mesh: Affine2::IDENTITY,
    });
    Use {
        tangents: material.normal_texture.is_some(),
        number: if material.is_drawn() {
            builder.add_material(material)
        } else {
            NONE
        },
        texture_from_mesh,
    }
}

/// Grey, or the colours of the vertices themselves.
fn without_material(soup: &Soup) -> Material {
    let mut material = MTL_DEFAULT.clone();
    if !soup.colours.is_empty() {
        material.diffuse = [1.0; 3];
    }
    material
}

fn drop_undrawn(soup: &mut Soup, uses: &[Use]) -> usize {
    let before = soup.triangles.len();
    soup.triangles
        .retain(|t| uses[t.material as usize].number != NONE);
    before - soup.triangles.len()
}

/// OBJ has no word for it, but its colours are meant for the screen: sRGB, 0..1 (or 0..255 if any is above 1). White
/// everywhere is no colour.
fn finish_colours(soup: &mut Soup) {
    let rgb = |c: &[f32; 4]| [c[0], c[1], c[2]];
    if soup.colours.iter().all(|c| rgb(c) == [1.0; 3]) {
        soup.colours = Vec::new();
        return;
    }
    let largest = soup.colours.iter().flat_map(rgb).fold(0.0, f32::max);
    let scale = if largest > 1.0 { 1.0 / 255.0 } else { 1.0 };
    for colour in &mut soup.colours {
        let [r, g, b] = rgb(colour).map(|v| light((v * scale).clamp(0.0, 1.0)));
        *colour = [r, g, b, 1.0];
    }
}

fn warn_of_unknown(
    builder: &mut Builder,
    path: &Path,
    materials: &[String],
    libraries: &Libraries,
) {
    let mut unknown: Vec<&str> = materials
        .iter()
        .map(String::as_str)
        .filter(|name| !name.is_empty() && !libraries.has(name))
        .collect();
    unknown.sort_unstable();
    if let [first, rest @ ..] = unknown.as_slice() {
        let more = if rest.is_empty() {
            String::new()
        } else {
            format!(" and {} more", rest.len())
        };
        builder.warn(
            path,
            &format!("material \"{first}\"{more} not defined; drawn grey"),
        );
    }
}
