//! What is encoded comes back.
use bsmdec::{
    decode, encode, Attribute, Domain, EncodeOptions, Entry, Mesh, Positions, Quality, Semantic, Status, Values,
};

fn square() -> Mesh {
    let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.25], [1.0, 1.0, 0.5], [0.0, 1.0, 0.75]];
    let mut mesh = Mesh::new(positions, vec![[0, 1, 2], [0, 2, 3]]);
    let colors = Values::U8((0..12).map(|k| 20 * k).collect());
    mesh.attributes.push(Attribute::new("color", Domain::Vertex, Semantic::Color, 3, colors));
    let places = Values::F32((0..12).map(|k| k as f32 / 12.0).collect());
    mesh.attributes.push(Attribute::new("uv", Domain::Corner, Semantic::Texcoord, 2, places));
    mesh.metadata.push(("unit".into(), Entry::Text("mm".into())));
    mesh
}

#[test]
fn a_lossless_mesh_comes_back() {
    let mesh = square();
    let options = EncodeOptions::new().positions(Positions::Lossless).keep_order(true);
    let decoded = decode(&encode(&mesh, &options).unwrap()).unwrap();
    assert_eq!((&decoded.positions, &decoded.faces), (&mesh.positions, &mesh.faces));
    assert_eq!(decoded.attributes[0], mesh.attributes[0]);
    assert_eq!(decoded.metadata, mesh.metadata);
    let (Values::F32(values), Values::F32(given)) = (&decoded.attributes[1].values, &mesh.attributes[1].values) else {
        panic!()
    };
    for (corner, row) in decoded.attributes[1].indices.iter().enumerate() {
        assert_eq!(values[2 * *row as usize..][..2], given[2 * corner..][..2]);
    }
}

#[test]
fn qualities_are_kept_and_wrong_meshes_refused() {
    let mesh = square();
    let coarse = encode(&mesh, &EncodeOptions::new().quality("uv", Quality::Bits(4))).unwrap();
    let whole = encode(&mesh, &EncodeOptions::new().quality("uv", Quality::Exact)).unwrap();
    assert!(coarse.len() < whole.len());
    let refused = |options| encode(&mesh, &options).unwrap_err().status;
    assert_eq!(refused(EncodeOptions::new().quality("uv", Quality::Degrees(1.0))), Status::Misused);
    assert_eq!(refused(EncodeOptions::new().positions(Positions::Bits(21))), Status::Misused);
    let mut broken = square();
    broken.faces[1][2] = 4;
    assert_eq!(encode(&broken, &EncodeOptions::new()).unwrap_err().message, "corner 5 is vertex 4 of 4");
}
