//! Units as people write them: `klm`, `W/m²/sr`, `mW/cm^2`, `umol/s/m2`.

use crate::QuantityError;
use crate::dimension::{Dimension, Powers};
use std::f64::consts::PI;
use std::fmt;

/// A unit that has a symbol of its own.
#[derive(Debug, PartialEq)]
struct Atom {
    symbol: &'static str,
    powers: Powers,
    /// SI units in one of this unit.
    factor: f64,
    prefixes: Prefixes,
    /// What it is called, for the list of units; empty for a second spelling.
    name: &'static str,
}

/// Which prefixes a unit takes.
#[derive(Debug, PartialEq)]
enum Prefixes {
    None,
    /// All but c and d.
    Usual,
    All,
}

const fn atom(symbol: &'static str, powers: Powers, factor: f64, prefixes: Prefixes, name: &'static str) -> Atom {
    Atom { symbol, powers, factor, prefixes, name }
}

/// Avogadro constant, photons in a mole: exact by the SI of 2019.
pub const AVOGADRO: f64 = 6.022_140_76e23;
/// Joules of an electron volt: exact by the SI of 2019.
pub const ELECTRON_VOLT: f64 = 1.602_176_634e-19;
const FOOT: f64 = 0.3048;
const DEGREE: f64 = PI / 180.0;

/// All atoms. Old units: BIPM, *The International System of Units*; NIST SP 811, appendix B.
#[rustfmt::skip]
static ATOMS: &[Atom] = &[
    //              J, lm, photon, m, sr, s, rad, K, EV
    atom("m",       [0, 0, 0, 1, 0, 0, 0, 0, 0], 1.0, Prefixes::All, "metre"),
    atom("in",      [0, 0, 0, 1, 0, 0, 0, 0, 0], 0.0254, Prefixes::None, "inch"),
    atom("ft",      [0, 0, 0, 1, 0, 0, 0, 0, 0], FOOT, Prefixes::None, "foot"),
    atom("au",      [0, 0, 0, 1, 0, 0, 0, 0, 0], 149_597_870_700.0, Prefixes::None, "astronomical unit"),
    atom("rad",     [0, 0, 0, 0, 0, 0, 1, 0, 0], 1.0, Prefixes::Usual, "radian"),
    atom("deg",     [0, 0, 0, 0, 0, 0, 1, 0, 0], DEGREE, Prefixes::None, "degree"),
    atom("°",       [0, 0, 0, 0, 0, 0, 1, 0, 0], DEGREE, Prefixes::None, ""),
    atom("sr",      [0, 0, 0, 0, 1, 0, 0, 0, 0], 1.0, Prefixes::Usual, "steradian"),
    atom("s",       [0, 0, 0, 0, 0, 1, 0, 0, 0], 1.0, Prefixes::Usual, "second"),
    atom("min",     [0, 0, 0, 0, 0, 1, 0, 0, 0], 60.0, Prefixes::None, "minute"),
    atom("h",       [0, 0, 0, 0, 0, 1, 0, 0, 0], 3600.0, Prefixes::None, "hour"),
    atom("d",       [0, 0, 0, 0, 0, 1, 0, 0, 0], 86_400.0, Prefixes::None, "day"),
    atom("Hz",      [0, 0, 0, 0, 0, -1, 0, 0, 0], 1.0, Prefixes::Usual, "hertz"),
    atom("K",       [0, 0, 0, 0, 0, 0, 0, 1, 0], 1.0, Prefixes::Usual, "kelvin"),
    atom("J",       [1, 0, 0, 0, 0, 0, 0, 0, 0], 1.0, Prefixes::Usual, "joule"),
    atom("Wh",      [1, 0, 0, 0, 0, 0, 0, 0, 0], 3600.0, Prefixes::Usual, "watt hour"),
    atom("eV",      [1, 0, 0, 0, 0, 0, 0, 0, 0], ELECTRON_VOLT, Prefixes::Usual, "electron volt"),
    atom("W",       [1, 0, 0, 0, 0, -1, 0, 0, 0], 1.0, Prefixes::Usual, "watt"),
    atom("lm",      [0, 1, 0, 0, 0, 0, 0, 0, 0], 1.0, Prefixes::Usual, "lumen"),
    atom("cd",      [0, 1, 0, 0, -1, 0, 0, 0, 0], 1.0, Prefixes::Usual, "candela: lm/sr"),
    atom("lx",      [0, 1, 0, -2, 0, 0, 0, 0, 0], 1.0, Prefixes::Usual, "lux: lm/m2"),
    atom("fc",      [0, 1, 0, -2, 0, 0, 0, 0, 0], 1.0 / (FOOT * FOOT), Prefixes::None, "footcandle: lm/ft2"),
    atom("ph",      [0, 1, 0, -2, 0, 0, 0, 0, 0], 1e4, Prefixes::None, "phot: lm/cm2"),
    atom("nit",     [0, 1, 0, -2, -1, 0, 0, 0, 0], 1.0, Prefixes::Usual, "nit: cd/m2"),
    atom("nt",      [0, 1, 0, -2, -1, 0, 0, 0, 0], 1.0, Prefixes::None, ""),
    atom("sb",      [0, 1, 0, -2, -1, 0, 0, 0, 0], 1e4, Prefixes::None, "stilb: cd/cm2"),
    atom("asb",     [0, 1, 0, -2, -1, 0, 0, 0, 0], 1.0 / PI, Prefixes::None, "apostilb: cd/m2/pi"),
    atom("La",      [0, 1, 0, -2, -1, 0, 0, 0, 0], 1e4 / PI, Prefixes::Usual, "lambert: cd/cm2/pi"),
    atom("fL",      [0, 1, 0, -2, -1, 0, 0, 0, 0], 1.0 / (PI * FOOT * FOOT), Prefixes::None, "footlambert: cd/ft2/pi"),
    atom("photons", [0, 0, 1, 0, 0, 0, 0, 0, 0], 1.0, Prefixes::None, "number of photons"),
    atom("photon",  [0, 0, 1, 0, 0, 0, 0, 0, 0], 1.0, Prefixes::None, ""),
    atom("mol",     [0, 0, 1, 0, 0, 0, 0, 0, 0], AVOGADRO, Prefixes::Usual, "mole of photons"),
    atom("EV",      [0, 0, 0, 0, 0, 0, 0, 0, 1], 1.0, Prefixes::None, "exposure value at ISO 100"),
];

