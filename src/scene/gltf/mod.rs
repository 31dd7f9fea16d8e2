//! glTF 2.0 models (`.gltf`, `.glb`).
//!
//! Skins and morph targets are drawn in their rest pose, textures always repeat, and blended materials become cut-outs with an
//! alpha threshold of 0.5.

mod buffers;
mod material;
mod mesh;

use std::collections::{HashMap, HashSet};
use std::path::Path;
use std::rc::Rc;

use glam::{Affine3A, Mat4, Vec3};

use crate::scene::builder::Builder;
use crate::scene::error::{SceneError, one_line};
use crate::scene::gltf::buffers::Buffers;
use crate::scene::gltf::material::{Materials, Surface};
use crate::scene::gltf::mesh::{Faces, read_faces};
use crate::scene::mesh::instance::{Mesh, append_instance};
use crate::scene::mesh::soup::NONE;
use crate::scene::obj::{ImportReport, Placement};
use crate::scene::scene_file::NamedCamera;

/// Adds the model at `path` to the scene; returns its cameras.
///
/// # Errors
/// When a file cannot be read, is not valid glTF, requires an unsupported extension, or contains nothing to draw.
pub fn append_gltf(
    builder: &mut Builder,
    path: &Path,
    placement: &Placement,
) -> Result<Vec<NamedCamera>, SceneError> {
    builder.progress.at(0.0, "reading");
    let bytes = builder.files.read(path)?;
    let invalid = |what: String| SceneError::Unsupported {
        path: path.to_owned(),
        what: format!("is not a usable glTF file ({what}); export it again"),
    };
    let gltf = parse(&bytes).map_err(|what| invalid(one_line(&what)))?;
    drop(bytes);
    let buffers = Buffers::read(builder, path, &gltf).map_err(invalid)?;
    builder.progress.at(0.2, "reading materials");
    let mut model = Model {
        path,
        placement,
        materials: Materials::read(builder, path, &gltf, &buffers),
        buffers,
        known: HashMap::new(),
        triangles: 0,
        report: ImportReport::default(),
        cameras: Vec::new(),
    };
    if gltf.skins().len() > 0 {
        builder.warn(path, "skins are drawn in their rest pose");
    }
    builder.progress.at(0.5, "building the mesh");
    let drawn_before = builder.scene.triangles();
    for (node, world_from_node) in nodes(&gltf) {
        let world_from_node = placement.world_from_mesh * world_from_node;
        model.append_node(builder, &node, world_from_node)?;
    }
    let empty = builder.scene.triangles() == drawn_before;
    model.report.finish(builder, path, empty)?;
    Ok(model.cameras)
}

/// Parses the document and its binary chunk. All indices in the result are in range.
fn parse(bytes: &[u8]) -> Result<gltf::Gltf, String> {
    let unchecked = gltf::Gltf::from_slice_without_validation(bytes);
    let gltf::Gltf { document, blob } = unchecked.map_err(|e| e.to_string())?;
    let mut root = document.into_json();
    // The crate's validation looks up the position accessor before it checks the index.
    let primitives = root.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let mut named = primitives.flat_map(|primitive| primitive.attributes.values());
    if named.any(|accessor| accessor.value() >= root.accessors.len()) {
        return Err("a mesh refers to an accessor that does not exist".to_owned());
    }
    for (number, image) in root.images.iter_mut().enumerate() {
        if image.buffer_view.is_none() && image.uri.is_none() {
            return Err(format!(
                "image {number} has neither a URI nor a buffer view"
            ));
        }
        // The crate requires a MIME type, but the decoder detects it from the content.
        let unknown = || gltf::json::image::MimeType("image/png".to_owned());
        image.mime_type.get_or_insert_with(unknown);
    }
    let document = gltf::Document::from_json(root).map_err(|e| e.to_string())?;
    Ok(gltf::Gltf { document, blob })
}

/// The nodes of the default scene (or else the first scene, or else all nodes), each once, with their transforms.
fn nodes(gltf: &gltf::Document) -> Vec<(gltf::Node<'_>, Affine3A)> {
    let scene = gltf.default_scene().or_else(|| gltf.scenes().next());
    let roots: Vec<gltf::Node<'_>> = match scene {
        Some(scene) => scene.nodes().collect(),
        None => {
            let children: HashSet<usize> = gltf
                .nodes()
                .flat_map(|n| n.children().map(|c| c.index()))
                .collect();
            gltf.nodes()
                .filter(|n| !children.contains(&n.index()))
                .collect()
        }
    };
    // A malformed file may contain cycles.
    let mut seen = HashSet::new();
    let mut open: Vec<_> = roots
        .into_iter()
        .rev()
        .map(|node| (node, Affine3A::IDENTITY))
        .collect();
    let mut found = Vec::new();
    while let Some((node, world_from_parent)) = open.pop() {
        if !seen.insert(node.index()) {
            continue;
        }
        let matrix = Mat4::from_cols_array_2d(&node.transform().matrix());
        let world_from_node = world_from_parent * Affine3A::from_mat4(matrix);
        open.extend(node.children().map(|child| (child, world_from_node)));
        found.push((node, world_from_node));
    }
    found
}

