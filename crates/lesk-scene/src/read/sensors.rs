//! Sensors of a scene file.

use super::fields::{Fields, Problems};
use super::node::Node;
use crate::error::{Problem, name_hint};
use crate::schema::SENSOR;
use crate::sensor::{Form, Limits, MeasureSettings, Quantity, Response, Sensor, grid_spacing};
use crate::tasks::{Task, tasks};
use lesk_geometry::Transform;
use lesk_light::Spectrum;
use lesk_math::Vec3;

const UP: [f64; 3] = [0.0, 0.0, 1.0];

pub(super) fn settings(settings: &mut MeasureSettings, fields: &Fields) {
    settings.maintenance_factor = fields.number("maintenance_factor").unwrap_or(settings.maintenance_factor);
    settings.error = fields.number("error").unwrap_or(settings.error);
    settings.max_depth = fields.integer("max_depth").map_or(settings.max_depth, |i| i as u32);
}

pub(super) fn sensor(node: &Node, problems: &mut Problems) -> Option<Sensor> {
    let (kind, fields) = Fields::variant(node, &SENSOR, problems)?;
    let quantity = quantity(&fields, problems);
    let task = task(&fields, problems);
    let form = form(kind, &fields, problems);
    let response = response(&fields, form.as_ref(), problems);
    let number = |name| fields.number(name);
    let limits = Limits { mean: fields.si("min_mean"), uniformity: number("min_uniformity"), ugr: number("max_ugr") };
    Some(Sensor {
        name: fields.text("name")?.to_string(),
        form: form?,
        response: response?,
        quantity: quantity?,
        task: task?,
        limits,
        place: fields.place,
    })
}

fn form(kind: &str, fields: &Fields, problems: &mut Problems) -> Option<Form> {
    match kind {
        "point" => Some(Form::Point { position: fields.numbers("position")? }),
        "line" => line(fields, problems),
        "grid" => grid(fields, problems),
        "camera" => camera(fields, problems),
        "luminance" => {
            let opening = if fields.has("opening") { fields.si("opening")? } else { 1f64.to_radians() };
            if !(0.0..std::f64::consts::PI).contains(&opening) {
                let text = format!("`opening` is {} deg, 0 to below 180 deg is accepted", opening.to_degrees());
                problems.add(Problem::new(fields.place_of("opening"), text));
            }
            let position = fields.numbers("position")?;
            Some(Form::Luminance { position, direction: sight(kind, fields, problems)?, half_angle: 0.5 * opening })
        }
        _ => {
            let position = fields.numbers("position")?;
            let up = if fields.has("up") { fields.numbers("up")? } else { UP };
            let direction = sight(kind, fields, problems)?;
            if Vec3::from(direction).cross(Vec3::from(up)).length() < 1e-9 {
                let text = "the line of sight and `up` are parallel";
                problems.add(Problem::new(fields.place, text).hint("give `up`, the direction of the observer's head"));
                return None;
            }
            Some(Form::Glare { position, direction, up })
        }
    }
}

/// `direction`, or the way to `target`.
fn sight(kind: &str, fields: &Fields, problems: &mut Problems) -> Option<[f64; 3]> {
    match fields.one_of(&["direction", "target"], problems) {
        Some("target") => {
            let (target, position) = (Vec3::from(fields.numbers("target")?), Vec3::from(fields.numbers("position")?));
            direction("target", (target - position).to_array(), fields, problems)
        }
        Some(_) => direction("direction", fields.numbers("direction")?, fields, problems),
        None => {
            let text = format!("sensor `{kind}` has no `direction`");
            problems.add(Problem::new(fields.place, text).hint("add `direction`, or `target` to look at"));
            None
        }
    }
}

/// The same with unit length.
fn direction(name: &'static str, given: [f64; 3], fields: &Fields, problems: &mut Problems) -> Option<[f64; 3]> {
    let length = Vec3::from(given).length();
    if length > 1e-12 && length < 1e12 {
        return Some((Vec3::from(given) / length).to_array());
    }
    let text = format!("`{name}` gives the direction {given:?}, it must have a length");
    problems.add(Problem::new(fields.place_of(name), text));
    None
}

fn line(fields: &Fields, problems: &mut Problems) -> Option<Form> {
    let (from, to): ([f64; 3], [f64; 3]) = (fields.numbers("from")?, fields.numbers("to")?);
    let length = (Vec3::from(to) - Vec3::from(from)).length();
    if length == 0.0 {
        problems.add(Problem::new(fields.place, "`from` and `to` are the same point"));
        return None;
    }
    let spacing = if fields.has("spacing") { fields.si("spacing")? } else { grid_spacing(length) };
    let count = (length / spacing).ceil() as usize;
    limit(count, fields, problems)?;
    Some(Form::Line { from, to, count })
}

fn grid(fields: &Fields, problems: &mut Problems) -> Option<Form> {
    let corner: [f64; 3] = fields.numbers("corner")?;
    let edges: [Vec3<f64>; 2] = [fields.numbers("u")?, fields.numbers("v")?].map(Vec3::from);
    let margin = if fields.has("margin") { fields.si("margin")? } else { 0.0 };
    let lengths = edges.map(|e| e.length() - 2.0 * margin);
    if !(edges[0].cross(edges[1]).length() > 1e-12 && lengths.iter().all(|l| *l > 0.0)) {
        let problem = match margin > 0.0 {
            true => Problem::new(fields.place_of("margin"), "`margin` leaves nothing of the grid"),
            false => Problem::new(fields.place, "`u` and `v` of the grid span no area"),
        };
        problems.add(problem);
        return None;
    }
    let units = edges.map(|e| e / e.length());
    let start = Vec3::from(corner) + (units[0] + units[1]) * margin;
    let spacing = if fields.has("spacing") { fields.si("spacing")? } else { grid_spacing(lengths[0].max(lengths[1])) };
    // a hair less, so that 6 m at 0.5 m are 12 cells and not 13
    let counts = lengths.map(|l| ((l / spacing - 1e-9).ceil() as usize).max(1));
    limit(counts[0].saturating_mul(counts[1]), fields, problems)?;
    let edges = [(units[0] * lengths[0]).to_array(), (units[1] * lengths[1]).to_array()];
    Some(Form::Grid { corner: start.to_array(), edges, counts })
}

