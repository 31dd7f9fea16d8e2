//! OBJ files read by this program and by the crate `tobj`: the same triangles, corner by corner, bit for bit.
//!
//! Positions, normals, texture coordinates, colours and material names are compared. Where the two readers differ by
//! definition, the comparison is limited to what they have in common:
//!
//! - v points down here and up in the file: 1 − v.
//! - Normals have unit length here. For a corner without a normal this program computes one (flat, smoothing group or crease
//!   angle) and tobj gives none: such normals are not compared.
//! - Colours are sRGB in the file, and linear 16-bit numbers here.
//! - Concave polygons are ear-clipped here and split into a fan by tobj: the corners and the area vector are the same.
//! - Degenerate triangles, those with non-finite positions and those of transparent materials are dropped here.
//! - tobj scales a position by its weight w; it is ignored here, since it belongs to rational curves.

use std::collections::{BTreeSet, HashMap};
use std::fs;
use std::panic::catch_unwind;
use std::path::Path;

use glam::{DVec3, Vec3};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use skylight::scene::{LoadOptions, Scene, load};

use crate::support::files_below;

/// Points and lines are skipped, polygons are triangulated, all attributes share one index.
const TOBJ: tobj::LoadOptions = tobj::GPU_LOAD_OPTIONS;

/// Number of generated files.
const CASES: u32 = 400;

/// The parts of a file to which both readers give the same meaning.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Compared {
    All,
    /// All but texture coordinates.
    ExceptTexcoords,
    /// All but normals.
    ExceptNormals,
    /// All but material names.
    ExceptMaterials,
    /// Positions and material names only.
    Positions,
    /// Nothing.
    Nothing,
    /// Everything; triangles may differ in how a concave polygon is split.
    ExceptSplit,
}

/// A corner without its normal, as bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
struct Corner {
    position: [u32; 3],
    texcoord: [u32; 2],
    colour: [u16; 4],
}

/// Material name, and the corners in order.
type Triangle = (String, [Corner; 3]);
/// The normals of a triangle's corners.
type Normals = [[u32; 3]; 3];

/// Bit patterns of numbers; −0 becomes 0.
fn bits<const N: usize>(numbers: [f32; N]) -> [u32; N] {
    numbers.map(|x| (x + 0.0).to_bits())
}

fn corner(compared: Compared, position: [f32; 3], texcoord: [f32; 2], colour: [u16; 4]) -> Corner {
    let skipped = matches!(compared, Compared::ExceptTexcoords | Compared::Positions);
    let texcoord = if skipped { [0.0; 2] } else { texcoord };
    let skipped = compared == Compared::Positions;
    Corner {
        position: bits(position),
        texcoord: bits(texcoord),
        colour: if skipped { [0; 4] } else { colour },
    }
}

fn named(compared: Compared, name: &str) -> String {
    let skipped = compared == Compared::ExceptMaterials;
    if skipped { "" } else { name }.to_owned()
}

/// The triangles of a scene, each with the normals of all its duplicates.
fn ours(scene: &Scene, compared: Compared) -> HashMap<Triangle, Vec<Normals>> {
    let mut found: HashMap<Triangle, Vec<Normals>> = HashMap::new();
    for part in &scene.parts {
        let name = &scene.materials[part.material as usize].name;
        let range = part.first_index as usize..(part.first_index + part.index_count) as usize;
        for triangle in scene.indices[range].chunks_exact(3) {
            let vertices = [0, 1, 2].map(|i| triangle[i] as usize);
            let white = [u16::MAX; 4];
            let corners = vertices.map(|v| {
                let colour = scene.colours.get(v).copied().unwrap_or(white);
                corner(compared, in_file(scene, v), scene.texcoords[v], colour)
            });
            let normals = vertices.map(|v| bits(scene.normals[v]));
            let key = (named(compared, name), corners);
            found.entry(key).or_default().push(normals);
        }
    }
    found
}

