//! OBJ files: read by `tobj` after [`super::obj_text`] has checked the lines, then triangulated into a [`Soup`].

use std::collections::HashMap;
use std::io::{BufRead, Read};
use std::path::Path;

use glam::{Affine3A, Vec2, Vec3};

use super::builder::Builder;
use super::error::SceneError;
use super::material::{Libraries, MTL_DEFAULT};
use super::obj_text::{self, Cleaned, EXTRA_LINES, FaceInfo};
use super::soup::{Corner, Dropped, NONE, Soup, Triangle};
use super::triangulate::triangulate;

/// Polygons stay polygons (ours are split in their own plane), and normals and texture coordinates keep their own numbers.
const TOBJ: tobj::LoadOptions = tobj::LoadOptions {
    single_index: false,
    triangulate: false,
    ignore_points: true,
    ignore_lines: true,
};

/// How a mesh stands in the world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Placement {
    pub world_from_mesh: Affine3A,
    /// Smooths corners without a normal below this crease angle, degrees.
    pub smooth_deg: Option<f32>,
}

/// Adds the model of `path` to the scene.
///
/// # Errors
/// A file that cannot be read, a line that makes no sense, or nothing to draw.
pub(super) fn append_obj(
    builder: &mut Builder,
    path: &Path,
    placement: &Placement,
) -> Result<(), SceneError> {
    builder.progress.at(0.0, "reading");
    let text = builder.files.read_text(path)?;
    builder.progress.at(0.1, "parsing");
    let malformed = |line, what| SceneError::Malformed {
        path: path.to_owned(),
        line,
        what,
    };
    let cleaned = obj_text::clean(&text).map_err(|e| malformed(e.line, e.what))?;
    drop(text);
    let folder = path.parent().unwrap_or(Path::new(""));
    builder.progress.at(0.4, "reading materials");
    let libraries = Libraries::read(builder, path, folder, &cleaned.libraries);
    let (models, materials) =
        parse(&cleaned, &libraries).map_err(|(line, what)| malformed(line, what))?;
    warn_of_unknown(builder, path, &cleaned, &materials);
    let mut soup = Soup::default();
    let mut undrawn = Undrawn::default();
    let mut numbers = MaterialNumbers {
        libraries: &libraries,
        materials: &materials,
        known: HashMap::new(),
    };
    let mut faces = cleaned.faces.iter();
    for model in &models {
        let material = numbers.of(builder, path, model.mesh.material_id);
        append_model(&mut soup, &model.mesh, material.unwrap_or(NONE), &mut faces);
    }
    builder.progress.at(0.7, "building the mesh");
    soup.triangles.retain(|t| undrawn.keep(t.material));
    finish(builder, path, soup, placement, &cleaned, undrawn)
}

fn finish(
    builder: &mut Builder,
    path: &Path,
    mut soup: Soup,
    placement: &Placement,
    cleaned: &Cleaned,
    undrawn: Undrawn,
) -> Result<(), SceneError> {
    soup.transform(&placement.world_from_mesh);
    let (dropped, faces) = soup.sweep();
    let left_out = left_out(dropped, cleaned, undrawn);
    if soup.triangles.is_empty() {
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
    let fits = soup.append_to(&mut builder.scene, &faces, placement.smooth_deg);
    let what = "more than 4294967295 vertices in one scene; use fewer or smaller meshes";
    fits.then_some(()).ok_or_else(|| SceneError::Unsupported {
        path: path.to_owned(),
        what: what.to_owned(),
    })
}

fn left_out(dropped: Dropped, cleaned: &Cleaned, undrawn: Undrawn) -> Vec<String> {
    let rows = [
        (
            dropped.not_finite,
            "triangles with infinite, NaN or absurdly large positions dropped",
        ),
        (dropped.degenerate, "triangles without area dropped"),
        (
            undrawn.0,
            "triangles of transparent materials (d < 0.5) left undrawn",
        ),
        (
            cleaned.not_faces,
            "points, lines and faces of fewer than three corners skipped",
        ),
        (
            cleaned.dangling,
            "faces name normals or texture coordinates that do not exist; computed instead",
        ),
    ];
    rows.into_iter()
        .filter(|(n, _)| *n > 0)
        .map(|(n, what)| format!("{n} {what}"))
        .collect()
}

/// Counts the triangles that an opaque renderer treats as cut out.
#[derive(Debug, Default, Clone, Copy)]
struct Undrawn(usize);

impl Undrawn {
    fn keep(&mut self, material: u32) -> bool {
        self.0 += usize::from(material == NONE);
        material != NONE
    }
}

type Parsed = (Vec<tobj::Model>, Vec<tobj::Material>);

fn parse(cleaned: &Cleaned, libraries: &Libraries) -> Result<Parsed, (usize, String)> {
    let mut reader = LineCounter {
        rest: cleaned.text.as_bytes(),
        lines: 0,
    };
    let read = tobj::load_obj_buf(&mut reader, &TOBJ, |_| {
        tobj::load_mtl_buf(&mut libraries.text.as_bytes())
    });
    let line = reader.lines.saturating_sub(EXTRA_LINES);
    let failed = |error: tobj::LoadError| (line, describe(error));
    let (models, materials) = read.map_err(failed)?;
    Ok((models, materials.map_err(failed)?))
}

fn describe(error: tobj::LoadError) -> String {
    match error {
        tobj::LoadError::PositionParseError => "a vertex position is not a number".to_owned(),
        tobj::LoadError::NormalParseError => "a normal is not a number".to_owned(),
        tobj::LoadError::TexcoordParseError => "a texture coordinate is not a number".to_owned(),
        other => other.to_string(),
    }
}

/// Knows which line is being read, for messages.
struct LineCounter<'a> {
    rest: &'a [u8],
    lines: usize,
}

