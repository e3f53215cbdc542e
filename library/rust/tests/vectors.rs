//! Every vector of the specification is decoded, to the positions whose checksum it has, or refused.
use bsmdec::{Decoder, Entry, Error, Event, Limits, Options, Source, Status};
use std::fs;
use std::path::{Path, PathBuf};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../spec/vectors/1.0")
}

/// The files of all versions.
fn files() -> impl Iterator<Item = PathBuf> {
    let folders = fs::read_dir(folder().parent().unwrap()).unwrap().map(|entry| entry.unwrap().path());
    folders.filter(|path| path.is_dir()).flat_map(|path| fs::read_dir(path).unwrap()).map(|entry| entry.unwrap().path())
}

/// Decode byte after byte, and ask for everything.
fn through(stream: &[u8], piece: usize, options: &Options) -> Result<(usize, usize), Error> {
    let mut decoder = Decoder::new(options)?;
    let (mut frames, mut losses, mut room) = (0, 0, Vec::new());
    let mut pieces = stream.chunks(piece);
    loop {
        match decoder.next()? {
            Event::NeedData => match pieces.next() {
                Some(bytes) => decoder.push(bytes)?,
                None => decoder.finish(),
            },
            Event::Connectivity { vertices, faces } => {
                room = vec![[0.0; 3]; vertices];
                assert_eq!((decoder.vertex_count(), decoder.face_count()), (vertices, decoder.faces()?.len()));
                assert_eq!(decoder.faces()?.len(), faces);
            }
            Event::Frame { vertices, .. } => {
                let positions = decoder.positions()?;
                assert_eq!(positions.len(), vertices);
                decoder.positions_into(&mut room)?;
                assert_eq!(positions[0][0] as f32, room[0][0]);
                frames += 1;
            }
            Event::Attribute(index) => assert!(decoder.attribute(index)?.is_some()),
            Event::Loss { .. } => {
                assert_ne!(decoder.last_loss().message, "");
                losses += 1;
            }
            Event::EndOfStream => return Ok((frames, losses)),
            _ => {}
        }
    }
}

#[test]
fn vectors_are_decoded_or_refused() {
    let mut count = 0;
    for path in files() {
        if path.extension().is_none_or(|end| end != "bsm") {
            continue;
        }
        let (name, stream) = (path.file_stem().unwrap().to_str().unwrap(), fs::read(&path).unwrap());
        let found = through(&stream, if name.contains("1") { 1 } else { 1000 }, &Options::default());
        assert_eq!(found.is_ok(), name.starts_with("good-"), "{name}: {found:?}");
        assert!(bsmdec::decode(&stream).is_ok() || !name.starts_with("good-"), "{name}");
        assert_eq!(name.contains("-sequence") && name.starts_with("good-"), found.is_ok_and(|(frames, _)| frames > 0));
        count += 1;
    }
    assert!(count > 400);
}

#[test]
fn wrong_orders_of_calls_are_errors() {
    let mut decoder = Decoder::new(&Options::default()).unwrap();
    assert_eq!(decoder.positions().unwrap_err().message, "positions are known after the first BLOCK");
    assert_eq!(decoder.split(None).unwrap_err().message, "faces are known after CONNECTIVITY");
    assert_eq!(decoder.attribute(0).unwrap(), None);
    assert_eq!(decoder.attribute(usize::MAX).unwrap(), None);
    decoder.finish();
    assert_eq!(decoder.push(b"late").unwrap_err().status, Status::Misused);
    assert_eq!(decoder.next().unwrap_err().status, Status::Truncated);
}

#[test]
fn bytes_behind_the_end_are_refused() {
    let mut stream = fs::read(folder().join("good-keys.bsm")).unwrap();
    stream.extend(b"more");
    let error = bsmdec::decode(&stream).unwrap_err();
    assert_eq!((error.status, error.message.as_str()), (Status::Corrupt, "data after END"));
    assert!(bsmdec::decode_with(&stream, &Options::new().tolerant(true)).is_ok());
}

