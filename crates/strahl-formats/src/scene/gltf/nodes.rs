use super::materials::Materials;
use super::meshes::Meshes;
use crate::input::Report;
use gltf_json::Root;
use gltf_json::camera::Type as CameraType;
use gltf_json::extensions::scene::khr_lights_punctual::{Light as JsonLight, Type as LightType};
use gltf_json::scene::Node;
use gltf_json::validation::Checked;
use std::f64::consts::PI;
use strahl_geometry::Primitive;
use strahl_math::{DAffine3, DMat3, DQuat, DVec3, Transform, det};
use strahl_scene::{
    Camera, Diagnostic, GroupId, Object, ObjectExt, ObjectKind, Projection, Scene, SceneLight, Span,
};
use strahl_shade::{Color, Falloff, Light, LightKind};

/// Traverses the nodes of the scene.
pub(super) struct Nodes<'a, 'r> {
    pub(super) root: &'a Root,
    pub(super) name: &'a str,
    pub(super) scene: &'r mut Scene,
    pub(super) report: &'r mut Report,
}

/// Where a mesh has been placed so far.
#[derive(Clone, Debug)]
enum Placed {
    /// Nowhere.
    Not,
    /// In a group, of which each node places an instance.
    Group(GroupId),
}

impl Nodes<'_, '_> {
    /// Places meshes, cameras and lights.
    pub(super) fn place(
        mut self,
        meshes: &mut Meshes<'_>,
        materials: &mut Materials<'_>,
    ) -> Result<(), String> {
        let nodes = self.in_order()?;
        let mut uses = vec![0_usize; self.root.meshes.len()];
        for (node, _) in &nodes {
            if let Some(mesh) = self.root.nodes[*node].mesh {
                uses[mesh.value()] += 1;
            }
        }
        let mut placed = vec![Placed::Not; uses.len()];
        for (index, world) in nodes {
            let node = &self.root.nodes[index];
            let name = node.name.clone().unwrap_or_else(|| format!("node {index}"));
            if node.skin.is_some() {
                self.warn("skins are ignored: the mesh has its rest pose");
            }
            if let Some(mesh) = node.mesh.map(|m| m.value()) {
                let objects = match placed[mesh] {
                    Placed::Group(group) => vec![Object::instance(group)],
                    Placed::Not => {
                        let objects = meshes.objects(mesh, materials, self.report)?;
                        if uses[mesh] > 1 && !objects.is_empty() {
                            let group = self.scene.add_group(objects);
                            placed[mesh] = Placed::Group(group);
                            vec![Object::instance(group)]
                        } else {
                            objects
                        }
                    }
                };
                self.add(objects, &name, node.name.is_some(), &world);
            }
            if let Some(camera) = node.camera {
                self.camera(camera.value(), &world);
            }
            if let Some(light) = node
                .extensions
                .as_ref()
                .and_then(|e| e.khr_lights_punctual.as_ref())
            {
                self.light(light.light.value(), &name, &world)?;
            }
        }
        if self.scene.objects.0.is_empty() {
            let name = self.name;
            self.report
                .warning(|| Diagnostic::warning(format!("`{name}` has no objects")));
        }
        Ok(())
    }

    fn warn(&mut self, what: &'static str) {
        let name = self.name;
        self.report
            .count(what, || Diagnostic::warning(format!("`{name}`: {what}")));
    }