/// The vertices of a tobj mesh, converted to this program's definitions.
struct Vertices<'m> {
    mesh: &'m tobj::Mesh,
    compared: Compared,
    /// Factor on colours: 1/255 if any colour of the file is above 1.
    colour_scale: f32,
}

impl Vertices<'_> {
    /// The `N` numbers of an attribute at a vertex; `None` if no corner of the mesh has the attribute.
    fn attribute<const N: usize>(&self, numbers: &[f32], v: usize) -> Option<[f32; N]> {
        let all = (!numbers.is_empty()).then(|| &numbers[N * v..N * v + N]);
        all.map(|all| std::array::from_fn(|i| all[i]))
    }

    fn corner(&self, v: usize) -> Corner {
        let mesh = self.mesh;
        let position = self.attribute(&mesh.positions, v).expect("positions");
        let [u, upward] = match self.compared {
            Compared::Positions => [0.0; 2],
            _ => self.attribute(&mesh.texcoords, v).unwrap_or([0.0; 2]),
        };
        let colour = match self.compared {
            Compared::Positions => None,
            _ => self.attribute::<3>(&mesh.vertex_color, v),
        };
        let channel = |c: f32| (linear((c * self.colour_scale).clamp(0.0, 1.0)) * 65_535.0).round();
        let [r, g, b] = colour.map_or([u16::MAX; 3], |c| c.map(|c| channel(c) as u16));
        let texcoord = [u, 1.0 - upward];
        corner(self.compared, position, texcoord, [r, g, b, u16::MAX])
    }

    /// The unit normal; `None` if the file has none, or a zero vector.
    fn normal(&self, v: usize) -> Option<[u32; 3]> {
        if matches!(self.compared, Compared::Positions | Compared::ExceptNormals) {
            return None;
        }
        let normal = self.attribute(&self.mesh.normals, v)?;
        Some(bits(Vec3::from(normal).try_normalize()?.to_array()))
    }
}

/// IEC 61966-2-1: sRGB signal to linear light.
fn linear(signal: f32) -> f32 {
    let signal = f64::from(signal);
    let light = if signal <= 0.04045 {
        signal / 12.92
    } else {
        ((signal + 0.055) / 1.055).powf(2.4)
    };
    light as f32
}

/// Rejects a mesh in which only some corners have an attribute: tobj does not tell which.
fn check_uniform(mesh: &tobj::Mesh, compared: Compared) -> Result<(), String> {
    let count = mesh.positions.len() / 3;
    let is_uniform = |numbers: &[f32], width: usize| [0, width * count].contains(&numbers.len());
    for (what, numbers, width) in [
        ("texture coordinates", &mesh.texcoords, 2),
        ("normals", &mesh.normals, 3),
        ("colours", &mesh.vertex_color, 3),
    ] {
        let skipped = match compared {
            Compared::ExceptNormals => what == "normals",
            _ => compared == Compared::Positions,
        };
        if !skipped && !is_uniform(numbers, width) {
            return Err(format!("only some corners of a mesh have {what}"));
        }
    }
    Ok(())
}

/// Triangles of tobj's models that this program draws, with their normals if the file has them.
fn theirs(
    models: &[tobj::Model],
    materials: &[tobj::Material],
    compared: Compared,
) -> Result<Vec<(Triangle, Option<Normals>)>, String> {
    let colours = models.iter().flat_map(|m| &m.mesh.vertex_color);
    let largest = colours.copied().fold(0.0, f32::max);
    let mut found = Vec::new();
    for mesh in models.iter().map(|model| &model.mesh) {
        check_uniform(mesh, compared)?;
        let material = mesh.material_id.map(|id| &materials[id]);
        let is_transparent = |m: &tobj::Material| m.dissolve.is_some_and(|d| d < 0.5);
        if material.is_some_and(is_transparent) {
            continue;
        }
        let name = material.map_or("", |m| &m.name);
        let vertices = Vertices {
            mesh,
            compared,
            colour_scale: if largest > 1.0 { 1.0 / 255.0 } else { 1.0 },
        };
        for triangle in mesh.indices.chunks_exact(3) {
            let numbers = [0, 1, 2].map(|i| triangle[i] as usize);
            let normals = numbers.map(|v| vertices.normal(v));
            let normals = match normals {
                [Some(a), Some(b), Some(c)] => Some([a, b, c]),
                _ => None,
            };
            let corners = numbers.map(|v| vertices.corner(v));
            found.push(((named(compared, name), corners), normals));
        }
    }
    Ok(found)
}

