//! Numbers out of buffers.

use super::container::Document;
use super::{Error, Result, element};
use ::gltf::json::accessor::{ComponentType, Type};
use ::gltf::json::validation::Checked;

/// Elements of an accessor without a buffer: they are all zero, and nothing in the file bounds their count.
const MAX_UNBACKED: u64 = 1 << 20;

/// An accessor whose elements have all been found to lie in their buffers.
pub(super) struct Numbers<'a> {
    bytes: Option<&'a [u8]>,
    stride: usize,
    pub count: usize,
    component: ComponentType,
    /// Components per element.
    pub width: usize,
    normalized: bool,
    /// Replaced elements: ascending numbers, values packed.
    sparse: Option<(Vec<u32>, &'a [u8])>,
}

impl<'a> Numbers<'a> {
    /// Accessor `index` of the document.
    pub fn open(document: &'a Document<'_>, index: usize) -> Result<Self> {
        Self::open_unplaced(document, index).map_err(|e| e.at(format!("accessor {index}")))
    }

    fn open_unplaced(document: &'a Document<'_>, index: usize) -> Result<Self> {
        let a = element(&document.root.accessors, index, "accessor")?;
        let (Checked::Valid(component), Checked::Valid(kind)) = (&a.component_type, &a.type_) else {
            return Err(Error::new("its component type or type is unknown"));
        };
        if matches!(kind, Type::Mat2 | Type::Mat3 | Type::Mat4) {
            return Err(Error::new("it holds matrices, numbers and vectors are accepted"));
        }
        let (component, width) = (component.0, kind.multiplicity());
        let size = width * component.size();
        let (bytes, stride) = match a.buffer_view {
            Some(view) => {
                let (bytes, stride) = document.view(view.value())?;
                let offset = a.byte_offset.map_or(0, |o| o.0);
                let bytes = window(bytes, offset, a.count.0, stride.unwrap_or(size), size)?;
                (Some(bytes), stride.unwrap_or(size))
            }
            None if a.count.0 <= MAX_UNBACKED => (None, size),
            None => {
                let count = a.count.0;
                return Err(Error::new(format!(
                    "it has {count} elements without a buffer, at most {MAX_UNBACKED} are accepted"
                )));
            }
        };
        let count = a.count.0 as usize;
        let sparse = a.sparse.as_ref().map(|s| sparse(document, s, count, size)).transpose()?;
        Ok(Numbers { bytes, stride, count, component, width, normalized: a.normalized, sparse })
    }

    /// Component `k` of element `i`; 0 for components that it does not have.
    pub fn get(&self, i: usize, k: usize) -> f32 {
        if k >= self.width {
            return 0.0;
        }
        let size = self.component.size();
        let packed = self.width * size;
        let replaced = self.sparse.as_ref().and_then(|(at, values)| {
            let found = at.binary_search(&(i as u32)).ok()?;
            Some(&values[found * packed + k * size..])
        });
        let bytes = replaced.or_else(|| self.bytes.map(|b| &b[i * self.stride + k * size..]));
        bytes.map_or(0.0, |b| decode(b, self.component, self.normalized))
    }

    /// Element `i` as an index.
    pub fn index(&self, i: usize) -> Result<u32> {
        match self.component {
            ComponentType::U32 => {
                let replaced = self.sparse.is_some();
                let b = self.bytes.filter(|_| !replaced).map(|b| &b[i * self.stride..]);
                Ok(b.map_or(self.get(i, 0) as u32, |b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])))
            }
            ComponentType::U8 | ComponentType::U16 => Ok(self.get(i, 0) as u32),
            other => Err(Error::new(format!("indices are {other:?}, unsigned integers are accepted"))),
        }
    }
}

/// The part of a view that holds `count` elements, or why it does not.
fn window(bytes: &[u8], offset: u64, count: u64, stride: usize, size: usize) -> Result<&[u8]> {
    let needed = match count {
        0 => Some(0),
        n => (n - 1).checked_mul(stride as u64).and_then(|x| x.checked_add(size as u64)),
    };
    let has = bytes.len();
    let end = needed.and_then(|n| n.checked_add(offset)).filter(|&end| end <= has as u64);
    match end {
        Some(end) => Ok(&bytes[offset as usize..end as usize]),
        None => Err(Error::new(format!(
            "{count} elements of {size} bytes, {stride} apart, from byte {offset} do not fit into {has} bytes"
        ))),
    }
}

/// Numbers and packed values of the replaced elements.
fn sparse<'a>(
    document: &'a Document<'_>,
    s: &::gltf::json::accessor::sparse::Sparse,
    count: usize,
    size: usize,
) -> Result<(Vec<u32>, &'a [u8])> {
    let Checked::Valid(kind) = s.indices.component_type else {
        return Err(Error::new("the type of its sparse indices is unknown"));
    };
    let width = kind.0.size();
    let (at, _) = document.view(s.indices.buffer_view.value())?;
    let at = window(at, s.indices.byte_offset.0, s.count.0, width, width)?;
    let (values, _) = document.view(s.values.buffer_view.value())?;
    let values = window(values, s.values.byte_offset.0, s.count.0, size, size)?;
    let number = |b: &[u8]| b.iter().rev().fold(0u32, |n, &byte| n << 8 | byte as u32);
    let at: Vec<u32> = at.chunks_exact(width).map(number).collect();
    if !at.is_sorted_by(|a, b| a < b) || at.last().is_some_and(|&last| last as usize >= count) {
        return Err(Error::new(format!("its sparse indices must ascend and stay below {count}")));
    }
    Ok((at, values))
}

/// One component as the specification (section 3.6.2.2) converts it.
fn decode(b: &[u8], component: ComponentType, normalized: bool) -> f32 {
    let (value, most) = match component {
        ComponentType::I8 => (b[0] as i8 as f32, 127.0),
        ComponentType::U8 => (b[0] as f32, 255.0),
        ComponentType::I16 => (i16::from_le_bytes([b[0], b[1]]) as f32, 32767.0),
        ComponentType::U16 => (u16::from_le_bytes([b[0], b[1]]) as f32, 65535.0),
        ComponentType::U32 => return u32::from_le_bytes([b[0], b[1], b[2], b[3]]) as f32,
        ComponentType::F32 => return f32::from_le_bytes([b[0], b[1], b[2], b[3]]),
    };
    if normalized { (value / most).max(-1.0) } else { value }
}
