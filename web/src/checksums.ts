/** Checksums of frames (specification, F 1.3, F 1.4). */

/** What a step makes of each number in eight times. */
const table = (begin: (byte: number) => number, step: (value: number) => number): Uint32Array =>
    Uint32Array.from({ length: 256 }, (_, byte) => [1, 2, 3, 4, 5, 6, 7, 8].reduce(step, begin(byte)));
const CRC32 = table(
    (byte) => byte,
    (value) => (value >>> 1) ^ (value & 1 && 0xedb88320),
);
const CRC16 = table(
    (byte) => byte << 8,
    (value) => ((value << 1) ^ (value & 0x8000 && 0x1021)) & 0xffff,
);

/** CRC-32 of zlib; `before` is that of the bytes in front. */
export function crc32(data: Uint8Array, before = 0): number {
    let value = ~before;
    for (let i = 0; i < data.length; i++) value = CRC32[(value ^ data[i]) & 255] ^ (value >>> 8);
    return ~value >>> 0;
}

/** CRC-16 called XMODEM. */
export function crc16(data: Uint8Array): number {
    let value = 0;
    for (let i = 0; i < data.length; i++) value = ((value << 8) & 0xffff) ^ CRC16[(value >> 8) ^ data[i]];
    return value;
}
