//! What a quantity measures: one table of names, symbols and units.

use std::fmt;

/// What a quantity measures; [`Dimension::si_symbol`] is the unit in which [`Quantity::si`](crate::Quantity::si) gives it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Dimension {
    /// m
    Length,
    /// m²
    Area,
    /// rad
    Angle,
    /// sr
    SolidAngle,
    /// s
    Time,
    /// Hz
    Frequency,
    /// K
    Temperature,
    /// J
    RadiantEnergy,
    /// W
    RadiantFlux,
    /// W/sr
    RadiantIntensity,
    /// W/m², arriving (irradiance) or leaving (exitance, radiosity)
    Irradiance,
    /// W/m²/sr
    Radiance,
    /// J/m²
    RadiantExposure,
    /// lm s
    LuminousEnergy,
    /// lm
    LuminousFlux,
    /// cd
    LuminousIntensity,
    /// lx, arriving (illuminance) or leaving (luminous exitance)
    Illuminance,
    /// cd/m²
    Luminance,
    /// lx s
    LuminousExposure,
    /// photons
    PhotonNumber,
    /// photons/s
    PhotonFlux,
    /// photons/s/sr
    PhotonIntensity,
    /// photons/s/m²
    PhotonIrradiance,
    /// photons/s/m²/sr
    PhotonRadiance,
    /// photons/m²
    PhotonExposure,
    /// W/m, usually per nm
    SpectralFlux,
    /// W/sr/m, usually per nm
    SpectralIntensity,
    /// W/m³, usually W/m² per nm
    SpectralIrradiance,
    /// W/m³/sr, usually W/m²/sr per nm
    SpectralRadiance,
    /// lm/W
    Efficacy,
    /// EV at ISO 100, a logarithm to base 2
    ExposureValue,
}

/// How light is counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum System {
    /// By the watt.
    Radiometric,
    /// By the lumen.
    Photometric,
    /// By the photon.
    Photon,
    /// By the watt per wavelength.
    Spectral,
}

/// What is asked of the light, however it is counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Form {
    /// All of it, over some time: J.
    Energy,
    /// All of it, per time: W.
    Flux,
    /// Per solid angle of a direction: W/sr.
    Intensity,
    /// Per area of a surface: W/m².
    Irradiance,
    /// Per projected area and solid angle: W/m²/sr.
    Radiance,
    /// Per area of a surface, over some time: J/m².
    Exposure,
}

/// Powers of the base units J, lm, photon, m, sr, s, rad, K, EV.
pub(crate) type Powers = [i8; 9];

/// One row of the table.
struct Row {
    dimension: Dimension,
    /// With its article: `a length`.
    name: &'static str,
    /// As a Czech lecture calls it; empty where Lesk has no need of it.
    czech: &'static str,
    symbol: &'static str,
    /// Units that people use, the SI unit first.
    units: &'static [&'static str],
    powers: Powers,
    light: Option<(System, Form)>,
}

macro_rules! rows {
    ($($dimension:ident, $name:literal, $czech:literal, $symbol:literal, [$($unit:literal),+], $powers:expr, $light:expr;)+) => {
        &[$(Row {
            dimension: Dimension::$dimension, name: $name, czech: $czech, symbol: $symbol, units: &[$($unit),+],
            powers: $powers, light: $light,
        }),+]
    };
}

use Form::*;
use System::*;

