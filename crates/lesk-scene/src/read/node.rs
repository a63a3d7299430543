//! A TOML document as plain nodes with their places.

use crate::error::{Place, Problem};
use toml_edit::{Document, Item, TableLike, Value};

/// A value with its place.
#[derive(Debug)]
pub(crate) struct Node {
    pub data: Data,
    pub place: Place,
}

#[derive(Debug)]
pub(crate) enum Data {
    Text(String),
    Integer(i64),
    Float(f64),
    Bool(bool),
    Date,
    List(Vec<Node>),
    Table(Vec<Entry>),
}

/// A key with its value.
#[derive(Debug)]
pub(crate) struct Entry {
    pub key: String,
    pub place: Place,
    pub node: Node,
}

impl Node {
    pub fn entries(&self) -> Option<&[Entry]> {
        match &self.data {
            Data::Table(entries) => Some(entries),
            _ => None,
        }
    }

    /// What it is, in words.
    pub fn kind(&self) -> &'static str {
        match self.data {
            Data::Text(_) => "text",
            Data::Integer(_) | Data::Float(_) => "a number",
            Data::Bool(_) => "true or false",
            Data::Date => "a date",
            Data::List(_) => "a list",
            Data::Table(_) => "a table",
        }
    }

    /// The value as it is shown in messages.
    pub fn shown(&self) -> String {
        match &self.data {
            Data::Text(text) => format!("\"{}\"", crate::error::shown(text)),
            Data::Integer(i) => i.to_string(),
            Data::Float(x) => x.to_string(),
            Data::Bool(b) => b.to_string(),
            _ => self.kind().to_string(),
        }
    }
}

/// Reads TOML.
pub(crate) fn parse(text: &str) -> Result<Node, Problem> {
    let document = Document::parse(text).map_err(|e| {
        let message = format!("not valid TOML: {}", e.message().replace('\n', ", "));
        Problem::new(Place::bytes(e.span()), message)
    })?;
    Ok(Node { data: table(document.as_table()), place: Place::NONE })
}

fn table(table: &dyn TableLike) -> Data {
    let entry = |(name, item): (&str, &Item)| {
        let place = Place::bytes(table.key(name).and_then(|k| k.span()));
        let mut node = from_item(item)?;
        if node.place == Place::NONE {
            node.place = place;
        }
        Some(Entry { key: name.to_string(), place, node })
    };
    Data::Table(table.iter().filter_map(entry).collect())
}

fn from_item(item: &Item) -> Option<Node> {
    let place = Place::bytes(item.span());
    let data = match item {
        Item::None => return None,
        Item::Value(value) => return Some(from_value(value)),
        Item::Table(t) => table(t),
        Item::ArrayOfTables(list) => {
            let node = |t: &toml_edit::Table| Node { data: table(t), place: Place::bytes(t.span()) };
            Data::List(list.iter().map(node).collect())
        }
    };
    Some(Node { data, place })
}

fn from_value(value: &Value) -> Node {
    let data = match value {
        Value::String(s) => Data::Text(s.value().clone()),
        Value::Integer(i) => Data::Integer(*i.value()),
        Value::Float(x) => Data::Float(*x.value()),
        Value::Boolean(b) => Data::Bool(*b.value()),
        Value::Datetime(_) => Data::Date,
        Value::Array(list) => Data::List(list.iter().map(from_value).collect()),
        Value::InlineTable(t) => table(t),
    };
    Node { data, place: Place::bytes(value.span()) }
}
