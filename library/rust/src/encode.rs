//! Meshes to streams: a safe interface to bsmenc.
use std::ffi::{c_char, c_int, c_void, CString};
use std::mem::{size_of, zeroed};
use std::{ptr, slice};

use crate::raw::{self, bsmenc_attribute, bsmenc_mesh, bsmenc_options, bsmenc_stream};
use crate::{misused, string_of, Attribute, Entry, Error, Mesh, Status, Values};

/// How exactly an attribute is kept. By default integers and labels are exact, and floats have 12 to 20 bits.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Quality {
    /// Every bit.
    Exact,
    /// Bits of each number.
    Bits(u32),
    /// The largest error.
    Bound(f64),
    /// The largest error, in percent of the attribute's range.
    Percent(f64),
    /// The largest error of a normal, in degrees.
    Degrees(f64),
    /// Normals: the decoder computes them.
    Recompute,
    /// The attribute is left out.
    Omit,
}

/// What positions become.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Positions {
    /// Rounded to so many bits along the longest side, 1 to 20.
    Bits(u32),
    /// Rounded to `origin` + k * `cell`.
    Cells {
        /// Length of a cell.
        cell: f64,
        /// A point of the grid.
        origin: [f64; 3],
    },
    /// Kept in single precision, as are attributes of default quality.
    Lossless,
}

/// How to encode: `EncodeOptions::new().positions(Positions::Bits(12))`.
#[derive(Clone, Debug)]
pub struct EncodeOptions {
    positions: Positions,
    keep_order: bool,
    quick: bool,
    qualities: Vec<(String, Quality)>,
}

impl Default for EncodeOptions {
    fn default() -> EncodeOptions {
        EncodeOptions { positions: Positions::Bits(14), keep_order: false, quick: false, qualities: Vec::new() }
    }
}

impl EncodeOptions {
    /// The defaults: a grid of 14 bits.
    pub fn new() -> EncodeOptions {
        EncodeOptions::default()
    }

    /// What positions become.
    pub fn positions(mut self, positions: Positions) -> EncodeOptions {
        self.positions = positions;
        self
    }

    /// Whether to keep the order of vertices and faces, copies of vertices, and vertices in no face.
    pub fn keep_order(mut self, keep_order: bool) -> EncodeOptions {
        self.keep_order = keep_order;
        self
    }

    /// Whether the stream is quick to decode, and takes some more bytes.
    pub fn quick(mut self, quick: bool) -> EncodeOptions {
        self.quick = quick;
        self
    }

    /// The quality of the attribute of a name.
    pub fn quality(mut self, name: &str, quality: Quality) -> EncodeOptions {
        self.qualities.push((name.into(), quality));
        self
    }

    fn quality_of(&self, name: &str) -> (c_int, f64) {
        let asked = self.qualities.iter().rev().find(|(other, _)| other == name);
        match asked.map(|(_, quality)| *quality) {
            None => (0, 0.0),
            Some(Quality::Exact) => (1, 0.0),
            Some(Quality::Bits(bits)) => (2, bits.into()),
            Some(Quality::Bound(bound)) => (3, bound),
            Some(Quality::Percent(percent)) => (4, percent),
            Some(Quality::Degrees(degrees)) => (5, degrees),
            Some(Quality::Recompute) => (6, 0.0),
            Some(Quality::Omit) => (7, 0.0),
        }
    }
}

fn text_of(text: &str) -> Result<CString, Error> {
    CString::new(text).map_err(|_| misused("a name contains NUL"))
}

fn values_of(attribute: &Attribute) -> (c_int, *const c_void, usize) {
    match &attribute.values {
        Values::U8(values) => (0, values.as_ptr().cast(), values.len()),
        Values::I8(values) => (1, values.as_ptr().cast(), values.len()),
        Values::U16(values) => (2, values.as_ptr().cast(), values.len()),
        Values::I16(values) => (3, values.as_ptr().cast(), values.len()),
        Values::U32(values) => (4, values.as_ptr().cast(), values.len()),
        Values::I32(values) => (5, values.as_ptr().cast(), values.len()),
        Values::F32(values) => (6, values.as_ptr().cast(), values.len()),
        Values::F64(values) => (7, values.as_ptr().cast(), values.len()),
    }
}

