//! The file around the JSON: GLB chunks, data URIs, buffers beside it.

use super::super::{ImageSource, inside_folder, read_file};
use super::{Error, Result, check_version, element};
use ::gltf::json::{self, Root};
use std::borrow::Cow;
use std::path::Path;
use std::sync::Arc;

/// A parsed document and the bytes of its buffers.
pub(super) struct Document<'a> {
    pub root: Root,
    pub buffers: Vec<Cow<'a, [u8]>>,
    path: Option<&'a Path>,
}

impl<'a> Document<'a> {
    pub fn open(bytes: &'a [u8], path: Option<&'a Path>) -> Result<Self> {
        let (text, binary) = if bytes.starts_with(b"glTF") { chunks(bytes)? } else { (bytes, None) };
        let root: Root = json::deserialize::from_slice(text)
            .map_err(|e| Error::new(format!("is no glTF 2.0: {e}")).hint("the JSON must follow the glTF 2.0 schema"))?;
        check_version(&root)?;
        let mut document = Document { root, buffers: vec![], path };
        for index in 0..document.root.buffers.len() {
            let buffer = document.buffer(index, binary).map_err(|e| e.at(format!("buffer {index}")))?;
            document.buffers.push(buffer);
        }
        Ok(document)
    }

    fn buffer(&self, index: usize, binary: Option<&'a [u8]>) -> Result<Cow<'a, [u8]>> {
        let stated = &self.root.buffers[index];
        let bytes: Cow<'a, [u8]> = match (&stated.uri, binary) {
            (Some(uri), _) => match data_uri(uri)? {
                Some((_, bytes)) => Cow::Owned(bytes),
                None => Cow::Owned(read_file(&self.beside(uri)?)?),
            },
            (None, Some(binary)) if index == 0 => Cow::Borrowed(binary),
            _ => return Err(Error::new("has neither an address nor a chunk in the file")),
        };
        let (has, length) = (bytes.len(), stated.byte_length.0);
        if (has as u64) < length {
            return Err(Error::new(format!("declares {length} bytes, but has {has}")).hint("the file may be cut off"));
        }
        Ok(bytes)
    }

    /// The path of a file beside the document.
    fn beside(&self, uri: &str) -> Result<std::path::PathBuf> {
        let decoded = percent_decode(uri)?;
        match self.path {
            Some(path) => inside_folder(path, &decoded),
            None => Err(Error::new(format!("`{}` lies in a file that was not given", decoded.escape_debug()))),
        }
    }

    /// The bytes of a buffer view and its stride.
    pub fn view(&self, index: usize) -> Result<(&[u8], Option<usize>)> {
        let view = element(&self.root.buffer_views, index, "buffer view")?;
        let buffer = element(&self.buffers, view.buffer.value(), "buffer")?;
        let start = view.byte_offset.map_or(0, |o| o.0);
        let end = start.checked_add(view.byte_length.0).filter(|&end| end <= buffer.len() as u64);
        let Some(end) = end else {
            let (length, has) = (view.byte_length.0, buffer.len());
            return Err(Error::new(format!("buffer view {index} takes {length} bytes from byte {start} of {has}")));
        };
        Ok((&buffer[start as usize..end as usize], view.byte_stride.map(|s| s.0)))
    }

    /// Where the bytes of an image are.
    pub fn image(&self, index: usize) -> Result<ImageSource> {
        let image = element(&self.root.images, index, "image")?;
        let media_type = image.mime_type.as_ref().map_or(String::new(), |m| m.0.clone());
        if let Some(uri) = &image.uri {
            return Ok(match data_uri(uri)? {
                Some((stated, bytes)) => ImageSource::Embedded { media_type: stated, bytes: bytes.into() },
                None => ImageSource::File(self.beside(uri)?),
            });
        }
        let view = image.buffer_view.ok_or_else(|| Error::new("has neither an address nor a buffer view"))?;
        let (bytes, _) = self.view(view.value())?;
        Ok(ImageSource::Embedded { media_type, bytes: Arc::from(bytes) })
    }
}

