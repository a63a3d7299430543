//! Measured distributions of luminaires: IES LM-63 and EULUMDAT files, read, written, converted and integrated.
//!
//! The frame of a luminaire: x along C0, y along C90, z up; nadir is -z. Angles of the table are degrees, as in the files.

mod beam;
mod eulumdat;
mod ies;
mod opening;
mod planes;
mod text;
mod ugr;
mod web;

pub use beam::BeamAngles;
pub use ies::Generation;
pub use opening::{Opening, OpeningShape, Outline};
pub use planes::Symmetry;
pub use text::{MAX_BYTES, Warning};
pub use ugr::{REFLECTANCES, ROOMS, UgrTable, position_index};
pub use web::{Coordinates, Web};

use crate::error::LightError;
use lesk_math::Vec3;
use std::io::Read;
use std::path::Path;
use text::Warnings;

/// Most values that the table of a file may state.
const MAX_VALUES: usize = 1 << 19;
/// Most angles of one kind.
const MAX_ANGLES: usize = 1 << 14;
/// Largest value after all factors, cd.
const MAX_CANDELA: f64 = 1e12;

/// The kind of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// IES LM-63.
    Ies(Generation),
    /// EULUMDAT.
    Eulumdat,
}

impl Format {
    /// Its name with the edition.
    pub fn name(self) -> &'static str {
        match self {
            Format::Ies(generation) => generation.name(),
            Format::Eulumdat => "EULUMDAT",
        }
    }
}

/// What the intensities count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Counted {
    /// Luminous intensity, cd; the flux is lm.
    Light,
    /// Radiant intensity, W/sr; the flux is W.
    Power,
}

/// The lamps of a luminaire, as a file states them.
#[derive(Clone, Debug, PartialEq)]
pub struct LampSet {
    /// How many.
    pub count: f64,
    /// Their type.
    pub kind: String,
    /// Rated luminous flux of all of them together, lm; `None` for absolute photometry without one.
    pub flux: Option<f64>,
    /// Colour or colour temperature, as written.
    pub color: String,
    /// Colour rendering, as written.
    pub rendering: String,
    /// Power including the ballast, W; 0 where unknown.
    pub watts: f64,
}

/// The multiplying factors of LM-63's tilt section: how the lamp's output changes with the tilt of the luminaire.
#[derive(Clone, Debug, PartialEq)]
pub struct Tilt {
    /// Lamp to luminaire geometry, 1 to 3.
    pub geometry: u32,
    /// Angles, degrees, ascending.
    pub angles: Vec<f64>,
    /// One factor for each angle.
    pub factors: Vec<f64>,
}

impl Tilt {
    /// The factor at an angle in degrees, linear between those of the file, constant beyond.
    pub fn factor(&self, angle_deg: f64) -> f64 {
        let i = self.angles.partition_point(|a| *a <= angle_deg);
        if i == 0 || i == self.angles.len() {
            return self.factors[i.saturating_sub(1)];
        }
        let t = (angle_deg - self.angles[i - 1]) / (self.angles[i] - self.angles[i - 1]);
        self.factors[i - 1] * (1.0 - t) + self.factors[i] * t
    }
}

/// Where a declared flux comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Declared {
    /// The header gives the flux of the luminaire.
    Luminaire,
    /// The header gives the flux of the lamps alone.
    Lamps,
}

/// How to read.
#[derive(Clone, Copy, Debug, Default)]
pub struct ReadOptions {
    /// Whether whatever would be a warning is an error.
    pub strict: bool,
    /// Which lamp set of an EULUMDAT file is taken, from 0.
    pub lamp_set: usize,
}

/// The measured distribution of a luminaire with what its file says about it.
#[derive(Clone, Debug, PartialEq)]
pub struct Photometry {
    /// The kind of the file.
    pub format: Format,
    /// Descriptions by keyword, in order: those in brackets of an IES file, or `maker`, `luminaire`, `number`, `file`,
    /// `date`, `report` of EULUMDAT.
    pub texts: Vec<(String, String)>,
    /// Intensities after all factors.
    pub web: Web,
    /// The symmetry that the file states; of types A and B, whether H is mirrored counts as about C90-C270.
    pub symmetry: Symmetry,
    /// What the intensities count.
    pub counted: Counted,
    /// Whether the values are absolute; else they go with the lamps' rated flux.
    pub absolute: bool,
    /// The luminous opening.
    pub opening: Opening,
    /// The luminaire's extents along C0, along C90 and upward, metres; 0 where unknown.
    pub housing: [f64; 3],
    /// Lamp sets; the chosen one is `lamp_set`.
    pub lamps: Vec<LampSet>,
    /// The chosen lamp set.
    pub lamp_set: usize,
    /// Factors of the file that are already in the intensities, beyond the rated flux: ballast.
    pub ballast_factor: f64,
    /// Light output ratio that the file states, 0 to 1.
    pub stated_lor: Option<f64>,
    /// Flux of the luminaire that a keyword states, in the unit of the values.
    pub stated_flux: Option<f64>,
    /// Tilt factors; they are not in the intensities.
    pub tilt: Option<Tilt>,
    /// What was repaired or is doubtful.
    pub warnings: Vec<Warning>,
}

