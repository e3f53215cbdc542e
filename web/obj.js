#!/usr/bin/env node
/**
 * Reads a BSM stream and writes OBJ or GLB: npx bsm-decoder mesh.bsm > mesh.obj; or a sequence, as a folder of OBJ, as
 * PC2, MDD, NPZ or GLB: npx bsm-decoder horse.bsm horse.glb
 */
import { closeSync, existsSync, mkdirSync, openSync, readFileSync, statSync, writeSync } from "node:fs";
import { basename, join } from "node:path";
import zlib from "node:zlib";
import { Decoder, END_OF_STREAM, loadKernels, NEED_DATA } from "bsm-decoder";
import { glbOf } from "./glb.js";

const USAGE = `usage: bsm-decoder MESH.bsm > MESH.obj
       bsm-decoder IN.bsm OUT.obj|.glb|.pc2|.mdd|.npz
       bsm-decoder SEQUENCE.bsm FOLDER         (an OBJ file for each frame)
IN - reads the standard input, OUT - writes an OBJ to the standard output.`;
const given = process.argv.slice(2);
if (given.includes("--help") || given.includes("-h")) {
    console.log(USAGE);
    process.exit(0);
}
const [path, ...targets] = given;
const target = targets[0] === "-" ? "" : (targets[0] ?? "");
if (!path || targets.length > 1 || given.some((word) => /^-./.test(word))) {
    console.error(USAGE);
    process.exit(2);
}

/** The events of a stream that is there. */
function* eventsOf(kernels, data) {
    const decoder = new Decoder(kernels, {}, { whole: true });
    decoder.receiveData(data);
    for (let event; (event = decoder.nextEvent()) !== NEED_DATA;) yield event;
    decoder.receiveEof();
    for (let event; (event = decoder.nextEvent()) !== END_OF_STREAM;) yield event;
}

/** Write text or bytes, whole, to a file or to the standard output. */
function write(place, content) {
    const bytes = Buffer.from(content);
    const file = place ? openSync(place, "w") : 1;
    for (let at = 0; at < bytes.length;) at += writeSync(file, bytes, at);
    if (place) closeSync(file);
}

function objOf(positions, faces) {
    const lines = [];
    for (let i = 0; i < positions.length; i += 3)
        lines.push(`v ${positions[i]} ${positions[i + 1]} ${positions[i + 2]}\n`);
    for (let i = 0; i < faces.length; i += 3) lines.push(`f ${faces[i] + 1} ${faces[i + 1] + 1} ${faces[i + 2] + 1}\n`);
    return lines.join("");
}

/** A point cache: a head of numbers, then all frames in single precision. */
function cacheOf(kind, frames, rate) {
    const points = frames[0].length / 3;
    const times = kind === "mdd" ? 4 * frames.length : 0;
    const head = kind === "mdd" ? 8 : 32;
    const bytes = Buffer.alloc(head + times + 12 * points * frames.length);
    if (kind === "mdd") {
        bytes.writeInt32BE(frames.length, 0);
        bytes.writeInt32BE(points, 4);
        frames.forEach((_, i) => bytes.writeFloatBE(i / rate, head + 4 * i));
    } else {
        bytes.write("POINTCACHE2\x00", "latin1");
        [1, points].forEach((number, i) => bytes.writeInt32LE(number, 12 + 4 * i));
        [0, 1].forEach((number, i) => bytes.writeFloatLE(number, 20 + 4 * i));
        bytes.writeInt32LE(frames.length, 28);
    }
    let at = head + times;
    const put = (kind === "mdd" ? bytes.writeFloatBE : bytes.writeFloatLE).bind(bytes);
    for (const frame of frames) for (const number of frame) at = put(number, at);
    return bytes;
}

function npyOf(type, shape, parts) {
    const words = `{'descr': '${type}', 'fortran_order': False, 'shape': (${shape.join(", ")}${shape.length === 1 ? "," : ""}), }`;
    const head = Buffer.from(`${words.padEnd(64 * Math.ceil((words.length + 11) / 64) - 11)}\n`, "latin1");
    const begin = Buffer.from([0x93, ...Buffer.from("NUMPY"), 1, 0, head.length & 255, head.length >> 8]);
    return Buffer.concat([
        begin,
        head,
        ...parts.map(({ buffer, byteOffset, byteLength }) => Buffer.from(buffer, byteOffset, byteLength)),
    ]);
}