/// A position in the coordinates of the file.
fn in_file(scene: &Scene, vertex: usize) -> [f32; 3] {
    let position = scene.positions[vertex];
    if scene.origin == DVec3::ZERO {
        return position;
    }
    let relative = DVec3::from(position.map(f64::from));
    (scene.origin + relative).as_vec3().into()
}

/// Area vector of a triangle, doubled: along the normal, m².
fn area(triangle: &Triangle) -> DVec3 {
    let [a, b, c] = triangle
        .1
        .map(|c| Vec3::from(c.position.map(f32::from_bits)).as_dvec3());
    (b - a).cross(c - a)
}

/// Whether a triangle has finite positions and a height above 1e-10 of its longest edge.
fn is_drawn(triangle: &Triangle) -> bool {
    let [a, b, c] = triangle
        .1
        .map(|c| Vec3::from(c.position.map(f32::from_bits)).as_dvec3());
    let edges = [b - a, c - b, a - c].map(|edge| edge.length_squared());
    area(triangle).length() > 1e-10 * edges.into_iter().fold(0.0, f64::max)
}

/// Compares one file. Returns the number of triangles that agree, or the first difference.
fn compare(
    scene: &Scene,
    models: &[tobj::Model],
    materials: &[tobj::Material],
    compared: Compared,
) -> Result<usize, String> {
    let mut ours = ours(scene, compared);
    let all = theirs(models, materials, compared)?;
    // Triangles with normals come first: the others match any normals.
    let (with, without): (Vec<_>, Vec<_>) = all.into_iter().partition(|(_, n)| n.is_some());
    let (mut agreeing, mut only_theirs) = (0, Vec::new());
    for (triangle, normals) in with.into_iter().chain(without) {
        let candidates = ours.get_mut(&triangle);
        let agrees = |have: &Normals| normals.is_none_or(|want| *have == want);
        let found = candidates.and_then(|list| Some((list.iter().position(agrees)?, list)));
        match found {
            Some((at, list)) => {
                list.swap_remove(at);
                agreeing += 1;
            }
            None => only_theirs.push(triangle),
        }
    }
    only_theirs.retain(is_drawn);
    let left = ours.into_iter();
    let only_ours: Vec<Triangle> = left.flat_map(|(t, n)| vec![t; n.len()]).collect();
    if compared == Compared::ExceptSplit {
        same_polygons(&only_ours, &only_theirs)?;
        return Ok(agreeing + only_ours.len());
    }
    match (only_ours.first(), only_theirs.first()) {
        (None, None) => Ok(agreeing),
        (ours, theirs) => Err(format!(
            "{agreeing} agree, {} only here {ours:x?}, {} only by tobj {theirs:x?}",
            only_ours.len(),
            only_theirs.len()
        )),
    }
}

/// Checks that two sets of triangles can be triangulations of the same polygons.
fn same_polygons(ours: &[Triangle], theirs: &[Triangle]) -> Result<(), String> {
    if ours.is_empty() {
        return Err("no polygon is split differently".to_owned());
    }
    let corners = |set: &[Triangle]| -> BTreeSet<Corner> { set.iter().flat_map(|t| t.1).collect() };
    let sum = |set: &[Triangle]| set.iter().map(area).sum::<DVec3>();
    let (a, b) = (sum(ours), sum(theirs));
    // A corner on a straight edge may occur in degenerate triangles only.
    let agree = corners(ours).is_subset(&corners(theirs)) && (a - b).length() <= 1e-5 * a.length();
    agree
        .then_some(())
        .ok_or_else(|| format!("polygons of area {a} here and {b} by tobj"))
}

