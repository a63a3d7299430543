//! Checks a table against its section and gives its values by name.

use super::node::{Data, Entry, Node};
use crate::error::{Place, Problem, list, name_hint, shown};
use crate::schema::{Field, Kind, Variants};
use lesk_quantities::{Dimension, Quantity};

/// All problems so far.
#[derive(Default)]
pub(crate) struct Problems(pub Vec<Problem>);

/// Problems beyond this number are not kept.
const MAX_PROBLEMS: usize = 1000;

impl Problems {
    pub fn add(&mut self, problem: Problem) {
        if self.0.len() < MAX_PROBLEMS {
            self.0.push(problem);
        }
    }
}

/// A value that has been checked.
pub(crate) enum Checked<'a> {
    Text(&'a str),
    Texts(Vec<&'a str>),
    Bool(bool),
    Integer(i64),
    Integers(Vec<i64>),
    Number(f64),
    Numbers(Vec<f64>),
    Rows([[f64; 4]; 3]),
    Quantity(Quantity),
    Node(&'a Node),
}

/// The values of a table that are legal; the others have been reported.
pub(crate) struct Fields<'a> {
    values: Vec<(&'static str, Checked<'a>, Place)>,
    /// Keys that are there, legal or not.
    present: Vec<&'static str>,
    pub place: Place,
}

/// What a table is checked against.
pub(crate) struct Expected<'e> {
    /// What it is called in messages: `camera`, `shape sphere`.
    pub name: &'e str,
    pub fields: Vec<Field>,
    /// Keys that belong to its siblings: the key and the sibling.
    pub elsewhere: Vec<(&'static str, &'static str)>,
}

impl<'e> Expected<'e> {
    pub fn plain(name: &'e str, fields: &[Field]) -> Self {
        Expected { name, fields: fields.to_vec(), elsewhere: vec![] }
    }
}

impl<'a> Fields<'a> {
    /// Checks a table; `None` where the node is none.
    pub fn of(node: &'a Node, expected: &Expected, problems: &mut Problems) -> Option<Self> {
        let Some(entries) = node.entries() else {
            let text = format!("`{}` is {}, a table is accepted", expected.name, node.shown());
            problems.add(Problem::new(node.place, text));
            return None;
        };
        let mut fields = Fields { values: vec![], present: vec![], place: node.place };
        for entry in entries {
            match expected.fields.iter().find(|f| f.name == entry.key) {
                Some(field) => {
                    fields.present.push(field.name);
                    match check(field, &entry.node) {
                        Ok(value) => fields.values.push((field.name, value, entry.node.place)),
                        Err(problem) => problems.add(problem),
                    }
                }
                None => problems.add(unknown(entry, expected)),
            }
        }
        for field in expected.fields.iter().filter(|f| f.required) {
            if !fields.present.contains(&field.name) {
                let text = format!("{} has no `{}`", expected.name, field.name);
                problems.add(Problem::new(node.place, text).hint(format!("`{}`: {}", field.name, field.doc)));
            }
        }
        Some(fields)
    }

    /// Checks a table whose keys depend on the word under its tag; gives that word too.
    pub fn variant(node: &'a Node, v: &'static Variants, problems: &mut Problems) -> Option<(&'static str, Self)> {
        let words: Vec<&'static str> = v.cases.iter().map(|(word, _)| *word).collect();
        let Some(entries) = node.entries() else {
            problems.add(Problem::new(node.place, format!("{} is {}, a table is accepted", v.name, node.shown())));
            return None;
        };
        let Some(tag) = entries.iter().find(|e| e.key == v.tag) else {
            let text = format!("{} has no `{}`, one of {} is accepted", v.name, v.tag, list(&words));
            problems.add(Problem::new(node.place, text));
            return None;
        };
        let case = match &tag.node.data {
            Data::Text(word) => v.cases.iter().find(|(name, _)| name == word),
            _ => None,
        };
        let Some((word, own)) = case else {
            problems.add(not_a_choice(v.tag, &tag.node, &words));
            return None;
        };
        let tag_field = Field { name: v.tag, doc: "", kind: Kind::Text, required: false };
        let fields: Vec<Field> = v.common.iter().chain(*own).copied().chain([tag_field]).collect();
        let mut elsewhere = Vec::new();
        for (other, keys) in v.cases.iter().filter(|(other, _)| other != word) {
            elsewhere.extend(keys.iter().map(|f| (f.name, *other)));
        }
        let name = format!("{} `{word}`", v.name);
        let fields = Fields::of(node, &Expected { name: &name, fields, elsewhere }, problems)?;
        Some((word, fields))
    }

