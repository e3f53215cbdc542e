/** BufferViews of glTF whose bytes a stream holds, as `spec/EXT_bsm_compression.md` defines them. */
import type { Picture, Shape } from "./drawing";
import type { Pool, StreamDecoding } from "./pool";

export const EXTENSION = "EXT_bsm_compression";

/** Constructors by the component types of glTF. */
const KINDS = {
    5120: Int8Array,
    5121: Uint8Array,
    5122: Int16Array,
    5123: Uint16Array,
    5125: Uint32Array,
    5126: Float32Array,
} as const;
const SETS: Record<string, string> = { TEXCOORD_0: "uv", TEXCOORD_1: "uv1", COLOR_0: "color" };

/** What the extension says of a bufferView. */
export interface Coded {
    stream: number;
    attribute: string;
    componentType?: keyof typeof KINDS;
}

/** Bytes of a scene that streams may become in all: a small file can name one stream many times. */
export const MOST_BYTES = 2 ** 30;

/** What streams of a scene became: each piece of bytes is decoded once, and each of its arrays made once. */
export class CodedViews<T> {
    private readonly shapes = new Map<string, T>();
    private readonly arrays = new Map<string, ArrayBuffer>();
    private readonly decodings = new Set<StreamDecoding>();
    private taken = 0;

    /** What a stream became: of bufferViews of the same bytes, `decode` is called for the first only. */
    shape(from: BufferView, decode: () => T): T {
        const shape = this.shapes.get(placeOf(from)) ?? decode();
        this.shapes.set(placeOf(from), shape);
        return shape;
    }

    /** The bytes of a bufferView, of what `decode` makes of the stream of `from`. */
    async made(
        this: CodedViews<Promise<Shape>>,
        from: BufferView,
        coded: Coded,
        byteLength: number,
        index: number,
        decode: () => Promise<Shape>,
    ): Promise<ArrayBuffer> {
        return this.bytes(await this.shape(from, decode), from, coded, byteLength, index);
    }

    /** The bytes of a bufferView, of what is drawn of the stream of `from`. */
    bytes(shape: Shape, from: BufferView, coded: Coded, byteLength: number, index: number): ArrayBuffer {
        const key = [placeOf(from), byteLength, coded.componentType, coded.attribute].join(" ");
        const bytes = this.arrays.get(key) ?? bytesOf(shape, coded, byteLength, index);
        if (!this.arrays.has(key)) this.charge(byteLength);
        this.arrays.set(key, bytes);
        return bytes;
    }

    /** What is drawn of a stream or its first frame; `take` gets all pictures, and `end` hears that no more come. */
    decode(
        pool: Pool,
        data: Uint8Array,
        what: string,
        take: (picture: Picture, decoding: StreamDecoding) => void,
        end: (error?: unknown) => void,
    ): Promise<Shape> {
        return new Promise((resolve, fail) => {
            let shape: Shape | undefined;
            const onError = (error: unknown): void => (fail(error), end(error));
            const onPicture = (picture: Picture): void => {
                if (picture.type === "whole") this.charge(sizeOf((shape = picture.shape)));
                if (picture.type === "frame") this.charge(sizeOf({ ...picture, index: new Uint8Array() }));
                take(picture, decoding);
                if (picture.type === "frame" && shape) resolve(shape);
            };
            const onEnd = (): void => {
                end();
                if (shape) resolve(shape);
                else fail(new Error(`${what} is a stream without a mesh`));
            };
            const decoding = pool.open({ onPicture, onEnd, onError }, { drawing: "whole" });
            this.decodings.add(decoding);
            this.charge(0);
            decoding.receiveData(data);
            decoding.receiveEof();
        });
    }

    /** Count bytes that were made. */
    charge(bytes: number): void {
        this.taken += bytes;
        if (this.taken <= MOST_BYTES) return;
        for (const decoding of this.decodings) decoding.close();
        throw new Error(`[${EXTENSION}] the streams become more than ${MOST_BYTES} bytes`);
    }
}

/** Where the bytes of a bufferView are. */
interface BufferView {
    buffer: number;
    byteOffset?: number;
    byteLength: number;
}

/** A name for the bytes of a bufferView, which others may have as well. */
export function placeOf({ buffer, byteOffset = 0, byteLength }: BufferView): string {
    return `${buffer} ${byteOffset} ${byteLength}`;
}

/** Bytes of the arrays in which a stream or a frame is drawn. */
export function sizeOf(
    drawn: Record<"index" | "positions" | "normals", ArrayBufferView> & Pick<Shape, "attributes">,
): number {
    const arrays = [drawn.index, drawn.positions, drawn.normals, ...drawn.attributes.map(({ values }) => values)];
    return arrays.reduce((sum, { byteLength }) => sum + byteLength, 0);
}

/** The bytes of a bufferView, of what is drawn of its stream; it says how many these are. */
function bytesOf(shape: Shape, { attribute, componentType }: Coded, byteLength: number, index: number): ArrayBuffer {
    const { index: corners, positions, normals, attributes } = shape;
    const own = { indices: corners, POSITION: positions, NORMAL: normals } as Record<string, ArrayLike<number>>;
    const others = attributes.find(({ name }) => name === (SETS[attribute] ?? attribute));
    const values = Object.hasOwn(own, attribute) ? own[attribute] : others?.values;
    const Kind = KINDS[componentType ?? (attribute === "indices" ? 5125 : 5126)];
    if (!values || !Kind) throw new Error(`bufferView ${index}: its stream has no ${attribute} of such a type`);
    const bytes = Kind.from(values).buffer as ArrayBuffer;
    if (bytes.byteLength !== byteLength)
        throw new Error(`bufferView ${index}: ${attribute} has ${bytes.byteLength} bytes, not ${byteLength}`);
    return bytes;
}
