//! Steps with their times: each is announced and timed as it runs, and all are summed by area at the end.

use crate::process::Error;
use std::time::{Duration, Instant};

/// Where the time of a step is booked.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Area {
    Build,
    Rust,
    Models,
    Python,
    Shaders,
    Docs,
}

const AREAS: [(Area, &str); 6] = [
    (Area::Build, "build"),
    (Area::Rust, "Rust"),
    (Area::Models, "models"),
    (Area::Python, "Python"),
    (Area::Shaders, "shaders"),
    (Area::Docs, "docs"),
];

/// One step of a task.
pub struct Step {
    pub name: &'static str,
    pub area: Area,
    pub run: fn() -> Result<(), Error>,
}

/// Runs the steps in order up to the first that fails, then prints the time budget.
pub fn run(steps: &[&Step]) -> Result<(), Error> {
    let mut times = Vec::new();
    let mut outcome = Ok(());
    for step in steps {
        println!("== {}", step.name);
        let start = Instant::now();
        let result = (step.run)();
        let time = start.elapsed();
        times.push((step.name, step.area, time));
        if let Err(error) = result {
            println!("== {} failed after {}", step.name, seconds(time));
            outcome = Err(error);
            break;
        }
        println!("== {} done in {}", step.name, seconds(time));
    }
    print!("\n{}", budget(&times));
    if outcome.is_ok() {
        println!("all {} steps passed", steps.len());
    }
    outcome
}

/// The table of times: one line per area, with its steps from the longest to the shortest.
fn budget(times: &[(&str, Area, Duration)]) -> String {
    let mut table = String::from("time budget\n");
    for (area, title) in AREAS {
        let mut steps: Vec<_> = times.iter().filter(|time| time.1 == area).collect();
        if steps.is_empty() {
            continue;
        }
        steps.sort_by_key(|step| std::cmp::Reverse(step.2));
        let sum: Duration = steps.iter().map(|step| step.2).sum();
        let parts: Vec<_> = steps.iter().map(|step| format!("{} {}", step.0, seconds(step.2))).collect();
        table += &format!("  {title:<8}{:>9}   {}\n", seconds(sum), parts.join(", "));
    }
    let total: Duration = times.iter().map(|time| time.2).sum();
    table + &format!("  {:<8}{:>9}\n", "total", seconds(total))
}

fn seconds(time: Duration) -> String {
    format!("{:.1} s", time.as_secs_f64())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_budget_sums_by_area_and_sorts_by_time() {
        let ms = Duration::from_millis;
        let times = [("fmt", Area::Rust, ms(500)), ("clippy", Area::Rust, ms(2000)), ("pytest", Area::Python, ms(100))];
        let expected = "time budget\n  Rust        2.5 s   clippy 2.0 s, fmt 0.5 s\n  \
                        Python      0.1 s   pytest 0.1 s\n  total       2.6 s\n";
        assert_eq!(budget(&times), expected);
    }

    #[test]
    fn a_failing_step_stops_the_run() {
        let fails = Step { name: "fails", area: Area::Rust, run: || Err(Error::Check { what: "no".to_string() }) };
        let never = Step { name: "never", area: Area::Rust, run: || panic!("must not run") };
        assert_eq!(run(&[&fails, &never]).unwrap_err().to_string(), "no");
    }
}
