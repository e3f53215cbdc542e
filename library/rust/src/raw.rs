//! The functions and structures of `bsmdec.h`, which documents them. They are unsafe to call.
#![allow(non_camel_case_types, missing_docs)]
use std::ffi::{c_char, c_int, c_void};

#[repr(C)]
pub struct bsmdec {
    _private: [u8; 0],
}

#[repr(C)]
#[derive(Clone, Copy)]
pub struct bsmdec_error {
    pub status: c_int,
    pub offset: i64,
    pub frame: i64,
    pub block: i64,
    pub message: [c_char; 160],
    pub limit: *const c_char,
    pub value: f64,
}

/// Upper bounds for a stream. One that needs more fails with [`Status::Limit`](crate::Status::Limit) before the memory
/// is allocated or the time is spent. Start with `Limits::default()` and change what you need:
///
/// ```
/// let mut limits = bsmdec::Limits::default();
/// limits.vertices = 1e6;
/// ```
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Limits {
    /// Vertices of the mesh.
    pub vertices: f64,
    /// Faces of the mesh.
    pub faces: f64,
    /// Blocks of the mesh.
    pub blocks: f64,
    /// Vertices of a block.
    pub block_size: f64,
    /// Coefficients of a block.
    pub coefficients: f64,
    /// Frames of a sequence.
    pub frames: f64,
    /// Frames of a group of pictures (GOP).
    pub gop_frames: f64,
    /// Bytes of one section of the stream.
    pub frame_bytes: f64,
    /// Bytes of all metadata.
    pub metadata_bytes: f64,
    /// Attributes of the mesh.
    pub attributes: f64,
    /// Numbers in all attributes.
    pub attribute_values: f64,
    /// Bytes to decode a GOP.
    pub sequence_bytes: f64,
    /// Bytes to decode a grid, a refinement or an attribute.
    pub field_bytes: f64,
    /// Estimated CPU time in nanoseconds that is granted at once.
    pub work: f64,
    /// The same, for each vertex received.
    pub work_per_vertex: f64,
    /// The same, for each byte received.
    pub work_per_byte: f64,
    /// The same, at most.
    pub most_work: f64,
    /// Estimated memory in bytes that is granted at once.
    pub memory: f64,
    /// The same, for each vertex received.
    pub memory_per_vertex: f64,
    /// The same, for each byte received.
    pub memory_per_byte: f64,
    /// The same, at most.
    pub most_memory: f64,
    /// Bytes that the decoder may hold at any time.
    pub heap: f64,
}

#[repr(C)]
#[derive(Clone, Copy)]
pub struct bsmdec_limits {
    pub size: usize,
    pub bounds: Limits,
}

#[repr(C)]
pub struct bsmdec_options {
    pub size: usize,
    pub limits: *const bsmdec_limits,
    pub allocator: *const c_void,
    pub tolerant: c_int,
    pub start: i64,
    pub fields: *const bsmdec_field,
    pub field_count: usize,
    pub stride: usize,
    pub index_size: usize,
    pub parallel: *const c_void,
    pub layers: i64,
}

#[repr(C)]
pub struct bsmdec_field {
    pub semantic: c_int,
    pub name: *const c_char,
    pub kind: c_int,
    pub components: c_int,
    pub offset: usize,
}

#[repr(C)]
#[derive(Default)]
pub struct bsmdec_event {
    pub kind: c_int,
    pub index: i64,
    pub count: i64,
    pub vertices: i64,
    pub faces: i64,
    pub frames: i64,
}

#[repr(C)]
pub struct bsmdec_attribute {
    pub name: *const c_char,
    pub domain: c_int,
    pub semantic: c_int,
    pub kind: c_int,
    pub components: c_int,
    pub rows: i64,
    pub indices: i64,
    pub moves: c_int,
}

#[repr(C)]
pub struct bsmdec_metadata {
    pub name: *const c_char,
    pub kind: c_int,
    pub whole: i64,
    pub number: f64,
    pub bytes: *const c_void,
    pub size: usize,
}

#[repr(C)]
pub struct bsmdec_changes {
    pub count: i64,
    pub vertices: *const i32,
    pub positions: *const f64,
    pub last: *const u8,
}

#[repr(C)]
pub struct bsmdec_losses {
    pub missing_count: i64,
    pub missing: *const i32,
    pub degraded_count: i64,
    pub degraded: *const i32,
}

