//! Derivatives by the parameters against central differences, in `f64`.
//!
//! The step is h = 2e-5 of the parameter's size. Truncation errs by h^2 f'''/6 and is estimated by a second difference
//! with the step 2 h, which errs by four times as much; rounding errs by eps |f| / h times the condition of f.

mod common;

use common::{Random, condition, reference};
use lesk_bsdf::{Scatter, registry};
use lesk_math::{CHANNELS, Vec3};

const STEP: f64 = 2e-5;

/// Directions half anywhere, half where the model draws.
fn pair(model: &dyn Scatter, params: &[f64], random: &mut Random) -> (Vec3<f64>, Vec3<f64>) {
    let domain = model.model().domain;
    let wo = random.direction(domain, 1e-3);
    let drawn = (reference(model).draw)(params, wo, [random.unit(), random.unit(), random.unit()]);
    let far = drawn.delta == 0.0 && drawn.pdf > 0.0 && drawn.wi.z.abs() > 1e-3 && random.unit() < 0.5;
    (if far { drawn.wi } else { random.direction(domain, 1e-3) }, wo)
}

/// Whether the gradient jumps within two steps of these parameters, at the floors under the widths of slopes.
fn near_a_kink(model: &dyn Scatter, params: &[f64]) -> bool {
    let value = |name| common::value_of(model, params, name);
    let near = |x: f64, kink: f64| (x / kink - 1.0).abs() < 1e-3;
    match model.id() {
        "metallic_roughness" => near(value("roughness").powi(2), 1e-3),
        "disney_2012" => {
            let (alpha, aspect) = (value("roughness").powi(2), (1.0 - 0.9 * value("anisotropic")).sqrt());
            near(alpha / aspect, 1e-3) || near(alpha * aspect, 1e-3)
        }
        _ => false,
    }
}

#[test]
fn gradients_agree_with_central_differences() {
    for model in registry::all() {
        let mut random = Random::new(1);
        let f = reference(model).eval;
        let gradient = model.forms().gradient.expect("every model of the registry has one");
        let mut nonzero = 0;
        for _ in 0..4000 {
            let mut params = random.params(model.specs());
            let (wi, wo) = pair(model, &params, &mut random);
            if near_a_kink(model, &params) {
                continue;
            }
            let count = params.len();
            let mut exact = vec![f64::NAN; CHANNELS * count];
            let value = gradient(&params, wi, wo, &mut exact);
            let direct = f(&params, wi, wo);
            let changes = condition(|params, wi, wo| f(params, wi, wo).0, &params, wi, wo);
            for c in 0..CHANNELS {
                // dual numbers sum products in another order
                let off = (value.0[c] - direct.0[c]).abs();
                assert!(off <= 16.0 * f64::EPSILON * (direct.0[c].abs() + changes[c]), "{}: value", model.id());
            }
            for p in 0..count {
                let x = params[p];
                let h = STEP * x.abs().max(1e-2);
                let mut at = |x: f64| {
                    params[p] = x;
                    f(&params, wi, wo)
                };
                let near = (at(x + h) - at(x - h)) * (0.5 / h);
                let far = (at(x + 2.0 * h) - at(x - 2.0 * h)) * (0.25 / h);
                params[p] = x;
                for c in 0..CHANNELS {
                    let (exact, near, far) = (exact[c * count + p], near.0[c], far.0[c]);
                    let truncation = (far - near).abs(); // three times the error of `near`
                    let rounding = 16.0 * f64::EPSILON * (direct.0[c].abs() + changes[c]) / h;
                    let allowed = truncation + rounding + 1e-12 * exact.abs() + 1e-250;
                    assert!(
                        (exact - near).abs() <= allowed,
                        "{} d/d[{p}] channel {c}: {exact} instead of {near} (allowed {allowed:.1e}), \
                         wi {wi:?} wo {wo:?} parameters {params:?}",
                        model.id()
                    );
                    nonzero += usize::from(exact != 0.0);
                }
            }
        }
        let smooth = model.delta(&common::narrow(&random.params(model.specs())), Vec3::Z).is_none();
        assert_eq!(nonzero > 1000, smooth, "{}: {nonzero} derivatives differ from 0", model.id());
    }
}
