//! The numbers behind the tilt line: fields one after the other, with any white space or commas between them.

use super::super::text::{at, number, shown};
use crate::error::LightError;
use std::fmt::Display;

/// Reads numbers and knows where it is.
pub(super) struct Numbers<'a> {
    lines: &'a [&'a str],
    /// The line that is read (from 0), and what is left of it.
    line: usize,
    rest: &'a str,
    /// The line of the number read last, from 1.
    pub at: u32,
}

fn is_separator(c: char) -> bool {
    c.is_whitespace() || c == ','
}

impl<'a> Numbers<'a> {
    pub fn new(lines: &'a [&'a str], first: usize) -> Self {
        Numbers { lines, line: first, rest: lines.get(first).copied().unwrap_or(""), at: first as u32 + 1 }
    }

    /// The next word; `None` at the end of the file.
    pub fn word(&mut self) -> Option<&'a str> {
        loop {
            let rest = self.rest.trim_start_matches(is_separator);
            if !rest.is_empty() {
                let end = rest.find(is_separator).unwrap_or(rest.len());
                self.rest = &rest[end..];
                self.at = self.line as u32 + 1;
                return Some(&rest[..end]);
            }
            self.line += 1;
            self.rest = self.lines.get(self.line).copied()?;
        }
    }

    /// Bytes that are left, which bound how many numbers can follow.
    fn left(&self) -> usize {
        let later = self.lines.iter().skip(self.line + 1).map(|line| line.len() + 1).sum::<usize>();
        self.rest.len() + 1 + later
    }

    /// The next number.
    pub fn next(&mut self, field: &str) -> Result<f64, LightError> {
        let Some(word) = self.word() else {
            return Err(at(self.lines.len() as u32, field, "is missing: the file ends before it"));
        };
        number(word).ok_or_else(|| at(self.at, field, format!("is {}, a finite number is accepted", shown(word))))
    }

    /// The next number, which must be whole and within a range; a decimal point is allowed, as in 1986.
    pub fn whole(&mut self, field: &str, least: usize, most: usize) -> Result<usize, LightError> {
        let x = self.next(field)?;
        if x.fract() != 0.0 || x < least as f64 || x > most as f64 {
            return Err(at(self.at, field, format!("is {x}, a whole number from {least} to {most} is accepted")));
        }
        Ok(x as usize)
    }

    /// So many numbers; nothing is kept for numbers that cannot be there.
    pub fn list(&mut self, field: &str, count: usize) -> Result<Vec<f64>, LightError> {
        self.enough(field, count)?;
        let mut list = Vec::with_capacity(count);
        for i in 0..count {
            list.push(self.next(&format_args!("{field} {} of {count}", i + 1).to_string())?);
        }
        Ok(list)
    }

    /// Checks that what is left of the file can hold so many numbers: each needs a digit and a separator.
    pub fn enough(&self, field: &str, count: usize) -> Result<(), LightError> {
        if count > self.left().div_ceil(2) {
            let text =
                format!("has {count} values by the header, but the file has only {} bytes left", self.left() - 1);
            return Err(at(self.at, field, text));
        }
        Ok(())
    }

    /// Ascending angles.
    pub fn angles(&mut self, field: &str, count: usize, within: [f64; 2]) -> Result<Vec<f64>, LightError> {
        self.enough(field, count)?;
        let mut angles: Vec<f64> = Vec::with_capacity(count);
        for _ in 0..count {
            let angle = self.next(field)?;
            let fault = |text: &dyn Display| at(self.at, field, text);
            if !(within[0]..=within[1]).contains(&angle) {
                return Err(fault(&format!("is {angle} deg, {} to {} is accepted", within[0], within[1])));
            }
            if let Some(last) = angles.last().filter(|last| angle <= **last) {
                return Err(fault(&format!("is {angle} deg after {last} deg, but angles ascend")));
            }
            angles.push(angle);
        }
        Ok(angles)
    }
}
