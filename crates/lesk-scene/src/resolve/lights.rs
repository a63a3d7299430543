//! Lights: quantities become photometric values, watts through their spectrum.

use super::Resolver;
use super::objects::Part;
use crate::description::{
    AreaLightDescription, Emission, EnvironmentDescription, EnvironmentKind, LightColor, LightDescription, LightKind,
    MapStrength, Picture,
};
use crate::error::{Place, Problem};
use lesk_light::{
    Area, CieSky, Directional, Environment, HosekSky, Light, LightError, Point, Sky, Spectrum, Spot, Up, rec709,
};
use lesk_math::{Color, Vec3, vec3};
use lesk_quantities::{Dimension, colorspace};

use Dimension::{Illuminance, Luminance, LuminousFlux, LuminousIntensity};

impl Resolver<'_> {
    pub(super) fn lights(&mut self) {
        let d = self.description;
        for light in &d.lights {
            if let Some(light) = self.light(light) {
                self.lights.push(light);
            }
        }
        for luminaire in &d.luminaires {
            self.luminaire(luminaire);
        }
        if let Some(environment) = &d.environment
            && let Some(light) = self.environment(environment)
        {
            self.lights.push(light);
        }
    }

    fn light(&mut self, d: &LightDescription) -> Option<Light> {
        if let LightKind::Projector { .. } = d.kind {
            return self.projector(d);
        }
        let about = if d.name.is_empty() { "light".to_string() } else { format!("light `{}`", d.name) };
        let accepted = match d.kind {
            LightKind::Point { .. } | LightKind::Spot { .. } => &[LuminousFlux, LuminousIntensity][..],
            LightKind::Directional { .. } => &[Illuminance],
            LightKind::Projector { .. } => &[LuminousFlux],
        };
        let (dimension, value) = self.photometric(&about, &d.emission, accepted)?;
        let is_flux = dimension == LuminousFlux;
        let light = match d.kind {
            LightKind::Point { position } if is_flux => Point::from_flux(narrow(position), value).map(Light::Point),
            LightKind::Point { position } => Point::new(narrow(position), value).map(Light::Point),
            LightKind::Spot { position, direction, half_angles } => {
                let make = if is_flux { Spot::from_flux } else { Spot::new };
                make(narrow(position), narrow(direction), value, half_angles).map(Light::Spot)
            }
            LightKind::Directional { direction, diameter } => {
                let light = Directional::new(narrow(direction), value);
                let light = if diameter > 0.0 { light.and_then(|l| l.with_diameter(diameter)) } else { light };
                light.map(Light::Directional)
            }
            LightKind::Projector { .. } => return None,
        };
        let far = match d.kind {
            LightKind::Point { position } | LightKind::Spot { position, .. } => position,
            LightKind::Directional { .. } | LightKind::Projector { .. } => [0.0; 3],
        };
        if !far.iter().all(|x| x.abs() <= 1e12) {
            let text = format!("{about} is at {far:?}, coordinates up to 1e12 m are accepted");
            self.problem(Problem::new(d.place, text));
            return None;
        }
        if let (Ok(Light::Spot(spot)), true) = (&light, is_flux) {
            let (flux, peak) = (d.emission.amount, spot.intensity().luminance());
            self.note(format!("{about}: the cone concentrates {flux} to {peak:.2} cd on its axis"));
        }
        self.check(d.place, &about, light)
    }

    pub(super) fn area_light(&mut self, part: &Part, d: &AreaLightDescription) -> Option<Area> {
        let about = super::objects::about(part.name);
        let (dimension, value) = self.photometric(&about, &d.emission, &[LuminousFlux, Luminance])?;
        let is_flux = dimension == LuminousFlux;
        let place = d.emission.place;
        let Some(picture) = &d.texture else {
            let make = if is_flux { Area::from_flux } else { Area::new };
            let light = make(self.geometry(part.geometry), &part.transform, value, d.two_sided);
            return self.check(place, &about, light);
        };
        // with a flux for its luminance, the light has the right colour
        let light = self.mapped(part, picture, value, d.two_sided, place)?;
        let flux = if is_flux { value.luminance() } else { light.flux() };
        self.check(place, &about, light.with_flux(flux))
    }

    fn environment(&mut self, d: &EnvironmentDescription) -> Option<Light> {
        match &d.kind {
            EnvironmentKind::Sky { emission, dome } => {
                let (dimension, value) = self.photometric("environment", emission, &[Luminance, Illuminance])?;
                // E = π L of a half space
                let luminance = if dimension == Illuminance { value * std::f32::consts::FRAC_1_PI } else { value };
                let up = match d.up {
                    Up::Z => vec3(0.0, 0.0, 1.0),
                    Up::Y => vec3(0.0, 1.0, 0.0),
                };
                let sky = if *dome { Sky::dome(luminance, up) } else { Sky::new(luminance) };
                self.check(d.place, "environment", sky).map(Light::Sky)
            }
            EnvironmentKind::CieSky { number, sun, ground, emission } => {
                let (dimension, value) = self.photometric("environment", emission, &[Luminance, Illuminance])?;
                let picture = CieSky::new(*number, sun[0], sun[1]).and_then(|sky| sky.picture(*ground));
                let picture = self.check(d.place, "environment", picture)?;
                let make = || -> Result<Environment, LightError> {
                    let map = |scale| Environment::new(picture.clone(), scale, d.up, 0.0);
                    let unit = if dimension == Illuminance { map(Color::splat(1.0))?.illuminance() } else { 1.0 };
                    map(value * (1.0 / unit) as f32)
                };
                let made = make();
                self.check(d.place, "environment", made).map(Light::Environment)
            }
            EnvironmentKind::HosekSky { turbidity, sun, ground } => {
                let made = HosekSky::new(*turbidity, *ground, sun[0], sun[1]).and_then(|sky| {
                    let map = Environment::new(sky.picture()?, Color::splat(1.0), d.up, 0.0)?;
                    Ok((map, colorspace::luminance(sky.sun_illuminance())))
                });
                let (map, direct) = self.check(d.place, "environment", made)?;
                let lux = map.illuminance();
                self.note(format!(
                    "environment: the sky gives {lux:.0} lx on a horizontal plane; a light of type `sun` with this \
                     turbidity adds {direct:.0} lx perpendicular to it"
                ));
                Some(Light::Environment(map))
            }
            EnvironmentKind::Map { image, rotation, strength } => {
                let map = self.map(image, *rotation, *strength, d.up, d.place)?;
                Some(Light::Environment(map))
            }
        }
    }

    fn map(
        &mut self,
        picture: &Picture,
        rotation: f64,
        strength: MapStrength,
        up: Up,
        place: Place,
    ) -> Option<Environment> {
        let image = self.files.image(picture);
        let image = self.check(place, "environment", image)?;
        let make = || -> Result<Environment, LightError> {
            let map = |scale| Environment::new((*image).clone(), Color::splat(scale), up, rotation);
            match strength {
                MapStrength::Scale(scale) => map(scale as f32),
                MapStrength::Illuminance(lux) => map(1.0)?.with_illuminance(lux),
                MapStrength::Luminance(luminance) => map(1.0)?.with_luminance(luminance),
            }
        };
        let made = make();
        let map = self.check(place, "environment", made)?;
        if map.repaired() > 0 {
            let count = map.repaired();
            self.note(format!("environment: {count} numbers of the map are negative or not finite and count as 0"));
        }
        Some(map)
    }

    /// The photometric dimension of an emission and its value: the colour whose luminance is the amount.
    pub(super) fn photometric(
        &mut self,
        about: &str,
        d: &Emission,
        accepted: &[Dimension],
    ) -> Option<(Dimension, Color<f32>)> {
        let given = d.amount.dimension();
        let dimension = given.photometric();
        if !accepted.contains(&dimension) {
            let expected = d.amount.expect(accepted).map(|_| ());
            self.check(d.place, about, expected)?;
            return None;
        }
        let mut amount = d.amount.si();
        if given.is_radiometric() {
            let LightColor::Spectrum(spectrum) = d.color else {
                let text = format!("{about}: `{}` counts watts, which need a named spectrum", d.amount);
                let hint = format!("add `spectrum`: {}", Spectrum::ACCEPTED);
                self.problem(Problem::new(d.place, text).hint(hint));
                return None;
            };
            let watts = d.amount;
            amount *= spectrum.efficacy();
            let unit = dimension.si_symbol();
            self.note(format!("{about}: {watts} are {amount:.6} {unit} at {}", spectrum.conversion()));
            self.spectra.insert(spectrum.to_string());
        }
        let rgb = self.unit_color(about, d.color, d.place)?;
        let value = rgb.map(|c| (c * amount) as f32);
        Some((dimension, rec709(value)))
    }

    /// The colour of an emission, scaled to luminance 1.
    pub(super) fn unit_color(&mut self, about: &str, color: LightColor, place: Place) -> Option<[f64; 3]> {
        match color {
            LightColor::White => Some([1.0; 3]),
            LightColor::Spectrum(spectrum) => Some(spectrum.rgb()),
            LightColor::Rgb(rgb) => {
                let luminance = colorspace::luminance(rgb);
                let legal = rgb.iter().all(|c| (0.0..=1e6).contains(c)) && luminance > 0.0;
                if !legal {
                    let text = format!("{about}: `color` is {rgb:?}, three numbers from 0 are accepted, not all 0");
                    self.problem(Problem::new(place, text));
                    return None;
                }
                Some(rgb.map(|c| c / luminance))
            }
        }
    }
}

/// The nearest f32 vector.
pub(super) fn narrow(v: [f64; 3]) -> Vec3<f32> {
    Vec3::from(v.map(|x| x as f32))
}
