//! glTF 2.0 models (`.gltf`, `.glb`).
//!
//! The JSON is read without a schema: only what is drawn is looked at and checked. A primitive, a picture or an attribute that is
//! not valid costs that part, with a warning that counts such parts and names the first. Skins and morph targets are drawn in
//! their rest pose, and blended materials become cut-outs with an alpha threshold of 0.5.

mod accessor;
mod buffers;
mod camera;
mod extensions;
mod faces;
mod instances;
mod item;
mod json;
mod material;
mod mesh;
mod meshopt;
mod nodes;
mod skin;

use std::collections::HashMap;
use std::path::Path;
use std::rc::Rc;

use glam::{DAffine3, DVec3};

use crate::scene::builder::Builder;
use crate::scene::error::SceneError;
use crate::scene::gltf::buffers::Buffers;
use crate::scene::gltf::extensions::Told;
use crate::scene::gltf::faces::Faces;
use crate::scene::gltf::item::Item;
use crate::scene::gltf::material::{Materials, Source, Surface};
use crate::scene::gltf::mesh::Primitive;
use crate::scene::gltf::nodes::Graph;
use crate::scene::gltf::skin::Skin;
use crate::scene::losses::shortened;
use crate::scene::mesh::instance::{Mesh, append_instance};
use crate::scene::mesh::soup::NONE;
use crate::scene::obj::ImportReport;
use crate::scene::placement::Placement;
use crate::scene::scene_file::NamedCamera;

/// Why a file of the first version is refused.
const OLD_VERSION: &str =
    "glTF 1.0, which is not read; export it as glTF 2.0, or convert it with gltf-pipeline";
/// Longest reason of a refusal, characters.
const MAX_REASON: usize = 140;
/// Vertices of a primitive that are looked at to find where a model lies.
const LOOKED_AT: usize = 16;
/// Nodes that are looked at for the same.
const NODES_LOOKED_AT: usize = 256;

/// Adds the model at `path` to the scene; returns its cameras.
///
/// # Errors
/// When the file cannot be read, is not glTF 2.0, exceeds a limit, or contains nothing to draw.
pub fn append_gltf(
    builder: &mut Builder,
    path: &Path,
    placement: &Placement,
) -> Result<Vec<NamedCamera>, SceneError> {
    builder.progress.at(0.0, "reading");
    let bytes = builder.files.read(path)?;
    let refused = |what: String| SceneError::Unsupported {
        path: path.to_owned(),
        what: shortened(&what, MAX_REASON),
    };
    let json::Container { json, binary } = json::read(&bytes).map_err(refused)?;
    drop(bytes);
    let root = Item::of(&json);
    if let Some(what) = unusable(root) {
        return Err(refused(what.to_owned()));
    }
    let buffers = Buffers::read(builder, path, root, binary);
    let mut report = ImportReport::default();
    let graph = Graph::read(root, &mut report.losses);
    let mut model = Model {
        path,
        root,
        placement,
        buffers: &buffers,
        graph: &graph,
        materials: Materials::default(),
        told: Told::of_file(root),
        known: HashMap::new(),
        triangles: 0,
        report,
        cameras: Vec::new(),
    };
    builder.progress.at(0.5, "building the mesh");
    model.find_origin(builder);
    let drawn_before = builder.scene.triangles();
    for node in &graph.drawn {
        model.append_node(builder, *node)?;
    }
    let empty = builder.scene.triangles() == drawn_before;
    for line in model.told.lines() {
        builder.warn(path, &line);
    }
    model.report.finish(builder, path, empty)?;
    Ok(model.cameras)
}

/// Why nothing of a file can be drawn.
fn unusable(root: Item<'_>) -> Option<&'static str> {
    let version = root.get("asset").get("version");
    let is_first = version.text().is_some_and(|v| v.starts_with("1."))
        || version.number().is_some_and(|v| v < 2.0);
    if is_first || root.get("meshes").is_object() {
        return Some(OLD_VERSION);
    }
    (!root.is_object()).then_some("no glTF: it has no JSON object; export it again")
}

struct Model<'m> {
    path: &'m Path,
    root: Item<'m>,
    placement: &'m Placement,
    buffers: &'m Buffers<'m>,
    graph: &'m Graph,
    materials: Materials,
    told: Told,
    /// Meshes read so far with the bits of their morph weights, for reuse by further instances.
    known: HashMap<(usize, Vec<u64>), Rc<Vec<Mesh>>>,
    /// Triangles read, drawn or not, not counting instances.
    triangles: usize,
    report: ImportReport,
    cameras: Vec<NamedCamera>,
}

