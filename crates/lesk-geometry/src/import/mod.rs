//! Files of other programs, as plain data.
//!
//! Nothing here interprets a material: an [`Asset`] holds what the file states, in the file's terms and units.
//! Every reader bounds what a file declares by the bytes that it has, and returns an [`Error`] for anything else.

pub mod gltf;
pub mod mtl;
pub mod obj;
pub mod ply;
mod source;

use crate::error::{Error, Result};
use crate::mesh::{Mesh, MeshData};
use crate::polygons::{PolygonData, PolygonMesh};
use crate::transform::Transform;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Everything that a file holds.
#[derive(Clone, Debug, Default)]
pub struct Asset {
    /// Meshes, each with one material.
    pub meshes: Vec<NamedMesh>,
    /// Where meshes stand. A file without a scene graph places each of its meshes once.
    pub instances: Vec<Placement>,
    /// Materials as the file describes them.
    pub materials: Vec<Material>,
    /// Cameras.
    pub cameras: Vec<Camera>,
    /// Lights.
    pub lights: Vec<Light>,
    /// What was repaired or left out, one sentence each, with its place.
    pub warnings: Vec<String>,
}

/// A mesh of a file.
#[derive(Clone, Debug)]
pub struct NamedMesh {
    /// Name in the file; may be empty.
    pub name: String,
    /// The triangles.
    pub mesh: Arc<Mesh>,
    /// Index into [`Asset::materials`].
    pub material: Option<usize>,
}

/// A mesh at a place.
#[derive(Clone, Debug)]
pub struct Placement {
    /// Name of the node or mesh; may be empty.
    pub name: String,
    /// Index into [`Asset::meshes`].
    pub mesh: usize,
    /// Where it stands.
    pub world_from_local: Transform,
}

/// A material with its name.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name in the file; may be empty.
    pub name: String,
    /// What the file states.
    pub description: Description,
}

/// The terms in which a file describes a material.
#[derive(Clone, Debug, PartialEq)]
pub enum Description {
    /// Wavefront MTL.
    Mtl(Mtl),
    /// glTF 2.0 metallic-roughness.
    MetallicRoughness(MetallicRoughness),
}

/// A material of a Wavefront MTL file. Colours are linear RGB as written.
#[derive(Clone, Debug, PartialEq)]
pub struct Mtl {
    /// `Kd`: diffuse reflectance.
    pub kd: [f32; 3],
    /// `Ks`: specular reflectance.
    pub ks: [f32; 3],
    /// `Ns`: Phong exponent.
    pub ns: f32,
    /// `Ke`: emission, unit not stated by the format.
    pub ke: [f32; 3],
    /// `d` (or 1 - `Tr`): 1 is opaque.
    pub d: f32,
    /// `Ni`: index of refraction.
    pub ni: f32,
    /// `illum`: illumination model 0 to 10, where stated.
    pub illum: Option<u32>,
    /// `map_Kd`: image of the diffuse reflectance.
    pub map_kd: Option<Texture>,
    /// `map_Ks`: image of the specular reflectance.
    pub map_ks: Option<Texture>,
    /// `map_Ke`: image of the emission.
    pub map_ke: Option<Texture>,
}

impl Default for Mtl {
    fn default() -> Self {
        Mtl {
            kd: [0.8; 3],
            ks: [0.0; 3],
            ns: 0.0,
            ke: [0.0; 3],
            d: 1.0,
            ni: 1.0,
            illum: None,
            map_kd: None,
            map_ks: None,
            map_ke: None,
        }
    }
}

/// A material of glTF 2.0. Factors are linear; every texture multiplies its factor.
#[derive(Clone, Debug, PartialEq)]
pub struct MetallicRoughness {
    /// Base colour and opacity.
    pub base_color: [f32; 4],
    /// Image of the base colour, sRGB.
    pub base_color_texture: Option<Texture>,
    /// 0 dielectric, 1 metal.
    pub metallic: f32,
    /// The roughness dial; alpha is its square.
    pub roughness: f32,
    /// Roughness in green, metalness in blue, linear.
    pub metallic_roughness_texture: Option<Texture>,
    /// Emitted luminance in nits where `KHR_materials_emissive_strength` is used, else relative.
    pub emissive: [f32; 3],
    /// Image of the emission, sRGB.
    pub emissive_texture: Option<Texture>,
    /// Tangent-space normals, linear.
    pub normal_texture: Option<Texture>,
    /// Factor of the x and y of the normal texture.
    pub normal_scale: f32,
    /// What the fourth component of the base colour does.
    pub alpha: Alpha,
    /// Whether back faces show.
    pub double_sided: bool,
    /// Index of refraction (`KHR_materials_ior`; 1.5 where absent).
    pub ior: f32,
    /// Share of light that enters a dielectric instead of being scattered (`KHR_materials_transmission`).
    pub transmission: f32,
    /// Whether the surface bounds a body of that dielectric (`KHR_materials_volume`); else it is a thin sheet.
    pub solid: bool,
}

