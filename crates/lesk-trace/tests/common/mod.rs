//! Scenes made in code.
#![allow(dead_code)] // each test file uses a part

use lesk_bsdf::{params, registry};
use lesk_geometry::{Geometry, Transform, World, WorldBuilder};
use lesk_image::PixelFilter;
use lesk_light::{Area, Light, Lights};
use lesk_math::{Color, Vec3, vec3};
use lesk_scene::{Camera, Film, Material, MeasureSettings, Object, RenderSettings, Scene};
use lesk_trace::{Settings, film_for, render};
use std::ops::ControlFlow;

/// A model with some parameters (colours grey), others at their defaults.
pub fn material(id: &str, values: &[(&str, f32)]) -> Material {
    let model = registry::find(id).expect("a model of the registry");
    let mut table: Vec<f32> = params::defaults(model.specs()).iter().map(|&v| v as f32).collect();
    for (name, value) in values {
        let at = params::offset_of(model.specs(), name).expect("a parameter of the model");
        let spec = model.specs().iter().find(|s| s.name == *name).expect("a parameter of the model");
        table[at..at + spec.len()].fill(*value);
    }
    Material::new(id, model, &table, true)
}

/// Builds a scene; every part is public for changes.
pub struct Parts {
    world: WorldBuilder,
    objects: Vec<Object>,
    materials: Vec<Material>,
    emitters: Vec<(usize, f32)>,
    pub lights: Vec<Light>,
}

impl Parts {
    pub fn new() -> Parts {
        Parts { world: WorldBuilder::new(), objects: vec![], materials: vec![], emitters: vec![], lights: vec![] }
    }

    /// Adds an object; `luminance` in cd/m2 makes it a two-sided light.
    pub fn add(&mut self, geometry: Geometry, place: Transform, material: Option<Material>, luminance: f32) {
        let number = self.world.geometry(geometry);
        self.world.instance(number, place).expect("a place that f32 holds");
        let index = material.map(|m| {
            self.materials.push(m);
            self.materials.len() as u32 - 1
        });
        if luminance > 0.0 {
            self.emitters.push((self.objects.len(), luminance));
        }
        self.objects.push(Object { name: String::new(), material: index, light: None });
    }

    pub fn build(mut self, camera: Camera, size: [u32; 2]) -> Scene {
        let world: World = self.world.build().expect("a small world");
        for (object, luminance) in self.emitters {
            let (geometry, place) = (world.geometry_of(object as u32), world.place(object as u32));
            let light = Area::new(geometry, place, Color::splat(luminance), true).expect("a legal light");
            self.objects[object].light = Some(self.lights.len() as u32);
            self.lights.push(Light::Area(light));
        }
        Scene {
            title: String::new(),
            camera,
            film: Film { width: size[0], height: size[1], filter: PixelFilter::box_filter(0.5).unwrap(), ev100: None },
            render: RenderSettings::default(),
            raster: Default::default(),
            sensors: vec![],
            measure: MeasureSettings::default(),
            world,
            objects: self.objects,
            materials: self.materials,
            lights: Lights::new(self.lights).expect("few lights"),
            notes: vec![],
            spectra: vec![],
            files: vec![],
            fingerprint: [7; 32],
        }
    }
}

/// A pinhole camera of a narrow view.
pub fn camera(from: [f64; 3], to: [f64; 3], size: [u32; 2], fov_deg: f64) -> Camera {
    let [from, to]: [Vec3<f64>; 2] = [from.into(), to.into()];
    let up = if (to - from).x.abs() + (to - from).y.abs() < 1e-9 { vec3(0.0, 1.0, 0.0) } else { vec3(0.0, 0.0, 1.0) };
    Camera::new(Transform::look_at(from, to, up).unwrap(), size, fov_deg.to_radians(), 0.0, 1.0).unwrap()
}

pub fn settings(spp: u32, max_depth: u32) -> Settings {
    Settings { render: RenderSettings { spp, max_depth, ..RenderSettings::default() }, time: None }
}

/// Mean luminance of the whole film and its standard error, in cd/m2.
pub fn mean(scene: &Scene, settings: &Settings) -> (f64, f64) {
    let mut film = film_for(scene, settings).unwrap();
    render(scene, settings, &mut film, |_, _| ControlFlow::Continue(()));
    let n = f64::from(film.width()) * f64::from(film.height());
    let (mut sum, mut variance) = (0.0, 0.0);
    for y in 0..film.height() {
        for x in 0..film.width() {
            sum += film.mean(x, y)[1];
            variance += film.variance(x, y)[1];
        }
    }
    (sum / n, variance.sqrt() / n)
}
