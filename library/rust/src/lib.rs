//! Decodes BSM streams of triangle meshes and mesh sequences, and encodes meshes: a safe interface to bsmdec and bsmenc,
//! libraries in C.
//!
//! ```no_run
//! let stream = std::fs::read("bunny.bsm")?;
//! let mesh = bsmdec::decode(&stream)?;
//! println!("{} vertices, {} faces", mesh.positions.len(), mesh.faces.len());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`decode`] reads a whole mesh, and [`encode`] writes one. A [`Decoder`] takes bytes as they arrive, reports events, and plays sequences.
#![warn(missing_docs)]

mod encode;
pub mod raw;

use std::ffi::{c_char, c_int, CStr, CString};
use std::mem::{size_of, size_of_val, zeroed, MaybeUninit};
use std::{error, fmt, ptr, slice};

pub use encode::{encode, EncodeOptions, Positions, Quality};
pub use raw::Limits;

/// The class of an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Status {
    /// The call is not possible now, or an argument is wrong.
    Misused,
    /// The bytes are not a BSM stream.
    Format,
    /// The stream contradicts the specification, itself or a checksum.
    Corrupt,
    /// The stream needs a version or an extension that this library does not have.
    Unsupported,
    /// The stream needs more than the limits allow.
    Limit,
    /// A computation gave a number that is not finite.
    Numeric,
    /// There is no memory.
    NoMemory,
    /// The encoder cannot keep a mesh as the options ask.
    Unreachable,
    /// A fault of the encoder: the decoded stream differs from the mesh.
    Fault,
    /// The stream ends too early.
    Truncated,
}

impl Status {
    fn of(status: c_int) -> Status {
        match status {
            3 => Status::Format,
            4 => Status::Corrupt,
            5 => Status::Unsupported,
            6 => Status::Limit,
            7 => Status::Numeric,
            8 => Status::NoMemory,
            10 => Status::Unreachable,
            11 => Status::Fault,
            12 => Status::Truncated,
            _ => Status::Misused,
        }
    }
}

/// An error, and where the stream is wrong if that is known.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Error {
    /// Its class.
    pub status: Status,
    /// A sentence in English.
    pub message: String,
    /// Byte of the stream.
    pub offset: Option<u64>,
    /// Section of the stream.
    pub frame: Option<u64>,
    /// Block of the mesh.
    pub block: Option<u64>,
}

impl fmt::Display for Error {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(to, "{}", self.message)?;
        self.offset.map_or(Ok(()), |offset| write!(to, " (at byte {offset})"))
    }
}

impl error::Error for Error {}

fn misused(message: &str) -> Error {
    Error { status: Status::Misused, message: message.into(), offset: None, frame: None, block: None }
}

/// # Safety
/// `text` ends with 0.
unsafe fn string_of(text: *const c_char) -> String {
    CStr::from_ptr(text).to_string_lossy().into_owned()
}

/// # Safety
/// `error` is NULL or one of a decoder that lives.
unsafe fn error_of(error: *const raw::bsmdec_error) -> Error {
    let Some(found) = error.as_ref() else { return misused("there is no decoder") };
    let message = string_of(found.message.as_ptr());
    let [offset, frame, block] = [found.offset, found.frame, found.block].map(|place| u64::try_from(place).ok());
    Error { status: Status::of(found.status), message, offset, frame, block }
}

