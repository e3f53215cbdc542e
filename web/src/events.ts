/** What a decoder tells, and what it is asked for. */
import type { Attribute } from "./attributes";
import type { Described } from "./errors";
import type { Header } from "./header";

/** What the author says of a mesh, by names. */
export type Metadata = Map<string, string | number | bigint | Uint8Array>;

/** What a block changed: vertices, their positions in the unit of the mesh, and which of them are final. */
export interface Changes {
    vertices: Int32Array;
    positions: Float64Array;
    final: Uint8Array;
}

/** Positions of vertices that no face uses. */
export type Loose = Pick<Changes, "vertices" | "positions">;

/** The header has arrived. */
export interface HeaderEvent {
    type: "header";
    header: Header;
}

/** Metadata have arrived; nothing that is decoded depends on them. */
export interface MetadataEvent {
    type: "metadata";
    entries: Metadata;
}

/**
 * The faces have arrived, three vertices each, in the order that the mesh had if the stream stores that; how many
 * vertices there are, and where those are that no face uses.
 */
export interface ConnectivityEvent {
    type: "connectivity";
    faces: Int32Array;
    vertices: number;
    loose: Loose;
}

/** A block, or a chunk of a grid, has been decoded: which vertices it moved or finished, and where they are now. */
export interface BlockEvent extends Changes {
    type: "block";
    index: number;
}

/** Levels of refinement have moved vertices. */
export interface RefinementEvent extends Changes {
    type: "refinement";
}

/** Something could not be decoded, and a tolerant decoder goes on: a block, frames, or bytes of neither. */
export interface LossEvent {
    type: "loss";
    block?: number;
    frames?: { first: number; count: number };
    error: Described;
}

/** The stream has come to its end: its checksum is right, or a tolerant decoder has lost something. */
export interface EndEvent {
    type: "end";
    /** Vertices without any position. */
    missing: Int32Array;
    /** Vertices that are less good than they were encoded. */
    degraded: Int32Array;
    /** Where all vertices of a static mesh are, shape (n, 3), if that was wished for as a whole. */
    positions?: Float64Array;
}

export type Event = HeaderEvent | MetadataEvent | ConnectivityEvent | BlockEvent | RefinementEvent | AttributeEvent | FrameEvent | LossEvent | EndEvent;

/** What a decoder is asked for beside the mesh. */
export interface Wishes {
    /** Report damage behind the faces as `LossEvent`, and go on with everything that does not depend on what is lost. */
    tolerant?: boolean;
    /** Tell positions of a static mesh at its end, all at once, and not what each block changes: that is less work. */
    whole?: boolean;
    /** Asked once the header is there: how many helpers share the work on chains of blocks. */
    helpers?: (header: Header) => number;
}

/** An attribute is there, whole. */
export interface AttributeEvent extends Attribute {
    type: "attribute";
}

/** A whole mesh, or the first frame of a sequence: positions, shape (n, 3), faces, shape (m, 3), and attributes. */
export interface Mesh {
    positions: Float64Array;
    faces: Int32Array;
    attributes: Attribute[];
}

/** A frame of a sequence: its number from 0, positions, shape (n, 3), and the attributes that move, as they are in it. */
export interface FrameEvent<Positions = Float64Array> {
    type: "frame";
    index: number;
    positions: Positions;
    attributes: Attribute[];
}
