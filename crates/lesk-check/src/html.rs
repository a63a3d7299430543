//! Reports as one HTML page without any outside resource.

use crate::furnace::Curve;
use crate::report::{Report, Row, Verdict};
use crate::text::{mark, number, place};
use lesk_bsdf::model::Property;
use std::fmt::Write;

const STYLE: &str = "
:root { color-scheme: light dark; --line: #8884; --good: #1a7f4b; --mild: #8a6d1a; --bad: #c0392b; --soft: #8881; }
@media (prefers-color-scheme: dark) { :root { --good: #56c98c; --mild: #d9b64a; --bad: #ff7b6b; } }
body { font: 15px/1.45 system-ui, sans-serif; max-width: 72rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.6rem; margin: 0 0 .3rem } h2 { font-size: 1.15rem; margin: 2.4rem 0 .4rem }
h2 small { font-weight: normal; opacity: .65; margin-left: .6rem }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums }
th, td { text-align: left; padding: .3rem .7rem .3rem 0; border-bottom: 1px solid var(--line); vertical-align: top }
th { font-weight: 600; font-size: .85rem; opacity: .75 } .wide { overflow-x: auto }
td.n { text-align: right; white-space: nowrap } th.n { text-align: right } a { color: inherit }
.good { color: var(--good) } .mild { color: var(--mild) } .bad { color: var(--bad); font-weight: 600 }
code, .place { font-family: ui-monospace, monospace; font-size: .82em } .place { opacity: .75; word-break: break-word }
details summary { cursor: pointer } .note { max-width: 30rem; font-size: .88em; margin: .3rem 0 .3rem 1rem }
.model { display: flex; gap: 1.5rem; flex-wrap: wrap; align-items: flex-start }
.model .wide { flex: 1 1 36rem } svg { flex: 0 0 auto } svg text { fill: currentColor; font: 10px system-ui, sans-serif }
";

fn count(models: usize) -> String {
    if models == 1 { "one model".into() } else { format!("{models} models") }
}

/// The page: a matrix of models and properties, and a table with albedo curves per model.
pub fn html(reports: &[Report]) -> String {
    let mut out = String::from("<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n");
    out.push_str("<meta name=\"viewport\" content=\"width=device-width\">\n<title>Lesk: checks</title>\n<style>");
    out.push_str(STYLE);
    out.push_str("</style></head><body>\n<h1>What the models claim, tested</h1>\n");
    let rows: usize = reports.iter().map(|report| report.rows.len()).sum();
    let failed: usize = reports.iter().map(|report| report.failures().count()).sum();
    let state = if failed == 0 {
        "<span class=\"good\">all as stated</span>".to_owned()
    } else {
        format!("<span class=\"bad\">{failed} failed</span>")
    };
    let _ = writeln!(out, "<p>{rows} statements about {}: {state}.", count(reports.len()));
    out.push_str("A property is claimed and tested, or refuted by a counterexample; nothing is left open.</p>\n");
    matrix(&mut out, reports);
    for report in reports {
        section(&mut out, report);
    }
    out.push_str("</body></html>\n");
    out
}

/// Models by properties, with a mark each.
fn matrix(out: &mut String, reports: &[Report]) {
    out.push_str("<div class=\"wide\"><table><tr><th>model</th>");
    let names: Vec<&str> = Property::ALL.iter().map(|p| p.name()).chain(["limit", "finite"]).collect();
    names.iter().for_each(|name| out.push_str(&format!("<th>{}</th>", name.replace('_', " "))));
    out.push_str("</tr>\n");
    for report in reports {
        let id = escape(&report.id);
        let _ = write!(out, "<tr><td><a href=\"#{id}\">{id}</a></td>");
        for name in &names {
            let rows: Vec<&Row> = report.rows.iter().filter(|row| row.property == *name).collect();
            let _ = write!(out, "<td>{}</td>", summary(&rows));
        }
        out.push_str("</tr>\n");
    }
    out.push_str("</table></div>\n");
}

/// One cell of the matrix.
fn summary(rows: &[&Row]) -> String {
    let any = |verdict: Verdict| rows.iter().any(|row| row.verdict == verdict);
    let partly = any(Verdict::RefutedOutside) || any(Verdict::RefutedAsStored);
    let (class, text) = match (rows.is_empty(), any(Verdict::Failed), any(Verdict::Held)) {
        (true, ..) => return "<span aria-label=\"none\">&middot;</span>".to_owned(),
        (_, true, _) => ("bad", "\u{2717} failed"),
        (_, _, true) if partly => ("good", "\u{2713} where&hellip;"),
        (_, _, true) => ("good", "\u{2713}"),
        _ => ("mild", "no"),
    };
    let conditions: Vec<&str> = rows.iter().filter_map(|row| row.condition.as_deref()).collect();
    format!("<span class=\"{class}\" title=\"{}\">{text}</span>", escape(&conditions.join("; ")))
}

fn section(out: &mut String, report: &Report) {
    let (id, title, paper) = (escape(&report.id), escape(&report.title), escape(&report.paper));
    let _ = writeln!(out, "<h2 id=\"{id}\">{id}<small>{title} [{paper}], {:.1} s</small></h2>", report.seconds);
    out.push_str("<div class=\"model\"><div class=\"wide\"><table><tr><th>property</th><th>condition</th>");
    out.push_str("<th>outcome</th><th class=\"n\">worst value</th><th class=\"n\">allowed</th></tr>\n");
    report.rows.iter().for_each(|row| table_row(out, row));
    out.push_str("</table></div>\n");
    curves(out, &report.albedo);
    out.push_str("</div>\n");
}

/// One statement; what its value means and where it was found unfolds.
fn table_row(out: &mut String, row: &Row) {
    let class = match row.verdict {
        Verdict::Held => "good",
        Verdict::Failed => "bad",
        _ => "mild",
    };
    let condition = match (row.verdict, row.condition.as_deref()) {
        (Verdict::RefutedAsStored, _) => "counterexample".to_owned(),
        (_, Some(condition)) => format!("<code>{}</code>", escape(condition)),
        (_, None) => "always".to_owned(),
    };
    let show = |x: Option<f64>| x.map_or("&ndash;".to_owned(), number);
    let open = if row.verdict == Verdict::Failed { " open" } else { "" };
    let _ = write!(out, "<tr><td><details{open}><summary>{}</summary>", row.property.replace('_', " "));
    let _ = write!(out, "<div class=\"note\">value: {}", escape(&row.measure));
    if row.error > 0.0 {
        let _ = write!(out, " &plusmn; {}", number(row.error));
    }
    if !row.note.is_empty() {
        let _ = write!(out, "<br>{}", escape(&row.note));
    }
    // a value of zero was found everywhere
    let found = if row.value == Some(0.0) { String::new() } else { escape(&place(row)) };
    let _ = write!(out, "<div class=\"place\">{found}</div></div></details></td>");
    let _ = write!(out, "<td>{condition}</td><td class=\"{class}\">{}</td>", mark(row.verdict));
    let _ = writeln!(out, "<td class=\"n\">{}</td><td class=\"n\">{}</td></tr>", show(row.value), show(row.allowed));
}

/// Width, height and margins of the plot, pixels.
const SIZE: [f64; 2] = [300.0, 190.0];
const LEFT: f64 = 34.0;
const RIGHT: f64 = 14.0;
const BOTTOM: f64 = 30.0;

/// Directional albedo against the polar angle: reflected solid, with transmission added dashed.
fn curves(out: &mut String, curves: &[Curve]) {
    if curves.is_empty() {
        return;
    }
    let sum = |c: &Curve, i: usize| c.reflected[i] + c.transmitted[i];
    let top = curves.iter().flat_map(|c| (0..c.theta_deg.len()).map(move |i| sum(c, i))).fold(1.0, f64::max);
    let x = |theta: f64| LEFT + (SIZE[0] - LEFT - RIGHT) * theta / 90.0;
    let y = |value: f64| (SIZE[1] - BOTTOM) - (SIZE[1] - BOTTOM - 8.0) * value / top;
    let [w, h] = SIZE;
    let _ = writeln!(out, "<svg width=\"{w}\" height=\"{h}\" role=\"img\" aria-label=\"directional albedo\">");
    for theta in [0.0, 30.0, 60.0, 90.0] {
        let _ = write!(out, "<path d=\"M{0:.1} 8V{1:.1}\" stroke=\"#8884\"/>", x(theta), h - BOTTOM);
        let _ =
            writeln!(out, "<text x=\"{:.1}\" y=\"{}\" text-anchor=\"middle\">{theta}\u{b0}</text>", x(theta), h - 17.0);
    }
    for value in [0.0, 0.5 * top, top] {
        let _ = write!(out, "<path d=\"M{LEFT} {0:.1}H{1}\" stroke=\"#8884\"/>", y(value), w - RIGHT);
        let _ = writeln!(out, "<text x=\"30\" y=\"{:.1}\" text-anchor=\"end\">{value:.2}</text>", y(value) + 3.0);
    }
    for (curve, colour) in curves.iter().zip(["#2f7fd6", "#d6722f"]) {
        let line = |value: &dyn Fn(usize) -> f64| -> String {
            let folded = |theta: f64| if theta > 90.0 { 180.0 - theta } else { theta };
            let point = |i: usize| format!("{:.1},{:.1}", x(folded(curve.theta_deg[i])), y(value(i)));
            (0..curve.theta_deg.len()).map(point).collect::<Vec<_>>().join(" ")
        };
        let reflected = line(&|i| curve.reflected[i]);
        let _ =
            writeln!(out, "<polyline points=\"{reflected}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"2\"/>");
        if curve.transmitted.iter().any(|&t| t > 0.0) {
            let total = line(&|i| sum(curve, i));
            let dashes = "stroke-width=\"1.5\" stroke-dasharray=\"4 3\"";
            let _ = writeln!(out, "<polyline points=\"{total}\" fill=\"none\" stroke=\"{colour}\" {dashes}/>");
        }
    }
    let labels: Vec<String> = curves.iter().map(|curve| escape(&curve.label)).collect();
    let _ = write!(out, "<text x=\"{LEFT}\" y=\"{:.1}\">albedo: {}", h - 4.0, labels.join(" (blue); "));
    out.push_str(if curves.len() > 1 { " (orange)</text></svg>\n" } else { "</text></svg>\n" });
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
