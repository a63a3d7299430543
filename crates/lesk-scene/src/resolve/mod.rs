//! From a description to a scene: names become numbers, files become data, and every problem is kept.

mod camera;
mod files;
mod groups;
mod import;
mod lights;
mod luminaires;
mod materials;
mod objects;

use crate::description::SceneDescription;
use crate::error::{Place, Problem, SceneError};
use crate::scene::{Object, Scene};
use crate::{Camera, Material, MeasureSettings, RasterSettings};
use files::Files;
use lesk_geometry::WorldBuilder;
use lesk_light::{Light, Lights};
use std::collections::{BTreeSet, HashMap};
use std::fmt::{self, Write};

/// Problems and notes beyond these numbers are not kept.
const MAX_PROBLEMS: usize = 1000;
const MAX_NOTES: usize = 200;

impl SceneDescription {
    /// Looks up every name, reads every file, builds the trees.
    ///
    /// # Errors
    /// All problems that there are, see [`SceneError`].
    pub fn build(&self) -> Result<Scene, SceneError> {
        self.resolve().map_err(|problems| SceneError::new(problems, None, ""))
    }

    pub(crate) fn resolve(&self) -> Result<Scene, Vec<Problem>> {
        let mut resolver = Resolver::new(self);
        resolver.materials();
        resolver.objects();
        resolver.lights();
        resolver.check(Place::NONE, "raster", self.raster.check());
        let camera = resolver.camera();
        resolver.finish(camera)
    }
}

/// What has been found so far.
struct Resolver<'a> {
    description: &'a SceneDescription,
    problems: Vec<Problem>,
    notes: Vec<String>,
    spectra: BTreeSet<String>,
    files: Files,
    materials: Vec<Material>,
    /// The number of each named material; `None` for one with a problem of its own.
    material_names: HashMap<String, Option<u32>>,
    world: WorldBuilder,
    geometries: objects::Geometries,
    objects: Vec<Object>,
    lights: Vec<Light>,
}

impl<'a> Resolver<'a> {
    fn new(description: &'a SceneDescription) -> Self {
        Resolver {
            description,
            problems: Vec::new(),
            notes: Vec::new(),
            spectra: BTreeSet::new(),
            files: Files::new(description.folder.clone()),
            materials: Vec::new(),
            material_names: HashMap::new(),
            world: WorldBuilder::new(),
            geometries: objects::Geometries::default(),
            objects: Vec::new(),
            lights: Vec::new(),
        }
    }

    fn problem(&mut self, problem: Problem) {
        if self.problems.len() < MAX_PROBLEMS && !self.problems.contains(&problem) {
            self.problems.push(problem);
        }
    }

    /// Keeps the problem of a result, as an error text with its place and what it is about.
    fn check<T, E: fmt::Display>(&mut self, place: Place, about: &str, result: Result<T, E>) -> Option<T> {
        match result {
            Ok(value) => Some(value),
            Err(error) => {
                let about = if about.is_empty() { String::new() } else { format!("{about}: ") };
                self.problem(Problem::from_text(place, &format!("{about}{error}")));
                None
            }
        }
    }

    fn note(&mut self, note: String) {
        if self.notes.len() < MAX_NOTES && !self.notes.contains(&note) {
            self.notes.push(note);
        }
    }

    fn finish(mut self, camera: Option<Camera>) -> Result<Scene, Vec<Problem>> {
        let (Some(camera), true) = (camera, self.problems.is_empty()) else {
            return Err(self.problems);
        };
        let lights = std::mem::take(&mut self.lights);
        let lights = self.check(Place::NONE, "", Lights::new(lights));
        let world = std::mem::take(&mut self.world).build();
        let world = self.check(Place::NONE, "", world);
        let (Some(world), Some(lights)) = (world, lights) else {
            return Err(self.problems);
        };
        if lights.is_empty() {
            self.note("the scene has no light: its picture is black".into());
        }
        let d = self.description;
        let fingerprint = self.fingerprint();
        Ok(Scene {
            title: d.title.clone(),
            camera,
            film: d.film.clone(),
            render: d.render.clone(),
            raster: d.raster.clone(),
            sensors: d.sensors.clone(),
            measure: d.measure,
            world,
            objects: self.objects,
            materials: self.materials,
            lights,
            notes: self.notes,
            spectra: self.spectra.into_iter().collect(),
            files: self.files.list(),
            fingerprint,
        })
    }

    /// The hash of everything that the description says and that its files hold; samples per pixel and exposure, which
    /// a caller may change, are left out, and so is the folder.
    fn fingerprint(&self) -> [u8; 32] {
        let mut plain = self.description.clone();
        plain.folder.clear();
        plain.film.ev100 = None;
        plain.render.spp = 0;
        // they change no traced picture
        plain.raster = RasterSettings::default();
        plain.sensors.clear();
        plain.measure = MeasureSettings::default();
        let mut hasher = HashText(self.files.hasher().clone());
        // writing to a hasher cannot fail
        let _ = write!(hasher, "{plain:?}");
        *hasher.0.finalize().as_bytes()
    }
}

/// Text that is hashed instead of kept.
struct HashText(blake3::Hasher);

impl fmt::Write for HashText {
    fn write_str(&mut self, s: &str) -> fmt::Result {
        self.0.update(s.as_bytes());
        Ok(())
    }
}
