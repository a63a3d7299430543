//! Groups within groups: no circles, and no more than fits.

use super::Resolver;
use crate::description::{GroupDescription, ObjectDescription, Shape};
use crate::error::{Problem, list, name_hint};
use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// Most objects of a scene once its groups are placed, and most groups in groups.
const MAX_OBJECTS: u64 = 1 << 22;
const MAX_NESTING: u32 = 64;

/// The groups of a scene by name.
pub(super) struct Groups<'a> {
    by_name: HashMap<&'a str, &'a GroupDescription>,
    /// How much each group holds; absent for a group that contains itself, or one that does.
    sizes: HashMap<&'a str, Size>,
    /// Objects placed by the scene so far.
    placed: u64,
}

/// What placing a group once costs.
#[derive(Clone, Copy)]
struct Size {
    objects: u64,
    depth: u32,
}

impl<'a> Groups<'a> {
    /// Collects the groups; reports doubles and circles.
    pub fn new(groups: &'a [GroupDescription], resolver: &mut Resolver) -> Self {
        let mut all = Groups { by_name: HashMap::new(), sizes: HashMap::new(), placed: 0 };
        for group in groups {
            if all.by_name.insert(&group.name, group).is_some() {
                resolver.problem(Problem::new(group.place, format!("group `{}` is there twice", group.name)));
            }
        }
        let mut seen = HashMap::new();
        groups.iter().for_each(|group| all.visit(&group.name, &mut seen, resolver));
        all
    }

    /// Walks over everything below a group, and notes the sizes of groups from the innermost outward; `seen` says of
    /// each group whether it is done or on the way here. The stack is our own: groups may be nested more deeply than the
    /// program's.
    fn visit(&mut self, start: &'a str, seen: &mut HashMap<&'a str, bool>, resolver: &mut Resolver) {
        let mut stack: Vec<(&'a str, usize)> = vec![];
        let enter = |name: &'a str, seen: &mut HashMap<&'a str, bool>, stack: &mut Vec<(&'a str, usize)>| {
            if let Entry::Vacant(slot) = seen.entry(name) {
                slot.insert(false);
                stack.push((name, 0));
            }
        };
        enter(start, seen, &mut stack);
        while let Some((name, next)) = stack.pop() {
            let Some(&group) = self.by_name.get(name) else { continue };
            let Some(child) = group.objects.get(next) else {
                seen.insert(name, true);
                let size = self.size_of(group);
                self.sizes.extend(size.map(|size| (name, size)));
                continue;
            };
            stack.push((name, next + 1));
            let Shape::Group(inner) = &child.shape else { continue };
            if seen.get(inner.as_str()) == Some(&false) && self.by_name.contains_key(inner.as_str()) {
                let way: Vec<&str> = stack.iter().map(|(n, _)| *n).skip_while(|n| n != inner).collect();
                let text = format!("group `{inner}` contains itself: {} -> {inner}", shortened(&way));
                resolver.problem(Problem::new(child.place, text));
            } else {
                enter(inner, seen, &mut stack);
            }
        }
    }

    /// `None` where an inner group has no size.
    fn size_of(&self, group: &GroupDescription) -> Option<Size> {
        let mut size = Size { objects: 1, depth: 1 };
        for object in &group.objects {
            let Shape::Group(inner) = &object.shape else {
                size.objects = size.objects.saturating_add(1);
                continue;
            };
            // an unknown name is reported where it is placed
            if self.by_name.contains_key(inner.as_str()) {
                let inner = self.sizes.get(inner.as_str())?;
                size.objects = size.objects.saturating_add(inner.objects);
                size.depth = size.depth.max(inner.depth.saturating_add(1));
            }
        }
        Some(size)
    }

    /// The group that an object of the scene itself places; reports one that is unknown or too large.
    pub fn place(
        &mut self,
        name: &str,
        d: &ObjectDescription,
        resolver: &mut Resolver,
    ) -> Option<&'a GroupDescription> {
        let group = self.find(name, d, resolver)?;
        let size = self.sizes.get(name)?;
        self.placed = self.placed.saturating_add(size.objects);
        let problem = if size.depth > MAX_NESTING {
            format!("group `{name}` is nested {} deep, up to {MAX_NESTING} is accepted", size.depth)
        } else if self.placed > MAX_OBJECTS {
            format!(
                "group `{name}` brings the scene to more than {MAX_OBJECTS} objects, which is the most that is accepted"
            )
        } else {
            return Some(group);
        };
        resolver.problem(Problem::new(d.place, problem));
        None
    }

    /// The group of this name; reports one that is unknown.
    pub fn find(&self, name: &str, d: &ObjectDescription, resolver: &mut Resolver) -> Option<&'a GroupDescription> {
        if d.material.is_some() || d.light.is_some() {
            let text = format!("instance of group `{name}` has a material or light of its own");
            resolver.problem(Problem::new(d.place, text).hint("give them to the objects of the group"));
        }
        let found = self.by_name.get(name).copied();
        if found.is_none() {
            let known: Vec<&str> = resolver.description.groups.iter().map(|g| g.name.as_str()).collect();
            let text = match known.is_empty() {
                true => format!("unknown group `{name}`, the scene has none"),
                false => format!("unknown group `{name}`, there are {}", list(&known)),
            };
            resolver.problem(Problem::new(d.place, text).hint(name_hint(name, &known)));
        }
        found
    }
}

/// The way around a circle, its middle left out where it is long.
fn shortened(way: &[&str]) -> String {
    if way.len() > 8 {
        return format!("{} -> ... -> {}", way[..4].join(" -> "), way[way.len() - 3..].join(" -> "));
    }
    way.join(" -> ")
}
