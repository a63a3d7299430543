//! The search for the best chain of rules.

use super::assumptions::{Assumptions, Need, OPTIONS};
use super::rules::{Node, RULES, Rule};
use crate::Form;

/// Longest chain that is looked at; the graph has eight nodes, and no two need more.
const MAX_RULES: usize = 4;

pub(super) type Chain = Vec<&'static Rule>;

/// All chains between two nodes that visit no node twice; meters and temperatures are ends only.
fn chains(from: Node, to: Node) -> Vec<Chain> {
    fn extend(chain: &mut Chain, seen: &mut Vec<Node>, to: Node, found: &mut Vec<Chain>) {
        let at = seen[seen.len() - 1];
        for rule in RULES.iter().filter(|rule| rule.from == at) {
            if seen.contains(&rule.to) {
                continue;
            }
            chain.push(rule);
            if rule.to == to {
                found.push(chain.clone());
            } else if chain.len() < MAX_RULES && matches!(rule.to, Node::Light(_)) {
                seen.push(rule.to);
                extend(chain, seen, to, found);
                seen.pop();
            }
            chain.pop();
        }
    }
    if from == to {
        return vec![Chain::new()];
    }
    let mut found = Vec::new();
    extend(&mut Chain::new(), &mut vec![from], to, &mut found);
    found
}

/// The needs of a chain, each once.
fn needs(chain: &[&Rule]) -> Vec<Need> {
    let mut needs: Vec<Need> = chain.iter().flat_map(|rule| rule.needs).copied().collect();
    needs.sort_unstable();
    needs.dedup();
    needs
}

fn missing(chain: &[&Rule], a: &Assumptions) -> Vec<Need> {
    needs(chain).into_iter().filter(|need| !a.has(*need)).collect()
}

/// What was given and is not used by a chain; an angle of incidence is used where a rule takes it.
pub(super) fn unused(chain: &[&Rule], a: &Assumptions) -> Vec<Need> {
    let used = |need: &Need| chain.iter().any(|rule| rule.needs.contains(need) || rule.takes.contains(need));
    Need::ALL.into_iter().filter(|need| a.has(*need) && !used(need)).collect()
}

/// One picture per chain: no number stands for two things, light that arrives from a distance is no exitance of the lit
/// surface and no hemisphere, and a flat surface does not shine alike in all directions.
fn consistent(chain: &[&Rule]) -> bool {
    let once = |need: &Need| chain.iter().filter(|rule| rule.needs.contains(need)).count() <= 1;
    let has = |from: Form, to: Form, needs: &[Need]| {
        let ends = [Node::Light(from), Node::Light(to)];
        chain.iter().any(|rule| ends.contains(&rule.from) && ends.contains(&rule.to) && rule.needs == needs)
    };
    let far = has(Form::Intensity, Form::Irradiance, &[Need::Distance]);
    let near = [Need::Lambertian, Need::Dome].iter().any(|need| has(Form::Irradiance, Form::Radiance, &[*need]));
    let flat = has(Form::Radiance, Form::Intensity, &[Need::Area]);
    let round = has(Form::Flux, Form::Intensity, &[]);
    Need::ALL.iter().all(once) && !(far && near) && !(flat && round)
}

/// The chain that leaves the least of what was given unused, then the one that supposes the least, then the shortest;
/// or, if none has all that it needs, the sets of needs that would do.
pub(super) fn best(from: Node, to: Node, a: &Assumptions) -> Result<Chain, Vec<Vec<Need>>> {
    let all: Vec<Chain> = chains(from, to).into_iter().filter(|chain| consistent(chain)).collect();
    let supposed = |chain: &Chain| chain.iter().filter(|rule| rule.needs.is_empty()).count();
    let ready = all.iter().filter(|chain| missing(chain, a).is_empty());
    if let Some(chain) = ready.min_by_key(|chain| (unused(chain, a).len(), supposed(chain), chain.len())) {
        return Ok(chain.clone());
    }
    let fewest = all.iter().map(|chain| missing(chain, a).len()).min().unwrap_or(0);
    let mut sets: Vec<Vec<Need>> =
        all.iter().map(|chain| missing(chain, a)).filter(|set| set.len() == fewest).collect();
    sets.sort_unstable();
    sets.dedup();
    Err(sets)
}

/// `a distance (--at 1.5m), or an area (--area 2m2)`.
pub(super) fn advice(sets: &[Vec<Need>]) -> String {
    let one = |need: &Need| {
        let info = &OPTIONS[*need as usize];
        format!("{} (`{}`, in Python `{}`)", info.title, info.flag, info.name)
    };
    let set = |needs: &Vec<Need>| needs.iter().map(one).collect::<Vec<_>>().join(" and ");
    sets.iter().map(set).collect::<Vec<_>>().join(", or ")
}
