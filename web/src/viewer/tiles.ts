/** Tiles of a mesh of any size: coarse ones first, then those worth most where one looks; memory has a bound. */
import { Vector3 } from "three";
import { messageOf } from "../fetched";
import { BSMGeometry } from "../geometry";
import { disposeOf, materialsOf } from "../materials";
import type { Pool } from "../pool";

const BUDGET = 3_000_000; // faces that are shown at a time
const AT_ONCE = 4;
const FOOT = 16; // bytes behind the index of a shard
const MOST_WHOLE = 2 ** 26; // bytes of a shard that is fetched whole
const FINE = 1; // pixels that a tile may be off

type Triple = [number, number, number];

interface Manifest {
    cell: number;
    origin: Triple;
    attributes?: object;
    levels: object[];
    shards: { file: string; size: number; index: number; sha256: string }[];
}

interface TileEntry {
    name: string;
    offset: number;
    size: number;
    sha256: string;
    faces: number;
    error: number;
    low: Triple;
    high: Triple;
}

/** Give back a tile that is not shown again: one that others hide for a while keeps its image. */
function discard(geometry: BSMGeometry): void {
    geometry.dispose();
    disposeOf([geometry.userData.material ?? []].flat());
}

class Tile {
    readonly below: Tile[] = [];
    readonly center: Vector3;
    readonly radius: number;
    geometry?: BSMGeometry;
    asked = false;
    tried = false;

    constructor(
        readonly entry: TileEntry,
        readonly url: string,
        { cell, origin }: Manifest,
    ) {
        const placeOf = (place: Triple): Vector3 => new Vector3(...place.map((at, d) => at * cell + origin[d]));
        const [low, high] = [placeOf(entry.low), placeOf(entry.high)];
        this.center = low.clone().add(high).divideScalar(2);
        this.radius = low.distanceTo(high) / 2;
    }

    /** Drop the geometry of this one and of those below, but of some. */
    keep(some: Set<Tile>): void {
        if (!some.has(this) && this.geometry) {
            discard(this.geometry);
            [this.geometry, this.asked] = [undefined, false];
        }
        this.below.forEach((tile) => tile.keep(some));
    }

    /** The error in pixels, seen from a place, if a unit at distance 1 has `pixels` pixels. */
    off(eye: Vector3, pixels: number): number {
        const far = Math.max(eye.distanceTo(this.center) - this.radius, 1e-3 * this.radius);
        return this.below.length === 0 ? 0 : (pixels * this.entry.error) / far;
    }
}

/** Files of servers that send no ranges, whole. */
const wholes = new Map<string, Promise<Uint8Array<ArrayBuffer>>>();

/** Bytes of a file from its server, which may send all of it once and for all. */
async function piece(url: string, offset: number, size: number): Promise<Uint8Array<ArrayBuffer>> {
    const before = await wholes.get(url);
    if (before) return before.slice(offset, offset + size);
    const response = await fetch(url, { headers: { Range: `bytes=${offset}-${offset + size - 1}` } });
    if (!response.ok) throw new Error(`${url}: ${response.status} ${response.statusText}`);
    if (response.status === 206) return new Uint8Array(await response.arrayBuffer());
    if (Number(response.headers.get("content-length")) > MOST_WHOLE)
        throw new Error(`${url}: this server sends no ranges of files; choose one that does, or smaller shards`);
    const whole = response.arrayBuffer().then((buffer) => new Uint8Array(buffer));
    wholes.set(url, whole);
    whole.catch(() => wholes.delete(url));
    return (await whole).slice(offset, offset + size);
}

/** Bytes of a file, if they are those that were written. */
async function ranged(url: string, offset: number, size: number, sum: string): Promise<Uint8Array> {
    const bytes = await piece(url, offset, size);
    if (!globalThis.crypto.subtle) return bytes; // on plain http, where streams are checked by their own sums alone
    const digest = new Uint8Array(await crypto.subtle.digest("SHA-256", bytes));
    const found = Array.from(digest, (byte) => byte.toString(16).padStart(2, "0")).join("");
    if (found !== sum) throw new Error(`${url}: bytes from ${offset} on differ from those that bsm tile wrote`);
    return bytes;
}

export function wholeOf(pool: Pool, bytes: Uint8Array, crease?: number): Promise<BSMGeometry> {
    return new Promise((resolve, fail) => {
        const geometry = new BSMGeometry();
        const stream = pool.open(
            { onPicture: (picture) => geometry.accept(picture), onEnd: () => resolve(geometry), onError: fail },
            { drawing: "whole", crease },
        );
        stream.receiveData(bytes);
        stream.receiveEof();
    });
}

