/**
 * Streams that are fetched: one request for all loads of an address at the same time, and none if THREE.Cache has it.
 *
 * FileLoader gives a file when all of it is there, and streams are decoded while they come. So requests are made here:
 * each keeps the pieces that came, for who joins later, and puts the whole into the cache that FileLoader uses, under its
 * key. It stops when its last waiting load is cancelled.
 */
import { Cache } from "three";
import { resolved } from "./fetched";

/** What is heard of a request: pieces, how much of how much was received (0: not known), and the end. */
export interface Passenger {
    /** A piece, which several loads may share: it must not be changed. */
    onPiece: (piece: Uint8Array) => void;
    onProgress?: (loaded: number, total: number) => void;
    signal?: AbortSignal;
}

interface Flight {
    pieces: Uint8Array<ArrayBuffer>[];
    passengers: Set<(piece: Uint8Array, loaded: number, total: number) => void>;
    stop: AbortController;
    over: Promise<void>;
}

const flights = new Map<string, Flight>();

/** Fetch an address. The promise resolves with the last byte, even if a signal has stopped this load. */
export async function fetchPieces(address: string, request: RequestInit, passenger: Passenger): Promise<void> {
    const cached: unknown = Cache.enabled ? Cache.get(`file:${address}`) : undefined;
    if (cached instanceof ArrayBuffer) {
        passenger.onPiece(new Uint8Array(cached));
        return passenger.onProgress?.(cached.byteLength, cached.byteLength);
    }
    const key = JSON.stringify([resolved(address), request.credentials, request.headers]);
    const flight = flights.get(key) ?? begun(key, address, request);
    for (const piece of flight.pieces) passenger.onPiece(piece);
    let fall: (error: unknown) => void;
    const fallen = new Promise<never>((_, fail) => (fall = fail));
    const hear = (piece: Uint8Array, loaded: number, total: number): void => {
        try {
            passenger.onPiece(piece);
            passenger.onProgress?.(loaded, total);
        } catch (error) {
            fall(error); // other loads go on
            leave();
        }
    };
    flight.passengers.add(hear);
    const leave = (): void => {
        if (flight.passengers.delete(hear) && flight.passengers.size === 0) flight.stop.abort();
    };
    passenger.signal?.addEventListener("abort", leave, { once: true });
    await Promise.race([flight.over, fallen]).finally(leave);
}

function begun(key: string, address: string, request: RequestInit): Flight {
    const flight: Flight = { pieces: [], passengers: new Set(), stop: new AbortController(), over: Promise.resolve() };
    flight.over = received(flight, address, request).finally(() => flights.delete(key));
    flight.stop.signal.addEventListener("abort", () => flights.delete(key));
    flight.over.catch(() => {}); // waiting loads get the error
    flights.set(key, flight);
    return flight;
}

/** How many bytes will come, as they are counted here: those of a compressed answer are not known before its end. */
function totalOf({ headers }: Response): number {
    const length = headers.has("content-encoding") ? null : headers.get("content-length");
    return Number(headers.get("x-file-size") ?? length ?? 0);
}

async function received(flight: Flight, address: string, request: RequestInit): Promise<void> {
    const response = await fetch(resolved(address), { ...request, signal: flight.stop.signal });
    if (!response.ok || !response.body) throw new Error(`${response.status} ${response.statusText}`);
    const total = totalOf(response);
    const reader = response.body.getReader();
    let loaded = 0;
    for (let piece; !(piece = await reader.read()).done;) {
        loaded += piece.value.length;
        flight.pieces.push(piece.value);
        for (const hear of [...flight.passengers]) hear(piece.value, loaded, loaded <= total ? total : 0);
    }
    if (Cache.enabled) Cache.add(`file:${address}`, await new Blob(flight.pieces).arrayBuffer());
}