/// Files that tobj rejects, and its error.
const REFUSED: [(&str, &str); 5] = [
    // A corner refers to a vertex that does not exist.
    (
        "tinyobj_odd/invalid-relative-texture-index.obj",
        "FaceVertexOutOfBounds",
    ),
    (
        "tinyobj_odd/invalid-relative-vertex-index.obj",
        "FaceVertexOutOfBounds",
    ),
    (
        "tinyobj_odd/issue-140-zero-face-idx.obj",
        "FaceVertexOutOfBounds",
    ),
    // Numbers such as -1.#IND00.
    ("tinyobj_odd/test-nan.obj", "PositionParseError"),
    // A `usemtl` without a name.
    ("trimesh_odd/wallhole.obj", "MaterialParseError"),
];

/// Files that the readers define differently, and why.
const PARTLY: [(&str, Compared, &str); 13] = [
    ("colonnade.obj", Compared::ExceptNormals, MIXED),
    (
        "tinyobj_odd/issue-161-inconsistent-f.obj",
        Compared::Positions,
        MIXED,
    ),
    (
        "trimesh_odd/nancolor.obj",
        Compared::Positions,
        "colours that are not finite",
    ),
    ("spot/spot_control_mesh.obj", Compared::ExceptSplit, CONCAVE),
    (
        "tinyobj_odd/issue-319-002.obj",
        Compared::ExceptSplit,
        CONCAVE,
    ),
    (
        "tinyobj_odd/issue-319-003.obj",
        Compared::ExceptSplit,
        CONCAVE,
    ),
    (
        "trimesh_odd/polygonfaces.obj",
        Compared::ExceptSplit,
        CONCAVE,
    ),
    (
        "tinyobj_odd/colorspace-issue-184.obj",
        Compared::ExceptTexcoords,
        OPTIONS,
    ),
    (
        "tinyobj_odd/texture-options-issue-85.obj",
        Compared::ExceptTexcoords,
        OPTIONS,
    ),
    (
        "tinyobj_odd/mtl filename with whitespace issue46.obj",
        Compared::ExceptMaterials,
        LIBRARIES,
    ),
    (
        "tinyobj_odd/mtllib-multiple-files-issue-112.obj",
        Compared::ExceptMaterials,
        LIBRARIES,
    ),
    (
        "tinyobj_odd/cube-vertex-w-component.obj",
        Compared::Nothing,
        "weights, see the test below",
    ),
    (
        "tinyobj_odd/line-prim.obj",
        Compared::Nothing,
        "tobj makes polygons of lines",
    ),
];
const MIXED: &str = "tobj does not tell which corners of a mesh have an attribute";
const CONCAVE: &str = "concave polygons";
const OPTIONS: &str = "scale and offset of a texture";
const LIBRARIES: &str = "several libraries, or spaces, in one `mtllib`";

/// What tobj reads from a file; it panics on some.
fn by_tobj(path: &Path) -> Result<(Vec<tobj::Model>, Vec<tobj::Material>), String> {
    let path = path.to_owned();
    let read = catch_unwind(move || tobj::load_obj(&path, &TOBJ));
    let (models, materials) = read
        .map_err(|_| "panics".to_owned())?
        .map_err(|error| format!("{error:?}"))?;
    Ok((models, materials.unwrap_or_default()))
}

#[test]
fn tobj_reads_the_same_of_every_file() {
    let assets = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets");
    let shared = crate::common::shared().map(|shared| shared.join("scenes"));
    let mut wrong = Vec::new();
    let mut agreeing = 0;
    for root in [Some(assets), shared.clone()].into_iter().flatten() {
        let paths = files_below(&root, &["obj"]);
        assert!(!paths.is_empty(), "{} has no OBJ file", root.display());
        for path in paths {
            let name = path
                .strip_prefix(&root)
                .expect("below")
                .display()
                .to_string();
            match outcome(&path, &name) {
                Ok(line) => {
                    println!("{name} | {line}");
                    agreeing += usize::from(line.ends_with("triangles agree"));
                }
                Err(what) => wrong.push(format!("{name}: {what}")),
            }
        }
    }
    println!("{agreeing} files agree in everything");
    assert!(wrong.is_empty(), "{wrong:#?}");
    let least = if shared.is_some() { 100 } else { 0 };
    assert!(agreeing >= least, "{agreeing}");
}