/// What [`Decoder::next`] reports.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Event {
    /// Push more bytes, or call [`Decoder::finish`].
    NeedData,
    /// A header was read. These are the stream's claims.
    Header {
        /// Vertices of the mesh.
        vertices: u64,
        /// Faces of the mesh.
        faces: u64,
        /// Frames of the sequence; 0 for a mesh, and if the encoder did not know.
        frames: u64,
    },
    /// This many entries of metadata are available.
    Metadata(u64),
    /// The faces are available.
    Connectivity {
        /// Vertices of the mesh.
        vertices: usize,
        /// Faces of the mesh.
        faces: usize,
    },
    /// A block was decoded; more positions are known.
    Block(u64),
    /// More vertices were refined.
    Refinement,
    /// Some values of the attribute of this number arrived.
    Values(usize),
    /// The attribute of this number is available.
    Attribute(usize),
    /// A frame of a sequence is the current one.
    Frame {
        /// Its number.
        index: u64,
        /// Its vertices.
        vertices: usize,
        /// Its faces.
        faces: usize,
    },
    /// Tolerant decoders: something was lost, see [`Decoder::last_loss`].
    Loss {
        /// The first frame that is lost.
        first: i64,
        /// Lost frames; 0 if no frame was lost.
        frames: u64,
    },
    /// The mesh is complete, or all frames were reported.
    End {
        /// Vertices of the mesh, or of the last frame.
        vertices: usize,
        /// Faces of the mesh, or of the last frame.
        faces: usize,
    },
    /// Nothing follows.
    EndOfStream,
}

/// The values of an attribute, in their own type.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[allow(missing_docs)]
pub enum Values {
    U8(Vec<u8>),
    I8(Vec<i8>),
    U16(Vec<u16>),
    I16(Vec<i16>),
    U32(Vec<u32>),
    I32(Vec<i32>),
    F32(Vec<f32>),
    F64(Vec<f64>),
}

/// What has a value: a vertex, a corner (a vertex in one face), or a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Domain {
    Vertex,
    Corner,
    Face,
}

/// What the values of an attribute mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
#[allow(missing_docs)]
pub enum Semantic {
    Generic,
    Color,
    Normal,
    Texcoord,
}

/// An attribute of vertices, corners or faces.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Attribute {
    /// Its name.
    pub name: String,
    /// What has a value.
    pub domain: Domain,
    /// What values mean.
    pub semantic: Semantic,
    /// Numbers of a value, such as 2 for texture coordinates.
    pub components: usize,
    /// All values, row by row.
    pub values: Values,
    /// Corners only: the row of each corner, three for each face.
    pub indices: Vec<u32>,
    /// Whether the values change from frame to frame.
    pub moves: bool,
}

impl Attribute {
    /// An attribute of vertices or faces, or of corners in the order of the faces.
    pub fn new(name: &str, domain: Domain, semantic: Semantic, components: usize, values: Values) -> Attribute {
        Attribute { name: name.into(), domain, semantic, components, values, indices: Vec::new(), moves: false }
    }
}

/// The value of an entry of metadata. `bsmdec.h` lists the names that are known.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[allow(missing_docs)]
pub enum Entry {
    Whole(i64),
    Number(f64),
    Text(String),
    Bytes(Vec<u8>),
}

impl Default for Limits {
    fn default() -> Limits {
        let mut limits = MaybeUninit::<raw::bsmdec_limits>::uninit();
        unsafe {
            raw::bsmdec_default_limits(limits.as_mut_ptr(), size_of::<raw::bsmdec_limits>());
            limits.assume_init().bounds
        }
    }
}

/// How to decode: `Options::new().tolerant(true)`.
#[derive(Clone, Debug, Default)]
pub struct Options {
    limits: Option<Limits>,
    tolerant: bool,
    start: u64,
}

impl Options {
    /// The default options.
    pub fn new() -> Options {
        Options::default()
    }

    /// Set upper bounds in place of `Limits::default()`.
    pub fn limits(mut self, limits: Limits) -> Options {
        self.limits = Some(limits);
        self
    }

    /// Report damage as [`Event::Loss`] and go on.
    pub fn tolerant(mut self, tolerant: bool) -> Options {
        self.tolerant = tolerant;
        self
    }

    /// Sequences: report no frame before this one.
    pub fn start(mut self, frame: u64) -> Options {
        self.start = frame;
        self
    }
}

/// The version of the library, such as "1.0.0".
pub fn version() -> &'static str {
    unsafe { CStr::from_ptr(raw::bsmdec_version()) }.to_str().unwrap_or_default()
}