/// The JSON and the binary chunk of a GLB file.
fn chunks(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>)> {
    let word = |at: usize| {
        let b = bytes.get(at..at + 4).ok_or_else(|| Error::new("file ends too early").hint("it may be cut off"))?;
        Ok(u32::from_le_bytes([b[0], b[1], b[2], b[3]]))
    };
    let version = word(4)?;
    if version != 2 {
        return Err(Error::new(format!("file is GLB version {version}, version 2 is accepted")));
    }
    let (mut at, mut text, mut binary) = (12, None, None);
    while at + 8 <= bytes.len() {
        let (length, kind) = (word(at)? as usize, word(at + 4)?);
        let body = bytes.get(at + 8..).and_then(|b| b.get(..length)).ok_or_else(|| {
            let left = bytes.len() - at - 8;
            Error::new(format!("chunk at byte {at} declares {length} bytes, {left} are left"))
                .hint("the file may be cut off")
        })?;
        match kind.to_le_bytes() {
            [b'J', b'S', b'O', b'N'] if text.is_none() => text = Some(body),
            [b'B', b'I', b'N', 0] if binary.is_none() => binary = Some(body),
            _ => {}
        }
        at += 8 + length.next_multiple_of(4);
    }
    Ok((text.ok_or_else(|| Error::new("file has no JSON chunk"))?, binary))
}

/// Media type and bytes of a data URI; `None` for any other address.
fn data_uri(uri: &str) -> Result<Option<(String, Vec<u8>)>> {
    let Some(rest) = uri.strip_prefix("data:") else { return Ok(None) };
    let Some((head, body)) = rest.split_once(";base64,") else {
        return Err(Error::new("data URI is not in base64"));
    };
    Ok(Some((head.to_string(), base64(body)?)))
}

/// RFC 4648, standard alphabet; padding may be left out.
fn base64(text: &str) -> Result<Vec<u8>> {
    let mut out = Vec::with_capacity(text.len() / 4 * 3 + 3);
    let (mut bits, mut count) = (0u32, 0);
    for (i, c) in text.trim_end_matches('=').bytes().enumerate() {
        let value = match c {
            b'A'..=b'Z' => c - b'A',
            b'a'..=b'z' => c - b'a' + 26,
            b'0'..=b'9' => c - b'0' + 52,
            b'+' => 62,
            b'/' => 63,
            _ => return Err(Error::new(format!("character {i} of base64 data is `{}`", (c as char).escape_debug()))),
        };
        bits = bits << 6 | value as u32;
        count += 6;
        if count >= 8 {
            count -= 8;
            out.push((bits >> count) as u8);
            bits &= (1 << count) - 1;
        }
    }
    Ok(out)
}

fn percent_decode(uri: &str) -> Result<String> {
    let bytes = uri.as_bytes();
    let mut out = Vec::with_capacity(bytes.len());
    let mut i = 0;
    while i < bytes.len() {
        let hex = |k: usize| bytes.get(i + k).and_then(|&c| (c as char).to_digit(16));
        match (bytes[i], hex(1), hex(2)) {
            (b'%', Some(high), Some(low)) => {
                out.push((16 * high + low) as u8);
                i += 3;
            }
            (c, ..) => {
                out.push(c);
                i += 1;
            }
        }
    }
    String::from_utf8(out).map_err(|_| Error::new(format!("`{}` is no address", uri.escape_debug())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_follows_the_test_vectors_of_rfc_4648() {
        for (text, plain) in [("", ""), ("Zg==", "f"), ("Zm8=", "fo"), ("Zm9v", "foo"), ("Zm9vYmFy", "foobar")] {
            assert_eq!(base64(text).unwrap(), plain.as_bytes());
        }
        assert_eq!(base64("Zm9vYmE").unwrap(), b"fooba");
        assert!(base64("Zm9v!").is_err());
    }

    #[test]
    fn percent_signs_are_decoded() {
        assert_eq!(percent_decode("a%20b%2Ec%").unwrap(), "a b.c%");
        assert!(percent_decode("%ff").is_err());
    }

    #[test]
    fn chunks_that_are_longer_than_the_file_are_refused() {
        let mut glb = b"glTF\x02\0\0\0\x20\0\0\0".to_vec();
        assert!(chunks(&glb).unwrap_err().to_string().contains("no JSON chunk"));
        glb.extend(b"\xff\xff\xff\xffJSON{}  ");
        assert!(chunks(&glb).unwrap_err().to_string().contains("declares 4294967295 bytes, 4 are left"));
        glb[4] = 1;
        assert!(chunks(&glb).unwrap_err().to_string().contains("version 1"));
        assert!(chunks(b"glTF").is_err());
    }
}
