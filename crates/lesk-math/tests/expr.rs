//! Recorded expressions: what they leave behind, and that it computes the same.

use lesk_math::expr::{self, Node};
use lesk_math::{Dual, Expr, Real, Vec3, vec3};

fn formula<R: Real>(x: R, y: R) -> R {
    let near = x.lt(y) & !y.le(R::ZERO);
    let a = (x.sqr() + y).sqrt() * x.sin().atan2(y.cos());
    let b = (x * R::lit(0.1)).exp() - y.abs().ln() + y.max(x).pow(R::HALF);
    R::select(near, a, b).fma(R::PI, x.min(y).round() / (y + R::lit(3.0)))
}

#[test]
fn evaluating_the_graph_equals_running_the_formula() {
    let (graph, out) = expr::record(|| formula(expr::input("x"), expr::input("y")));
    for (x, y) in [(0.5, 1.5), (2.5, 0.7), (-0.3, 0.2), (4.0, 4.0), (0.1, -2.0)] {
        let direct: f64 = formula(x, y);
        let recorded = graph.evaluate(&[x, y], &[out])[0];
        assert_eq!(recorded, direct, "at ({x}, {y})"); // the same operations in the same order: the same bits
    }
}

#[test]
fn exact_mathematics_equals_the_f32_polynomials() {
    let (graph, out) = expr::record(|| {
        expr::set_exact(true);
        formula(expr::input("x"), expr::input("y"))
    });
    let calls = graph.nodes.iter().filter(|n| matches!(n, Node::Unary(expr::Unary::Exp | expr::Unary::Sin, _)));
    assert_eq!(calls.count(), 0, "exact recordings call no function of the target");
    for (x, y) in [(0.5_f32, 1.5), (2.5, 0.7), (4.0, 4.5)] {
        let (direct, recorded) = (formula(x, y), graph.evaluate(&[x, y], &[out])[0]);
        // constants fold in f64 while recording: a few roundings differ
        assert!((direct - recorded).abs() <= 16.0 * f32::EPSILON * direct.abs().max(1.0), "{direct} {recorded}");
    }
}

#[test]
fn equal_operations_are_recorded_once() {
    let (graph, _) = expr::record(|| {
        let (x, y) = (expr::input("x"), expr::input("y"));
        (x * y + x * y, x * y)
    });
    assert_eq!(graph.nodes.len(), 4); // x, y, x y, sum
}

#[test]
fn constants_fold_and_identities_vanish() {
    let (graph, out) = expr::record(|| {
        let x = expr::input("x");
        let zero = x * Expr::ZERO + Expr::lit(2.0) * Expr::lit(3.0) - Expr::lit(6.0);
        (x + zero) * Expr::ONE / Expr::ONE - (-(-zero))
    });
    assert_eq!(graph.nodes.len(), 1);
    assert_eq!(graph.evaluate(&[7.0_f64], &[out]), [7.0]);
}

#[test]
fn derivatives_can_be_recorded() {
    let (graph, slope) = expr::record(|| {
        let x = Dual::<Expr, 1>::variable(expr::input("x"), 0);
        (x.sqr() * x.exp()).d[0]
    });
    let x = 0.7_f64;
    let exact = (2.0 * x + x * x) * x.exp(); // (x^2 e^x)'
    assert!((graph.evaluate(&[x], &[slope])[0] - exact).abs() < 4.0 * f64::EPSILON * exact);
}

#[test]
fn names_stay_with_all_components() {
    let (graph, h) = expr::record(|| {
        let v = |n: &str| {
            vec3(expr::input(&format!("{n}.x")), expr::input(&format!("{n}.y")), expr::input(&format!("{n}.z")))
        };
        (v("wi") + v("wo")).normalize().named("h")
    });
    let Vec3 { x: Expr::Node(x), z: Expr::Node(z), .. } = h else { panic!("a sum of inputs is no constant") };
    assert_eq!(graph.names.first(), Some(&(x.index, "h")));
    assert_eq!(graph.names.last(), Some(&(z.index, "h")));
}

#[test]
#[should_panic(expected = "another recording")]
fn an_expression_of_another_recording_is_refused() {
    let (_, stale) = expr::record(|| expr::input("x") + Expr::ONE);
    expr::record(|| stale + expr::input("y"));
}

#[test]
#[should_panic(expected = "outside `record`")]
fn an_expression_outside_a_recording_is_refused() {
    expr::input("x");
}

#[test]
fn recordings_nest() {
    let (outer, _) = expr::record(|| {
        let x = expr::input("x");
        let (inner, _) = expr::record(|| expr::input("a") * expr::input("b"));
        assert_eq!(inner.nodes.len(), 3);
        x + Expr::ONE
    });
    assert_eq!(outer.nodes.len(), 3); // x, 1, sum
}
