/** Whatever the order in which messages between page and threads arrive, the last picture is that of Python. */
import assert from "node:assert/strict";
import { createHash } from "node:crypto";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import test from "node:test";
import { BSMGeometry, BSMLoader } from "../src/three";
import { Pool } from "../src/pool";
import { TileSet } from "../src/viewer/tiles";
import { Vector3 } from "three";
import { readNpz } from "./npz";
import { drawing, Lines, staged } from "./replay";
import { VECTORS } from "./shared";

/** How many orders; `BSM_ORDERS=1000` draws the number that is promised. */
const ORDERS = Number(process.env.BSM_ORDERS ?? 60);
const STATIC = [
    "keys",
    "independent-predicted",
    "labels",
    "refined",
    "layer-chunks",
    "grid-chunks",
    "splits-seams",
    "attribute-uv-blocks",
    "attribute-textured",
    "light",
    "light-chunks",
    "light-splits",
    "pieces",
    "isolated",
];
const MOVING = [
    "sequence-learnt",
    "sequence-returning",
    "sequence-low-delay",
    "sequence-runs",
    "sequence-runs-many",
    "sequence-moving",
    "sequence-attributes",
    "sequence-overlap",
];

const streamOf = (name: string): Uint8Array => Uint8Array.from(readFileSync(join(VECTORS, `good-${name}.bsm`)));
const EXPECTED = new Map(
    [...STATIC, ...MOVING].map((name) => [name, readNpz(readFileSync(join(VECTORS, `good-${name}.npz`)))]),
);

/** Faces of a mesh by the places of their corners: a set, since parts and materials sort them. */
function facesOf(index: ArrayLike<number>, positions: ArrayLike<number>): string[] {
    const place = (corner: number): string =>
        [0, 1, 2].map((d) => Math.fround(positions[3 * index[corner] + d])).join();
    return Array.from({ length: index.length / 3 }, (_, k) =>
        [3 * k, 3 * k + 1, 3 * k + 2].map(place).join(" "),
    ).sort();
}

/** Compare a geometry with what Python decodes. */
function check(geometry: BSMGeometry, name: string): void {
    const { positions, faces, runs } = EXPECTED.get(name)!;
    assert.equal(geometry.drawRange.count, geometry.getIndex()!.count, `${name}: all is drawn`);
    if (!name.startsWith("sequence")) {
        return assert.deepEqual(
            facesOf(geometry.getIndex()!.array, geometry.getAttribute("position").array),
            facesOf(faces.values as Int32Array, positions.values as Float64Array),
            name,
        );
    }
    const count = runs ? runs.shape[0] : 1;
    const drawn = new Set(geometry.frames.map(({ shape }) => shape));
    assert.ok(drawn.size <= count);
    let at = 0;
    for (const { positions: found, shape } of geometry.frames) {
        const vertices = shape.vertices ?? Int32Array.from({ length: found.length / 3 }, (_, i) => i);
        const size = runs ? found.length / 3 : positions.shape[1];
        vertices.forEach((vertex, i) => {
            for (let d = 0; d < 3; d++)
                assert.equal(found[3 * i + d], Math.fround(positions.values[at + 3 * vertex + d] as number), name);
        });
        at += 3 * size;
    }
    assert.equal(at, positions.values.length, `${name}: all frames are there`);
    geometry.showFrame(0);
    const first = faces.values.subarray(0, runs ? 3 * Number(runs.values[2]) : faces.values.length) as Int32Array;
    assert.deepEqual(
        facesOf(geometry.getIndex()!.array, geometry.getAttribute("position").array),
        facesOf(first, positions.values.subarray(0, positions.values.length) as Float64Array),
        `${name}: faces`,
    );
}

/** One order: loads of some streams, good, damaged or stopped, in one pool. */
async function replay(seed: number): Promise<number> {
    const draw = drawing(seed);
    const lines = new Lines(draw);
    const { source, restore } = staged(lines);
    const pool = new Pool(draw(8) > 0 ? source : { ...source, worker: () => undefined }, 1 + draw(4));
    const names = [...STATIC, ...MOVING];
    let compared = 0;
    const wrong: string[] = [];
    try {
        for (let k = 3 + draw(4); k > 0; k--) {
            const name = names[draw(names.length)];
            const data = streamOf(name);
            const fate = draw(5); // 0: damaged, 1: stopped, others: good
            if (fate === 0) data[20 + draw(data.length - 20)] ^= 1 << draw(8);
            const tolerant = draw(3) === 0;
            const ended: string[] = [];
            const geometry = new BSMGeometry();
            const stream = pool.open(
                {
                    onPicture: (picture) => {
                        if (ended.length > 0) wrong.push(`${name}: ${picture.type} follows ${ended.join()}`);
                        geometry.accept(picture);
                    },
                    onEnd: () => void ended.push("end"),
                    onError: () => void ended.push("error"),
                },
                { tolerant, drawing: draw(3) > 0 ? "growing" : "whole", worthwhile: 0 },
            );
            const feed = lines.open();
            for (let at = 0; at < data.length;) {
                const size = 1 + draw(draw(2) ? data.length : 40);
                const piece = data.slice(at, at + size);
                feed(() => stream.receiveData(piece));
                at += size;
            }
            feed(() => stream.receiveEof());
            if (fate === 1) {
                const stop = lines.open();
                for (let wait = draw(60); wait > 0; wait--) stop(() => {});
                stop(() => (stream.close(), ended.push("stopped")));
            }
            if (draw(2)) await lines.run(); // the next one comes after it
            const finish = async (): Promise<void> => {
                if (fate > 1) {
                    assert.deepEqual(ended, ["end"], `${name}, order ${seed}`);
                    check(geometry, name);
                    compared++;
                } else
                    assert.ok(
                        ended.length === (fate === 1 && ended[0] === "end" ? 2 : 1),
                        `${name}, order ${seed}: ${ended.join()}, fate ${fate}`,
                    );
            };
            finishing.push(finish);
        }
        await lines.run();
        for (const finish of finishing.splice(0)) await finish();
        assert.deepEqual(wrong, [], `order ${seed}`);
        return compared;
    } finally {
        finishing.length = 0;
        restore();
    }
}
const finishing: (() => Promise<void>)[] = [];

