//! Lights and environments of a scene file.

use super::fields::{Expected, Fields, Problems};
use super::node::Node;
use crate::description::{
    AreaLightDescription, Emission, EnvironmentDescription, EnvironmentKind, LightColor, LightDescription, LightKind,
    LuminaireDescription, MapStrength, Picture,
};
use crate::error::{Problem, list};
use crate::schema::{AMOUNTS, AREA_LIGHT, COLORS, ENVIRONMENT, LIGHT};
use lesk_light::{HosekSky, Moment, Mounting, SUN_DIAMETER, Spectrum, SunPosition, Up};
use lesk_math::Vec3;
use lesk_quantities::{Quantity, Unit, colorspace};

/// An entry of `lights`.
pub(super) enum Read {
    Light(LightDescription),
    Luminaire(LuminaireDescription),
}

pub(super) fn light(node: &Node, problems: &mut Problems) -> Option<Read> {
    let (kind, fields) = Fields::variant(node, &LIGHT, problems)?;
    if kind == "luminaire" {
        return luminaire(&fields, problems).map(Read::Luminaire);
    }
    let emission = match fields.number("turbidity") {
        Some(turbidity) => sun_emission(&fields, turbidity, problems),
        None => emission(&fields, kind, problems),
    };
    let kind = match kind {
        "point" => LightKind::Point { position: fields.numbers("position")? },
        "directional" => {
            let diameter = if fields.has("diameter") { fields.si("diameter")? } else { 0.0 };
            LightKind::Directional { direction: direction(&fields, problems)?, diameter }
        }
        "sun" => {
            let [elevation, azimuth] = sun(&fields, problems)?;
            let toward = SunPosition { elevation, azimuth }.direction();
            LightKind::Directional { direction: (-toward).to_array(), diameter: SUN_DIAMETER }
        }
        "projector" => projector(&fields, problems)?,
        _ => spot(&fields, problems)?,
    };
    let name = fields.text("name").unwrap_or_default().to_string();
    Some(Read::Light(LightDescription { name, kind, emission: emission?, place: fields.place }))
}

fn spot(fields: &Fields, problems: &mut Problems) -> Option<LightKind> {
    let outer = fields.si("outer");
    let inner = if fields.has("inner") { fields.si("inner") } else { outer.map(|o| 0.75 * o) };
    let direction = aim(fields, "spot", problems);
    Some(LightKind::Spot {
        position: fields.numbers("position")?,
        direction: direction?,
        half_angles: [inner?, outer?],
    })
}

fn projector(fields: &Fields, problems: &mut Problems) -> Option<LightKind> {
    let direction = aim(fields, "projector", problems);
    Some(LightKind::Projector {
        image: Picture::File(fields.text("file")?.into()),
        position: fields.numbers("position")?,
        direction: direction?,
        up: if fields.has("up") { fields.numbers("up")? } else { [0.0, 0.0, 1.0] },
        width: fields.si("width")?,
    })
}

/// The axis of a light at `position`: `direction`, or toward `target`.
fn aim(fields: &Fields, kind: &str, problems: &mut Problems) -> Option<[f64; 3]> {
    match fields.one_of(&["direction", "target"], problems) {
        Some("target") => {
            let (target, position) =
                (Vec3::from(fields.numbers("target")?), Vec3::from(fields.numbers::<3>("position")?));
            Some((target - position).to_array())
        }
        Some(_) => fields.numbers("direction"),
        None => {
            let text = format!("light `{kind}` has no `direction`");
            problems.add(Problem::new(fields.place, text).hint("add `direction`, or `target` to point at"));
            None
        }
    }
}

fn luminaire(fields: &Fields, problems: &mut Problems) -> Option<LuminaireDescription> {
    let color = color(fields, problems);
    let aimed = fields.has("direction") || fields.has("target");
    let direction = if aimed { aim(fields, "luminaire", problems) } else { Some([0.0, 0.0, -1.0]) };
    let factor = |name: &str| if fields.has(name) { fields.number(name) } else { Some(1.0) };
    Some(LuminaireDescription {
        name: fields.text("name").unwrap_or_default().to_string(),
        file: fields.text("file")?.into(),
        lamp_set: fields.integer("lamp_set").unwrap_or(0) as usize,
        mounting: Mounting {
            position: fields.numbers("position")?,
            direction: direction?,
            rotation: if fields.has("rotation") { fields.si("rotation")? } else { 0.0 },
        },
        flux: if fields.has("flux") { Some(fields.quantity("flux")?) } else { None },
        factor: factor("dimming")? * factor("maintenance")?,
        color: color?,
        place: fields.place,
    })
}