/// Takes bytes as they arrive and reports events. After an event, its methods give what is available.
#[derive(Debug)]
pub struct Decoder {
    own: ptr::NonNull<raw::bsmdec>,
    vertices: usize,
    faces: usize,
    frames: u64,
    split: usize,
}

// Decoders share nothing.
unsafe impl Send for Decoder {}

impl Drop for Decoder {
    fn drop(&mut self) {
        unsafe { raw::bsmdec_close(self.own.as_ptr()) }
    }
}

/// Vertices that moved, and where they are now.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Changes<'a> {
    /// Their numbers.
    pub vertices: &'a [u32],
    /// Their positions.
    pub positions: &'a [[f64; 3]],
    /// 1 if no later block moves the vertex; refinement may.
    pub is_final: &'a [u8],
}

/// # Safety
/// There are `count` elements at `data` that live as long as the slice does; no element if `data` is NULL.
unsafe fn slice_of<'a, T>(data: *const T, count: usize) -> &'a [T] {
    if data.is_null() || count == 0 {
        return &[];
    }
    slice::from_raw_parts(data, count)
}

/// A value of each vertex: its position, or that of an attribute.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// The position.
    Position,
    /// The attribute of this number.
    Attribute(usize),
}

impl Source {
    fn number(self) -> c_int {
        match self {
            Source::Position => -1,
            Source::Attribute(index) => c_int::try_from(index).unwrap_or(c_int::MAX),
        }
    }
}

impl Decoder {
    /// Create a decoder.
    pub fn new(options: &Options) -> Result<Decoder, Error> {
        let limits = options.limits.map(|bounds| raw::bsmdec_limits { size: size_of::<raw::bsmdec_limits>(), bounds });
        let given = raw::bsmdec_options {
            size: size_of::<raw::bsmdec_options>(),
            limits: limits.as_ref().map_or(ptr::null(), ptr::from_ref),
            tolerant: options.tolerant.into(),
            start: i64::try_from(options.start).map_err(|_| misused("start is more than i64::MAX"))?,
            ..unsafe { zeroed() }
        };
        let no_memory = Error { status: Status::NoMemory, ..misused("there is no memory for a decoder") };
        let own = ptr::NonNull::new(unsafe { raw::bsmdec_open(&given) }).ok_or(no_memory)?;
        let decoder = Decoder { own, vertices: 0, faces: 0, frames: 0, split: 0 };
        match unsafe { error_of(raw::bsmdec_last_error(own.as_ptr())) } {
            error if error.message.is_empty() => Ok(decoder),
            error => Err(error),
        }
    }

    fn done(&self, status: c_int) -> Result<(), Error> {
        match Status::of(status) {
            _ if status == 0 => Ok(()),
            Status::Misused => Err(misused(&unsafe { string_of(raw::bsmdec_last_misuse(self.own.as_ptr())) })),
            _ => Err(unsafe { error_of(raw::bsmdec_last_error(self.own.as_ptr())) }),
        }
    }

    /// Append the next bytes of the stream, any number of them.
    pub fn push(&mut self, bytes: &[u8]) -> Result<(), Error> {
        self.done(unsafe { raw::bsmdec_push(self.own.as_ptr(), bytes.as_ptr().cast(), bytes.len()) })
    }

    /// Say that no more bytes will come.
    pub fn finish(&mut self) {
        unsafe { raw::bsmdec_finish(self.own.as_ptr()) };
    }