    /// The nodes of the scene with their maps to the world, parents first.
    fn in_order(&mut self) -> Result<Vec<(usize, DAffine3)>, String> {
        let root = self.root;
        let scene = root
            .scene
            .and_then(|s| root.scenes.get(s.value()))
            .or(root.scenes.first());
        let roots: Vec<usize> = match scene {
            Some(scene) => scene.nodes.iter().map(|n| n.value()).collect(),
            None => {
                // A file without scenes shows all nodes that are not children.
                let mut is_child = vec![false; root.nodes.len()];
                for child in root.nodes.iter().flat_map(|n| n.children.iter().flatten()) {
                    is_child[child.value()] = true;
                }
                (0..root.nodes.len()).filter(|n| !is_child[*n]).collect()
            }
        };
        let mut seen = vec![false; root.nodes.len()];
        let mut order = vec![];
        let mut waiting: Vec<_> = roots
            .into_iter()
            .rev()
            .map(|n| (n, DAffine3::IDENTITY))
            .collect();
        while let Some((index, parent)) = waiting.pop() {
            if std::mem::replace(&mut seen[index], true) {
                return Err(format!(
                    "node {index} is a child of two nodes, or of itself"
                ));
            }
            let node = &root.nodes[index];
            let world = parent * local(node);
            if !world.is_finite() {
                return Err(format!(
                    "the transformation of node {index} has a value that is not a finite number"
                ));
            }
            order.push((index, world));
            waiting.extend(
                node.children
                    .iter()
                    .flatten()
                    .rev()
                    .map(|child| (child.value(), world)),
            );
        }
        Ok(order)
    }

    fn add(&mut self, objects: Vec<Object>, node: &str, named: bool, world: &DAffine3) {
        let transform = Transform::try_new(world.matrix3, world.translation);
        let Some(transform) = transform.ok().or_else(|| self.flat(&objects, world)) else {
            let name = self.name;
            self.report.count("singular", || {
                let problem =
                    format!("`{name}`: `{node}` is left out: its transformation flattens it");
                Diagnostic::warning(problem)
            });
            return;
        };
        let single = objects.len() == 1;
        for object in objects {
            let object = if single && (named || object.name.is_none()) {
                object.named(node)
            } else {
                object
            };
            self.scene.objects.0.push(object.transformed(&transform));
        }
    }

    /// The transformation of what is flat in a plane of coordinates already, where only the axis across it has the scale 0:
    /// with any other scale there it looks the same. This one keeps the order of corners, by which
    /// the front is known.
    fn flat(&self, objects: &[Object], world: &DAffine3) -> Option<Transform> {
        let [x, y, z] = [0, 1, 2].map(|i| world.matrix3.col(i));
        let (axis, a, b) = match [x, y, z].map(|column| column == DVec3::ZERO) {
            [true, false, false] => (0, y, z),
            [false, true, false] => (1, z, x),
            [false, false, true] => (2, x, y),
            _ => return None,
        };
        if !objects.iter().all(|object| self.is_flat(object, axis)) {
            return None;
        }
        let mut linear = world.matrix3;
        *linear.col_mut(axis) = a.cross(b).try_normalize()? * a.length();
        Transform::try_new(linear, world.translation).ok()
    }

    /// Whether a mesh, or a group of them, has the coordinate 0 along an axis everywhere.
    fn is_flat(&self, object: &Object, axis: usize) -> bool {
        match &object.kind {
            ObjectKind::Shape(shape) => {
                let bounds = shape.bounds();
                bounds.min[axis] == 0.0 && bounds.max[axis] == 0.0
            }
            ObjectKind::Instance(group) => {
                let group = self.scene.groups.get(group.0 as usize);
                group.is_some_and(|g| g.objects.0.iter().all(|o| self.is_flat(o, axis)))
            }
            _ => false,
        }
    }

    /// The first camera of the scene is the scene's.
    fn camera(&mut self, index: usize, world: &DAffine3) {
        if self.scene.camera.is_some() {
            self.warn("only the first camera is used");
            return;
        }
        let Some(json) = self.root.cameras.get(index) else {
            return;
        };
        let (half, projection) = match (&json.type_, &json.perspective, &json.orthographic) {
            (Checked::Valid(CameraType::Perspective), Some(p), _) => {
                (det::tan(f64::from(p.yfov) * 0.5), Projection::Perspective)
            }
            (Checked::Valid(CameraType::Orthographic), _, Some(o)) => {
                (f64::from(o.ymag), Projection::Orthographic)
            }
            _ => {
                self.warn("a camera without its parameters is ignored");
                return;
            }
        };
        let along = |v: DVec3| world.transform_vector3(v);
        let camera = Camera::looking(
            world.translation,
            along(DVec3::NEG_Z),
            along(DVec3::Y),
            half,
            half,
            projection,
        );
        match camera.problem() {
            None if half > 0.0 => self.scene.camera = Some(camera),
            problem => {
                let name = self.name;
                let why = problem.unwrap_or("its field of view must be between 0 and 180 degrees");
                self.report.warning(|| {
                    Diagnostic::warning(format!("`{name}`: camera {index} is ignored: {why}"))
                });
            }
        }
    }

