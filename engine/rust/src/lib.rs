//! Decoder of BSM streams of triangle meshes and their sequences: bsmdec, with its memory and its order of calls kept safe.
//!
//! ```no_run
//! let stream = std::fs::read("bunny.bsm")?;
//! let mesh = bsmdec::decode(&stream)?;
//! println!("{} vertices, {} faces", mesh.positions.len(), mesh.faces.len());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![warn(missing_docs)]

pub mod raw;

use std::ffi::{c_char, c_int, CStr};
use std::{error, fmt, ptr, slice};

pub use raw::bsmdec_limits as Limits;

/// What went wrong, as the specification tells errors apart (F 1), and two that are no stream's fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// A call that makes no sense; nothing was touched.
    Misused,
    /// Not a BSM stream.
    Format,
    /// It contradicts the specification, itself or a checksum.
    Corrupt,
    /// Of a version, method or extension that is not known here.
    Unsupported,
    /// It asks for more than the limits grant.
    Limit,
    /// The mathematics breaks down.
    Numeric,
    /// The host has no memory.
    NoMemory,
    /// The data end before the stream does.
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
            12 => Status::Truncated,
            _ => Status::Misused,
        }
    }
}

/// An error of a stream, and where it is, as far as that is known.
#[derive(Clone, Debug)]
pub struct Error {
    /// Its class.
    pub status: Status,
    /// In words.
    pub message: String,
    /// Byte of the stream.
    pub offset: Option<u64>,
    /// Frame of the stream.
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

fn misused() -> Error {
    let message = "this cannot be asked for here".into();
    Error { status: Status::Misused, message, offset: None, frame: None, block: None }
}

/// # Safety
/// `text` ends with 0.
unsafe fn string_of(text: *const c_char) -> String {
    CStr::from_ptr(text).to_string_lossy().into_owned()
}

/// # Safety
/// `error` is NULL or one of a decoder that lives.
unsafe fn error_of(error: *const raw::bsmdec_error) -> Error {
    let Some(found) = error.as_ref() else { return misused() };
    let message = string_of(found.message.as_ptr());
    let [offset, frame, block] = [found.offset, found.frame, found.block].map(|place| u64::try_from(place).ok());
    Error { status: Status::of(found.status), message, offset, frame, block }
}

/// What has come; vertices and faces are as the user has them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// Push more, or finish.
    NeedData,
    /// What the stream claims.
    Header {
        /// Vertices.
        vertices: u64,
        /// Faces.
        faces: u64,
    },
    /// So many entries of metadata are known.
    Metadata(u64),
    /// Faces can be asked for.
    Connectivity,
    /// A block was decoded, or so many vertices of a grid.
    Block(u64),
    /// More vertices were refined.
    Refinement,
    /// An attribute can be asked for.
    Attribute(usize),
    /// A frame of a sequence can be asked for.
    Frame(u64),
    /// Of a tolerant decoder: something was lost; [`Decoder::last_loss`] tells what. Frames from a number on, if any are.
    Loss {
        /// The first of them.
        first: i64,
        /// How many.
        frames: u64,
    },
    /// The mesh is whole, or all frames were told.
    End,
    /// Nothing follows.
    EndOfStream,
}

/// Values of an attribute, in its own type.
#[derive(Clone, Debug, PartialEq)]
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

/// What has a value of an attribute.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Domain {
    Vertex,
    Corner,
    Face,
}

/// What values of an attribute mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Semantic {
    Generic,
    Color,
    Normal,
    Texcoord,
}

/// What a mesh carries beside its shape.
#[derive(Clone, Debug, PartialEq)]
pub struct Attribute {
    /// Its name.
    pub name: String,
    /// What has a value.
    pub domain: Domain,
    /// What values mean.
    pub semantic: Semantic,
    /// Numbers of a value.
    pub components: usize,
    /// All values, one behind the other.
    pub values: Values,
    /// Of corners: which value each one has; otherwise empty.
    pub indices: Vec<u32>,
    /// Whether frames have values of their own: these are of the frame told last.
    pub moves: bool,
}

