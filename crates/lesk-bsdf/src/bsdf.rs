//! The trait that a model's formulas implement, and the guards that every caller puts around them.

use crate::model::Domain;
use lesk_math::{Color, Real, Vec3};

/// A scattering model with its parameters, over the number type `R`.
///
/// Directions are unit vectors in the local frame (normal +z, tangent +x) and leave the surface: `wi` to the light,
/// `wo` to the viewer. A model may assume that the directions lie in its [`Domain`], at least [`MIN_COS`] from the
/// horizon; use the functions of this module, which see to it.
pub trait Bsdf<R: Real> {
    /// The continuous part f(wi, wo) in 1/sr, without the cosine, for radiance.
    fn eval(&self, wi: Vec3<R>, wo: Vec3<R>) -> Color<R>;

    /// Draws `wi` of the continuous part, given `wo` and three numbers in [0, 1); `u[2]` chooses a lobe.
    fn sample(&self, wo: Vec3<R>, u: [R; 3]) -> Vec3<R>;

    /// The density of [`sample`](Bsdf::sample) in 1/sr over `wi`. It may integrate to less than 1: the rest is
    /// drawn outside the domain and rejected.
    fn pdf(&self, wi: Vec3<R>, wo: Vec3<R>) -> R;

    /// The delta lobes, where the model has any.
    fn delta(&self, _wo: Vec3<R>) -> Option<[Delta<R>; 2]> {
        None
    }
}

/// A lobe that scatters into one direction only.
#[derive(Clone, Copy, Debug)]
pub struct Delta<R> {
    pub wi: Vec3<R>,
    /// The share of the radiance from `wi` that reaches `wo`; compares with f |cos wi| dwi.
    pub weight: Color<R>,
    /// The probability with which [`draw`] takes this lobe.
    pub probability: R,
}

impl<R: Real> Delta<R> {
    /// No lobe: the second place of a model that has only one.
    pub const NONE: Self = Delta { wi: Vec3::Z, weight: Color::BLACK, probability: R::ZERO };
}

/// A drawn direction.
#[derive(Clone, Copy, Debug)]
pub struct Sample<R> {
    pub wi: Vec3<R>,
    /// f |cos wi| / pdf, or weight / probability of a delta lobe; 0 for a failed draw.
    pub weight: Color<R>,
    /// Density in 1/sr, or the probability of a delta lobe; 0 for a failed draw.
    pub pdf: R,
    /// 1 for a delta lobe, else 0.
    pub delta: R,
}

/// Directions closer to the horizon than this cosine scatter nothing.
pub const MIN_COS: f64 = 1e-6;

/// A draw of a lower density, in 1/sr, fails: f / pdf would overflow in `f32`. Lobes end at 1e-8 of their peak or before.
pub const MIN_PDF: f64 = 1e-30;

/// Whether `w` may be an argument of a model of this domain.
#[inline(always)]
pub fn in_domain<R: Real>(domain: Domain, w: Vec3<R>) -> R::Mask {
    let z = match domain {
        Domain::Upper => w.z,
        Domain::BothSides | Domain::Sphere => w.z.abs(),
    };
    // an infinite or NaN component makes the product NaN, and the comparison false; loops know the squared length anyway
    let finite = (w.length_squared() * R::ZERO).le(R::ZERO);
    z.ge(R::lit(MIN_COS)) & finite
}

/// [`Bsdf::eval`], or 0 outside the domain.
#[inline(always)]
pub fn eval<R: Real, B: Bsdf<R> + ?Sized>(domain: Domain, bsdf: &B, wi: Vec3<R>, wo: Vec3<R>) -> Color<R> {
    let inside = in_domain(domain, wi) & in_domain(domain, wo);
    Color::select(inside, bsdf.eval(wi, wo), Color::BLACK)
}

/// [`Bsdf::pdf`], or 0 outside the domain. Where there are delta lobes it is already multiplied by the probability
/// that none of them is taken.
#[inline(always)]
pub fn pdf<R: Real, B: Bsdf<R> + ?Sized>(domain: Domain, bsdf: &B, wi: Vec3<R>, wo: Vec3<R>) -> R {
    let inside = in_domain(domain, wi) & in_domain(domain, wo);
    R::select(inside, bsdf.pdf(wi, wo), R::ZERO)
}

/// Draws a direction of the whole model. A draw outside the domain, or of no weight, has weight and pdf 0.
#[inline(always)]
pub fn draw<R: Real, B: Bsdf<R> + ?Sized>(domain: Domain, bsdf: &B, wo: Vec3<R>, u: [R; 3]) -> Sample<R> {
    let Some(lobes) = bsdf.delta(wo) else {
        return draw_continuous(domain, bsdf, wo, u);
    };
    let [first, second] = lobes;
    let is_first = u[2].lt(first.probability);
    let both = first.probability + second.probability;
    // what is left of u[2] chooses within the continuous part
    let rest = ((u[2] - both) / both.one_minus().max(R::lit(1e-7))).clamp(R::ZERO, R::lit(0.99999994));
    let continuous = draw_continuous(domain, bsdf, wo, [u[0], u[1], rest]);
    let probability = R::select(is_first, first.probability, second.probability);
    let weight = Color::select(is_first, first.weight, second.weight);
    let taken = u[2].lt(both) & probability.gt(R::ZERO) & in_domain(domain, wo);
    let weight = weight / probability.max(R::lit(1e-30));
    Sample {
        wi: Vec3::select(taken, Vec3::select(is_first, first.wi, second.wi), continuous.wi),
        weight: Color::select(taken, weight, continuous.weight),
        pdf: R::select(taken, probability, continuous.pdf),
        delta: R::select(taken, R::ONE, R::ZERO),
    }
}

#[inline(always)]
fn draw_continuous<R: Real, B: Bsdf<R> + ?Sized>(domain: Domain, bsdf: &B, wo: Vec3<R>, u: [R; 3]) -> Sample<R> {
    let wi = bsdf.sample(wo, u);
    let pdf = bsdf.pdf(wi, wo);
    let valid = in_domain(domain, wi) & in_domain(domain, wo) & pdf.gt(R::lit(MIN_PDF));
    let weight = bsdf.eval(wi, wo) * (wi.z.abs() / R::select(valid, pdf, R::ONE));
    Sample {
        // a failed draw still is a direction: the mirror image of nothing in particular
        wi: Vec3::select(valid, wi, Vec3::Z),
        weight: Color::select(valid, weight, Color::BLACK),
        pdf: R::select(valid, pdf, R::ZERO),
        delta: R::ZERO,
    }
}