test(`${ORDERS} orders of messages end in the picture of Python`, { timeout: 3_600_000 }, async () => {
    let compared = 0;
    for (let seed = 1; seed <= ORDERS; seed++) compared += await replay(seed);
    assert.ok(compared > ORDERS, `${compared} pictures`);
    console.log(`${ORDERS} orders, ${compared} pictures compared, 0 differ`);
});

/** Streams as tiles of one shard: a coarse one, and those that it is made of. */
function shardOf(streams: Record<string, Uint8Array>): Map<string, Uint8Array> {
    const sum = (bytes: Uint8Array): string => createHash("sha256").update(bytes).digest("hex");
    let offset = 0;
    const entries = Object.entries(streams).map(([name, bytes]) => {
        const entry = {
            name,
            offset,
            size: bytes.length,
            sha256: sum(bytes),
            faces: 10,
            error: name.length > 1 ? 0 : 100,
            low: [0, 0, 0],
            high: [1, 1, 1],
        };
        offset += bytes.length;
        return entry;
    });
    const index = Buffer.from(JSON.stringify(entries));
    const shard = Buffer.concat([...Object.values(streams), index, Buffer.alloc(16)]);
    const manifest = {
        cell: 1,
        origin: [0, 0, 0],
        levels: [{}, {}],
        shards: [{ file: "a", size: shard.length, index: index.length, sha256: sum(index) }],
    };
    return new Map([
        ["/0/manifest.json", Buffer.from(JSON.stringify(manifest))],
        ["/0/a", shard],
    ]);
}

test(`${Math.ceil(ORDERS / 10)} orders of messages show the finest tiles`, async () => {
    const LEAVES = ["keys", "grid-chunks", "refined", "light"];
    const files = shardOf({
        r: streamOf("labels"),
        ...Object.fromEntries(LEAVES.map((name, i) => [`r${i}`, streamOf(name)])),
    });
    for (let seed = 1; seed <= Math.ceil(ORDERS / 10); seed++) {
        const draw = drawing(seed);
        const lines = new Lines(draw);
        const { source, restore } = staged(lines, files);
        try {
            const pool = new Pool(source, 1 + draw(4));
            let tiles: TileSet | undefined;
            let restless = true;
            const opening = TileSet.open("/0", pool, () =>
                tiles?.look(new Vector3(0, 0, restless && draw(2) ? 1e9 : 1), 1000),
            ); // far away, or near
            await lines.run();
            tiles = await opening;
            for (const far of [1e9, 1, 1e9, 1].slice(draw(3))) {
                tiles.look(new Vector3(0, 0, far), 1000);
                if (draw(2)) await lines.run();
            }
            await lines.run();
            restless = false;
            tiles.look(new Vector3(), 1000);
            await lines.run();
            assert.equal(tiles.problem, "");
            assert.equal(tiles.shown.length, LEAVES.length, `order ${seed}`);
            tiles.shown.forEach((geometry, i) => check(geometry, LEAVES[i]));
            tiles.close();
        } finally {
            restore();
        }
    }
});

test("a load that is stopped fails once, and the next one of its loader comes", async () => {
    for (let seed = 1; seed <= Math.ceil(ORDERS / 10); seed++) {
        const draw = drawing(seed);
        const lines = new Lines(draw);
        const { source, restore } = staged(lines);
        try {
            const loader = new BSMLoader();
            (loader as unknown as { used: Pool }).used = new Pool(source, 1 + draw(3));
            const first = loader.parseAsync(streamOf("keys"), { onBlock: () => {} }).then(
                () => "whole",
                (error: Error) => error.name,
            );
            const stop = lines.open();
            for (let wait = draw(30); wait > 0; wait--) stop(() => {});
            stop(() => loader.abort());
            if (draw(2)) await lines.run();
            const second = loader.parseAsync(streamOf("refined"), { onBlock: () => {} }).then(
                (geometry) => check(geometry, "refined"),
                (error: Error) => assert.equal(error.name, "AbortError"),
            );
            await lines.run();
            assert.ok(["whole", "AbortError"].includes(await first));
            await second;
        } finally {
            restore();
        }
    }
});

test("a whole geometry refuses growth", () => {
    const geometry = new BSMGeometry();
    const empty = {
        index: new Uint32Array(0),
        positions: new Float32Array(0),
        normals: new Float32Array(0),
        attributes: [],
        pieces: [],
        center: [0, 0, 0] as [number, number, number],
        radius: 0,
        low: [0, 0, 0],
        high: [0, 0, 0],
    };
    geometry.accept({ type: "whole", shape: empty, run: 0 });
    const grown = {
        type: "grown" as const,
        vertices: new Int32Array(0),
        positions: new Float32Array(0),
        normals: new Float32Array(0),
        origin: new Int32Array(0),
        index: new Uint32Array(0),
        blocks: 1,
    };
    assert.throws(() => geometry.accept(grown), /whole and cannot grow/);
    assert.throws(
        () =>
            geometry.accept({
                type: "begun",
                vertices: 1,
                corners: 3,
                loose: { vertices: new Int32Array(0), positions: new Float64Array(0) },
            }),
        /whole and cannot grow/,
    );
});