extern "C" {
    pub fn bsmdec_default_limits(limits: *mut bsmdec_limits, size: usize) -> c_int;
    pub fn bsmdec_open(options: *const bsmdec_options) -> *mut bsmdec;
    pub fn bsmdec_close(decoder: *mut bsmdec);
    pub fn bsmdec_push(decoder: *mut bsmdec, bytes: *const c_void, size: usize) -> c_int;
    pub fn bsmdec_finish(decoder: *mut bsmdec) -> c_int;
    pub fn bsmdec_next(decoder: *mut bsmdec, event: *mut bsmdec_event) -> c_int;
    pub fn bsmdec_faces(decoder: *mut bsmdec, corners: *mut u32, count: usize) -> c_int;
    pub fn bsmdec_positions(decoder: *mut bsmdec, coordinates: *mut f64, count: usize) -> c_int;
    pub fn bsmdec_positions_single(decoder: *mut bsmdec, coordinates: *mut f32, count: usize) -> c_int;
    pub fn bsmdec_metadata_at(decoder: *mut bsmdec, index: i64, entry: *mut bsmdec_metadata) -> c_int;
    pub fn bsmdec_metadata_find(decoder: *mut bsmdec, name: *const c_char, entry: *mut bsmdec_metadata) -> c_int;
    pub fn bsmdec_attribute_count(decoder: *const bsmdec) -> c_int;
    pub fn bsmdec_attribute_at(decoder: *mut bsmdec, index: c_int, attribute: *mut bsmdec_attribute) -> c_int;
    pub fn bsmdec_attribute_values(decoder: *mut bsmdec, index: c_int, values: *mut c_void, size: usize) -> c_int;
    pub fn bsmdec_attribute_indices(decoder: *mut bsmdec, index: c_int, indices: *mut u32, count: usize) -> c_int;
    pub fn bsmdec_split(decoder: *mut bsmdec, attributes: *const c_int, count: c_int, vertices: *mut i64) -> c_int;
    pub fn bsmdec_split_indices(decoder: *mut bsmdec, index_size: usize, indices: *mut c_void, count: usize) -> c_int;
    pub fn bsmdec_split_values(
        decoder: *mut bsmdec,
        attribute: c_int,
        kind: c_int,
        components: c_int,
        stride: usize,
        to: *mut c_void,
        size: usize,
    ) -> c_int;
    pub fn bsmdec_read_changes(decoder: *mut bsmdec, changes: *mut bsmdec_changes) -> c_int;
    pub fn bsmdec_read_loose(decoder: *mut bsmdec, changes: *mut bsmdec_changes) -> c_int;
    pub fn bsmdec_read_losses(decoder: *mut bsmdec, losses: *mut bsmdec_losses) -> c_int;
    pub fn bsmdec_version() -> *const c_char;
    pub fn bsmdec_last_error(decoder: *const bsmdec) -> *const bsmdec_error;
    pub fn bsmdec_last_loss(decoder: *const bsmdec) -> *const bsmdec_error;
    pub fn bsmdec_last_misuse(decoder: *const bsmdec) -> *const c_char;
}

#[repr(C)]
pub struct bsmenc_attribute {
    pub name: *const c_char,
    pub domain: c_int,
    pub semantic: c_int,
    pub kind: c_int,
    pub components: c_int,
    pub rows: i64,
    pub values: *const c_void,
    pub indices: *const u32,
    pub quality: c_int,
    pub amount: f64,
}

#[repr(C)]
pub struct bsmenc_mesh {
    pub size: usize,
    pub vertices: i64,
    pub faces: i64,
    pub positions: *const f64,
    pub positions_single: *const f32,
    pub corners: *const u32,
    pub attributes: *const bsmenc_attribute,
    pub attribute_count: usize,
    pub metadata: *const bsmdec_metadata,
    pub metadata_count: usize,
    pub frames: i64,
}

#[repr(C)]
pub struct bsmenc_options {
    pub size: usize,
    pub positions: c_int,
    pub bits: c_int,
    pub cell: f64,
    pub origin: [f64; 3],
    pub keep_order: c_int,
    pub quick: c_int,
    pub limits: *const bsmdec_limits,
    pub allocator: *const c_void,
    pub progress: Option<unsafe extern "C" fn(host: *mut c_void, part: f64) -> c_int>,
    pub host: *mut c_void,
}

/// As far as it is read here: the C structure goes on.
#[repr(C)]
pub struct bsmenc_stream {
    pub status: c_int,
    pub message: *const c_char,
    pub bytes: *const u8,
    pub size: usize,
}

extern "C" {
    pub fn bsmenc_encode(
        mesh: *const bsmenc_mesh,
        options: *const bsmenc_options,
        stream: *mut *mut bsmenc_stream,
    ) -> c_int;
    pub fn bsmenc_release(stream: *mut bsmenc_stream);
}