/// Compares one file with the expectation in the tables.
fn outcome(path: &Path, name: &str) -> Result<String, String> {
    let partly = PARTLY.iter().find(|(file, ..)| *file == name);
    if let Some((_, Compared::Nothing, why)) = partly {
        return Ok(format!("not compared: {why}"));
    }
    let refused = REFUSED.iter().find(|(file, _)| *file == name);
    let (models, materials) = match (by_tobj(path), refused) {
        (Ok(_), Some(_)) => return Err("tobj should refuse it".to_owned()),
        (Ok(read), None) => read,
        (Err(error), Some((_, reason))) if error.contains(reason) => {
            return Ok(format!("tobj refuses it: {reason}"));
        }
        (Err(error), _) => return Err(format!("tobj refuses it: {error}")),
    };
    let loaded = match load(path, &LoadOptions::default()) {
        Ok(loaded) => loaded,
        Err(error) => {
            let all = theirs(&models, &materials, Compared::Positions)?;
            let drawn = all.iter().filter(|(t, _)| is_drawn(t)).count();
            return if drawn == 0 {
                Ok("nothing to draw by both".to_owned())
            } else {
                Err(format!("{drawn} triangles by tobj, but {error}"))
            };
        }
    };
    let compared = |compared| compare(&loaded.scene, &models, &materials, compared);
    match partly {
        None => compared(Compared::All).map(|n| format!("{n} triangles agree")),
        Some(_) if compared(Compared::All).is_ok() => Err("agrees in everything".to_owned()),
        Some((_, part, why)) => {
            compared(*part).map(|n| format!("{n} triangles agree {part:?}: {why}"))
        }
    }
}

/// One statement of a generated file, with raw numbers that the writer maps into range.
#[derive(Debug, Clone)]
enum Step {
    Object,
    Group,
    Material(usize),
    Smoothing(u32),
    Comment,
    /// More positions, texture coordinates and normals.
    Numbers(Vec<[f32; 8]>),
    /// Whether the following faces have texture coordinates and normals.
    Attributes(bool, bool),
    Triangle([usize; 3]),
    /// A convex polygon: its centre, two semi-axes, number of corners.
    Polygon([[f32; 3]; 3], usize),
}

/// Style of a whole file.
#[derive(Debug, Clone, Copy)]
struct Style {
    carriage_return: bool,
    tabs: bool,
    /// 0: no colours; 1: colours in 0..1; 2: colours in 0..255.
    colours: u8,
    /// Whether positions without colours may have the weight 1.
    weights: bool,
    /// Whether faces use negative (relative) indices.
    negative: bool,
}

/// Two that the library defines, a name with spaces, and one that is undefined.
const MATERIALS: [&str; 4] = ["red", "brick wall 2", "glass.007", "undefined"];
const LIBRARY: &str = "# three materials\nnewmtl red\nKd 0.8 0.1 0.1\nKs 0 0 0\nNs 10\nillum 2\n\n\
    newmtl brick wall 2\nKa 0 0 0\nKd 0.4 0.3 0.2\nKs 0.1 0.1 0.1\nNs 50\nd 1\nillum 2\n\n\
    newmtl glass.007\nKd 0.9 0.9 1\nKs 0.5 0.5 0.5\nNs 300\nNi 1.45\nd 0.75\nillum 2\n";

struct Writer {
    text: String,
    style: Style,
    counts: [usize; 3],
    attributes: (bool, bool),
}