/// Elevation and azimuth of the sun, as stated or by place and time.
fn sun(fields: &Fields, problems: &mut Problems) -> Option<[f64; 2]> {
    let stated = ["elevation", "azimuth"].into_iter().find(|name| fields.has(name));
    let placed = ["latitude", "longitude", "time"].into_iter().find(|name| fields.has(name));
    if let (Some(a), Some(b)) = (stated, placed) {
        let text = format!("`{a}` and `{b}` are both there, either the place of the sun or place and time is accepted");
        problems.add(Problem::new(fields.place_of(b), text));
        return None;
    }
    if placed.is_none() {
        let azimuth = if fields.has("azimuth") { fields.si("azimuth")? } else { 0.0 };
        let Some(elevation) = fields.si("elevation") else {
            if !fields.has("elevation") {
                let hint = "add `elevation` and `azimuth`, or `latitude`, `longitude` and `time`";
                problems.add(Problem::new(fields.place, "the sun has no place").hint(hint));
            }
            return None;
        };
        return Some([elevation, azimuth]);
    }
    for name in ["latitude", "longitude", "time"].into_iter().filter(|name| !fields.has(name)) {
        let hint = "a place of the sun needs `latitude`, `longitude` and `time`";
        problems.add(Problem::new(fields.place, format!("the sun has no `{name}`")).hint(hint));
    }
    let (latitude, longitude) = (fields.si("latitude")?.to_degrees(), fields.si("longitude")?.to_degrees());
    let position = Moment::parse_time(fields.text("time")?).and_then(|(date, hours_utc)| {
        let at = Moment {
            latitude_deg: latitude,
            longitude_deg: longitude,
            altitude: 0.0,
            date,
            hours_utc,
            delta_t: None,
            air: None,
        };
        SunPosition::at(&at)
    });
    match position {
        Ok(sun) if sun.elevation > 0.0 => Some([sun.elevation, sun.azimuth]),
        Ok(sun) => {
            let text = format!("the sun is {:.2} deg below the horizon then", -sun.elevation.to_degrees());
            problems.add(Problem::new(fields.place_of("time"), text).hint("take another `time`"));
            None
        }
        Err(e) => {
            problems.add(Problem::from_text(fields.place_of("time"), &e.to_string()));
            None
        }
    }
}

/// The direct sun of a cloudless sky.
fn sun_emission(fields: &Fields, turbidity: f64, problems: &mut Problems) -> Option<Emission> {
    let place = fields.place_of("turbidity");
    if let Some(other) = ["illuminance"].iter().chain(&COLORS).find(|name| fields.has(name)) {
        let text = format!("`{other}` and `turbidity` are both there, one of them is accepted");
        problems
            .add(Problem::new(fields.place_of(other), text).hint("turbidity gives the sun its strength and colour"));
        return None;
    }
    // that the sun has no place is told with its direction
    let [elevation, azimuth] = sun(fields, &mut Problems(vec![]))?;
    let direct = HosekSky::new(turbidity, [0.0; 3], elevation, azimuth).map_err(|e| e.to_string()).and_then(|sky| {
        let rgb = sky.sun_illuminance();
        let lux = colorspace::luminance(rgb);
        if lux <= 0.0 {
            return Err("the sun stands so low that no light comes through".to_string());
        }
        let amount = Unit::parse("lx").and_then(|unit| Quantity::new(lux, unit)).map_err(|e| e.to_string())?;
        Ok(Emission { amount, color: LightColor::Rgb(rgb), place })
    });
    direct.map_err(|e| problems.add(Problem::from_text(place, &e))).ok()
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
    let texture = match fields.node("texture") {
        Some(node) => Some(super::materials::light_texture(node, problems)?),
        None => None,
    };
    Some(AreaLightDescription { emission, two_sided: fields.bool("two_sided").unwrap_or(false), texture })
}

/// The one amount and the colour of a light called `kind`.
fn emission(fields: &Fields, kind: &str, problems: &mut Problems) -> Option<Emission> {
    let accepted: Vec<&str> = match kind {
        "point" | "spot" => vec!["flux", "intensity"],
        "projector" => vec!["flux"],
        "directional" | "sun" => vec!["illuminance"],
        "sky" | "cie_sky" => vec!["luminance", "illuminance"],
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
    } else if kind == "cie_sky" {
        let emission = emission(&fields, "cie_sky", problems);
        // the skies of an overcast day are the same for any sun
        let needed = !matches!(fields.integer("number")?, 1 | 3 | 5 | 16) || fields.has("time");
        let sun = if needed || fields.has("elevation") { sun(&fields, problems) } else { Some([1.0, 0.0]) };
        let ground = if fields.has("ground") { fields.number("ground")? } else { 0.0 };
        EnvironmentKind::CieSky { number: fields.integer("number")? as u32, sun: sun?, ground, emission: emission? }
    } else if kind == "hosek_sky" {
        let sun = sun(&fields, problems);
        let ground = if fields.has("ground") { fields.numbers("ground")? } else { [0.0; 3] };
        EnvironmentKind::HosekSky { turbidity: fields.number("turbidity")?, sun: sun?, ground }
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
