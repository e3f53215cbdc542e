//! Reads a BSM stream and writes OBJ: `cargo run --example obj mesh.bsm > mesh.obj`.
use std::io::{stdout, BufWriter, Write};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args().nth(1).ok_or("usage: obj MESH.bsm > MESH.obj")?;
    let mesh = bsmdec::decode(&std::fs::read(path)?)?;
    let mut out = BufWriter::new(stdout().lock());
    for [x, y, z] in &mesh.positions {
        writeln!(out, "v {x} {y} {z}")?;
    }
    for [a, b, c] in &mesh.faces {
        writeln!(out, "f {} {} {}", a + 1, b + 1, c + 1)?;
    }
    Ok(out.flush()?)
}