impl Default for MetallicRoughness {
    fn default() -> Self {
        MetallicRoughness {
            base_color: [1.0; 4],
            base_color_texture: None,
            metallic: 1.0,
            roughness: 1.0,
            metallic_roughness_texture: None,
            emissive: [0.0; 3],
            emissive_texture: None,
            normal_texture: None,
            normal_scale: 1.0,
            alpha: Alpha::Opaque,
            double_sided: false,
            ior: 1.5,
            transmission: 0.0,
            solid: false,
        }
    }
}

/// How opacity is used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Alpha {
    /// Ignored.
    Opaque,
    /// The surface is there where opacity reaches the cutoff.
    Mask(f32),
    /// The surface covers its background by this share.
    Blend,
}

/// An image and how it is laid over a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// Where the image comes from.
    pub image: ImageSource,
    /// Which set of texture coordinates of the mesh it uses, 0 or 1.
    pub uv_set: usize,
    /// Rows of the affine map from the mesh's texture coordinates to the image's; both have v upward, whatever the file
    /// says.
    pub uv: [[f32; 3]; 2],
    /// How it continues beyond 0 to 1, along u and v.
    pub wrap: [Wrap; 2],
    /// Whether texels are blended; `false` shows the nearest.
    pub smooth: bool,
}

/// How an image continues beyond its border.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wrap {
    /// Again from the other side.
    #[default]
    Repeat,
    /// Again, every second time mirrored.
    Mirror,
    /// With its last texel.
    Clamp,
}

/// An encoded image.
#[derive(Clone, Debug, PartialEq)]
pub enum ImageSource {
    /// A file.
    File(PathBuf),
    /// The bytes of a file with its media type, as `image/png`; empty where not stated.
    Embedded {
        /// Media type.
        media_type: String,
        /// Encoded image.
        bytes: Arc<[u8]>,
    },
}

/// A camera: local -z is the view, +y up.
#[derive(Clone, Debug)]
pub struct Camera {
    /// Name in the file; may be empty.
    pub name: String,
    /// Where it stands.
    pub world_from_local: Transform,
    /// How it projects.
    pub projection: Projection,
}

/// How a camera projects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Through a point.
    Perspective {
        /// Full vertical opening, radians.
        vertical_fov: f32,
        /// Width over height, where stated.
        aspect: Option<f32>,
    },
    /// Along parallel rays.
    Orthographic {
        /// Half the width and half the height of the view, metres.
        half_size: [f32; 2],
    },
}

/// A light of `KHR_lights_punctual`: it shines along local -z.
#[derive(Clone, Debug)]
pub struct Light {
    /// Name in the file; may be empty.
    pub name: String,
    /// Where it stands.
    pub world_from_local: Transform,
    /// Linear RGB factor of the intensity.
    pub color: [f32; 3],
    /// Candela for points and spots, lux for directional lights.
    pub intensity: f32,
    /// Which kind.
    pub kind: LightKind,
}

/// The kind of a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// Into all directions.
    Point,
    /// From infinitely far.
    Directional,
    /// Into a cone.
    Spot {
        /// Angle from the axis up to which it has full intensity, radians.
        inner: f32,
        /// Angle from the axis beyond which it is dark, radians.
        outer: f32,
    },
}

impl Asset {
    /// Reads a file; the ending of its name says which kind: `obj`, `ply`, `gltf` or `glb`.
    ///
    /// # Errors
    /// Another ending; what the reader finds.
    pub fn read(path: &Path) -> Result<Asset> {
        let ending = path.extension().and_then(|e| e.to_str()).unwrap_or("").to_ascii_lowercase();
        match ending.as_str() {
            "obj" => obj::read(path),
            "ply" => ply::read(path),
            "gltf" | "glb" => gltf::read(path),
            _ => Err(Error::new(format!("meshes with the ending `{ending}` cannot be read"))
                .hint("accepted are `obj`, `ply`, `gltf` and `glb`")
                .at(path.display())),
        }
    }

