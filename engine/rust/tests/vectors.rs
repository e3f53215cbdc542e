//! Every vector of the specification is decoded, to the positions whose checksum it has, or refused.
use bsmdec::{Decoder, Entry, Error, Event, Options, Status};
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
            Event::Connectivity => room = vec![[0.0; 3]; decoder.faces()?.iter().flatten().max().map_or(0, |&v| v as usize + 1)],
            Event::Frame(_) => {
                let positions = decoder.positions()?;
                room.resize(positions.len(), [0.0; 3]);
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
        if path.extension().map_or(true, |end| end != "bsm") {
            continue;
        }
        let (name, stream) = (path.file_stem().unwrap().to_str().unwrap(), fs::read(&path).unwrap());
        let found = through(&stream, if name.contains("1") { 1 } else { 1000 }, &Options::default());
        assert_eq!(found.is_ok(), name.starts_with("good-"), "{name}: {found:?}");
        assert_eq!(bsmdec::decode(&stream).is_err() && name.starts_with("good-"), false, "{name}");
        assert_eq!(name.contains("-sequence") && name.starts_with("good-"), found.map_or(false, |(frames, _)| frames > 0));
        count += 1;
    }
    assert!(count > 400);
}

#[test]
fn wrong_orders_of_calls_are_errors() {
    let mut decoder = Decoder::new(&Options::default()).unwrap();
    assert_eq!(decoder.positions().unwrap_err().status, Status::Misused);
    assert_eq!(decoder.attribute(0).unwrap(), None);
    assert_eq!(decoder.attribute(usize::MAX).unwrap(), None);
    decoder.finish();
    assert_eq!(decoder.push(b"late").unwrap_err().status, Status::Misused);
    assert_eq!(decoder.next().unwrap_err().status, Status::Truncated);
}

#[test]
fn limits_metadata_and_damage_are_told() {
    let stream = fs::read(folder().join("good-metadata.bsm")).unwrap();
    let mut limits = bsmdec::default_limits();
    assert!(limits.heap > 1e9 && limits.frames == 1048576.0, "{limits:?}");
    limits.vertices = 3.0;
    let narrow = Options { limits: Some(limits), ..Options::default() };
    assert_eq!(through(&stream, 100, &narrow).unwrap_err().status, Status::Limit);
    let mut decoder = Decoder::new(&Options::default()).unwrap();
    decoder.push(&stream).unwrap();
    decoder.finish();
    while decoder.next().unwrap() != Event::End {}
    assert!(decoder.metadata().iter().any(|(_, value)| matches!(value, Entry::Text(_))));
    let mut damaged = fs::read(folder().join("good-keys.bsm")).unwrap();
    let place = damaged.len() - 40;
    damaged[place] ^= 1;
    assert_eq!(through(&damaged, 64, &Options::default()).unwrap_err().status, Status::Corrupt);
    let (_, losses) = through(&damaged, 64, &Options { tolerant: true, ..Options::default() }).unwrap();
    assert!(losses > 0);
}