impl Writer {
    fn line(&mut self, words: &[String]) {
        let gap = if self.style.tabs { "\t" } else { " " };
        self.text += &words.join(gap);
        self.text += if self.style.carriage_return {
            "\r\n"
        } else {
            "\n"
        };
    }

    fn statement(&mut self, line: &str) {
        self.line(&[line.to_owned()]);
    }

    /// A number in one of the forms that exporters write.
    fn number(&self, x: f32) -> String {
        match (self.text.len() + x.to_bits() as usize) % 4 {
            0 => format!("{x}"),
            1 => format!("{x:.6}"),
            2 => format!("{x:e}"),
            _ => format!("{x:.3}"),
        }
    }

    fn position(&mut self, [x, y, z]: [f32; 3], colour: [f32; 3]) {
        let mut words = vec!["v".to_owned()];
        words.extend([x, y, z].map(|x| self.number(x)));
        let [r, g, b] = colour.map(f32::abs);
        match self.style.colours {
            0 if self.style.weights && self.counts[0].is_multiple_of(2) => words.push("1.0".into()),
            0 => {}
            1 => words.extend([r, g, b].map(|c| format!("{:.4}", c.fract()))),
            // All above 1, so that the scale is unambiguous for every subset of the vertices.
            _ => words.extend([r, g, b].map(|c| format!("{:.0}", 2.0 + c % 254.0))),
        }
        self.line(&words);
        self.counts[0] += 1;
    }

    fn numbers(&mut self, [x, y, z, u, v, a, b, c]: [f32; 8]) {
        self.position([x, y, z], [a, b, c]);
        let words = ["vt".to_owned(), self.number(u), self.number(v)];
        self.line(&words);
        let words = [
            "vn".to_owned(),
            self.number(a),
            self.number(b),
            self.number(c),
        ];
        self.line(&words);
        self.counts[1] += 1;
        self.counts[2] += 1;
    }

    /// A face with these positions; its other indices follow from them.
    fn face(&mut self, positions: &[usize]) {
        let number = |at: usize, count: usize| {
            if self.style.negative {
                (at as i64 - count as i64).to_string()
            } else {
                (at + 1).to_string()
            }
        };
        let [_, texcoords, normals] = self.counts;
        let corner = |(i, position): (usize, &usize)| {
            let place = number(*position, self.counts[0]);
            let texcoord = number((7 * position + i) % texcoords, texcoords);
            let normal = number((3 * position + 2 * i) % normals, normals);
            match self.attributes {
                (false, false) => place,
                (true, false) => format!("{place}/{texcoord}"),
                (false, true) => format!("{place}//{normal}"),
                (true, true) => format!("{place}/{texcoord}/{normal}"),
            }
        };
        let mut words = vec!["f".to_owned()];
        words.extend(positions.iter().enumerate().map(corner));
        self.line(&words);
    }

    fn step(&mut self, number: usize, step: &Step) {
        match step {
            Step::Object => self.statement(&format!("o object {number}")),
            Step::Group => self.statement(&format!("g part{number} second")),
            Step::Material(i) => {
                self.statement(&format!("usemtl {}", MATERIALS[i % MATERIALS.len()]));
            }
            Step::Smoothing(0) => self.statement("s off"),
            Step::Smoothing(group) => self.statement(&format!("s {group}")),
            Step::Comment => self.statement("# f 1 2 3"),
            Step::Numbers(list) => list.iter().for_each(|numbers| self.numbers(*numbers)),
            Step::Attributes(texcoords, normals) => {
                // A new group, because tobj does not tell which corners of a mesh have an attribute.
                self.statement(&format!("g attributes{number}"));
                self.attributes = (*texcoords, *normals);
            }
            Step::Triangle(corners) => {
                let count = self.counts[0];
                self.face(&corners.map(|i| i % count));
            }
            Step::Polygon([centre, a, b], sides) => {
                let first = self.counts[0];
                for i in 0..*sides {
                    let (sin, cos) = (std::f32::consts::TAU * i as f32 / *sides as f32).sin_cos();
                    let at = Vec3::from(*centre) + cos * Vec3::from(*a) + sin * Vec3::from(*b);
                    self.position(at.to_array(), *a);
                }
                self.face(&(first..first + sides).collect::<Vec<_>>());
            }
        }
    }
}