    /// Checks a mesh, notes its repairs and adds it; nothing is added where no triangle is left.
    /// `polygons` are given where they say more than the triangles.
    fn add_mesh(
        &mut self,
        name: &str,
        data: MeshData,
        polygons: Option<PolygonData>,
        material: Option<usize>,
    ) -> Result<Option<usize>> {
        let place = if name.is_empty() { "mesh".to_string() } else { format!("mesh `{name}`") };
        let (mesh, repairs) = Mesh::new(data).map_err(|e| e.at(&place))?;
        for (count, what) in [
            (repairs.degenerate_triangles, "triangles without area dropped"),
            (repairs.replaced_normals, "unusable normals replaced by those of the faces around"),
            (repairs.replaced_uvs, "texture coordinates that are not finite replaced by 0"),
            (repairs.turned_triangles, "triangles turned to the side of their normals"),
            (usize::from(repairs.dropped_tangents), "list of tangents that are no directions dropped"),
        ] {
            if count > 0 {
                self.warn(format!("{place}: {count} {what}"));
            }
        }
        if mesh.triangles().is_empty() {
            self.warn(format!("{place}: no triangle left, dropped"));
            return Ok(None);
        }
        let mesh = match polygons {
            Some(polygons) => mesh.with_polygons(Arc::new(PolygonMesh::new(polygons).map_err(|e| e.at(&place))?)),
            None => mesh,
        };
        self.meshes.push(NamedMesh { name: name.to_string(), mesh: Arc::new(mesh), material });
        Ok(Some(self.meshes.len() - 1))
    }

    /// Places every mesh once, where the file has it.
    fn place_all(&mut self) {
        let placed = |(mesh, m): (usize, &NamedMesh)| Placement {
            name: m.name.clone(),
            mesh,
            world_from_local: Transform::IDENTITY,
        };
        self.instances = self.meshes.iter().enumerate().map(placed).collect();
    }

    /// Keeps the first hundred warnings: a broken file could cause one per line.
    fn warn(&mut self, text: String) {
        match self.warnings.len() {
            0..100 => self.warnings.push(text),
            100 => self.warnings.push("more warnings are left out".into()),
            _ => {}
        }
    }
}

/// The file's bytes, with the path in the error.
fn read_file(path: &Path) -> Result<Vec<u8>> {
    std::fs::read(path).map_err(|e| Error::unreadable(&e).at(path.display()))
}

/// `relative` inside the folder of `path`; absolute paths and those that leave the folder are refused.
fn inside_folder(path: &Path, relative: &str) -> Result<PathBuf> {
    use std::path::Component;
    let folder = path.parent().unwrap_or(Path::new(""));
    let tidy = relative.replace('\\', "/");
    let mut out = PathBuf::new();
    let mut depth = 0usize;
    for part in Path::new(&tidy).components() {
        match part {
            Component::Normal(name) => {
                out.push(name);
                depth += 1;
            }
            Component::CurDir => {}
            Component::ParentDir if depth > 0 => {
                out.pop();
                depth -= 1;
            }
            _ => {
                return Err(Error::new(format!("`{relative}` leads out of the folder of the file"))
                    .hint("files that belong together must lie in one folder or below it"));
            }
        }
    }
    // a drive letter, a scheme or a nul byte has no place in a relative path
    if out.as_os_str().is_empty() || tidy.contains([':', '\0']) {
        return Err(Error::new(format!("`{relative}` is no relative path")));
    }
    Ok(folder.join(out))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn references_stay_inside_the_folder() {
        let base = Path::new("/scenes/a.gltf");
        assert_eq!(inside_folder(base, "img/b.png").unwrap(), Path::new("/scenes/img/b.png"));
        assert_eq!(inside_folder(base, "./x/../b.png").unwrap(), Path::new("/scenes/b.png"));
        for bad in ["../b.png", "/etc/passwd", "x/../../b", "C:\\b", "http://a/b", "", "a\0b", "..\\b"] {
            assert!(inside_folder(base, bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn unknown_endings_are_named() {
        let e = Asset::read(Path::new("a.stl")).unwrap_err().to_string();
        assert!(e.contains("`stl`") && e.contains("`obj`"), "{e}");
    }
}