/// In the order of [`Dimension`]. The Czech names are those of Bittner's lecture (zářivost and svítivost: intensities).
#[rustfmt::skip]
static ROWS: &[Row] = rows![
    Length, "a length", "", "", ["m", "cm", "mm", "km", "nm", "in", "ft"], [0, 0, 0, 1, 0, 0, 0, 0, 0], None;
    Area, "an area", "", "A", ["m2", "cm2", "mm2", "ft2"], [0, 0, 0, 2, 0, 0, 0, 0, 0], None;
    Angle, "an angle", "", "θ", ["rad", "deg"], [0, 0, 0, 0, 0, 0, 1, 0, 0], None;
    SolidAngle, "a solid angle", "prostorový úhel", "Ω", ["sr", "msr"], [0, 0, 0, 0, 1, 0, 0, 0, 0], None;
    Time, "a time", "", "t", ["s", "ms", "min", "h", "d"], [0, 0, 0, 0, 0, 1, 0, 0, 0], None;
    Frequency, "a frequency", "", "ν", ["Hz", "THz"], [0, 0, 0, 0, 0, -1, 0, 0, 0], None;
    Temperature, "a temperature", "", "T", ["K"], [0, 0, 0, 0, 0, 0, 0, 1, 0], None;
    RadiantEnergy, "a radiant energy", "zářivá energie", "Q", ["J", "kJ", "Wh", "kWh", "eV"], [1, 0, 0, 0, 0, 0, 0, 0, 0], Some((Radiometric, Energy));
    RadiantFlux, "a radiant flux", "zářivý tok", "Φ", ["W", "mW"], [1, 0, 0, 0, 0, -1, 0, 0, 0], Some((Radiometric, Flux));
    RadiantIntensity, "a radiant intensity", "zářivost", "I", ["W/sr", "mW/sr"], [1, 0, 0, 0, -1, -1, 0, 0, 0], Some((Radiometric, Intensity));
    Irradiance, "an irradiance", "intenzita ozáření", "E", ["W/m2", "mW/cm2", "uW/cm2"], [1, 0, 0, -2, 0, -1, 0, 0, 0], Some((Radiometric, Irradiance));
    Radiance, "a radiance", "zář", "L", ["W/m2/sr"], [1, 0, 0, -2, -1, -1, 0, 0, 0], Some((Radiometric, Radiance));
    RadiantExposure, "a radiant exposure", "", "H", ["J/m2", "mJ/cm2", "kWh/m2"], [1, 0, 0, -2, 0, 0, 0, 0, 0], Some((Radiometric, Exposure));
    LuminousEnergy, "a luminous energy", "světelné množství", "Qv", ["lm s", "lm h", "Mlm h"], [0, 1, 0, 0, 0, 1, 0, 0, 0], Some((Photometric, Energy));
    LuminousFlux, "a luminous flux", "světelný tok", "Φv", ["lm", "klm"], [0, 1, 0, 0, 0, 0, 0, 0, 0], Some((Photometric, Flux));
    LuminousIntensity, "a luminous intensity", "svítivost", "Iv", ["cd", "kcd"], [0, 1, 0, 0, -1, 0, 0, 0, 0], Some((Photometric, Intensity));
    Illuminance, "an illuminance", "osvětlení", "Ev", ["lx", "klx", "fc", "ph"], [0, 1, 0, -2, 0, 0, 0, 0, 0], Some((Photometric, Irradiance));
    Luminance, "a luminance", "jas", "Lv", ["cd/m2", "kcd/m2", "nit", "sb", "asb", "La", "fL"], [0, 1, 0, -2, -1, 0, 0, 0, 0], Some((Photometric, Radiance));
    LuminousExposure, "a luminous exposure", "osvit", "Hv", ["lx s", "lx h", "klx h"], [0, 1, 0, -2, 0, 1, 0, 0, 0], Some((Photometric, Exposure));
    PhotonNumber, "a number of photons", "", "Np", ["photons", "umol", "mol"], [0, 0, 1, 0, 0, 0, 0, 0, 0], Some((Photon, Energy));
    PhotonFlux, "a photon flux", "", "Φp", ["photons/s", "umol/s"], [0, 0, 1, 0, 0, -1, 0, 0, 0], Some((Photon, Flux));
    PhotonIntensity, "a photon intensity", "", "Ip", ["photons/s/sr", "umol/s/sr"], [0, 0, 1, 0, -1, -1, 0, 0, 0], Some((Photon, Intensity));
    PhotonIrradiance, "a photon irradiance", "", "Ep", ["photons/s/m2", "umol/s/m2"], [0, 0, 1, -2, 0, -1, 0, 0, 0], Some((Photon, Irradiance));
    PhotonRadiance, "a photon radiance", "", "Lp", ["photons/s/m2/sr", "umol/s/m2/sr"], [0, 0, 1, -2, -1, -1, 0, 0, 0], Some((Photon, Radiance));
    PhotonExposure, "a photon exposure", "", "Hp", ["photons/m2", "mol/m2"], [0, 0, 1, -2, 0, 0, 0, 0, 0], Some((Photon, Exposure));
    SpectralFlux, "a spectral flux", "", "Φλ", ["W/m", "W/nm", "mW/nm"], [1, 0, 0, -1, 0, -1, 0, 0, 0], Some((Spectral, Flux));
    SpectralIntensity, "a spectral intensity", "", "Iλ", ["W/sr/m", "W/sr/nm"], [1, 0, 0, -1, -1, -1, 0, 0, 0], Some((Spectral, Intensity));
    SpectralIrradiance, "a spectral irradiance", "", "Eλ", ["W/m3", "W/m2/nm", "mW/m2/nm"], [1, 0, 0, -3, 0, -1, 0, 0, 0], Some((Spectral, Irradiance));
    SpectralRadiance, "a spectral radiance", "", "Lλ", ["W/m3/sr", "W/m2/sr/nm"], [1, 0, 0, -3, -1, -1, 0, 0, 0], Some((Spectral, Radiance));
    Efficacy, "a luminous efficacy", "", "K", ["lm/W"], [-1, 1, 0, 0, 0, 1, 0, 0, 0], None;
    ExposureValue, "an exposure value", "", "EV", ["EV"], [0, 0, 0, 0, 0, 0, 0, 0, 1], None;
];