fn given(
    mesh: &Mesh,
    attribute: &Attribute,
    name: &CString,
    options: &EncodeOptions,
) -> Result<bsmenc_attribute, Error> {
    let (kind, values, count) = values_of(attribute);
    let corners = !attribute.indices.is_empty();
    if attribute.components == 0 || count % attribute.components != 0 {
        return Err(misused("an attribute has not a number for each component"));
    }
    if corners && attribute.indices.len() != 3 * mesh.faces.len() {
        return Err(misused("an attribute has not an index for each corner"));
    }
    let (quality, amount) = options.quality_of(&attribute.name);
    Ok(bsmenc_attribute {
        name: name.as_ptr(),
        domain: attribute.domain as c_int,
        semantic: attribute.semantic as c_int,
        kind,
        components: attribute.components as c_int,
        rows: (count / attribute.components) as i64,
        values,
        indices: if corners { attribute.indices.as_ptr() } else { ptr::null() },
        quality,
        amount,
    })
}

fn entry_of(name: &CString, entry: &Entry) -> raw::bsmdec_metadata {
    let (kind, whole, number, bytes): (c_int, i64, f64, &[u8]) = match entry {
        Entry::Whole(whole) => (1, *whole, 0.0, &[]),
        Entry::Number(number) => (2, 0, *number, &[]),
        Entry::Text(text) => (3, 0, 0.0, text.as_bytes()),
        Entry::Bytes(bytes) => (4, 0, 0.0, bytes),
    };
    raw::bsmdec_metadata { name: name.as_ptr(), kind, whole, number, bytes: bytes.as_ptr().cast(), size: bytes.len() }
}

/// Encode a mesh. The stream was decoded and compared with the mesh before this returns.
///
/// ```
/// use bsmdec::{decode, encode, EncodeOptions, Mesh};
/// let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// let stream = encode(&Mesh::new(positions, faces), &EncodeOptions::new())?;
/// assert_eq!(decode(&stream)?.faces.len(), 4);
/// # Ok::<(), bsmdec::Error>(())
/// ```
pub fn encode(mesh: &Mesh, options: &EncodeOptions) -> Result<Vec<u8>, Error> {
    let names = mesh.attributes.iter().map(|a| text_of(&a.name)).collect::<Result<Vec<_>, _>>()?;
    let named = mesh.attributes.iter().zip(&names);
    let attributes =
        named.map(|(attribute, name)| given(mesh, attribute, name, options)).collect::<Result<Vec<_>, _>>()?;
    let keys = mesh.metadata.iter().map(|(name, _)| text_of(name)).collect::<Result<Vec<_>, _>>()?;
    let metadata: Vec<_> = mesh.metadata.iter().zip(&keys).map(|((_, entry), key)| entry_of(key, entry)).collect();
    let whole = bsmenc_mesh {
        size: size_of::<bsmenc_mesh>(),
        vertices: mesh.positions.len() as i64,
        faces: mesh.faces.len() as i64,
        positions: mesh.positions.as_ptr().cast(),
        corners: mesh.faces.as_ptr().cast(),
        attributes: attributes.as_ptr(),
        attribute_count: attributes.len(),
        metadata: metadata.as_ptr(),
        metadata_count: metadata.len(),
        ..unsafe { zeroed() }
    };
    let (positions, bits, cell, origin) = match options.positions {
        Positions::Bits(bits) => (0, bits.min(255).max(1) as c_int, 0.0, [0.0; 3]),
        Positions::Cells { cell, origin } => (1, 0, cell, origin),
        Positions::Lossless => (2, 0, 0.0, [0.0; 3]),
    };
    let chosen = bsmenc_options {
        size: size_of::<bsmenc_options>(),
        positions,
        bits,
        cell,
        origin,
        keep_order: options.keep_order.into(),
        quick: options.quick.into(),
        ..unsafe { zeroed() }
    };
    let mut stream: *mut bsmenc_stream = ptr::null_mut();
    // The arrays that `whole` points to live until the call returns; the stream is released after its bytes are copied.
    unsafe {
        let status = raw::bsmenc_encode(&whole, &chosen, &mut stream);
        let Some(found) = stream.as_ref() else {
            return Err(Error { status: Status::NoMemory, ..misused("out of memory") });
        };
        let result = if status == 0 {
            Ok(slice::from_raw_parts(found.bytes, found.size).to_vec())
        } else {
            Err(Error { status: Status::of(status), ..misused(&string_of(found.message as *const c_char)) })
        };
        raw::bsmenc_release(stream);
        result
    }
}
