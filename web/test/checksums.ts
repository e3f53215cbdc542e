/**
 * Checksums of frames (specification, F 1.3, F 1.4). No number has more than 16 bits: before a loop is compiled, a page
 * makes an object of each larger one.
 */

/** What eight steps make of each byte, its lower and its upper half. */
function table(shift: number, step: (value: number) => number): [low: Uint16Array, high: Uint16Array] {
    const halves: [Uint16Array, Uint16Array] = [new Uint16Array(256), new Uint16Array(256)];
    for (let byte = 0; byte < 256; byte++) {
        let value = byte << shift;
        for (let k = 0; k < 8; k++) value = step(value);
        halves[0][byte] = value;
        halves[1][byte] = value >>> 16;
    }
    return halves;
}
const [LOW, HIGH] = table(0, (value) => (value >>> 1) ^ (value & 1 && 0xedb88320));
const [CRC16] = table(8, (value) => (value << 1) ^ (value & 0x8000 && 0x11021));

/** CRC-32 of zlib; `before` is that of the bytes in front. */
export function crc32(data: Uint8Array, before = 0): number {
    let [low, high] = [~before & 0xffff, ~before >>> 16];
    for (let i = 0; i < data.length; i++) {
        const place = (low ^ data[i]) & 255;
        low = LOW[place] ^ (low >> 8) ^ ((high & 255) << 8);
        high = HIGH[place] ^ (high >> 8);
    }
    return ~((high << 16) | low) >>> 0;
}

/** CRC-16 called XMODEM. */
export function crc16(data: Uint8Array): number {
    let value = 0;
    for (let i = 0; i < data.length; i++) value = ((value & 255) << 8) ^ CRC16[(value >> 8) ^ data[i]];
    return value;
}
