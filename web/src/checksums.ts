/** Checksums of frames (specification, F 1.3, F 1.4). */

const CRC32 = Uint32Array.from({ length: 256 }, (_, byte) => {
    let value = byte;
    for (let k = 0; k < 8; k++) value = value & 1 ? (value >>> 1) ^ 0xedb88320 : value >>> 1;
    return value;
});

const CRC16 = Uint16Array.from({ length: 256 }, (_, byte) => {
    let value = byte << 8;
    for (let k = 0; k < 8; k++) value = value & 0x8000 ? (value << 1) ^ 0x1021 : value << 1;
    return value;
});

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