impl Read for LineCounter<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let n = (&mut &*self.rest).read(buffer)?;
        self.consume(n);
        Ok(n)
    }
}

impl BufRead for LineCounter<'_> {
    fn fill_buf(&mut self) -> std::io::Result<&[u8]> {
        Ok(self.rest)
    }

    fn consume(&mut self, n: usize) {
        let (read, rest) = self.rest.split_at(n.min(self.rest.len()));
        self.lines += read.iter().filter(|byte| **byte == b'\n').count();
        self.rest = rest;
    }
}

/// From `tobj`'s numbers to the scene's; each material is made when it is first used.
struct MaterialNumbers<'a> {
    libraries: &'a Libraries,
    materials: &'a [tobj::Material],
    known: HashMap<Option<usize>, Option<u32>>,
}

impl MaterialNumbers<'_> {
    /// None for a material that is not drawn.
    fn of(&mut self, builder: &mut Builder, path: &Path, id: Option<usize>) -> Option<u32> {
        if let Some(known) = self.known.get(&id) {
            return *known;
        }
        let found = id.and_then(|i| self.materials.get(i));
        let number = match found {
            Some(source) => {
                let material = self.libraries.material(builder, path, source);
                (material.dissolve >= 0.5).then(|| builder.add_material(material))
            }
            None => Some(builder.add_material(MTL_DEFAULT.clone())),
        };
        self.known.insert(id, number);
        number
    }
}

fn warn_of_unknown(
    builder: &mut Builder,
    path: &Path,
    cleaned: &Cleaned,
    materials: &[tobj::Material],
) {
    let unknown: Vec<&str> = cleaned
        .materials
        .iter()
        .map(String::as_str)
        .filter(|name| !materials.iter().any(|m| m.name == *name))
        .collect();
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

fn append_model<'a>(
    soup: &mut Soup,
    mesh: &tobj::Mesh,
    material: u32,
    faces: &mut impl Iterator<Item = &'a FaceInfo>,
) {
    let first = [
        soup.positions.len(),
        soup.texcoords.len(),
        soup.normals.len(),
    ]
    .map(|n| n as u32);
    soup.positions
        .extend(mesh.positions.chunks_exact(3).map(Vec3::from_slice));
    soup.texcoords
        .extend(mesh.texcoords.chunks_exact(2).map(Vec2::from_slice));
    soup.normals
        .extend(mesh.normals.chunks_exact(3).map(Vec3::from_slice));
    let mut start = 0;
    let all_triangles = std::iter::repeat_n(3, mesh.indices.len() / 3);
    let arities: Box<dyn Iterator<Item = usize>> = if mesh.face_arities.is_empty() {
        Box::new(all_triangles)
    } else {
        Box::new(mesh.face_arities.iter().map(|n| *n as usize))
    };
    for (arity, info) in arities.zip(faces) {
        let corners: Vec<Corner> = (start..start + arity)
            .map(|i| corner(mesh, i, first, *info))
            .collect();
        start += arity;
        append_face(soup, &corners, material, info.smoothing);
    }
}

fn corner(mesh: &tobj::Mesh, i: usize, first: [u32; 3], info: FaceInfo) -> Corner {
    let pick = |wanted: bool, list: &[u32], first: u32| match list.get(i) {
        Some(index) if wanted => first + index,
        _ => NONE,
    };
    Corner {
        position: pick(true, &mesh.indices, first[0]),
        texcoord: pick(info.texcoords, &mesh.texcoord_indices, first[1]),
        normal: pick(info.normals, &mesh.normal_indices, first[2]),
    }
}

fn append_face(soup: &mut Soup, corners: &[Corner], material: u32, smoothing: u32) {
    let push = |soup: &mut Soup, t: [usize; 3]| {
        soup.triangles.push(Triangle {
            corners: t.map(|i| corners[i]),
            material,
            smoothing,
        });
    };
    if corners.len() == 3 {
        return push(soup, [0, 1, 2]);
    }
    let points: Vec<_> = corners
        .iter()
        .map(|c| soup.position(*c).as_dvec3())
        .collect();
    triangulate(&points).into_iter().for_each(|t| push(soup, t));
}
