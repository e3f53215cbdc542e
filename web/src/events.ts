/** What a decoder reports, and what it is asked for. */
import type { Attribute } from "./attributes";
import type { Described } from "./errors";
import type { Header } from "./header";

/** What the author says of a mesh, by names. */
export type Metadata = Map<string, string | number | bigint | Uint8Array>;

/** Vertices that a block changed, in the unit of the mesh, and which are final; `first`: they are those from it on. */
export interface Changes {
    first?: number;
    vertices: Int32Array;
    positions: Float64Array;
    final: Uint8Array;
}

/** Positions of vertices that no face uses. */
export type Loose = Pick<Changes, "vertices" | "positions">;

/** What a decoder reports. */
export type Event =
    | { type: "header"; header: Header }
    /** Nothing that is decoded depends on them. */
    | { type: "metadata"; entries: Metadata }
    /** Three vertices of each face, in the order of the mesh if the stream stores that; `vertices` counts them. */
    | { type: "connectivity"; faces: Int32Array; vertices: number; loose: Loose }
    /** A block, or a chunk of a grid, has been decoded. */
    | ({ type: "block"; index: number } & Changes)
    /** Levels of refinement have moved vertices. */
    | ({ type: "refinement" } & Changes)
    | ({ type: "attribute" } & Attribute)
    | FrameEvent
    /** Something could not be decoded, and a tolerant decoder goes on: a block, frames, or bytes of neither. */
    | { type: "loss"; block?: number; frames?: { first: number; count: number }; error: Described }
    /** The checksum is right, or something is lost: vertices without a position, and those that are less exact. */
    | { type: "end"; missing: Int32Array; degraded: Int32Array; positions?: Float64Array };

export type EventOf<Type> = Extract<Event, { type: Type }>;

/** What a decoder is asked for beside the mesh. */
export interface Wishes {
    /** Report damage after the connectivity as a loss, and go on with what does not depend on it. */
    tolerant?: boolean;
    /** Tell positions of a static mesh at its end, all at once, and not what each block changes: that is less work. */
    whole?: boolean;
    /** Asked once the header is there: how many helpers share the work on chains of blocks. */
    helpers?: (header: Header) => number;
}

/** A whole mesh, or the first frame of a sequence: positions, shape (n, 3), faces, shape (m, 3), and attributes. */
export interface Mesh {
    positions: Float64Array;
    faces: Int32Array;
    attributes: Attribute[];
}

/** A frame of a sequence: its number from 0, positions, shape (n, 3), and the attributes that move. */
export interface FrameEvent<Positions = Float64Array> {
    type: "frame";
    index: number;
    positions: Positions;
    attributes: Attribute[];
}
