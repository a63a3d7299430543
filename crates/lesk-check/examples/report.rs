//! Prints the table of all models, or of those named, and writes the page: `report [--full] [--html FILE] [MODEL]...`

use lesk_check::{Effort, check, check_all, html, text};

fn main() -> std::io::Result<()> {
    let mut arguments = std::env::args().skip(1);
    let (mut effort, mut page, mut names) = (Effort::Quick, None, Vec::new());
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--full" => effort = Effort::Full,
            "--html" => page = arguments.next(),
            _ => names.push(argument),
        }
    }
    let reports = if names.is_empty() {
        check_all(effort)
    } else {
        names.iter().filter_map(|id| lesk_bsdf::registry::find(id)).map(|model| check(model, effort)).collect()
    };
    print!("{}", text(&reports));
    page.map_or(Ok(()), |path| std::fs::write(path, html(&reports)))
}