/// Words that people write for a symbol.
static WORDS: &[(&str, &str)] = &[
    ("lumen", "lm"),
    ("lux", "lx"),
    ("candela", "cd"),
    ("watt", "W"),
    ("nits", "nit"),
    ("joule", "J"),
    ("metre", "m"),
    ("meter", "m"),
    ("kelvin", "K"),
    ("degree", "deg"),
    ("footcandle", "fc"),
    ("footlambert", "fL"),
    ("stilb", "sb"),
    ("apostilb", "asb"),
    ("lambert", "La"),
    ("phot", "ph"),
    ("steradian", "sr"),
];

/// An SI prefix, as a quotient of two exact numbers: 7 mm is 7 / 1000, correctly rounded.
#[derive(Debug, PartialEq)]
struct Prefix {
    symbol: &'static str,
    times: f64,
    over: f64,
}

const fn prefix(symbol: &'static str, times: f64, over: f64) -> Prefix {
    Prefix { symbol, times, over }
}

/// SI prefixes, none first; `c` and `d` for the metre only; `u` and the two micro signs of Unicode are the same.
static PREFIXES: &[Prefix] = &[
    prefix("", 1.0, 1.0),
    prefix("f", 1.0, 1e15),
    prefix("p", 1.0, 1e12),
    prefix("n", 1.0, 1e9),
    prefix("u", 1.0, 1e6),
    prefix("µ", 1.0, 1e6),
    prefix("μ", 1.0, 1e6),
    prefix("m", 1.0, 1e3),
    prefix("c", 1.0, 1e2),
    prefix("d", 1.0, 1e1),
    prefix("k", 1e3, 1.0),
    prefix("M", 1e6, 1.0),
    prefix("G", 1e9, 1.0),
    prefix("T", 1e12, 1.0),
];

