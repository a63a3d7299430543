//! Reports as a table for the terminal.

use crate::report::{Report, Row, Verdict};
use std::fmt::Write;

/// The mark of a verdict.
pub fn mark(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Held => "holds",
        Verdict::RefutedOutside => "not outside",
        Verdict::RefutedAsStored => "does not hold",
        Verdict::Failed => "FAILED",
    }
}

/// A number in at most 10 characters.
pub fn number(x: f64) -> String {
    match x.abs() {
        0.0 => "0".to_owned(),
        a if (1e-3..10.0).contains(&a) => format!("{x:.6}"),
        a if (10.0..1e5).contains(&a) => format!("{x:.3}"),
        _ => format!("{x:.2e}"),
    }
}

/// `alpha_x 0.2, ...; wi 30.0 0.0, wo 50.0 140.0` in degrees.
pub fn place(row: &Row) -> String {
    let Some(place) = &row.place else { return String::new() };
    let short = |x: f64| if x == 0.0 || x.abs() >= 1e-3 { format!("{:.5}", x) } else { format!("{x:.3e}") };
    let trim = |text: String| match text.contains(['e', 'N', 'i']) {
        true => text,
        false => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
    };
    let params: Vec<String> =
        place.params.iter().map(|(name, value)| format!("{name} {}", trim(short(*value)))).collect();
    let [[ti, pi], [to, po]] = [place.wi_deg, place.wo_deg];
    format!("{}; wi {ti:.4} {pi:.2}, wo {to:.4} {po:.2}", params.join(", "))
}

/// One table per model: property, condition, verdict, worst value and what is allowed; the place where it failed.
pub fn text(reports: &[Report]) -> String {
    let mut out = String::new();
    for report in reports {
        let verdict = if report.passed() { "ok" } else { "FAILED" };
        let _ = writeln!(out, "{} - {} ({:.1} s): {verdict}", report.id, report.title, report.seconds);
        for row in &report.rows {
            let condition = row.condition.as_deref().unwrap_or("always");
            let condition = if row.verdict == Verdict::RefutedAsStored { "counterexample" } else { condition };
            let show = |x: Option<f64>| x.map_or("-".to_owned(), number);
            let (value, allowed) = (show(row.value), show(row.allowed));
            let _ = writeln!(
                out,
                "  {:<15} {condition:<34} {:<13} {value:>10} of {allowed:<10} {:6.2} s",
                row.property,
                mark(row.verdict),
                row.seconds
            );
            if row.verdict == Verdict::Failed {
                let _ = writeln!(out, "    {}: {}", row.measure, row.note);
                let _ = writeln!(out, "    at {}", place(row));
            }
        }
    }
    let failed = reports.iter().filter(|report| !report.passed()).count();
    let _ = writeln!(out, "{} models, {failed} failed", reports.len());
    out
}
