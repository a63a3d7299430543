//! What stands in a scene.

use super::light::{AreaLightDescription, Emission};
use crate::error::Place;
use lesk_geometry::{Mesh, Transform};
use std::fmt;
use std::path::PathBuf;
use std::sync::Arc;

/// Objects under one name, to be placed several times.
#[derive(Clone, Debug)]
pub struct GroupDescription {
    /// The name that instances use.
    pub name: String,
    /// What it consists of.
    pub objects: Vec<ObjectDescription>,
    /// Where it is stated.
    pub place: Place,
}

/// A shape, a file or a group at a place.
#[derive(Clone, Debug)]
pub struct ObjectDescription {
    /// Its name in reports; may be empty.
    pub name: String,
    /// What it is.
    pub shape: Shape,
    /// Where it is.
    pub transform: Transform,
    /// The name of its material; a file's own materials are used where there is none.
    pub material: Option<String>,
    /// The light that its surface emits.
    pub light: Option<AreaLightDescription>,
    /// Where it is stated.
    pub place: Place,
}

impl ObjectDescription {
    /// A shape at the origin.
    pub fn new(shape: Shape) -> Self {
        ObjectDescription {
            name: String::new(),
            shape,
            transform: Transform::IDENTITY,
            material: None,
            light: None,
            place: Place::NONE,
        }
    }

    /// The same with a material.
    #[must_use]
    pub fn material(mut self, name: impl Into<String>) -> Self {
        self.material = Some(name.into());
        self
    }

    /// The same at a place.
    #[must_use]
    pub fn at(mut self, transform: Transform) -> Self {
        self.transform = transform;
        self
    }

    /// The same shining from its outer side.
    #[must_use]
    pub fn light(mut self, emission: Emission) -> Self {
        self.light = Some(AreaLightDescription { emission, two_sided: false, texture: None });
        self
    }
}

/// The form of an object.
#[derive(Clone, Debug)]
pub enum Shape {
    /// Around the origin.
    Sphere {
        /// Metres.
        radius: f64,
    },
    /// In the plane z = 0, normal +z.
    Disk {
        /// Metres.
        radius: f64,
    },
    /// In the plane z = 0 around the origin, normal +z.
    Rectangle {
        /// Width along x and height along y, metres.
        size: [f64; 2],
    },
    /// Around the origin, along the axes.
    Cube {
        /// Edges along x, y and z, metres.
        size: [f64; 3],
    },
    /// Around the z axis, from z = 0 upward.
    Cylinder {
        /// Metres.
        radius: f64,
        /// Metres.
        height: f64,
        /// Whether disks close both ends.
        capped: bool,
    },
    /// The Utah teapot on the plane z = 0.
    Teapot {
        /// Subdivision: each patch has level x level cells.
        level: u32,
    },
    /// Triangles from a program.
    Mesh(Triangles),
    /// All of an OBJ, PLY or glTF file, with its materials and lights.
    File {
        /// The file.
        file: PathBuf,
        /// What to do about shading normals.
        normals: Normals,
    },
    /// The objects of a group.
    Group(String),
}

/// A mesh of a program; shared, so that the same mesh is kept once.
#[derive(Clone)]
pub struct Triangles(pub Arc<Mesh>);

/// The size, without the triangles.
impl fmt::Debug for Triangles {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Mesh({} triangles)", self.0.triangles().len())
    }
}

/// Shading normals of a mesh from a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Normals {
    /// As the file has them; flat where it has none.
    #[default]
    File,
    /// Averaged over the faces around each vertex.
    Smooth,
    /// One per triangle.
    Flat,
}