fn allowed(prefix: &Prefix, atom: &Atom) -> bool {
    match atom.prefixes {
        _ if prefix.symbol.is_empty() => true,
        Prefixes::None => false,
        Prefixes::Usual => !matches!(prefix.symbol, "c" | "d"),
        Prefixes::All => true,
    }
}

/// One symbol with its prefix and power: `cm2`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Factor {
    /// Place in [`PREFIXES`].
    prefix: u8,
    /// Place in [`ATOMS`].
    atom: u8,
    power: i8,
}

impl Factor {
    fn prefix(self) -> &'static Prefix {
        &PREFIXES[usize::from(self.prefix)]
    }

    fn atom(self) -> &'static Atom {
        &ATOMS[usize::from(self.atom)]
    }
}

/// A product has at most this many symbols.
const MAX_FACTORS: usize = 6;

/// A product of symbols of the table that has a [`Dimension`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    factors: [Option<Factor>; MAX_FACTORS],
    dimension: Dimension,
}

impl Unit {
    /// Reads a unit: `lm`, `kcd/m²`, `W/m^2/sr`, `W/(m2 sr)`, `W m-2 sr-1`, `lm s`.
    ///
    /// # Errors
    /// `UnknownUnit`, with the known spelling where there is one.
    pub fn parse(text: &str) -> Result<Unit, QuantityError> {
        let unknown = || QuantityError::UnknownUnit { given: text.trim().to_string(), meant: meant(text) };
        // longer than any product of the table; bounds the work on foreign text
        if text.len() > 200 {
            return Err(unknown());
        }
        let mut unit = Unit { factors: [None; MAX_FACTORS], dimension: Dimension::Length };
        let words = split(text).ok_or_else(unknown)?;
        if words.is_empty() || words.len() > MAX_FACTORS {
            return Err(unknown());
        }
        let mut powers: Powers = [0; 9];
        for (slot, (word, below)) in unit.factors.iter_mut().zip(&words) {
            let factor = factor(word, *below).ok_or_else(unknown)?;
            for (sum, power) in powers.iter_mut().zip(factor.atom().powers) {
                *sum += power * factor.power;
            }
            *slot = Some(factor);
        }
        // what stands below a bar is printed last: `lm2/lm s` would mean nothing
        unit.factors[..words.len()].sort_by_key(|factor| factor.is_some_and(|f| f.power < 0));
        unit.dimension = Dimension::of_powers(&powers).ok_or_else(unknown)?;
        Ok(unit)
    }

    /// What the unit measures.
    pub fn dimension(self) -> Dimension {
        self.dimension
    }

    /// SI units in one of this unit: 0.01 for `cm`.
    pub fn factor(self) -> f64 {
        self.to_si(1.0)
    }

    /// Numerator and denominator of the factor: exact powers of ten stay exact.
    fn ratio(self) -> (f64, f64) {
        let (mut times, mut over) = (1.0, 1.0);
        for factor in self.factors.iter().flatten() {
            let n = i32::from(factor.power.abs());
            let (up, down) = (factor.prefix().times * factor.atom().factor, factor.prefix().over);
            let (up, down) = if factor.power > 0 { (up, down) } else { (down, up) };
            times *= up.powi(n);
            over *= down.powi(n);
        }
        (times, over)
    }

    pub(crate) fn to_si(self, value: f64) -> f64 {
        let (times, over) = self.ratio();
        value * times / over
    }

    pub(crate) fn value_of(self, si: f64) -> f64 {
        let (times, over) = self.ratio();
        si * over / times
    }