fn limit(count: usize, fields: &Fields, problems: &mut Problems) -> Option<()> {
    if count <= crate::sensor::MAX_PROBES {
        return Some(());
    }
    let text = format!("the sensor has {count} points, up to {} are accepted", crate::sensor::MAX_PROBES);
    problems.add(Problem::new(fields.place_of("spacing"), text).hint("make `spacing` larger"));
    None
}

fn camera(fields: &Fields, problems: &mut Problems) -> Option<Form> {
    let [eye, target]: [[f64; 3]; 2] = [fields.numbers("eye")?, fields.numbers("target")?];
    let up = if fields.has("up") { fields.numbers("up")? } else { UP };
    let fov = if fields.has("fov") { fields.si("fov")? } else { 40f64.to_radians() };
    if !(1e-4..=3.139).contains(&fov) {
        let text = format!("`fov` is {} deg, 0.006 to 179.8 deg is accepted", fov.to_degrees());
        problems.add(Problem::new(fields.place_of("fov"), text));
    }
    let size = match fields.integers("size") {
        Some(&[width, height]) => [width as u32, height as u32],
        _ => [64, 48],
    };
    let [eye, target, up] = [eye, target, up].map(Vec3::from);
    match Transform::look_at(eye, target, up) {
        Ok(world_from_local) => {
            let illuminance = fields.text("of") == Some("illuminance");
            Some(Form::Camera { world_from_local, horizontal_fov: fov, size, illuminance })
        }
        Err(e) => {
            problems.add(Problem::from_text(fields.place, &e.to_string()));
            None
        }
    }
}

fn response(fields: &Fields, form: Option<&Form>, problems: &mut Problems) -> Option<Response> {
    let usual = match form {
        Some(Form::Grid { edges: [u, v], .. }) => Vec3::from(*u).cross(Vec3::from(*v)).normalize().to_array(),
        _ => UP,
    };
    let receiver = fields.text("receiver").unwrap_or("planar");
    let usual = if receiver.ends_with("cylindrical") { UP } else { usual };
    let axis = match fields.has("normal") {
        true => direction("normal", fields.numbers("normal")?, fields, problems)?,
        false => usual,
    };
    if fields.has("facing") != (receiver == "semicylindrical") && form.is_some() {
        let text = match receiver {
            "semicylindrical" => "receiver `semicylindrical` has no `facing`".to_string(),
            _ => format!("`facing` does not belong to receiver `{receiver}`, but to `semicylindrical`"),
        };
        problems.add(Problem::new(fields.place_of("facing"), text));
        return None;
    }
    Some(match receiver {
        "cylindrical" => Response::Cylindrical { axis },
        "semicylindrical" => {
            let given = Vec3::from(fields.numbers::<3>("facing")?);
            let across = given - Vec3::from(axis) * given.dot(Vec3::from(axis));
            Response::Semicylindrical { axis, facing: direction("facing", across.to_array(), fields, problems)? }
        }
        "spherical" => Response::Spherical,
        "hemispherical" => Response::Hemispherical { normal: axis },
        _ => Response::Planar { normal: axis },
    })
}

fn quantity(fields: &Fields, problems: &mut Problems) -> Option<Quantity> {
    let name = fields.text("quantity").unwrap_or("photometric");
    let spectrum = match fields.text("spectrum").map(Spectrum::parse) {
        Some(Ok(spectrum)) => Some(spectrum),
        Some(Err(e)) => {
            problems.add(Problem::from_text(fields.place_of("spectrum"), &e.to_string()));
            return None;
        }
        None => None,
    };
    match (name, spectrum) {
        ("photometric", None) => Some(Quantity::Photometric),
        ("radiometric", Some(spectrum)) => Some(Quantity::Radiometric(spectrum)),
        ("photons", Some(spectrum)) => Some(Quantity::Photons(spectrum)),
        ("photometric", Some(_)) => {
            let text = "`spectrum` is given, but the quantity is photometric";
            problems.add(Problem::new(fields.place_of("spectrum"), text).hint("add `quantity = \"radiometric\"`"));
            None
        }
        _ => {
            let text = format!("quantity `{name}` needs a named spectrum");
            let hint = format!("add `spectrum`: {}", Spectrum::ACCEPTED);
            problems.add(Problem::new(fields.place_of("quantity"), text).hint(hint));
            None
        }
    }
}

/// The task, if there is one; `None` for an unknown one.
fn task(fields: &Fields, problems: &mut Problems) -> Option<Option<&'static Task>> {
    let Some(id) = fields.text("task") else { return Some(None) };
    let task = Task::find(id);
    if task.is_none() {
        let known: Vec<&str> = tasks().iter().map(|t| t.id.as_str()).collect();
        let text = format!("there is no task `{}`", crate::error::shown(id));
        let hint = match name_hint(id, &known) {
            near if near.contains("did you mean") => near,
            _ => "`lesk lux --tasks` lists them".to_string(),
        };
        problems.add(Problem::new(fields.place_of("task"), text).hint(hint));
        return None;
    }
    Some(task)
}