/// A value that the author has given a name.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub enum Entry {
    Whole(i64),
    Number(f64),
    Text(String),
    Bytes(Vec<u8>),
}

/// How to decode.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Upper bounds; those that are usual if there are none.
    pub limits: Option<Limits>,
    /// Go on behind damage, and tell of it.
    pub tolerant: bool,
    /// Of a sequence: tell of no frame before this one.
    pub start: u64,
}

/// The limits that are usual, to be changed and given to [`Options`].
pub fn default_limits() -> Limits {
    let mut limits = Limits::default();
    unsafe { raw::bsmdec_default_limits(&mut limits) };
    limits
}

/// Takes bytes as they come and tells events in turn; what an event speaks of is asked for by the other methods.
pub struct Decoder {
    own: ptr::NonNull<raw::bsmdec>,
    vertices: usize,
    faces: usize,
}

// It has nothing in common with any other, and belongs to whoever holds it.
unsafe impl Send for Decoder {}

impl Drop for Decoder {
    fn drop(&mut self) {
        unsafe { raw::bsmdec_close(self.own.as_ptr()) }
    }
}

impl Decoder {
    /// A decoder.
    pub fn new(options: &Options) -> Result<Decoder, Error> {
        let limits = options.limits.as_ref().map_or(ptr::null(), ptr::from_ref);
        let start = i64::try_from(options.start).map_err(|_| misused())?;
        let given = raw::bsmdec_options { limits, allocator: ptr::null(), tolerant: options.tolerant.into(), start };
        let opened = ptr::NonNull::new(unsafe { raw::bsmdec_open(&given) });
        let own = opened.ok_or(Error { status: Status::NoMemory, message: "no memory".into(), ..misused() })?;
        Ok(Decoder { own, vertices: 0, faces: 0 })
    }

    fn done(&self, status: c_int) -> Result<(), Error> {
        match Status::of(status) {
            _ if status == 0 => Ok(()),
            Status::Misused => Err(misused()),
            _ => Err(unsafe { error_of(raw::bsmdec_last_error(self.own.as_ptr())) }),
        }
    }

    /// More bytes of the stream, any number of them.
    pub fn push(&mut self, bytes: &[u8]) -> Result<(), Error> {
        self.done(unsafe { raw::bsmdec_push(self.own.as_ptr(), bytes.as_ptr().cast(), bytes.len()) })
    }

    /// No more bytes will come.
    pub fn finish(&mut self) {
        unsafe { raw::bsmdec_finish(self.own.as_ptr()) };
    }

    /// The next event; the first error of the stream again and again.
    #[allow(clippy::should_implement_trait)]
    pub fn next(&mut self) -> Result<Event, Error> {
        let mut event = raw::bsmdec_event::default();
        self.done(unsafe { raw::bsmdec_next(self.own.as_ptr(), &mut event) })?;
        let [index, vertices, faces] = [event.index, event.vertices, event.faces].map(|number| number.max(0) as u64);
        if event.kind >= 3 {
            (self.vertices, self.faces) = (vertices as usize, faces as usize);
        }
        Ok(match event.kind {
            0 => Event::NeedData,
            1 => Event::Header { vertices, faces },
            2 => Event::Metadata(index),
            3 => Event::Connectivity,
            4 => Event::Block(index),
            5 => Event::Refinement,
            6 => Event::Attribute(index as usize),
            7 => Event::Frame(index),
            8 => Event::Loss { first: event.index, frames: event.count.max(0) as u64 },
            9 => Event::End,
            _ => Event::EndOfStream,
        })
    }

    /// The corners of all faces.
    pub fn faces(&mut self) -> Result<Vec<[u32; 3]>, Error> {
        let mut corners = vec![[0; 3]; self.faces];
        self.done(unsafe { raw::bsmdec_faces(self.own.as_ptr(), corners.as_mut_ptr().cast(), 3 * self.faces) })?;
        Ok(corners)
    }