    fn get(&self, name: &str) -> Option<&Checked<'a>> {
        self.values.iter().find(|(n, ..)| *n == name).map(|(_, value, _)| value)
    }

    /// Whether the key is there, legal or not.
    pub fn has(&self, name: &str) -> bool {
        self.present.contains(&name)
    }

    /// The place of a key's value, else that of the table.
    pub fn place_of(&self, name: &str) -> Place {
        self.values.iter().find(|(n, ..)| *n == name).map_or(self.place, |(_, _, place)| *place)
    }

    pub fn text(&self, name: &str) -> Option<&'a str> {
        match self.get(name)? {
            Checked::Text(text) => Some(text),
            _ => None,
        }
    }

    pub fn texts(&self, name: &str) -> Vec<String> {
        match self.get(name) {
            Some(Checked::Texts(texts)) => texts.iter().map(|t| t.to_string()).collect(),
            _ => vec![],
        }
    }

    pub fn bool(&self, name: &str) -> Option<bool> {
        match self.get(name)? {
            Checked::Bool(b) => Some(*b),
            _ => None,
        }
    }

    pub fn integer(&self, name: &str) -> Option<i64> {
        match self.get(name)? {
            Checked::Integer(i) => Some(*i),
            _ => None,
        }
    }

    pub fn integers(&self, name: &str) -> Option<&[i64]> {
        match self.get(name)? {
            Checked::Integers(i) => Some(i),
            _ => None,
        }
    }

    pub fn number(&self, name: &str) -> Option<f64> {
        match self.get(name)? {
            Checked::Number(x) => Some(*x),
            _ => None,
        }
    }

    /// `N` numbers, or one for all of them.
    pub fn numbers<const N: usize>(&self, name: &str) -> Option<[f64; N]> {
        match self.get(name)? {
            Checked::Number(x) => Some([*x; N]),
            Checked::Numbers(x) => x.as_slice().try_into().ok(),
            _ => None,
        }
    }

    pub fn rows(&self, name: &str) -> Option<[[f64; 4]; 3]> {
        match self.get(name)? {
            Checked::Rows(rows) => Some(*rows),
            _ => None,
        }
    }

    pub fn quantity(&self, name: &str) -> Option<Quantity> {
        match self.get(name)? {
            Checked::Quantity(q) => Some(*q),
            _ => None,
        }
    }

    /// A quantity in SI units.
    pub fn si(&self, name: &str) -> Option<f64> {
        self.quantity(name).map(Quantity::si)
    }

    pub fn node(&self, name: &str) -> Option<&'a Node> {
        match self.get(name)? {
            Checked::Node(node) => Some(node),
            _ => None,
        }
    }

    /// The tables of a list; nothing where it is absent.
    pub fn list(&self, name: &str) -> &'a [Node] {
        match self.node(name).map(|n| &n.data) {
            Some(Data::List(nodes)) => nodes,
            _ => &[],
        }
    }

    /// The tables by name; nothing where they are absent.
    pub fn named(&self, name: &str) -> &'a [Entry] {
        self.node(name).and_then(Node::entries).unwrap_or(&[])
    }

    /// Reports all but the first of some keys that exclude each other; gives the first.
    pub fn one_of(&self, names: &[&'static str], problems: &mut Problems) -> Option<&'static str> {
        let there: Vec<&'static str> = names.iter().copied().filter(|n| self.has(n)).collect();
        for extra in there.iter().skip(1) {
            let text = format!("`{extra}` and `{}` are both there, one of them is accepted", there[0]);
            problems.add(Problem::new(self.place_of(extra), text));
        }
        there.first().copied()
    }
}

fn unknown(entry: &Entry, expected: &Expected) -> Problem {
    let key = shown(&entry.key);
    if let Some((_, other)) = expected.elsewhere.iter().find(|(name, _)| *name == entry.key) {
        let text = format!("`{key}` does not belong to {}, but to `{other}`", expected.name);
        return Problem::new(entry.place, text);
    }
    let known: Vec<&str> = expected.fields.iter().map(|f| f.name).collect();
    Problem::new(entry.place, format!("unknown key `{key}` in {}", expected.name)).hint(name_hint(&key, &known))
}

fn not_a_choice(name: &str, node: &Node, words: &[&str]) -> Problem {
    let hint = match &node.data {
        Data::Text(given) => {
            crate::error::nearest(given.get(..64.min(given.len())).unwrap_or(""), words.iter().copied())
                .map_or(String::new(), |w| format!("did you mean `{w}`?"))
        }
        _ => String::new(),
    };
    Problem::new(node.place, format!("`{name}` is {}, one of {} is accepted", node.shown(), list(words))).hint(hint)
}

/// The value of a field, or what is wrong with it.
pub(crate) fn check<'a>(field: &Field, node: &'a Node) -> Result<Checked<'a>, Problem> {
    let name = field.name;
    let wrong = |accepted: &str| Problem::new(node.place, format!("`{name}` is {}, {accepted}", node.shown()));
    Ok(match (field.kind, &node.data) {
        (Kind::Text, Data::Text(text)) => Checked::Text(text),
        (Kind::Text, _) => return Err(wrong("text in quotes is accepted")),
        (Kind::Bool, Data::Bool(b)) => Checked::Bool(*b),
        (Kind::Bool, _) => return Err(wrong("true or false is accepted")),
        (Kind::Choice(words), Data::Text(text)) if words.contains(&text.as_str()) => Checked::Text(text),
        (Kind::Choice(words), _) => return Err(not_a_choice(name, node, words)),
        (Kind::Choices(words), Data::List(nodes)) => Checked::Texts(choices(name, nodes, words)?),
        (Kind::Choices(words), _) => return Err(wrong(&format!("a list of {} is accepted", list(words)))),
        (Kind::Integer([low, high]), data) => match data {
            Data::Integer(i) if (low..=high).contains(i) => Checked::Integer(*i),
            _ if low == high => return Err(wrong(&format!("{low} is accepted"))),
            _ => return Err(wrong(&format!("a whole number from {low} to {high} is accepted"))),
        },
        (Kind::Integers(count, range), data) => Checked::Integers(integers(name, node, data, count, range)?),
        (Kind::Number([low, high]), _) => match real(node) {
            Some(x) if (low..=high).contains(&x) => Checked::Number(x),
            _ => return Err(wrong(&format!("a number{} is accepted", range_text(low, high))).hint(unitless(node))),
        },
        (Kind::Numbers(count), Data::List(nodes)) => Checked::Numbers(numbers(name, node, nodes, count)?),
        (Kind::Numbers(count), _) => {
            return Err(wrong(&format!("a list of {count} numbers is accepted")).hint(unitless(node)));
        }
        (Kind::NumberOr(count), Data::List(nodes)) => Checked::Numbers(numbers(name, node, nodes, count)?),
        (Kind::NumberOr(count), _) => match real(node) {
            Some(x) => Checked::Number(x),
            None => return Err(wrong(&format!("a number or a list of {count} is accepted")).hint(unitless(node))),
        },
        (Kind::Matrix, _) => Checked::Rows(rows(name, node)?),
        (Kind::Quantity(dimensions, range), _) => Checked::Quantity(quantity(name, node, dimensions, range)?),
        (Kind::Exposure, _) => Checked::Number(exposure(name, node)?),
        (Kind::Table(_), Data::Table(_)) | (Kind::Named(_), Data::Table(_)) => Checked::Node(node),
        (Kind::List(_), Data::List(_)) => Checked::Node(node),
        (Kind::Steps, Data::Table(_) | Data::List(_)) => Checked::Node(node),
        (Kind::Table(_), _) => return Err(wrong("a table is accepted")),
        (Kind::Named(_), _) => {
            return Err(wrong("tables by name are accepted").hint(format!("write `[{name}.SOME_NAME]` above its keys")));
        }
        (Kind::List(_), _) => {
            return Err(
                wrong("a list of tables is accepted").hint(format!("write `[[{name}]]` with two pairs of brackets"))
            );
        }
        (Kind::Steps, _) => {
            return Err(wrong("a table or a list of tables is accepted")
                .hint("for example `[{ rotate = \"30 deg\" }, { translate = [0, 0, 1] }]`"));
        }
    })
}