struct Model<'m> {
    path: &'m Path,
    placement: &'m Placement,
    buffers: Buffers,
    materials: Materials,
    /// Meshes read so far, for reuse by further instances.
    known: HashMap<usize, Rc<Vec<Mesh>>>,
    /// Triangles read, drawn or not, not counting instances.
    triangles: usize,
    report: ImportReport,
    cameras: Vec<NamedCamera>,
}

impl Model<'_> {
    fn append_node(
        &mut self,
        builder: &mut Builder,
        node: &gltf::Node<'_>,
        world_from_node: Affine3A,
    ) -> Result<(), SceneError> {
        if let Some(camera) = node.camera() {
            self.add_camera(node, &camera, world_from_node);
        }
        let Some(mesh) = node.mesh() else {
            return Ok(());
        };
        let meshes = match self.known.get(&mesh.index()) {
            Some(meshes) => meshes.clone(),
            None => {
                let meshes = Rc::new(self.read_mesh(builder, &mesh)?);
                self.known.insert(mesh.index(), meshes.clone());
                meshes
            }
        };
        for mesh in meshes.iter() {
            builder.check_triangles(self.path, mesh.indices.len() / 3)?;
            let dropped = append_instance(&mut builder.scene, mesh, &world_from_node);
            self.report.dropped.not_finite += dropped.not_finite;
            self.report.dropped.degenerate += dropped.degenerate;
        }
        Ok(())
    }

    fn read_mesh(
        &mut self,
        builder: &mut Builder,
        mesh: &gltf::Mesh<'_>,
    ) -> Result<Vec<Mesh>, SceneError> {
        let mut meshes = Vec::new();
        for primitive in mesh.primitives() {
            let surface = self.materials.of(&primitive.material());
            let limit = builder.corners_left();
            let faces = read_faces(&self.buffers, &primitive, surface, limit);
            let faces = faces.map_err(|what| SceneError::Unsupported {
                path: self.path.to_owned(),
                what: format!("mesh {}: {what}; export it again", mesh.index()),
            })?;
            let Some(faces) = faces else {
                self.report.not_faces += 1;
                continue;
            };
            self.triangles += faces.indices.len() / 3;
            builder.check_read(self.path, self.triangles)?;
            meshes.extend(self.make_mesh(faces, surface));
        }
        Ok(meshes)
    }

    /// `None` for a material that is not drawn.
    fn make_mesh(&mut self, faces: Faces, surface: Surface) -> Option<Mesh> {
        if surface.material.index == NONE {
            self.report.undrawn += faces.indices.len() / 3;
            return None;
        }
        let (mesh, dropped) = faces.into_mesh(surface, self.placement.smooth_deg);
        self.report.dropped.not_finite += dropped.not_finite;
        self.report.dropped.degenerate += dropped.degenerate;
        Some(mesh)
    }

    fn add_camera(
        &mut self,
        node: &gltf::Node<'_>,
        camera: &gltf::Camera<'_>,
        world_from_node: Affine3A,
    ) {
        // Orthographic cameras are not supported.
        let gltf::camera::Projection::Perspective(lens) = camera.projection() else {
            return;
        };
        let eye = Vec3::from(world_from_node.translation);
        let forward = world_from_node.transform_vector3(Vec3::NEG_Z);
        let fov = lens.yfov().to_degrees();
        let Some(forward) = forward.try_normalize().filter(|_| eye.is_finite()) else {
            return;
        };
        if !(1.0..=170.0).contains(&fov) {
            return;
        }
        let given = node.name().or(camera.name());
        let name = given.map_or_else(|| format!("camera {}", camera.index()), str::to_owned);
        let taken = self.cameras.iter().any(|c| c.name == name);
        let name = if taken {
            format!("{name} {}", self.cameras.len())
        } else {
            name
        };
        let point = |p: Vec3| format!("{},{},{}", p.x, p.y, p.z);
        self.cameras.push(NamedCamera {
            name,
            options: vec![
                ("eye".to_owned(), point(eye)),
                ("target".to_owned(), point(eye + forward)),
                ("fov".to_owned(), fov.to_string()),
            ],
        });
    }
}