/** Arrays in an archive without compression. */
function npzOf(arrays) {
    const [files, list] = [[], []];
    let at = 0;
    for (const [name, data] of Object.entries(arrays)) {
        const title = Buffer.from(`${name}.npy`);
        const common = Buffer.alloc(26);
        [20, 0, 0, 0, 33].forEach((number, i) => common.writeUInt16LE(number, 2 * i)); // of version 2.0, stored, of 1980
        [zlib.crc32(data), data.length, data.length].forEach((number, i) => common.writeUInt32LE(number, 10 + 4 * i));
        common.writeUInt16LE(title.length, 22);
        files.push(Buffer.from("PK\x03\x04", "latin1"), common, title, data);
        const place = Buffer.alloc(14);
        place.writeUInt32LE(at, 10);
        list.push(Buffer.from("PK\x01\x02\x14\x00", "latin1"), common, place, title);
        at += 30 + title.length + data.length;
    }
    const end = Buffer.alloc(22);
    end.write("PK\x05\x06", "latin1");
    [8, 10].forEach((place) => end.writeUInt16LE(Object.keys(arrays).length, place));
    end.writeUInt32LE(
        list.reduce((sum, { length }) => sum + length, 0),
        12,
    );
    end.writeUInt32LE(at, 16);
    return Buffer.concat([...files, ...list, end]);
}

try {
    const kind = /\.(obj|glb|pc2|mdd|npz)$/i.exec(target)?.[1].toLowerCase();
    const isFolder = statSync(target || ".", { throwIfNoEntry: false })?.isDirectory() ?? false;
    if (!kind && !isFolder && /\.[a-z]\w{1,4}$/i.test(target))
        throw new Error(
            `${target}: its suffix is not written here; use .obj, .glb, .pc2, .mdd or .npz, or name a folder`,
        );
    const [frames, colors, attributes, metadata] = [[], [], [], new Map()];
    let [faces, positions, header, runs] = [undefined, undefined, undefined, 0];
    for (const event of eventsOf(await loadKernels(), new Uint8Array(readFileSync(path === "-" ? 0 : path)))) {
        if (event.type === "header") ({ header } = event);
        if (event.type === "metadata") for (const [name, value] of event.entries) metadata.set(name, value);
        if (event.type === "connectivity") [faces, runs] = [event.faces, runs + 1];
        if (event.type === "attribute" && runs < 2) attributes.push(event);
        if (event.type === "end") positions = event.positions;
        if (event.type !== "frame") continue;
        if (!target || kind === "obj")
            throw new Error(
                `this is a sequence${header.frames ? ` of ${header.frames} frames` : ""}: ` +
                    "name a folder, or a .glb, .npz, .pc2 or .mdd file, after it",
            );
        if (kind) {
            frames.push(event.positions);
            colors.push(event.attributes.find(({ semantic }) => semantic === "color"));
        } else {
            mkdirSync(target, { recursive: true });
            write(join(target, `${String(event.index).padStart(4, "0")}.obj`), objOf(event.positions, faces));
        }
    }
    const isMoving = header.gopFrames > 0;
    const rate = metadata.get("frame_rate") > 0 ? metadata.get("frame_rate") : 24;
    if (isMoving && kind && runs > 1)
        throw new Error("the faces of this sequence change: name a folder for its frames");
    if (!isMoving && target && kind !== "obj" && kind !== "glb")
        throw new Error(`this is one mesh: name a .obj or .glb file, not ${target}`);
    let left = new Set(attributes.map(({ name }) => name));
    if (kind === "glb") {
        const made = glbOf(
            { faces, attributes, metadata, frames: isMoving ? frames : [positions], colors, rate, isMoving },
            basename(target).slice(0, -4),
        );
        write(target, made.glb);
        left = new Set(made.left);
    } else if (!isMoving) write(target, objOf(positions, faces));
    else if (kind) {
        const count = frames[0].length / 3;
        const words = Buffer.from(JSON.stringify({ frame_rate: rate }));
        if (kind === "npz")
            write(
                target,
                npzOf({
                    positions: npyOf("<f8", [frames.length, count, 3], frames),
                    faces: npyOf("<i4", [faces.length / 3, 3], [faces]),
                    metadata: npyOf("|u1", [words.length], [words]),
                }),
            );
        else {
            const mesh = target.replace(/\.\w+$/, ".obj");
            if (!existsSync(mesh)) write(mesh, objOf(frames[0], faces)); // a cache has no faces
            write(target, cacheOf(kind, frames, rate));
        }
    }
    if (left.size > 0) console.error(`bsm-decoder: ${path}: left out: ${[...left].join(", ")}; bsm decode writes them`);
} catch (error) {
    if (error.code === "EPIPE") process.exit(0); // nobody reads on
    const known = { ENOENT: `no such file or folder: ${error.path}`, EISDIR: "this is a folder; name a .bsm file" };
    console.error(`bsm-decoder: ${path}: ${known[error.code] ?? error.message}`);
    process.exit(1);
}
