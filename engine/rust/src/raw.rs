//! bsmdec.h as it is; all of it is unsafe to call.
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
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub struct bsmdec_limits {
    pub vertices: f64,
    pub faces: f64,
    pub blocks: f64,
    pub block_size: f64,
    pub coefficients: f64,
    pub frames: f64,
    pub gop_frames: f64,
    pub frame_bytes: f64,
    pub metadata_bytes: f64,
    pub attributes: f64,
    pub attribute_values: f64,
    pub sequence_bytes: f64,
    pub field_bytes: f64,
    pub work: f64,
    pub work_per_vertex: f64,
    pub work_per_byte: f64,
    pub most_work: f64,
    pub memory: f64,
    pub memory_per_vertex: f64,
    pub memory_per_byte: f64,
    pub most_memory: f64,
    pub heap: f64,
}

#[repr(C)]
pub struct bsmdec_options {
    pub limits: *const bsmdec_limits,
    pub allocator: *const c_void,
    pub tolerant: c_int,
    pub start: i64,
}

#[repr(C)]
#[derive(Default)]
pub struct bsmdec_event {
    pub kind: c_int,
    pub index: i64,
    pub count: i64,
    pub vertices: i64,
    pub faces: i64,
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

extern "C" {
    pub fn bsmdec_default_limits(limits: *mut bsmdec_limits);
    pub fn bsmdec_open(options: *const bsmdec_options) -> *mut bsmdec;
    pub fn bsmdec_close(decoder: *mut bsmdec);
    pub fn bsmdec_push(decoder: *mut bsmdec, bytes: *const c_void, size: usize) -> c_int;
    pub fn bsmdec_finish(decoder: *mut bsmdec) -> c_int;
    pub fn bsmdec_next(decoder: *mut bsmdec, event: *mut bsmdec_event) -> c_int;
    pub fn bsmdec_faces(decoder: *mut bsmdec, corners: *mut u32, count: usize) -> c_int;
    pub fn bsmdec_positions(decoder: *mut bsmdec, coordinates: *mut f64, count: usize) -> c_int;
    pub fn bsmdec_positions_single(decoder: *mut bsmdec, coordinates: *mut f32, count: usize) -> c_int;
    pub fn bsmdec_metadata_at(decoder: *const bsmdec, index: i64, entry: *mut bsmdec_metadata) -> c_int;
    pub fn bsmdec_attribute_count(decoder: *const bsmdec) -> c_int;
    pub fn bsmdec_attribute_at(decoder: *const bsmdec, index: c_int, attribute: *mut bsmdec_attribute) -> c_int;
    pub fn bsmdec_attribute_values(decoder: *mut bsmdec, index: c_int, values: *mut c_void, size: usize) -> c_int;
    pub fn bsmdec_attribute_indices(decoder: *mut bsmdec, index: c_int, indices: *mut u32, count: usize) -> c_int;
    pub fn bsmdec_last_error(decoder: *const bsmdec) -> *const bsmdec_error;
    pub fn bsmdec_last_loss(decoder: *const bsmdec) -> *const bsmdec_error;
}