/// A finite number.
pub(crate) fn real(node: &Node) -> Option<f64> {
    match node.data {
        Data::Integer(i) => Some(i as f64),
        Data::Float(x) if x.is_finite() => Some(x),
        _ => None,
    }
}

/// A number without rows of zeros.
fn short(x: f64) -> String {
    if x == 0.0 || (1e-4..1e7).contains(&x.abs()) { x.to_string() } else { format!("{x:e}") }
}

fn range_text(low: f64, high: f64) -> String {
    match (low > -1e300, high < 1e300) {
        (true, true) => format!(" from {} to {}", short(low), short(high)),
        (true, false) => format!(" from {}", short(low)),
        _ => String::new(),
    }
}

/// The hint for text where a bare number is meant.
fn unitless(node: &Node) -> &'static str {
    match &node.data {
        Data::Text(_) => "this is a bare number, without quotes and unit",
        _ => "",
    }
}

fn numbers(name: &str, node: &Node, nodes: &[Node], count: usize) -> Result<Vec<f64>, Problem> {
    if nodes.len() != count {
        let text = format!("`{name}` has {} entries, {count} numbers are accepted", nodes.len());
        return Err(Problem::new(node.place, text));
    }
    let one = |n: &Node| {
        let text = || format!("`{name}` holds {}, finite numbers are accepted", n.shown());
        real(n).ok_or_else(|| Problem::new(n.place, text()).hint(unitless(n)))
    };
    nodes.iter().map(one).collect()
}