impl Dimension {
    fn row(self) -> &'static Row {
        &ROWS[self as usize]
    }

    /// All of them, in the order of the table.
    pub fn all() -> impl Iterator<Item = Dimension> {
        ROWS.iter().map(|row| row.dimension)
    }

    /// The dimension of a product of base units, if it has a name.
    pub(crate) fn of_powers(powers: &Powers) -> Option<Dimension> {
        ROWS.iter().find(|row| row.powers == *powers).map(|row| row.dimension)
    }

    /// The dimension of light that is counted and asked for like this.
    pub fn of_light(system: System, form: Form) -> Option<Dimension> {
        ROWS.iter().find(|row| row.light == Some((system, form))).map(|row| row.dimension)
    }

    /// How it counts light, and what it asks of it; `None` for lengths and other things that are not light.
    pub fn light(self) -> Option<(System, Form)> {
        self.row().light
    }

    /// The symbol of the unit in which [`Quantity::si`](crate::Quantity::si) gives this dimension.
    pub fn si_symbol(self) -> &'static str {
        self.row().units[0]
    }

    /// Units that people use for this dimension, the SI unit first.
    pub fn examples(self) -> &'static [&'static str] {
        self.row().units
    }

    /// Its name without an article: `luminous flux`.
    pub fn name(self) -> &'static str {
        let name = self.row().name;
        name.split_once(' ').map_or(name, |(_, rest)| rest)
    }

    /// Its Czech name; empty where the lecture has none.
    pub fn czech(self) -> &'static str {
        self.row().czech
    }

    /// The symbol of formulas: Φ, E, L; with v for the luminous twin and p for photons.
    pub fn symbol(self) -> &'static str {
        self.row().symbol
    }

    /// True for units that count light by the watt.
    pub fn is_radiometric(self) -> bool {
        matches!(self.light(), Some((Radiometric, _)))
    }

    /// True for units that count light by the lumen.
    pub fn is_photometric(self) -> bool {
        matches!(self.light(), Some((Photometric, _)))
    }

    /// The photometric sibling of a radiometric dimension; any other dimension is returned as it is.
    pub fn photometric(self) -> Dimension {
        match self.light() {
            Some((Radiometric, form)) => Self::of_light(Photometric, form).unwrap_or(self),
            _ => self,
        }
    }
}

impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.row().name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Unit;

    #[test]
    fn rows_stand_in_the_order_of_the_enum_and_are_all_different() {
        for (i, row) in ROWS.iter().enumerate() {
            assert_eq!(row.dimension as usize, i, "{}", row.name);
            assert_eq!(Dimension::of_powers(&row.powers), Some(row.dimension), "{}", row.name);
        }
    }

    #[test]
    fn examples_of_every_dimension_are_units_of_it_and_the_first_is_si() {
        for dimension in Dimension::all() {
            for symbol in dimension.examples() {
                assert_eq!(Unit::parse(symbol).unwrap().dimension(), dimension, "{symbol}");
            }
            assert_eq!(Unit::parse(dimension.si_symbol()).unwrap().factor(), 1.0);
        }
    }

    #[test]
    fn every_radiometric_quantity_has_a_luminous_and_a_photon_twin() {
        for form in [Energy, Flux, Intensity, Irradiance, Radiance, Exposure] {
            for system in [Radiometric, Photometric, Photon] {
                let dimension = Dimension::of_light(system, form).unwrap();
                assert_eq!(dimension.light(), Some((system, form)));
            }
        }
        assert_eq!(Dimension::Radiance.photometric(), Dimension::Luminance);
        assert_eq!(Dimension::PhotonFlux.photometric(), Dimension::PhotonFlux);
    }
}
