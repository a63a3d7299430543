//! Shapes, meshes, importers and ray casting.