fn integers(name: &str, node: &Node, data: &Data, count: usize, [low, high]: [i64; 2]) -> Result<Vec<i64>, Problem> {
    let accepted = format!("{count} whole numbers from {low} to {high} are accepted");
    let Data::List(nodes) = data else {
        return Err(Problem::new(node.place, format!("`{name}` is {}, a list of {accepted}", node.shown())));
    };
    if nodes.len() != count {
        return Err(Problem::new(node.place, format!("`{name}` has {} entries, {accepted}", nodes.len())));
    }
    let one = |n: &Node| match n.data {
        Data::Integer(i) if (low..=high).contains(&i) => Ok(i),
        _ => Err(Problem::new(n.place, format!("`{name}` holds {}, {accepted}", n.shown()))),
    };
    nodes.iter().map(one).collect()
}

fn rows(name: &str, node: &Node) -> Result<[[f64; 4]; 3], Problem> {
    let wrong =
        || Problem::new(node.place, format!("`{name}` is {}, three rows of four numbers are accepted", node.shown()));
    let Data::List(list) = &node.data else { return Err(wrong()) };
    if list.len() != 3 {
        return Err(wrong().hint("leave out the last row, which is 0, 0, 0, 1"));
    }
    let mut out = [[0.0; 4]; 3];
    for (row, out) in list.iter().zip(&mut out) {
        let Data::List(entries) = &row.data else { return Err(wrong()) };
        out.copy_from_slice(&numbers(name, row, entries, 4)?);
    }
    Ok(out)
}

fn choices<'a>(name: &str, nodes: &'a [Node], words: &[&str]) -> Result<Vec<&'a str>, Problem> {
    let mut out = Vec::new();
    for node in nodes {
        match &node.data {
            Data::Text(text) if out.contains(&text.as_str()) => {
                return Err(Problem::new(node.place, format!("`{name}` has {} twice", node.shown())));
            }
            Data::Text(text) if words.contains(&text.as_str()) => out.push(text.as_str()),
            _ => return Err(not_a_choice(name, node, words)),
        }
    }
    Ok(out)
}

fn quantity(name: &str, node: &Node, accepted: &[Dimension], [low, high]: [f64; 2]) -> Result<Quantity, Problem> {
    let example = |number: &str| {
        let unit = accepted.first().map_or("m", |d| d.examples()[0]);
        format!("write text with a unit, for example `{name} = \"{number} {unit}\"`")
    };
    let text = match &node.data {
        Data::Text(text) => text,
        Data::Integer(_) | Data::Float(_) => {
            let text = format!("`{name}` is {} without a unit", node.shown());
            return Err(Problem::new(node.place, text).hint(example(&node.shown())));
        }
        _ => {
            let text = format!("`{name}` is {}, text with a number and a unit is accepted", node.shown());
            return Err(Problem::new(node.place, text).hint(example("1")));
        }
    };
    let value =
        Quantity::parse_as(text, accepted).map_err(|e| Problem::from_text(node.place, &format!("`{name}`: {e}")))?;
    if !(low..=high).contains(&value.si()) {
        let accepted = match (low == f64::MIN_POSITIVE, high < 1e300, value.dimension()) {
            (true, false, _) => "it must be positive".to_string(),
            (.., Dimension::Angle) => {
                format!("{} to {} deg is accepted", short(low.to_degrees()), short(high.to_degrees()))
            }
            (.., other) => format!("{} to {} {} is accepted", short(low), short(high), other.si_symbol()),
        };
        return Err(Problem::new(
            node.place,
            format!("`{name}` is `{}`, {accepted}", crate::error::shown(text.trim())),
        ));
    }
    Ok(value)
}

fn exposure(name: &str, node: &Node) -> Result<f64, Problem> {
    let value = match &node.data {
        Data::Text(text) => Quantity::parse_as(text, &[Dimension::ExposureValue])
            .map_err(|e| Problem::from_text(node.place, &format!("`{name}`: {e}")))?
            .si(),
        _ => real(node).ok_or_else(|| {
            let text = format!("`{name}` is {}, a number is accepted", node.shown());
            Problem::new(node.place, text).hint("bright sun is 15, a lit room 6 to 8")
        })?,
    };
    if !(-50.0..=50.0).contains(&value) {
        return Err(Problem::new(node.place, format!("`{name}` is {value}, -50 to 50 is accepted")));
    }
    Ok(value)
}
