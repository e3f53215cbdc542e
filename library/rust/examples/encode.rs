//! Encodes a tetrahedron and writes it: `cargo run --example encode tetrahedron.bsm`.
use bsmdec::{encode, EncodeOptions, Mesh, Positions};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    let stream = encode(&Mesh::new(positions, faces), &EncodeOptions::new().positions(Positions::Bits(14)))?;
    std::fs::write(std::env::args().nth(1).unwrap_or("tetrahedron.bsm".into()), stream)?;
    Ok(())
}