export class TileSet {
    /** What is wrong with tiles that could not be shown; coarser ones stand in their place. */
    problem = "";
    got = 0;
    there = 0;
    private cut = new Set<Tile>();
    private wanted: Tile[] = [];
    private loading = 0;
    private closed = false;

    private constructor(
        readonly manifest: Manifest,
        private readonly tops: Tile[],
        private readonly pool: Pool,
        private readonly changed: () => void,
    ) {}

    static async open(url: string, pool: Pool, changed: () => void): Promise<TileSet> {
        const response = await fetch(`${url}/manifest.json`);
        if (!response.ok) throw new Error(`${url}: ${response.status} ${response.statusText}`);
        const manifest = (await response.json()) as Manifest;
        void pool.preload(Object.keys(manifest.attributes ?? {}).length > 0 ? "whole" : "grid").catch(() => {}); // who decodes says it
        const nodes = new Map<string, Tile>();
        for (const { file, size, index, sha256 } of manifest.shards) {
            const at = `${url}/${file}`;
            const text = new TextDecoder().decode(await ranged(at, size - FOOT - index, index, sha256));
            for (const entry of JSON.parse(text) as TileEntry[]) nodes.set(entry.name, new Tile(entry, at, manifest));
        }
        for (const [name, tile] of nodes) nodes.get(name.slice(0, -1))?.below.push(tile);
        const tops = [...nodes].flatMap(([name, tile]) => (nodes.has(name.slice(0, -1)) ? [] : [tile]));
        return new TileSet(manifest, tops, pool, changed);
    }

    get extent(): { center: number[]; diagonal: number } {
        const sum = this.tops.reduce((sum, { center }) => sum.add(center), new Vector3());
        const center = sum.divideScalar(this.tops.length);
        const reaches = this.tops.map((top) => top.center.distanceTo(center) + top.radius);
        return { center: center.toArray(), diagonal: 2 * Math.max(...reaches) };
    }

    /** Choose what is to be seen from a place: what is most pixels off gives way to what it is made of. */
    look(eye: Vector3, pixels: number): void {
        const chosen = new Set(this.tops);
        let faces = this.tops.reduce((sum, { entry }) => sum + entry.faces, 0);
        const order: Tile[] = [...this.tops];
        for (;;) {
            let [worst, most]: [Tile | undefined, number] = [undefined, FINE];
            for (const tile of chosen) {
                const off = tile.off(eye, pixels);
                if (off > most) [worst, most] = [tile, off];
            }
            if (!worst) break;
            const more = worst.below.reduce((sum, { entry }) => sum + entry.faces, -worst.entry.faces);
            if (faces + more > BUDGET) break;
            faces += more;
            chosen.delete(worst);
            worst.below.forEach((tile) => chosen.add(tile));
            order.push(...worst.below);
        }
        this.cut = chosen;
        this.wanted = order;
        const kept = new Set(order);
        this.tops.forEach((tile) => tile.keep(kept));
        this.load();
    }

    /** What is there of it: all parts of a tile in its place, or the tile. */
    get shown(): BSMGeometry[] {
        const parts = (tile: Tile): BSMGeometry[] | undefined => {
            const own = tile.geometry && [tile.geometry];
            if (this.cut.has(tile)) return own;
            const below = tile.below.map(parts);
            return below.every((part) => part !== undefined) ? below.flat() : own;
        };
        return this.tops.flatMap((tile) => parts(tile) ?? []);
    }

    get complete(): boolean {
        return this.loading === 0 && this.wanted.length >= this.tops.length && this.wanted.every(({ asked }) => asked);
    }

    close(): void {
        this.closed = true;
        this.tops.forEach((tile) => tile.keep(new Set()));
    }

    private load(): void {
        for (const tile of this.wanted) {
            // The first picture has the link for itself.
            if (this.closed || this.loading >= (this.tops.every(({ tried }) => tried) ? AT_ONCE : this.tops.length))
                return;
            if (tile.asked) continue;
            tile.asked = true;
            this.loading++;
            void this.fetched(tile).finally(() => {
                this.loading--;
                tile.tried = true;
                this.load();
                if (!this.closed) this.changed();
            });
        }
    }

    private async fetched(tile: Tile): Promise<void> {
        const { offset, size, sha256, name } = tile.entry;
        try {
            const bytes = await ranged(tile.url, offset, size, sha256);
            const geometry = await wholeOf(this.pool, bytes);
            if (geometry.metadata.has("image.0.data")) {
                [geometry.userData.material] = await materialsOf(geometry);
            }
            this.got += bytes.length;
            this.there++;
            if (this.closed || !this.wanted.includes(tile)) {
                discard(geometry);
                tile.asked = false;
                return;
            }
            tile.geometry = geometry;
        } catch (error) {
            this.problem = `Tile ${name} cannot be shown; showing a coarser tile: ${messageOf(error)}`;
        }
    }
}
