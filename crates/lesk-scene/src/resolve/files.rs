//! Files, each read once, and the hash of what they hold.

use crate::description::Picture;
use lesk_geometry::Mesh;
use lesk_geometry::import::Asset;
use lesk_image::texture::{Interpolation, Role, Wrap};
use lesk_image::{Image, Texture, Transfer, io};
use lesk_light::photometry::{Photometry, ReadOptions};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// How an image becomes a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Reading {
    pub role: Role,
    pub srgb: Option<bool>,
    pub wrap: [Wrap; 2],
    pub interpolation: Interpolation,
}

/// An image read for a parameter, with the smallest and largest of its numbers after decoding.
#[derive(Clone, Debug)]
pub(super) struct Loaded {
    pub texture: Arc<Texture>,
    pub image: Arc<Image>,
}

/// Everything that was read.
pub(super) struct Files {
    folder: PathBuf,
    images: HashMap<PathBuf, Result<Arc<Image>, String>>,
    textures: Vec<(PathBuf, Reading, Loaded)>,
    assets: HashMap<PathBuf, Result<Arc<Asset>, String>>,
    photometries: HashMap<(PathBuf, usize), Result<Arc<Photometry>, String>>,
    read: Vec<PathBuf>,
    hasher: blake3::Hasher,
}

impl Files {
    pub fn new(folder: PathBuf) -> Self {
        Files {
            folder,
            images: HashMap::new(),
            textures: Vec::new(),
            assets: HashMap::new(),
            photometries: HashMap::new(),
            read: Vec::new(),
            hasher: blake3::Hasher::new(),
        }
    }

    /// The files that were read, in order.
    pub fn list(&self) -> Vec<PathBuf> {
        self.read.clone()
    }

    pub fn hasher(&self) -> &blake3::Hasher {
        &self.hasher
    }

    fn path(&self, file: &Path) -> PathBuf {
        self.folder.join(file)
    }

    /// The picture, decoded.
    pub fn image(&mut self, picture: &Picture) -> Result<Arc<Image>, String> {
        match picture {
            Picture::Image(image) => {
                self.hash_image(image);
                Ok(image.clone())
            }
            Picture::Encoded(bytes) => {
                let image = io::decode(bytes).map(Arc::new).map_err(|e| e.to_string())?;
                self.hash_image(&image);
                Ok(image)
            }
            Picture::File(file) => {
                let path = self.path(file);
                if let Some(known) = self.images.get(&path) {
                    return known.clone();
                }
                let result = self.read_image(&path);
                self.images.insert(path, result.clone());
                result
            }
        }
    }

    fn read_image(&mut self, path: &Path) -> Result<Arc<Image>, String> {
        let image = io::read(path).map_err(|e| e.to_string())?;
        self.hash_image(&image);
        self.read.push(path.to_path_buf());
        Ok(Arc::new(image))
    }

    fn hash_image(&mut self, image: &Image) {
        let head = format!("{} {} {} {:?}", image.width(), image.height(), image.channels(), image.transfer());
        self.hasher.update(head.as_bytes());
        let mut bytes = Vec::with_capacity(1 << 16);
        for block in image.data().chunks(1 << 14) {
            bytes.clear();
            block.iter().for_each(|v| bytes.extend(v.to_le_bytes()));
            self.hasher.update(&bytes);
        }
    }

    /// The picture as a texture; the same file read the same way is one texture.
    pub fn texture(&mut self, picture: &Picture, reading: Reading) -> Result<Loaded, String> {
        let path = match picture {
            Picture::File(file) => Some(self.path(file)),
            _ => None,
        };
        let known = self.textures.iter().find(|(p, r, _)| Some(p) == path.as_ref() && *r == reading);
        if let Some((_, _, loaded)) = known {
            return Ok(loaded.clone());
        }
        let mut image = self.image(picture)?;
        if let Some(srgb) = reading.srgb {
            let transfer = if srgb { Transfer::Srgb } else { Transfer::Linear };
            let (w, h, c) = (image.width(), image.height(), image.channels());
            let data = image.data().to_vec();
            image = Arc::new(Image::new(w, h, c, transfer, data).map_err(|e| e.to_string())?);
        }
        let texture = Texture::new((*image).clone(), reading.role, reading.wrap, reading.interpolation);
        let loaded = Loaded { texture: Arc::new(texture), image };
        if let Some(path) = path {
            self.textures.push((path, reading, loaded.clone()));
        }
        Ok(loaded)
    }

    /// The luminaire of a photometric file.
    pub fn photometry(&mut self, file: &Path, lamp_set: usize) -> Result<Arc<Photometry>, String> {
        let path = self.path(file);
        if let Some(known) = self.photometries.get(&(path.clone(), lamp_set)) {
            return known.clone();
        }
        let options = ReadOptions { strict: false, lamp_set };
        let result = Photometry::read(&path, options).map(Arc::new).map_err(|e| e.to_string());
        if let Ok(photometry) = &result {
            self.read.push(path.clone());
            let web = &photometry.web;
            let head = format!("{:?} {:?} {:?} {:?}", web.coordinates(), web.v(), web.h(), photometry.opening);
            self.hasher.update(head.as_bytes());
            web.values().iter().for_each(|x| {
                self.hasher.update(&x.to_le_bytes());
            });
        }
        self.photometries.insert((path, lamp_set), result.clone());
        result
    }

    /// The meshes, materials, cameras and lights of a file, with its path.
    pub fn asset(&mut self, file: &Path) -> Result<(PathBuf, Arc<Asset>), String> {
        let path = self.path(file);
        if let Some(known) = self.assets.get(&path) {
            return known.clone().map(|asset| (path, asset));
        }
        let result = Asset::read(&path).map(Arc::new).map_err(|e| e.to_string());
        if let Ok(asset) = &result {
            self.read.push(path.clone());
            self.hash_asset(asset);
        }
        self.assets.insert(path.clone(), result.clone());
        result.map(|asset| (path, asset))
    }

    fn hash_asset(&mut self, asset: &Asset) {
        for mesh in &asset.meshes {
            self.hash_mesh(&mesh.mesh);
        }
        let rest = format!("{:?} {:?} {:?} {:?}", asset.instances, asset.materials, asset.cameras, asset.lights);
        self.hasher.update(rest.as_bytes());
    }

    /// Adds the numbers of a mesh to the hash.
    pub fn hash_mesh(&mut self, mesh: &Mesh) {
        let mut bytes = Vec::new();
        let floats = |v: &[f32], out: &mut Vec<u8>| v.iter().for_each(|x| out.extend(x.to_le_bytes()));
        for v in mesh.positions().iter().chain(mesh.normals()) {
            floats(&v.to_array(), &mut bytes);
        }
        mesh.uvs().iter().for_each(|uv| floats(uv, &mut bytes));
        mesh.triangles().iter().flatten().for_each(|i| bytes.extend(i.to_le_bytes()));
        let counts = [mesh.positions().len(), mesh.normals().len(), mesh.uvs().len(), mesh.triangles().len()];
        self.hasher.update(format!("{counts:?}").as_bytes());
        self.hasher.update(&bytes);
    }
}