impl Model<'_> {
    fn node(&self, number: usize) -> Item<'_> {
        self.root.get("nodes").at(number)
    }

    /// Chooses the scene's origin from a sample of the vertices, if it has none.
    fn find_origin(&self, builder: &mut Builder) {
        let with_mesh = |node: &&usize| self.node(**node).get("mesh").exists();
        let nodes: Vec<usize> = self.graph.drawn.iter().filter(with_mesh).copied().collect();
        let step = nodes.len().div_ceil(NODES_LOOKED_AT).max(1);
        let mut points = Vec::new();
        for node in nodes.iter().step_by(step) {
            let file_from_node = self.graph.file_from_node(*node);
            let mesh = self.node(*node).get("mesh").index();
            let Some((file_from_node, mesh)) = file_from_node.zip(mesh) else {
                continue;
            };
            let world_from_node = self.placement.world_from_mesh * file_from_node;
            let primitives = self.root.get("meshes").at(mesh).get("primitives");
            let positions = primitives.at(0).get("attributes").get("POSITION").index();
            let sample = positions.map(|number| self.buffers.sample(number, LOOKED_AT));
            let sample = sample.and_then(Result::ok).unwrap_or_default();
            let place =
                |p: [f32; 3]| world_from_node.transform_point3(DVec3::from(p.map(f64::from)));
            points.extend(sample.into_iter().map(place));
        }
        builder.choose_origin(self.path, &mut points);
    }

    fn append_node(&mut self, builder: &mut Builder, number: usize) -> Result<(), SceneError> {
        let root = self.root;
        let node = root.get("nodes").at(number);
        self.told.see(node);
        if node.extension("KHR_lights_punctual").exists() {
            self.told
                .tell("KHR_lights_punctual", "the light is that of sun and sky");
        }
        let Some(file_from_node) = self.graph.file_from_node(number) else {
            return Ok(());
        };
        let world_from_node = self.placement.world_from_mesh * file_from_node;
        if node.get("camera").exists() {
            let camera = camera::read(root, node, world_from_node, &self.cameras);
            if camera.is_none() {
                let place = || format!("nodes[{number}].camera");
                self.report
                    .losses
                    .add("cameras that are not perspective left out", place);
            }
            self.cameras.extend(camera);
        }
        let mesh = node.get("mesh");
        if !mesh.exists() {
            return Ok(());
        }
        // No list is as long: it is told of as a mesh that does not exist.
        let mesh = mesh.index().unwrap_or(usize::MAX);
        if let Some(skin) = node.get("skin").index() {
            match Skin::read(root, skin, self.graph, self.buffers) {
                Ok(skin) => return self.append_posed(builder, node, mesh, &skin),
                Err(why) => {
                    let what = "skins that are not valid left out";
                    self.report
                        .losses
                        .add(what, || format!("skins[{skin}]: {why}"));
                }
            }
        }
        let meshes = self.meshes(builder, node, mesh)?;
        for world_from_mesh in self.instances(builder, node, number, world_from_node) {
            for mesh in meshes.iter() {
                self.append_instance(builder, mesh, world_from_mesh)?;
            }
        }
        Ok(())
    }

    fn append_instance(
        &mut self,
        builder: &mut Builder,
        mesh: &Mesh,
        world_from_mesh: DAffine3,
    ) -> Result<(), SceneError> {
        builder.check_triangles(self.path, mesh.indices.len() / 3)?;
        let scene_from_mesh = builder.scene_from_world(world_from_mesh, DVec3::ZERO);
        let dropped = append_instance(&mut builder.scene, mesh, &scene_from_mesh);
        self.report.dropped.add(dropped);
        Ok(())
    }

    /// Draws a mesh with a skin: its vertices go with the joints, wherever the node itself is.
    fn append_posed(
        &mut self,
        builder: &mut Builder,
        node: Item<'_>,
        mesh: usize,
        skin: &Skin,
    ) -> Result<(), SceneError> {
        let weights = self.weights(node, mesh);
        for (mesh, origin) in self.read_mesh(builder, mesh, &weights, Some(skin))? {
            let world_from_mesh =
                self.placement.world_from_mesh * DAffine3::from_translation(origin);
            self.append_instance(builder, &mesh, world_from_mesh)?;
        }
        Ok(())
    }

    /// The meshes of a node without a skin, in the node's space.
    fn meshes(
        &mut self,
        builder: &mut Builder,
        node: Item<'_>,
        mesh: usize,
    ) -> Result<Rc<Vec<Mesh>>, SceneError> {
        let weights = self.weights(node, mesh);
        let key = (mesh, weights.iter().map(|w| w.to_bits()).collect());
        if let Some(known) = self.known.get(&key) {
            return Ok(known.clone());
        }
        let meshes = self.read_mesh(builder, mesh, &weights, None)?;
        let meshes = Rc::new(meshes.into_iter().map(|(mesh, _)| mesh).collect::<Vec<_>>());
        self.known.insert(key, meshes.clone());
        Ok(meshes)
    }

    /// Weights of the morph targets: the node's, or else those of its mesh.
    fn weights(&self, node: Item<'_>, mesh: usize) -> Vec<f64> {
        let mesh = self.root.get("meshes").at(mesh);
        let own = node.get("weights");
        let weights = if own.exists() {
            own
        } else {
            mesh.get("weights")
        };
        let finite = |item: Item<'_>| item.number().unwrap_or(0.0);
        let mut weights: Vec<f64> = weights.items().map(finite).collect();
        // Trailing zeros change nothing: equal poses share a mesh.
        while weights.last() == Some(&0.0) {
            weights.pop();
        }
        weights
    }

    /// The transforms of a node's mesh: its own, or those of EXT_mesh_gpu_instancing.
    fn instances(
        &mut self,
        builder: &Builder,
        node: Item<'_>,
        number: usize,
        world_from_node: DAffine3,
    ) -> Vec<DAffine3> {
        let attributes = node.extension("EXT_mesh_gpu_instancing").get("attributes");
        if !attributes.is_object() {
            return vec![world_from_node];
        }
        match instances::transforms(self.buffers, attributes, builder.corners_left()) {
            Ok(list) => list.into_iter().map(|t| world_from_node * t).collect(),
            Err(why) => {
                let what = "nodes with instances that are not valid drawn once";
                self.report
                    .losses
                    .add(what, || format!("nodes[{number}]: {why}"));
                vec![world_from_node]
            }
        }
    }

    /// The meshes of all primitives, each with the point that its vertices are relative to.
    fn read_mesh(
        &mut self,
        builder: &mut Builder,
        number: usize,
        weights: &[f64],
        skin: Option<&Skin>,
    ) -> Result<Vec<(Mesh, DVec3)>, SceneError> {
        let root = self.root;
        let mesh = root.get("meshes").at(number);
        if !mesh.exists() {
            let place = || format!("meshes[{number}]");
            self.report
                .losses
                .add("meshes that do not exist not drawn", place);
        }
        self.told.see(mesh);
        if mesh.exists() && mesh.get("primitives").items().len() == 0 {
            let place = || format!("meshes[{number}]");
            self.report.losses.add("meshes without primitives", place);
        }
        let mut meshes = Vec::new();
        for (i, item) in mesh.get("primitives").items().enumerate() {
            let place = format!("meshes[{number}].primitives[{i}]");
            self.told.see(item);
            let mut losses = std::mem::take(&mut self.report.losses);
            let mut primitive = Primitive {
                item,
                place: &place,
                buffers: self.buffers,
                losses: &mut losses,
                limit: builder.corners_left(),
            };
            let read = self.read_primitive(builder, &mut primitive, weights, skin);
            if let Err(why) = &read {
                losses.add_shape("primitives not drawn", || format!("{place}: {why}"));
            }
            self.report.losses = losses;
            let Some((faces, surface, origin)) = read.ok().flatten() else {
                continue;
            };
            self.triangles += faces.indices.len() / 3;
            builder.check_read(self.path, self.triangles)?;
            meshes.extend(self.make_mesh(faces, surface).map(|mesh| (mesh, origin)));
        }
        Ok(meshes)
    }

    fn read_primitive(
        &mut self,
        builder: &mut Builder,
        primitive: &mut Primitive<'_, '_>,
        weights: &[f64],
        skin: Option<&Skin>,
    ) -> Result<Option<(Faces, Surface, DVec3)>, String> {
        if !primitive.has_faces() {
            self.report.not_faces += 1;
            return Ok(None);
        }
        let source = Source {
            builder,
            path: self.path,
            root: self.root,
            buffers: self.buffers,
            losses: primitive.losses,
            told: &mut self.told,
        };
        let surface = self.materials.of(source, primitive.item);
        let mut faces = primitive.faces(surface)?;
        primitive.morph(&mut faces, weights);
        let origin = match skin {
            None => DVec3::ZERO,
            Some(skin) => skin.pose(primitive, &mut faces).ok_or("it has no joints")?,
        };
        Ok(Some((faces, surface, origin)))
    }

    /// `None` for a material that is not drawn.
    fn make_mesh(&mut self, faces: Faces, surface: Surface) -> Option<Mesh> {
        if surface.material.index == NONE {
            self.report.undrawn += faces.indices.len() / 3;
            return None;
        }
        let (mesh, dropped) = faces.into_mesh(surface, self.placement.smooth_deg);
        self.report.dropped.add(dropped);
        Some(mesh)
    }
}
