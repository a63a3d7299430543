//! The scene graph, cameras and lights.

use super::super::{Asset, Camera, Light, LightKind, Placement, Projection};
use super::container::Document;
use super::{Error, Result, element};
use crate::transform::Transform;
use ::gltf::json::extensions::scene::khr_lights_punctual::Type as LightType;
use ::gltf::json::{self, validation::Checked};
use lesk_math::vec3;

/// Walks the default scene (else the first, else all nodes without a parent); `meshes` are the numbers of the asset's
/// meshes per mesh of the file.
pub(super) fn add_nodes(document: &Document<'_>, meshes: &[Vec<usize>], asset: &mut Asset) -> Result<()> {
    let nodes = &document.root.nodes;
    let mut reached = vec![false; nodes.len()];
    let mut stack: Vec<(usize, Transform)> = Vec::new();
    for root in roots(&document.root)?.into_iter().rev() {
        stack.push((root, Transform::IDENTITY));
    }
    while let Some((number, parent)) = stack.pop() {
        let node = element(nodes, number, "node")?;
        if std::mem::replace(&mut reached[number], true) {
            return Err(Error::new(format!("node {number} is reached twice"))
                .hint("the nodes of a scene must form trees, without cycles and without shared children"));
        }
        let name = node.name.clone().unwrap_or_default();
        let place = format!("node {number} `{}`", name.escape_debug());
        // checked again as a whole: scales multiply down the tree
        let world = match local_transform(node).and_then(|local| Transform::from_rows(*(parent * local).rows())) {
            Ok(world) => world,
            Err(e) => {
                asset.warn(format!("{place}: left out with everything below it: {}", e.message));
                continue;
            }
        };
        add_contents(document, meshes, node, &name, &world, asset).map_err(|e| e.at(place))?;
        for child in node.children.iter().flatten().rev() {
            stack.push((child.value(), world));
        }
    }
    Ok(())
}

fn roots(root: &json::Root) -> Result<Vec<usize>> {
    if root.scenes.is_empty() {
        let mut has_parent = vec![false; root.nodes.len()];
        for child in root.nodes.iter().flat_map(|n| n.children.iter().flatten()) {
            if let Some(slot) = has_parent.get_mut(child.value()) {
                *slot = true;
            }
        }
        return Ok((0..root.nodes.len()).filter(|&i| !has_parent[i]).collect());
    }
    let scene = element(&root.scenes, root.scene.map_or(0, |s| s.value()), "scene")?;
    Ok(scene.nodes.iter().map(|n| n.value()).collect())
}

fn local_transform(node: &json::Node) -> Result<Transform> {
    if let Some(m) = &node.matrix {
        return Transform::from_columns(&m.map(f64::from));
    }
    let t = node.translation.unwrap_or([0.0; 3]).map(f64::from);
    let s = node.scale.unwrap_or([1.0; 3]).map(f64::from);
    let [x, y, z, w] = node.rotation.unwrap_or_default().0.map(f64::from);
    let length = (x * x + y * y + z * z + w * w).sqrt();
    if !(length > 1e-6 && length.is_finite()) || t.iter().any(|x| !x.is_finite()) {
        return Err(Error::new(format!("rotation {:?} or translation {t:?} is unusable", [x, y, z, w])));
    }
    let angle = 2.0 * vec3(x, y, z).length().atan2(w);
    let turn = if angle == 0.0 { Transform::IDENTITY } else { Transform::rotate(vec3(x, y, z), angle)? };
    Ok(Transform::translate(t[0], t[1], t[2]) * turn * Transform::scale(s[0], s[1], s[2])?)
}

fn add_contents(
    document: &Document<'_>,
    meshes: &[Vec<usize>],
    node: &json::Node,
    name: &str,
    world: &Transform,
    asset: &mut Asset,
) -> Result<()> {
    if let Some(mesh) = node.mesh {
        if node.skin.is_some() {
            asset.warn(format!("node `{name}`: skin left out"));
        }
        for &part in element(meshes, mesh.value(), "mesh")? {
            let own = if name.is_empty() { asset.meshes[part].name.clone() } else { name.to_string() };
            asset.instances.push(Placement { name: own, mesh: part, world_from_local: *world });
        }
    }
    if let Some(camera) = node.camera {
        let camera = element(&document.root.cameras, camera.value(), "camera")?;
        let own = camera.name.clone().unwrap_or_else(|| name.to_string());
        asset.cameras.push(Camera { name: own, world_from_local: *world, projection: projection(camera)? });
    }
    if let Some(light) = node.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref()) {
        let extension = document.root.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref());
        let lights = extension.map_or(&[][..], |l| &l.lights);
        let light = element(lights, light.light.value(), "light")?;
        asset.lights.push(placed_light(light, name, world)?);
    }
    Ok(())
}

fn projection(camera: &json::Camera) -> Result<Projection> {
    let positive = |what: &str, x: f32, limit: f32| {
        if x > 0.0 && x < limit {
            Ok(x)
        } else {
            Err(Error::new(format!("camera has `{what}` = {x}, it must be above 0 and below {limit}")))
        }
    };
    match (camera.type_.as_ref(), &camera.perspective, &camera.orthographic) {
        (Checked::Valid(json::camera::Type::Perspective), Some(p), _) => Ok(Projection::Perspective {
            vertical_fov: positive("yfov", p.yfov, std::f32::consts::PI)?,
            aspect: p.aspect_ratio.map(|a| positive("aspectRatio", a, 1e6)).transpose()?,
        }),
        (Checked::Valid(json::camera::Type::Orthographic), _, Some(o)) => Ok(Projection::Orthographic {
            half_size: [positive("xmag", o.xmag.abs(), 1e12)?, positive("ymag", o.ymag.abs(), 1e12)?],
        }),
        _ => Err(Error::new("camera has a type without its properties")),
    }
}

fn placed_light(
    light: &json::extensions::scene::khr_lights_punctual::Light,
    node: &str,
    world: &Transform,
) -> Result<Light> {
    let bad = |what: String| Err(Error::new(format!("light has {what}")));
    if !(light.intensity >= 0.0 && light.intensity.is_finite()) {
        return bad(format!("`intensity` = {}, it must be finite and not negative", light.intensity));
    }
    if !light.color.iter().all(|c| *c >= 0.0 && c.is_finite()) {
        return bad(format!("`color` = {:?}, it must be finite and not negative", light.color));
    }
    let kind = match light.type_ {
        Checked::Valid(LightType::Point) => LightKind::Point,
        Checked::Valid(LightType::Directional) => LightKind::Directional,
        Checked::Valid(LightType::Spot) => {
            let spot = light.spot.clone().unwrap_or_default();
            let (inner, outer) = (spot.inner_cone_angle, spot.outer_cone_angle);
            if !(inner >= 0.0 && inner <= outer && outer > 0.0 && outer <= std::f32::consts::FRAC_PI_2) {
                return bad(format!("cone angles {inner} and {outer}, 0 <= inner <= outer <= pi/2 is accepted"));
            }
            LightKind::Spot { inner, outer }
        }
        Checked::Invalid => return bad("an unknown type".into()),
    };
    let name = light.name.clone().filter(|n| !n.is_empty()).unwrap_or_else(|| node.to_string());
    Ok(Light { name, world_from_local: *world, color: light.color, intensity: light.intensity, kind })
}
