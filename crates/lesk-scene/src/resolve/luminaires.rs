//! Luminaires and projectors: files become lights, openings become objects.

use super::Resolver;
use super::lights::narrow;
use super::objects::Part;
use crate::description::{LightDescription, LightKind, LuminaireDescription};
use crate::error::Problem;
use lesk_light::{Light, Luminaire, Projector, rec709};
use lesk_quantities::Dimension::LuminousFlux;

/// Most warnings of one file that become notes.
const MAX_WARNINGS: usize = 5;

impl Resolver<'_> {
    /// Adds a luminaire, and its opening as an object without material.
    pub(super) fn luminaire(&mut self, d: &LuminaireDescription) -> Option<()> {
        let about = if d.name.is_empty() { "luminaire".to_string() } else { format!("luminaire `{}`", d.name) };
        let photometry = self.files.photometry(&d.file, d.lamp_set);
        let photometry = self.check(d.place, &about, photometry)?;
        for warning in photometry.warnings.iter().take(MAX_WARNINGS) {
            self.note(format!("{}: {warning}", d.file.display()));
        }
        let mut factor = d.factor;
        if let Some(flux) = d.flux {
            let wanted = flux.expect(&[LuminousFlux]).map(|_| flux.si());
            factor *= self.check(d.place, &about, wanted)? / photometry.flux().max(f64::MIN_POSITIVE);
        }
        let color = self.unit_color(&about, d.color, d.place)?;
        let made = Luminaire::new(photometry, d.mounting, rec709(color.map(|c| c as f32)), factor);
        let luminaire = self.check(d.place, &about, made)?;
        let opening = luminaire.opening().map(|(geometry, transform)| (geometry.clone(), *transform));
        let number = self.lights.len() as u32;
        self.lights.push(Light::Luminaire(luminaire));
        if let Some((geometry, transform)) = opening {
            let geometry = self.add_geometry(geometry);
            let name = if d.name.is_empty() { "luminaire" } else { &d.name };
            self.place_part(Part { name, geometry, transform, material: None, place: d.place }, Some(number));
        }
        Some(())
    }

    pub(super) fn projector(&mut self, d: &LightDescription) -> Option<Light> {
        let about = if d.name.is_empty() { "light".to_string() } else { format!("light `{}`", d.name) };
        let LightKind::Projector { image, position, direction, up, width } = &d.kind else { return None };
        let (_, flux) = self.photometric(&about, &d.emission, &[LuminousFlux])?;
        let image = self.files.image(image);
        let image = self.check(d.place, &about, image)?;
        if !position.iter().all(|x| x.abs() <= 1e12) {
            let text = format!("{about} is at {position:?}, coordinates up to 1e12 m are accepted");
            self.problem(Problem::new(d.place, text));
            return None;
        }
        let made =
            Projector::from_flux((*image).clone(), narrow(*position), narrow(*direction), narrow(*up), *width, flux);
        self.check(d.place, &about, made).map(Light::Projector)
    }
}
