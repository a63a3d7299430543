//! Every model of the registry is what it says.

use lesk_check::{Effort, check_all, html, json, text};

#[test]
fn every_model_keeps_its_claims_and_stores_what_it_lacks() {
    let reports = check_all(Effort::Quick);
    let table = text(&reports);
    println!("{table}");
    assert!(reports.iter().all(|report| report.passed()), "\n{table}");
    // the forms that other programs read
    let value = json(&reports);
    assert_eq!(value["version"], 1);
    assert_eq!(value["models"].as_array().map(Vec::len), Some(lesk_bsdf::registry::all().len()));
    let page = html(&reports);
    assert!(reports.iter().all(|report| page.contains(&format!("id=\"{}\"", report.id))));
}