    /// Decode up to the next event. The first error of the stream is returned again and again.
    #[allow(clippy::should_implement_trait)]
    pub fn next(&mut self) -> Result<Event, Error> {
        let mut event = raw::bsmdec_event::default();
        self.done(unsafe { raw::bsmdec_next(self.own.as_ptr(), &mut event) })?;
        let [index, frames] = [event.index, event.frames].map(|number| number.max(0) as u64);
        let [vertices, faces] = [event.vertices, event.faces].map(|number| number.max(0) as usize);
        self.frames = frames;
        if event.kind != 1 {
            (self.vertices, self.faces) = (vertices, faces);
        }
        Ok(match event.kind {
            0 => Event::NeedData,
            1 => Event::Header { vertices: vertices as u64, faces: faces as u64, frames },
            2 => Event::Metadata(index),
            3 => Event::Connectivity { vertices, faces },
            4 => Event::Block(index),
            5 => Event::Refinement,
            6 => Event::Attribute(index as usize),
            7 => Event::Frame { index, vertices, faces },
            8 => Event::Loss { first: event.index, frames: event.count.max(0) as u64 },
            9 => Event::End { vertices, faces },
            10 => Event::EndOfStream,
            _ => Event::Values(index as usize),
        })
    }

    /// What [`Event::Block`] and [`Event::Refinement`] have changed since the previous call: to draw a mesh while it
    /// arrives, upload the vertices that moved. It is available from [`Event::Connectivity`] on, not for frames of a
    /// sequence.
    pub fn changes(&mut self) -> Result<Changes<'_>, Error> {
        self.read(raw::bsmdec_read_changes)
    }

    /// The vertices that no face uses. [`changes`](Decoder::changes) does not list them.
    pub fn loose(&mut self) -> Result<Changes<'_>, Error> {
        self.read(raw::bsmdec_read_loose)
    }

    fn read(
        &mut self,
        call: unsafe extern "C" fn(*mut raw::bsmdec, *mut raw::bsmdec_changes) -> c_int,
    ) -> Result<Changes<'_>, Error> {
        let mut found: raw::bsmdec_changes = unsafe { zeroed() };
        self.done(unsafe { call(self.own.as_ptr(), &mut found) })?;
        let count = found.count as usize;
        Ok(unsafe {
            Changes {
                vertices: slice_of(found.vertices.cast(), count),
                positions: slice_of(found.positions.cast(), count),
                is_final: slice_of(found.last, count),
            }
        })
    }

    /// Vertices of the current mesh, known from [`Event::Connectivity`] on: the length of its positions.
    pub fn vertex_count(&self) -> usize {
        self.vertices
    }

    /// Faces of the current mesh, known from [`Event::Connectivity`] on.
    pub fn face_count(&self) -> usize {
        self.faces
    }

    /// Frames of the whole sequence, known from [`Event::Header`] on; 0 for a mesh, and if the encoder did not know.
    pub fn frame_count(&self) -> u64 {
        self.frames
    }

    /// The vertices of all faces.
    pub fn faces(&mut self) -> Result<Vec<[u32; 3]>, Error> {
        let mut corners = vec![[0; 3]; self.faces];
        self.faces_into(&mut corners)?;
        Ok(corners)
    }

    /// The vertices of all faces, into memory of [`face_count`](Decoder::face_count) elements.
    pub fn faces_into(&mut self, to: &mut [[u32; 3]]) -> Result<(), Error> {
        self.done(unsafe { raw::bsmdec_faces(self.own.as_ptr(), to.as_mut_ptr().cast(), 3 * to.len()) })
    }

    /// The positions of the mesh or of the current frame. Before the end of a mesh, unknown positions are NaN.
    pub fn positions(&mut self) -> Result<Vec<[f64; 3]>, Error> {
        let mut found = vec![[0.0; 3]; self.vertices];
        self.done(unsafe { raw::bsmdec_positions(self.own.as_ptr(), found.as_mut_ptr().cast(), 3 * self.vertices) })?;
        Ok(found)
    }

    /// The positions in single precision.
    pub fn positions_f32(&mut self) -> Result<Vec<[f32; 3]>, Error> {
        let mut found = vec![[0.0; 3]; self.vertices];
        self.positions_into(&mut found)?;
        Ok(found)
    }

    /// The positions in single precision, into memory of [`vertex_count`](Decoder::vertex_count) elements, such as a
    /// mapped buffer.
    pub fn positions_into(&mut self, to: &mut [[f32; 3]]) -> Result<(), Error> {
        self.done(unsafe { raw::bsmdec_positions_single(self.own.as_ptr(), to.as_mut_ptr().cast(), 3 * to.len()) })
    }

    /// Split the vertices for graphics, which want one index for a whole vertex: those of the mesh in their order, then
    /// a copy for each further combination of corner values. Returns their number. `attributes`: those of vertices and
    /// corners that you need; `None`: all that are available. It holds until the next [`Event::Header`].
    pub fn split(&mut self, attributes: Option<&[usize]>) -> Result<usize, Error> {
        let numbers: Vec<c_int> =
            attributes.unwrap_or(&[]).iter().map(|&attribute| Source::Attribute(attribute).number()).collect();
        let (count, mut vertices) = (attributes.map_or(-1, |some| some.len() as c_int), 0);
        self.done(unsafe { raw::bsmdec_split(self.own.as_ptr(), numbers.as_ptr(), count, &mut vertices) })?;
        self.split = vertices as usize;
        Ok(self.split)
    }

    /// The split vertices of all faces.
    pub fn split_faces(&mut self) -> Result<Vec<[u32; 3]>, Error> {
        let mut found = vec![[0; 3]; self.faces];
        let (to, count) = (found.as_mut_ptr().cast(), 3 * found.len());
        self.done(unsafe { raw::bsmdec_split_indices(self.own.as_ptr(), size_of::<u32>(), to, count) })?;
        Ok(found)
    }

    /// A value of all split vertices, `N` numbers for each. Integers of colors and normals become fractions of one. If
    /// the attribute has fewer numbers, the fourth is 1 and others are 0.
    pub fn split_values<const N: usize>(&mut self, source: Source) -> Result<Vec<[f32; N]>, Error> {
        let mut found = vec![[0.0; N]; self.split];
        let (to, size, stride) = (found.as_mut_ptr().cast(), size_of_val(found.as_slice()), size_of::<[f32; N]>());
        let (own, float32) = (self.own.as_ptr(), 6);
        self.done(unsafe { raw::bsmdec_split_values(own, source.number(), float32, N as c_int, stride, to, size) })?;
        Ok(found)
    }

    /// The attribute of this number; `None` if it is not available, or if there is none.
    pub fn attribute(&mut self, index: usize) -> Result<Option<Attribute>, Error> {
        let (own, Ok(index)) = (self.own.as_ptr(), c_int::try_from(index)) else { return Ok(None) };
        let mut shape = MaybeUninit::<raw::bsmdec_attribute>::zeroed();
        if unsafe { raw::bsmdec_attribute_at(own, index, shape.as_mut_ptr()) } != 0 {
            return Ok(None);
        }
        let shape = unsafe { shape.assume_init() };
        let count = shape.rows as usize * shape.components as usize;
        macro_rules! values {
            ($kind:ident, $type:ty) => {{
                let mut values = vec![<$type>::default(); count];
                let size = size_of_val(values.as_slice());
                self.done(unsafe { raw::bsmdec_attribute_values(own, index, values.as_mut_ptr().cast(), size) })?;
                Values::$kind(values)
            }};
        }
        let values = match shape.kind {
            0 => values!(U8, u8),
            1 => values!(I8, i8),
            2 => values!(U16, u16),
            3 => values!(I16, i16),
            4 => values!(U32, u32),
            5 => values!(I32, i32),
            6 => values!(F32, f32),
            _ => values!(F64, f64),
        };
        let mut indices = vec![0; shape.indices as usize];
        if !indices.is_empty() {
            self.done(unsafe { raw::bsmdec_attribute_indices(own, index, indices.as_mut_ptr(), indices.len()) })?;
        }
        Ok(Some(Attribute {
            name: unsafe { string_of(shape.name) },
            domain: [Domain::Vertex, Domain::Corner, Domain::Face][shape.domain as usize],
            semantic: [Semantic::Generic, Semantic::Color, Semantic::Normal, Semantic::Texcoord]
                [shape.semantic as usize],
            components: shape.components as usize,
            values,
            indices,
            moves: shape.moves != 0,
        }))
    }

    /// Attributes of the mesh, also of those that are not available yet.
    pub fn attribute_count(&self) -> usize {
        unsafe { raw::bsmdec_attribute_count(self.own.as_ptr()) as usize }
    }

    /// The entries of metadata so far, in their order.
    pub fn metadata(&self) -> Vec<(String, Entry)> {
        let mut found = Vec::new();
        let mut entry = MaybeUninit::<raw::bsmdec_metadata>::zeroed();
        while unsafe { raw::bsmdec_metadata_at(self.own.as_ptr(), found.len() as i64, entry.as_mut_ptr()) } == 0 {
            let entry = unsafe { entry.assume_init_ref() };
            found.push(unsafe { (string_of(entry.name), entry_of(entry)) });
        }
        found
    }

    /// The entry of metadata of this name, if there is one so far.
    pub fn metadata_value(&self, name: &str) -> Option<Entry> {
        let (name, mut entry) = (CString::new(name).ok()?, MaybeUninit::<raw::bsmdec_metadata>::zeroed());
        let status = unsafe { raw::bsmdec_metadata_find(self.own.as_ptr(), name.as_ptr(), entry.as_mut_ptr()) };
        (status == 0).then(|| unsafe { entry_of(entry.assume_init_ref()) })
    }

    /// The loss of the last [`Event::Loss`].
    pub fn last_loss(&self) -> Error {
        unsafe { error_of(raw::bsmdec_last_loss(self.own.as_ptr())) }
    }
}