#[test]
fn limits_metadata_and_damage_are_reported() {
    let stream = fs::read(folder().join("good-metadata.bsm")).unwrap();
    let mut limits = Limits::default();
    assert!(limits.heap > 1e9 && limits.frames == 1048576.0, "{limits:?}");
    limits.vertices = 3.0;
    let narrow = Options::new().limits(limits);
    assert_eq!(through(&stream, 100, &narrow).unwrap_err().status, Status::Limit);
    let mut decoder = Decoder::new(&Options::default()).unwrap();
    decoder.push(&stream).unwrap();
    decoder.finish();
    while !matches!(decoder.next().unwrap(), Event::End { .. }) {}
    let metadata = decoder.metadata();
    assert!(metadata.iter().any(|(_, value)| matches!(value, Entry::Text(_))));
    assert!(metadata.iter().all(|(name, value)| decoder.metadata_value(name).as_ref() == Some(value)));
    assert_eq!(decoder.metadata_value("no such name"), None);
    assert_eq!(bsmdec::decode(&stream).unwrap().metadata, metadata);
    limits.vertices = f64::NAN;
    let error = Decoder::new(&Options::new().limits(limits)).unwrap_err();
    assert_eq!(
        (error.status, error.message.as_str()),
        (Status::Misused, "field 1 of the limits is negative or not a number")
    );
    let mut damaged = fs::read(folder().join("good-keys.bsm")).unwrap();
    let place = damaged.len() - 40;
    damaged[place] ^= 1;
    assert_eq!(through(&damaged, 64, &Options::default()).unwrap_err().status, Status::Corrupt);
    let (_, losses) = through(&damaged, 64, &Options::new().tolerant(true)).unwrap();
    assert!(losses > 0);
}

#[test]
fn vertices_are_split_for_graphics() {
    let stream = fs::read(folder().join("good-attribute-uv-plain.bsm")).unwrap();
    let mesh = bsmdec::decode(&stream).unwrap();
    let mut decoder = Decoder::new(&Options::default()).unwrap();
    decoder.push(&stream).unwrap();
    decoder.finish();
    while !matches!(decoder.next().unwrap(), Event::End { .. }) {}
    let vertices = decoder.split(None).unwrap();
    assert!(vertices > mesh.positions.len());
    let (faces, positions) = (decoder.split_faces().unwrap(), decoder.split_values::<3>(Source::Position).unwrap());
    let (uv, single) = (decoder.split_values::<2>(Source::Attribute(0)).unwrap(), mesh.positions_f32());
    assert_eq!((positions.len(), uv.len(), &single), (vertices, vertices, &decoder.positions_f32().unwrap()));
    assert_eq!(positions[..single.len()], single);
    let bsmdec::Values::F32(values) = &mesh.attributes[0].values else { panic!("{:?}", mesh.attributes[0]) };
    for (corner, (&drawn, &own)) in faces.iter().flatten().zip(mesh.faces.iter().flatten()).enumerate() {
        assert_eq!(positions[drawn as usize], single[own as usize]);
        let row = mesh.attributes[0].indices[corner] as usize;
        assert_eq!(uv[drawn as usize], values[2 * row..2 * row + 2]);
    }
    assert_eq!(decoder.split(Some(&[])).unwrap(), single.len());
    assert!(decoder
        .split_values::<2>(Source::Attribute(0))
        .unwrap_err()
        .message
        .contains("was not given to bsmdec_split"));
}

#[test]
fn frames_are_counted_before_they_come() {
    let stream = fs::read(folder().join("good-sequence-long.bsm")).unwrap();
    let (frames, _) = through(&stream, 1000, &Options::default()).unwrap();
    let mut decoder = Decoder::new(&Options::new().start(2)).unwrap();
    decoder.push(&stream).unwrap();
    let Event::Header { frames: claimed, .. } = decoder.next().unwrap() else { panic!() };
    assert_eq!(
        (claimed as usize, decoder.frame_count(), bsmdec::version()),
        (frames, claimed, env!("CARGO_PKG_VERSION"))
    );
}

#[test]
fn changes_make_up_the_mesh() {
    for name in ["good-keys", "good-smoothing", "good-grid-chunks", "good-refined-deep", "good-isolated"] {
        let stream = fs::read(folder().join(format!("{name}.bsm"))).unwrap();
        let (mut decoder, mut known, mut moved) = (Decoder::new(&Options::default()).unwrap(), Vec::new(), 0);
        decoder.push(&stream).unwrap();
        decoder.finish();
        loop {
            let event = decoder.next().unwrap();
            let changes = match event {
                Event::Connectivity { vertices, .. } => {
                    known = vec![[f64::NAN; 3]; vertices];
                    decoder.loose().unwrap()
                }
                Event::Block(_) | Event::Refinement => decoder.changes().unwrap(),
                Event::End { .. } => break,
                _ => continue,
            };
            moved += changes.vertices.len();
            for (&vertex, &position) in changes.vertices.iter().zip(changes.positions) {
                known[vertex as usize] = position;
            }
        }
        assert_eq!(known, decoder.positions().unwrap(), "{name}");
        assert!(moved >= known.len());
    }
}