fn text_of(style: Style, first: &[[f32; 8]], steps: &[Step]) -> String {
    let mut writer = Writer {
        text: String::new(),
        style,
        counts: [0; 3],
        attributes: (true, true),
    };
    writer.statement("mtllib m.mtl");
    first.iter().for_each(|numbers| writer.numbers(*numbers));
    for (number, step) in steps.iter().enumerate() {
        writer.step(number, step);
    }
    // At least one visible triangle per file.
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let first = writer.counts[0];
    corners.iter().for_each(|at| writer.position(*at, [3.5; 3]));
    writer.face(&[first, first + 1, first + 2]);
    writer.text
}

fn steps() -> impl Strategy<Value = Vec<Step>> {
    let numbers = || prop::collection::vec(prop::array::uniform8(-100.0f32..100.0), 1..5);
    let point = || prop::array::uniform3(-10.0f32..10.0);
    let step = prop_oneof![
        1 => Just(Step::Object),
        1 => Just(Step::Group),
        2 => any::<usize>().prop_map(Step::Material),
        2 => (0u32..4).prop_map(Step::Smoothing),
        1 => Just(Step::Comment),
        2 => numbers().prop_map(Step::Numbers),
        2 => any::<(bool, bool)>().prop_map(|(t, n)| Step::Attributes(t, n)),
        8 => any::<[usize; 3]>().prop_map(Step::Triangle),
        4 => ([point(), point(), point()], 4usize..9).prop_map(|(p, n)| Step::Polygon(p, n)),
    ];
    prop::collection::vec(step, 1..60)
}

fn style() -> impl Strategy<Value = Style> {
    let flags = any::<(bool, bool, bool, bool)>();
    (flags, 0u8..3).prop_map(
        |((carriage_return, tabs, weights, negative), colours)| Style {
            carriage_return,
            tabs,
            colours,
            weights,
            negative,
        },
    )
}

#[test]
fn tobj_reads_the_same_of_generated_files() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    fs::write(folder.path().join("m.mtl"), LIBRARY).expect("a library");
    let path = folder.path().join("m.obj");
    let config = Config {
        cases: CASES,
        failure_persistence: None,
        ..Config::default()
    };
    let same = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
    let first = prop::collection::vec(prop::array::uniform8(-100.0f32..100.0), 1..9);
    let agreeing = std::cell::Cell::new(0);
    let mut runner = TestRunner::new_with_rng(config, same);
    let result = runner.run(&(style(), first, steps()), |(style, first, steps)| {
        fs::write(&path, text_of(style, &first, &steps)).expect("a model");
        let (models, materials) = by_tobj(&path).map_err(TestCaseError::fail)?;
        let scene = load(&path, &LoadOptions::default()).expect("a model").scene;
        let agree = compare(&scene, &models, &materials, Compared::All);
        agreeing.set(agreeing.get() + agree.map_err(TestCaseError::fail)?);
        Ok(())
    });
    result.unwrap_or_else(|error| panic!("{error}"));
    println!("{} triangles of {CASES} files agree", agreeing.get());
    assert!(agreeing.get() > 10 * CASES as usize);
}

#[test]
fn a_weight_scales_the_position_in_tobj_only() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let path = folder.path().join("m.obj");
    fs::write(&path, "v 0 0 0 2\nv 4 0 0 2\nv 0 4 0 2\nf 1 2 3\n").expect("a model");
    let (models, _) = by_tobj(&path).expect("tobj reads it");
    assert_eq!(models[0].mesh.positions[3], 2.0);
    let scene = load(&path, &LoadOptions::default()).expect("a model").scene;
    assert_eq!(scene.bounds.max, Vec3::new(4.0, 4.0, 0.0));
}
