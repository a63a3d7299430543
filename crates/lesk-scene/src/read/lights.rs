//! Lights and environments of a scene file.

use super::fields::{Expected, Fields, Problems};
use super::node::Node;
use crate::description::{
    AreaLightDescription, Emission, EnvironmentDescription, EnvironmentKind, LightColor, LightDescription, LightKind,
    MapStrength, Picture,
};
use crate::error::{Problem, list};
use crate::schema::{AMOUNTS, AREA_LIGHT, COLORS, ENVIRONMENT, LIGHT};
use lesk_light::{Spectrum, Up};
use lesk_math::Vec3;

pub(super) fn light(node: &Node, problems: &mut Problems) -> Option<LightDescription> {
    let (kind, fields) = Fields::variant(node, &LIGHT, problems)?;
    let emission = emission(&fields, kind, problems);
    let kind = match kind {
        "point" => LightKind::Point { position: fields.numbers("position")? },
        "directional" => LightKind::Directional { direction: direction(&fields, problems)? },
        _ => spot(&fields, problems)?,
    };
    let name = fields.text("name").unwrap_or_default().to_string();
    Some(LightDescription { name, kind, emission: emission?, place: fields.place })
}

fn spot(fields: &Fields, problems: &mut Problems) -> Option<LightKind> {
    let outer = fields.si("outer");
    let inner = if fields.has("inner") { fields.si("inner") } else { outer.map(|o| 0.75 * o) };
    let position: Option<[f64; 3]> = fields.numbers("position");
    let direction = match fields.one_of(&["direction", "target"], problems) {
        Some("target") => {
            let (target, position) = (Vec3::from(fields.numbers("target")?), Vec3::from(position?));
            (target - position).to_array()
        }
        Some(_) => fields.numbers("direction")?,
        None => {
            let text = "light `spot` has no `direction`";
            problems.add(Problem::new(fields.place, text).hint("add `direction`, or `target` to point at"));
            return None;
        }
    };
    Some(LightKind::Spot { position: position?, direction, half_angles: [inner?, outer?] })
}

fn direction(fields: &Fields, problems: &mut Problems) -> Option<[f64; 3]> {
    let direction: [f64; 3] = fields.numbers("direction")?;
    if direction == [0.0; 3] {
        problems.add(Problem::new(fields.place_of("direction"), "`direction` is [0, 0, 0], it must have a length"));
        return None;
    }
    Some(direction)
}

/// The light of an object's surface.
pub(super) fn area_light(node: &Node, problems: &mut Problems) -> Option<AreaLightDescription> {
    let fields = Fields::of(node, &Expected::plain("light", AREA_LIGHT), problems)?;
    let emission = emission(&fields, "light", problems)?;
    Some(AreaLightDescription { emission, two_sided: fields.bool("two_sided").unwrap_or(false) })
}

/// The one amount and the colour of a light called `kind`.
fn emission(fields: &Fields, kind: &str, problems: &mut Problems) -> Option<Emission> {
    let accepted: Vec<&str> = match kind {
        "point" | "spot" => vec!["flux", "intensity"],
        "directional" => vec!["illuminance"],
        "sky" => vec!["luminance", "illuminance"],
        _ => vec!["flux", "luminance"],
    };
    let color = color(fields, problems);
    let Some(amount) = fields.one_of(&AMOUNTS, problems) else {
        let text =
            format!("{kind} does not say how strong it is, {} is accepted", list(&accepted).replace(", ", " or "));
        let hint = format!("for example `{}`", example(accepted[0]));
        problems.add(Problem::new(fields.place, text).hint(hint));
        return None;
    };
    Some(Emission { amount: fields.quantity(amount)?, color: color?, place: fields.place_of(amount) })
}

fn example(amount: &str) -> &'static str {
    match amount {
        "flux" => "flux = \"1100 lm\"",
        "illuminance" => "illuminance = \"10 klx\"",
        _ => "luminance = \"1000 cd/m2\"",
    }
}

fn color(fields: &Fields, problems: &mut Problems) -> Option<LightColor> {
    let chosen = fields.one_of(&COLORS, problems);
    let spectrum = match chosen {
        None => return Some(LightColor::White),
        Some("color") => return fields.numbers("color").map(LightColor::Rgb),
        Some("temperature") => Spectrum::blackbody(fields.si("temperature")?),
        Some(_) => Spectrum::parse(fields.text("spectrum")?),
    };
    match spectrum {
        Ok(spectrum) => Some(LightColor::Spectrum(spectrum)),
        Err(e) => {
            let place = fields.place_of(chosen.unwrap_or_default());
            problems.add(Problem::from_text(place, &e.to_string()));
            None
        }
    }
}

pub(super) fn environment(node: &Node, problems: &mut Problems) -> Option<EnvironmentDescription> {
    let (kind, fields) = Fields::variant(node, &ENVIRONMENT, problems)?;
    let up = if fields.text("up") == Some("y") { Up::Y } else { Up::Z };
    let kind = if kind == "sky" {
        let dome = fields.bool("dome").unwrap_or(false);
        EnvironmentKind::Sky { emission: emission(&fields, "sky", problems)?, dome }
    } else {
        let strength = match fields.one_of(&["scale", "illuminance", "luminance"], problems) {
            Some("illuminance") => MapStrength::Illuminance(fields.si("illuminance")?),
            Some("luminance") => MapStrength::Luminance(fields.si("luminance")?),
            Some(_) => MapStrength::Scale(fields.number("scale")?),
            None => MapStrength::Scale(1.0),
        };
        let rotation = if fields.has("rotation") { fields.si("rotation")? } else { 0.0 };
        EnvironmentKind::Map { image: Picture::File(fields.text("file")?.into()), rotation, strength }
    };
    Some(EnvironmentDescription { kind, up, place: fields.place })
}
