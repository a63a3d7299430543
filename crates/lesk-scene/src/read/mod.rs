//! From the text of a scene file to its description.

mod camera;
mod fields;
mod lights;
mod materials;
mod node;
mod objects;
mod raster;
mod sensors;

use crate::description::SceneDescription;
use crate::error::{Problem, SceneError};
use crate::scene::{Film, RenderSettings, Scene};
use crate::schema::{self, ROOT};
use fields::{Expected, Fields, Problems};
use lesk_image::PixelFilter;
use std::path::Path;

/// Longest scene file: larger ones are data, which belong into files of their own.
const MAX_BYTES: u64 = 64 << 20;

impl Scene {
    /// Reads a scene file and everything that it names.
    ///
    /// # Errors
    /// All problems that there are, with their lines.
    pub fn load(path: impl AsRef<Path>) -> Result<Scene, SceneError> {
        let path = path.as_ref();
        let text = read_text(path)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut scene = Self::resolve_text(&text, folder).map_err(|p| SceneError::new(p, Some(path.into()), &text))?;
        scene.files.insert(0, path.into());
        Ok(scene)
    }

    /// Reads a scene from text; relative file names start at `folder`.
    ///
    /// # Errors
    /// All problems that there are, with their lines.
    pub fn parse(text: &str, folder: impl AsRef<Path>) -> Result<Scene, SceneError> {
        Self::resolve_text(text, folder.as_ref()).map_err(|problems| SceneError::new(problems, None, text))
    }

    fn resolve_text(text: &str, folder: &Path) -> Result<Scene, Vec<Problem>> {
        let (description, mut problems) = read(text, folder);
        // what could be read is looked up even where the rest could not: all problems at once
        let scene = description.resolve();
        if problems.is_empty() {
            return scene;
        }
        problems.extend(scene.err().unwrap_or_default());
        Err(problems)
    }
}

impl SceneDescription {
    /// Reads the description from the text of a scene file; relative file names start at `folder`. Files are not
    /// opened, see [`build`](Self::build).
    ///
    /// # Errors
    /// All problems of the text, with their lines.
    pub fn parse(text: &str, folder: impl AsRef<Path>) -> Result<SceneDescription, SceneError> {
        let (description, problems) = read(text, folder.as_ref());
        if problems.is_empty() { Ok(description) } else { Err(SceneError::new(problems, None, text)) }
    }
}

fn read_text(path: &Path) -> Result<String, SceneError> {
    let fail = |text: String| SceneError::new(vec![Problem::new(Default::default(), text)], Some(path.into()), "");
    let size = std::fs::metadata(path).map_err(|e| fail(lesk_geometry::Error::unreadable(&e).message))?.len();
    if size > MAX_BYTES {
        return Err(fail(format!("scene file has {size} bytes, up to {MAX_BYTES} are accepted")));
    }
    std::fs::read_to_string(path).map_err(|e| fail(lesk_geometry::Error::unreadable(&e).message))
}

/// The description as far as it could be read, and everything that is wrong with it.
fn read(text: &str, folder: &Path) -> (SceneDescription, Vec<Problem>) {
    let mut problems = Problems::default();
    let mut scene = SceneDescription::new(camera::stand_in());
    scene.folder = folder.to_path_buf();
    match node::parse(text) {
        Ok(root) => {
            if let Some(fields) = Fields::of(&root, &Expected::plain("the scene", ROOT), &mut problems) {
                fill(&mut scene, &fields, &mut problems);
            }
        }
        Err(problem) => problems.add(problem),
    }
    (scene, problems.0)
}

fn fill(scene: &mut SceneDescription, root: &Fields, problems: &mut Problems) {
    scene.title = root.text("title").unwrap_or_default().to_string();
    if let Some(node) = root.node("camera")
        && let Some(fields) = Fields::of(node, &Expected::plain("camera", schema::CAMERA), problems)
    {
        scene.film.ev100 = fields.number("ev100");
        if let Some(camera) = camera::camera(&fields, problems) {
            scene.camera = camera;
        }
    }
    if let Some(node) = root.node("film")
        && let Some(fields) = Fields::of(node, &Expected::plain("film", schema::FILM), problems)
    {
        film(&mut scene.film, &fields, problems);
    }
    if let Some(node) = root.node("render")
        && let Some(fields) = Fields::of(node, &Expected::plain("render", schema::RENDER), problems)
    {
        render(&mut scene.render, &fields);
    }
    scene.raster.aovs = scene.render.aovs;
    if let Some(node) = root.node("raster")
        && let Some(fields) = Fields::of(node, &Expected::plain("raster", schema::RASTER), problems)
    {
        raster::settings(&mut scene.raster, &fields, problems);
    }
    if let Some(node) = root.node("measure")
        && let Some(fields) = Fields::of(node, &Expected::plain("measure", schema::MEASURE), problems)
    {
        sensors::settings(&mut scene.measure, &fields);
    }
    scene.sensors = root.list("sensors").iter().filter_map(|n| sensors::sensor(n, problems)).collect();
    scene.materials = root.named("materials").iter().map(|e| materials::material(e, problems)).collect();
    scene.groups = root.named("groups").iter().map(|e| objects::group(e, problems)).collect();
    scene.objects = root.list("objects").iter().filter_map(|n| objects::object(n, problems)).collect();
    for node in root.list("lights") {
        match lights::light(node, problems) {
            Some(lights::Read::Light(light)) => scene.lights.push(light),
            Some(lights::Read::Luminaire(luminaire)) => scene.luminaires.push(luminaire),
            None => {}
        }
    }
    scene.environment = root.node("environment").and_then(|n| lights::environment(n, problems));
}

fn film(film: &mut Film, fields: &Fields, problems: &mut Problems) {
    if let Some(&[width, height]) = fields.integers("size") {
        (film.width, film.height) = (width as u32, height as u32);
        let pixels = u64::from(film.width) * u64::from(film.height);
        if pixels > lesk_image::MAX_PIXELS {
            let text = format!("film has {pixels} pixels, up to {} are accepted", lesk_image::MAX_PIXELS);
            problems.add(Problem::new(fields.place_of("size"), text));
        }
    }
    let name = fields.text("filter").unwrap_or("blackman_harris");
    let filter = match fields.number("filter_radius") {
        None => PixelFilter::named(name),
        Some(radius) => match name {
            "box" => PixelFilter::box_filter(radius),
            "tent" => PixelFilter::tent(radius),
            "gaussian" => PixelFilter::gaussian(radius / 3.0),
            _ => PixelFilter::blackman_harris(radius),
        },
    };
    match filter {
        Ok(filter) => film.filter = filter,
        Err(e) => problems.add(Problem::new(fields.place_of("filter_radius"), e.to_string())),
    }
}

fn render(settings: &mut RenderSettings, fields: &Fields) {
    let number = |name: &str, usual: u32| fields.integer(name).map_or(usual, |i| i as u32);
    settings.spp = number("spp", settings.spp);
    settings.max_depth = number("max_depth", settings.max_depth);
    settings.roulette_depth = number("roulette_depth", settings.roulette_depth);
    settings.seed = fields.integer("seed").map_or(settings.seed, |i| i as u64);
    settings.split = fields.texts("split");
    settings.aovs = fields.bool("aovs").unwrap_or(settings.aovs);
    let terminator = fields.text("shadow_terminator").and_then(|text| text.parse().ok());
    settings.shadow_terminator = terminator.unwrap_or(settings.shadow_terminator);
}