/// # Safety
/// `entry` is one of a decoder that lives.
unsafe fn entry_of(entry: &raw::bsmdec_metadata) -> Entry {
    let bytes = || match entry.size {
        0 => Vec::new(),
        size => slice::from_raw_parts(entry.bytes.cast::<u8>(), size).to_vec(),
    };
    match entry.kind {
        1 => Entry::Whole(entry.whole),
        2 => Entry::Number(entry.number),
        3 => Entry::Text(String::from_utf8_lossy(&bytes()).into_owned()),
        _ => Entry::Bytes(bytes()),
    }
}

/// A decoded mesh.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Mesh {
    /// Positions of the vertices.
    pub positions: Vec<[f64; 3]>,
    /// Vertices of the faces.
    pub faces: Vec<[u32; 3]>,
    /// Attributes of vertices, corners and faces.
    pub attributes: Vec<Attribute>,
    /// Names and values that the author of the stream chose.
    pub metadata: Vec<(String, Entry)>,
}

impl Mesh {
    /// A mesh without attributes and metadata, which may be added.
    pub fn new(positions: Vec<[f64; 3]>, faces: Vec<[u32; 3]>) -> Mesh {
        Mesh { positions, faces, attributes: Vec::new(), metadata: Vec::new() }
    }

    /// The positions in single precision.
    pub fn positions_f32(&self) -> Vec<[f32; 3]> {
        self.positions.iter().map(|place| place.map(|coordinate| coordinate as f32)).collect()
    }
}

/// Decode a whole mesh, or the first frame of a sequence.
pub fn decode(stream: &[u8]) -> Result<Mesh, Error> {
    decode_with(stream, &Options::default())
}

/// The same with options.
pub fn decode_with(stream: &[u8], options: &Options) -> Result<Mesh, Error> {
    let mut decoder = Decoder::new(options)?;
    decoder.push(stream)?;
    decoder.finish();
    while !matches!(decoder.next()?, Event::EndOfStream | Event::Frame { .. }) {}
    let count = decoder.attribute_count();
    let attributes = (0..count).filter_map(|index| decoder.attribute(index).transpose()).collect::<Result<_, _>>()?;
    Ok(Mesh { positions: decoder.positions()?, faces: decoder.faces()?, attributes, metadata: decoder.metadata() })
}
