//! Rows of EN 12464-1: what a task demands of its light.

use crate::sensor::Limits;
use std::sync::LazyLock;

/// `data/en12464/PROVENANCE.md` says where the figures come from.
const TABLE: &str = include_str!("../../../data/en12464/tasks.csv");

/// The editions that the rows come from.
pub const TASK_EDITION: &str = "EN 12464-1:2011/2021; check the edition in force";

/// A task or area with its requirements.
#[derive(Clone, Debug, PartialEq)]
pub struct Task {
    /// The word for scene files.
    pub id: String,
    /// In words.
    pub name: String,
    /// Least mean maintained illuminance, lx.
    pub illuminance: f64,
    /// Greatest UGR.
    pub ugr: Option<f64>,
    /// Least uniformity min / mean.
    pub uniformity: Option<f64>,
    /// Least colour rendering index; Lesk does not check it.
    pub color_rendering: Option<f64>,
}

static TASKS: LazyLock<Vec<Task>> = LazyLock::new(|| TABLE.lines().skip(1).map(row).collect());

/// All rows, in the order of the table.
pub fn tasks() -> &'static [Task] {
    &TASKS
}

impl Task {
    /// The row with this id.
    pub fn find(id: &str) -> Option<&'static Task> {
        tasks().iter().find(|task| task.id == id)
    }

    /// What it demands of a sensor.
    pub fn limits(&self) -> Limits {
        Limits { mean: Some(self.illuminance), uniformity: self.uniformity, ugr: self.ugr }
    }
}

fn row(line: &str) -> Task {
    let fields = fields(line);
    let number = |i: usize| fields[i].parse::<f64>().ok();
    Task {
        id: fields[0].clone(),
        name: fields[1].clone(),
        illuminance: number(2).expect("data/en12464 has an illuminance in every row"),
        ugr: number(3),
        uniformity: number(4),
        color_rendering: number(5),
    }
}

/// The fields of a line of CSV; a field with commas stands in quotes.
fn fields(line: &str) -> Vec<String> {
    let (mut fields, mut quoted) = (vec![String::new()], false);
    for c in line.chars() {
        match c {
            '"' => quoted = !quoted,
            ',' if !quoted => fields.push(String::new()),
            _ => fields.last_mut().expect("there is a field").push(c),
        }
    }
    fields
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_has_an_id_of_its_own_and_figures_of_the_scale_of_the_standard() {
        // the scale of recommended illuminances of EN 12464-1, lx
        let scale = [20, 30, 50, 75, 100, 150, 200, 300, 500, 750, 1000, 1500, 2000, 3000, 5000];
        for (i, task) in tasks().iter().enumerate() {
            assert_eq!(tasks().iter().position(|t| t.id == task.id), Some(i), "{}", task.id);
            assert!(scale.contains(&(task.illuminance as i32)), "{}", task.id);
            assert!(task.uniformity.is_none_or(|u| (0.1..1.0).contains(&u)), "{}", task.id);
            assert!(task.ugr.is_none_or(|u| [16.0, 19.0, 22.0, 25.0, 28.0].contains(&u)), "{}", task.id);
        }
    }

    #[test]
    fn reading_in_an_office_needs_500_lx_u0_0_6_and_ugr_19() {
        let task = Task::find("office.writing").unwrap();
        let limits = Limits { mean: Some(500.0), uniformity: Some(0.6), ugr: Some(19.0) };
        assert_eq!(task.limits(), limits);
        assert_eq!(task.name, "office: writing, typing, reading, data processing");
    }
}