impl Photometry {
    /// A luminaire that is only a table of cd: without lamps, texts and size.
    pub fn new(web: Web) -> Self {
        let symmetry = match web.coordinates() {
            Coordinates::C => planes::detect(web.h(), |j| web.plane(j).to_vec()),
            _ => Symmetry::None,
        };
        let set = LampSet {
            count: 1.0,
            kind: String::new(),
            flux: None,
            color: String::new(),
            rendering: String::new(),
            watts: 0.0,
        };
        Photometry {
            format: Format::Ies(Generation::Y2019),
            texts: vec![],
            web,
            symmetry,
            counted: Counted::Light,
            absolute: true,
            opening: Opening::POINT,
            housing: [0.0; 3],
            lamps: vec![set],
            lamp_set: 0,
            ballast_factor: 1.0,
            stated_lor: None,
            stated_flux: None,
            tilt: None,
            warnings: vec![],
        }
    }

    /// Reads an IES or EULUMDAT file; its content decides which it is.
    ///
    /// # Errors
    /// A file that cannot be opened or understood; the message names line and field.
    pub fn read(path: impl AsRef<Path>, options: ReadOptions) -> Result<Self, LightError> {
        let path = path.as_ref();
        let bytes = bytes_of(path)?;
        let beside = |name: &str| tilt_file(path, name);
        Self::parse_with(&bytes, options, &beside)
            .map_err(|e| LightError::new(format!("{}: {}", path.display(), e.message())).hint(e.hint_text()))
    }

