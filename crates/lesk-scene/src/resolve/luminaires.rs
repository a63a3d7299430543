//! Luminaires and projectors: files become lights, openings become objects.

use super::Resolver;
use super::lights::narrow;
use super::objects::Part;
use crate::description::{Emission, LightColor, LightDescription, LightKind, LuminaireDescription};
use crate::error::Problem;
use lesk_light::photometry::{Counted, Photometry};
use lesk_light::{Light, Luminaire, Projector, Spectrum, rec709};
use lesk_quantities::Dimension::LuminousFlux;
use lesk_quantities::Quantity;
use std::sync::Arc;

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
        let stated = match d.flux {
            Some(amount) => Some(self.stated_flux(&about, d, amount)?),
            None => None,
        };
        let photometry = self.in_lumens(&about, d, photometry, stated.is_some())?;
        let factor = d.factor
            * match stated {
                Some(flux) => flux / photometry.flux().max(f64::MIN_POSITIVE),
                None => self.tilt_factor(&about, d, &photometry),
            };
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

    /// The flux that the scene states, lm.
    fn stated_flux(&mut self, about: &str, d: &LuminaireDescription, amount: Quantity) -> Option<f64> {
        let emission = Emission { amount, color: d.color, place: d.place };
        let (_, value) = self.photometric(about, &emission, &[LuminousFlux])?;
        Some(value.luminance().into())
    }

    /// The luminaire in cd. A file that counts watts needs a spectrum, unless the scene states the flux.
    fn in_lumens(
        &mut self,
        about: &str,
        d: &LuminaireDescription,
        photometry: Arc<Photometry>,
        stated: bool,
    ) -> Option<Arc<Photometry>> {
        if photometry.counted == Counted::Light {
            return Some(photometry);
        }
        let efficacy = match d.color {
            _ if stated => 1.0,
            LightColor::Spectrum(spectrum) => {
                let watts = photometry.flux();
                let lumens = watts * spectrum.efficacy();
                self.note(format!("{about}: {watts:.6} W of the file are {lumens:.6} lm at {}", spectrum.conversion()));
                self.spectra.insert(spectrum.to_string());
                spectrum.efficacy()
            }
            _ => {
                let text = format!("{about}: `{}` counts watts, which need a named spectrum", d.file.display());
                let hint = format!("add `spectrum`: {}; or `flux` in lm", Spectrum::ACCEPTED);
                self.problem(Problem::new(d.place, text).hint(hint));
                return None;
            }
        };
        Some(Arc::new((*photometry).clone().in_lumens(efficacy)))
    }

    /// What the file's TILT section leaves of the light of a luminaire that does not look straight down.
    fn tilt_factor(&mut self, about: &str, d: &LuminaireDescription, photometry: &Photometry) -> f64 {
        let Some(tilt) = &photometry.tilt else { return 1.0 };
        let [x, y, z] = d.mounting.direction;
        let angle = x.hypot(y).atan2(-z).to_degrees();
        let factor = tilt.factor(angle);
        self.note(format!("{about}: tilted by {angle:.1} deg, its lamps give {factor:.4} of their light (TILT)"));
        factor
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