    fn light(&mut self, index: usize, node: &str, world: &DAffine3) -> Result<(), String> {
        let lights = self
            .root
            .extensions
            .as_ref()
            .and_then(|e| e.khr_lights_punctual.as_ref());
        let Some(json) = lights.and_then(|l| l.lights.get(index)) else {
            return Err(format!("there is no light {index}"));
        };
        let light = light(json, world).map_err(|e| format!("light {index}: {e}"))?;
        let name = json.name.as_deref().unwrap_or(node);
        self.scene.lights.push(SceneLight {
            light,
            mask: None,
            name: Some(name.into()),
            span: Span::NONE,
        });
        Ok(())
    }
}

/// The transformation from a node's space to its parent's.
fn local(node: &Node) -> DAffine3 {
    if let Some(matrix) = node.matrix {
        let m = matrix.map(f64::from);
        let column = |i: usize| DVec3::new(m[4 * i], m[4 * i + 1], m[4 * i + 2]);
        let linear = DMat3::from_cols(column(0), column(1), column(2));
        return DAffine3 {
            matrix3: linear,
            translation: column(3),
        };
    }
    let vector = |v: Option<[f32; 3]>, default: f64| {
        v.map_or(DVec3::splat(default), |v| {
            DVec3::from_array(v.map(f64::from))
        })
    };
    let rotation = node
        .rotation
        .map_or([0.0, 0.0, 0.0, 1.0], |q| q.0.map(f64::from));
    let rotation = DQuat::from_array(rotation);
    let length = rotation.length();
    // A zero quaternion counts as no rotation.
    let rotation = if length > 0.0 && length.is_finite() {
        rotation / length
    } else {
        DQuat::IDENTITY
    };
    DAffine3::from_scale_rotation_translation(
        vector(node.scale, 1.0),
        rotation,
        vector(node.translation, 0.0),
    )
}

fn light(json: &JsonLight, world: &DAffine3) -> Result<Light, String> {
    let color = Color::from(json.color.map(f64::from)) * (f64::from(json.intensity) / PI);
    if !color.is_finite() || color.to_array().iter().any(|x| *x < 0.0) {
        return Err("colour and intensity must be finite and not negative".into());
    }
    let position = world.translation;
    let direction = world
        .transform_vector3(DVec3::NEG_Z)
        .try_normalize()
        .unwrap_or(DVec3::NEG_Z);
    let Checked::Valid(kind) = json.type_ else {
        return Err("it has no valid type".into());
    };
    Ok(match kind {
        LightType::Directional => Light::directional(direction, color),
        LightType::Point => Light::point(position, color).with_falloff(Falloff::InverseSquare),
        LightType::Spot => {
            let (inner, outer) = json.spot.as_ref().map_or((0.0, PI / 4.0), |s| {
                (f64::from(s.inner_cone_angle), f64::from(s.outer_cone_angle))
            });
            if !(inner >= 0.0 && inner <= outer && outer <= PI) {
                return Err(
                    "the angles of a spot must be 0 <= innerConeAngle <= outerConeAngle <= pi/2"
                        .into(),
                );
            }
            let kind = LightKind::Spot {
                position,
                direction,
                cos_inner: det::cos(inner),
                cos_outer: det::cos(outer),
                tightness: 0.0,
            };
            Light::new(kind, color).with_falloff(Falloff::InverseSquare)
        }
    })
}