    /// Symbols with names, like `fc` and `footcandle: lm/ft2`, and the dimension that each measures.
    pub fn symbols() -> impl Iterator<Item = (&'static str, &'static str, Dimension)> {
        let named = ATOMS.iter().filter(|atom| !atom.name.is_empty());
        named.filter_map(|atom| Some((atom.symbol, atom.name, Dimension::of_powers(&atom.powers)?)))
    }
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, factor) in self.factors.iter().flatten().enumerate() {
            let sign = match (i, factor.power > 0) {
                (0, _) => "",
                (_, true) => " ",
                (_, false) => "/",
            };
            write!(f, "{sign}{}{}", factor.prefix().symbol, factor.atom().symbol)?;
            match (i, factor.power) {
                (_, 1) | (1.., -1) => {}
                (0, power) => write!(f, "{power}")?,
                (_, power) => write!(f, "{}", power.abs())?,
            }
        }
        Ok(())
    }
}

/// The factors of a product and whether each stands below a fraction bar. Below a bar stands one factor or a
/// bracket: `W/m2 sr` could mean two things and is refused.
fn split(text: &str) -> Option<Vec<(&str, bool)>> {
    let mut words = Vec::new();
    for (part, section) in text.trim().split('/').enumerate() {
        let section = section.trim();
        let inner = section.strip_prefix('(').and_then(|rest| rest.strip_suffix(')'));
        if inner.is_some() && part == 0 {
            return None;
        }
        let found = inner.unwrap_or(section).split(|c: char| c.is_whitespace() || matches!(c, '*' | '·' | '⋅'));
        let before = words.len();
        words.extend(found.filter(|word| !word.is_empty()).map(|word| (word, part > 0)));
        let added = words.len() - before;
        if added == 0 || part > 0 && inner.is_none() && added > 1 {
            return None;
        }
    }
    Some(words)
}

/// Reads `cm2`, `m^-2`, `m²`, `sr⁻¹`; `below` a fraction bar the power changes its sign.
fn factor(word: &str, below: bool) -> Option<Factor> {
    let word: String = word.chars().filter_map(plain).collect();
    let end = word.find(|c: char| c.is_ascii_digit() || c == '-').unwrap_or(word.len());
    let (name, power) = word.split_at(end);
    let power: i8 = if power.is_empty() { 1 } else { power.parse().ok()? };
    if power == 0 || power.unsigned_abs() > 3 {
        return None;
    }
    let (prefix, atom) = symbol(name)?;
    Some(Factor { prefix, atom, power: if below { -power } else { power } })
}

/// The places of a prefix and a unit that together are spelled `name`.
fn symbol(name: &str) -> Option<(u8, u8)> {
    PREFIXES.iter().enumerate().find_map(|(i, prefix)| {
        let rest = name.strip_prefix(prefix.symbol)?;
        let found = ATOMS.iter().position(|atom| atom.symbol == rest && allowed(prefix, atom))?;
        Some((i as u8, found as u8))
    })
}

/// One spelling of powers: digits and a minus sign.
fn plain(c: char) -> Option<char> {
    Some(match c {
        '^' => return None,
        '⁻' | '−' => '-',
        '¹' => '1',
        '²' => '2',
        '³' => '3',
        other => other,
    })
}

/// What was probably meant by an unknown unit: another case, or a word for a symbol.
fn meant(text: &str) -> Option<&'static str> {
    let word = text.trim();
    let known = Dimension::all().flat_map(|d| d.examples()).copied().chain(ATOMS.iter().map(|atom| atom.symbol));
    let mut known = known.filter(|symbol| symbol.eq_ignore_ascii_case(word));
    known.next().or_else(|| {
        let word = word.to_lowercase();
        let single = word.strip_suffix('s').unwrap_or(&word);
        WORDS.iter().find(|(name, _)| *name == word || *name == single).map(|(_, symbol)| *symbol)
    })
}

#[cfg(test)]
#[path = "units_tests.rs"]
mod tests;