    /// The positions of the frame told last, or of the mesh: before its end as far as they are known, elsewhere NaN.
    pub fn positions(&mut self) -> Result<Vec<[f64; 3]>, Error> {
        let mut found = vec![[0.0; 3]; self.vertices];
        self.done(unsafe { raw::bsmdec_positions(self.own.as_ptr(), found.as_mut_ptr().cast(), 3 * self.vertices) })?;
        Ok(found)
    }

    /// The same in single precision, into memory that may be a mapped buffer.
    pub fn positions_into(&mut self, to: &mut [[f32; 3]]) -> Result<(), Error> {
        self.done(unsafe { raw::bsmdec_positions_single(self.own.as_ptr(), to.as_mut_ptr().cast(), 3 * to.len()) })
    }

    /// An attribute that is whole; None for others, and for numbers that no attribute has.
    pub fn attribute(&mut self, index: usize) -> Result<Option<Attribute>, Error> {
        let (own, Ok(index)) = (self.own.as_ptr(), c_int::try_from(index)) else { return Ok(None) };
        let mut shape = std::mem::MaybeUninit::<raw::bsmdec_attribute>::zeroed();
        if unsafe { raw::bsmdec_attribute_at(own, index, shape.as_mut_ptr()) } != 0 {
            return Ok(None);
        }
        let shape = unsafe { shape.assume_init() };
        let count = shape.rows as usize * shape.components as usize;
        macro_rules! values {
            ($kind:ident, $type:ty) => {{
                let mut values = vec![<$type>::default(); count];
                let size = std::mem::size_of_val(values.as_slice());
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
            semantic: [Semantic::Generic, Semantic::Color, Semantic::Normal, Semantic::Texcoord][shape.semantic as usize],
            components: shape.components as usize,
            values,
            indices,
            moves: shape.moves != 0,
        }))
    }

    /// How many attributes there are.
    pub fn attribute_count(&self) -> usize {
        unsafe { raw::bsmdec_attribute_count(self.own.as_ptr()) as usize }
    }

    /// The metadata that have come, in their order.
    pub fn metadata(&self) -> Vec<(String, Entry)> {
        let mut found = Vec::new();
        let mut entry = std::mem::MaybeUninit::<raw::bsmdec_metadata>::zeroed();
        while unsafe { raw::bsmdec_metadata_at(self.own.as_ptr(), found.len() as i64, entry.as_mut_ptr()) } == 0 {
            let one = unsafe { entry.assume_init_ref() };
            let bytes = || match one.size {
                0 => Vec::new(),
                size => unsafe { slice::from_raw_parts(one.bytes.cast::<u8>(), size).to_vec() },
            };
            let value = match one.kind {
                1 => Entry::Whole(one.whole),
                2 => Entry::Number(one.number),
                3 => Entry::Text(String::from_utf8_lossy(&bytes()).into_owned()),
                _ => Entry::Bytes(bytes()),
            };
            found.push((unsafe { string_of(one.name) }, value));
        }
        found
    }

    /// The loss that was told last.
    pub fn last_loss(&self) -> Error {
        unsafe { error_of(raw::bsmdec_last_loss(self.own.as_ptr())) }
    }
}

/// A mesh, decoded.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// Where vertices are.
    pub positions: Vec<[f64; 3]>,
    /// The corners of faces.
    pub faces: Vec<[u32; 3]>,
    /// What it carries beside.
    pub attributes: Vec<Attribute>,
}

/// Decode a whole stream: a mesh, or the first frame of a sequence.
pub fn decode(stream: &[u8]) -> Result<Mesh, Error> {
    let mut decoder = Decoder::new(&Options::default())?;
    decoder.push(stream)?;
    decoder.finish();
    while !matches!(decoder.next()?, Event::End | Event::Frame(_)) {}
    let count = decoder.attribute_count();
    let attributes = (0..count).filter_map(|index| decoder.attribute(index).transpose()).collect::<Result<_, _>>()?;
    Ok(Mesh { positions: decoder.positions()?, faces: decoder.faces()?, attributes })
}