    /// Reads the bytes of a file. Tilt factors in a file of their own are not looked for.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn parse(bytes: &[u8], options: ReadOptions) -> Result<Self, LightError> {
        Self::parse_with(bytes, options, &|_| None)
    }

    fn parse_with(
        bytes: &[u8],
        options: ReadOptions,
        tilt_file: &dyn Fn(&str) -> Option<Vec<u8>>,
    ) -> Result<Self, LightError> {
        let mut warnings = Warnings::new(options.strict);
        let text = text::decode(bytes, &mut warnings)?;
        let lines = text::lines(&text);
        if lines.iter().all(|line| line.trim().is_empty()) {
            return Err(LightError::new("file is empty"));
        }
        let mut photometry = if ies::is_ies(&lines) {
            ies::read(&lines, &mut warnings, tilt_file)?
        } else if eulumdat::is_eulumdat(&lines) {
            eulumdat::read(&lines, options.lamp_set, &mut warnings)?
        } else {
            return Err(LightError::new("file is neither IES LM-63 nor EULUMDAT").hint(
                "an IES file has a line that starts with `TILT=`, line 3 of EULUMDAT is a symmetry from 0 to 4",
            ));
        };
        photometry.warnings = warnings.list;
        Ok(photometry)
    }

    /// Intensity in cd (or W/sr) toward the angle `theta` from nadir and the azimuth `phi`, radians.
    pub fn intensity(&self, theta: f64, phi: f64) -> f64 {
        match self.web.coordinates() {
            Coordinates::C => self.web.at(theta.to_degrees(), phi.to_degrees()),
            _ => self.web.toward(Coordinates::C.direction(theta.to_degrees(), phi.to_degrees())),
        }
    }

    /// Intensity in cd (or W/sr) in a unit direction of the luminaire's frame.
    pub fn toward(&self, d: Vec3<f64>) -> f64 {
        self.web.toward(d)
    }

    /// Flux in lm (or W): the exact integral of the bilinear table.
    pub fn flux(&self) -> f64 {
        self.web.flux()
    }

    /// Rated flux of the chosen lamps, lm.
    pub fn lamp_flux(&self) -> Option<f64> {
        self.lamps.get(self.lamp_set).and_then(|set| set.flux)
    }

    /// Flux of the luminaire over the flux of its lamps with their ballast.
    pub fn light_output_ratio(&self) -> Option<f64> {
        let lamps = self.lamp_flux()? * self.ballast_factor;
        (lamps > 0.0).then(|| self.flux() / lamps)
    }

    /// The flux that the header states, in lm (or W), and of what.
    pub fn declared_flux(&self) -> Option<(f64, Declared)> {
        if let Some(flux) = self.stated_flux {
            return Some((flux, Declared::Luminaire));
        }
        let lamps = self.lamp_flux()?;
        Some(match self.stated_lor {
            Some(ratio) => (lamps * ratio, Declared::Luminaire),
            None => (lamps, Declared::Lamps),
        })
    }

    /// A luminaire whose file counts watts, in lumens, cd and lm: by its spectrum's lumens per watt.
    #[must_use]
    pub fn in_lumens(mut self, lm_per_watt: f64) -> Self {
        if self.counted == Counted::Power {
            self.web = self.web.scaled(lm_per_watt);
            self.stated_flux = self.stated_flux.map(|watts| watts * lm_per_watt);
            self.counted = Counted::Light;
        }
        self
    }

    /// Power of the luminaire, W; `None` where the file does not state it.
    pub fn watts(&self) -> Option<f64> {
        self.lamps.get(self.lamp_set).map(|set| set.watts).filter(|w| *w > 0.0)
    }

    /// The angle of peak, with the unit direction in the luminaire's frame: (intensity, direction).
    pub fn peak(&self) -> (f64, Vec3<f64>) {
        let (value, v, h) = self.web.peak();
        (value, self.web.coordinates().direction(v, h))
    }

    /// The same as a table of type C with steps in degrees, looked up by the bilinear contract.
    ///
    /// # Errors
    /// Steps that do not divide 180 (V) and 90 (H) degrees, or make a table that is too large.
    pub fn resampled(&self, v_step_deg: f64, h_step_deg: f64) -> Result<Self, LightError> {
        let v = steps("v_step", v_step_deg, 180.0, 180.0)?;
        let rotational = self.web.is_rotational();
        let h = if rotational { vec![0.0] } else { steps("h_step", h_step_deg, 90.0, 360.0)? };
        if v.len() * h.len() > MAX_VALUES {
            return Err(LightError::new(format!(
                "table would have {} values, at most {MAX_VALUES} are accepted",
                v.len() * h.len()
            ))
            .hint("take larger steps"));
        }
        let mut same = self.clone();
        same.web = self.web.resampled(v, h);
        same.symmetry = same.detected_symmetry();
        Ok(same)
    }

    /// The strongest symmetry of type C that the values have exactly.
    pub fn detected_symmetry(&self) -> Symmetry {
        match self.web.coordinates() {
            Coordinates::C => planes::detect(self.web.h(), |j| self.web.plane(j).to_vec()),
            _ => self.symmetry,
        }
    }

    /// The same in type C; types A and B are looked up in steps of 1 degree unless their own are coarser multiples.
    fn in_type_c(&self) -> Result<Self, LightError> {
        match self.web.coordinates() {
            Coordinates::C => Ok(self.clone()),
            _ => self.resampled(1.0, 1.0),
        }
    }

    /// The text of a description, by keyword without regard to case.
    pub fn text(&self, keyword: &str) -> Option<&str> {
        self.texts.iter().find(|(key, _)| key.eq_ignore_ascii_case(keyword)).map(|(_, text)| text.as_str())
    }

    /// As an IES file of a generation.
    ///
    /// # Errors
    /// Values that the file cannot hold.
    pub fn to_ies(&self, generation: Generation) -> Result<String, LightError> {
        ies::write(self, generation)
    }

    /// As an EULUMDAT file; types A and B become C.
    ///
    /// # Errors
    /// Radiant intensities, for which EULUMDAT has no place.
    pub fn to_eulumdat(&self) -> Result<String, LightError> {
        if self.counted == Counted::Power {
            return Err(LightError::new("the file counts watts, EULUMDAT holds lumens only").hint("write an .ies file"));
        }
        eulumdat::write(&self.in_type_c()?)
    }
}

/// Angles from 0 to `end` in equal steps that divide `part`.
fn steps(name: &str, step: f64, part: f64, end: f64) -> Result<Vec<f64>, LightError> {
    let count = (part / step).round();
    let legal = step > 0.0 && count >= 1.0 && count <= MAX_ANGLES as f64 / 4.0 && (count * step - part).abs() < 1e-6;
    if !legal {
        return Err(LightError::new(format!("`{name}` is {step} deg, a divisor of {part} deg from 0.05 is accepted")));
    }
    let all = (count * end / part).round() as usize;
    Ok((0..=all).map(|i| end * i as f64 / all as f64).collect())
}

/// The bytes of a file that is not too large.
fn bytes_of(path: &Path) -> Result<Vec<u8>, LightError> {
    let failed = |e: std::io::Error| {
        let text = e.to_string();
        let text = text.split(" (os error").next().unwrap_or_default().to_lowercase();
        LightError::new(format!("cannot read `{}`: {text}", path.display()))
    };
    let file = std::fs::File::open(path).map_err(failed)?;
    let mut bytes = Vec::new();
    // one byte more than accepted, so that a larger file is noticed
    file.take(MAX_BYTES as u64 + 1).read_to_end(&mut bytes).map_err(failed)?;
    Ok(bytes)
}

/// The tilt file that an IES file names, if it is a plain name in the same folder.
fn tilt_file(path: &Path, name: &str) -> Option<Vec<u8>> {
    let plain = !name.is_empty() && !name.contains(['/', '\\', ':']) && name != "." && name != "..";
    let folder = path.parent()?;
    if plain { bytes_of(&folder.join(name)).ok() } else { None }
}
