// Decode streams that come one after the other, each with its length in four bytes before it: `node mutants.mjs LIMITS
// < STREAMS`.
// Prints a line of JSON: what became of how many, and of each that shows a fault of the decoder its number and what it
// is. Every third is
// decoded in pieces, every third tolerantly.
import { readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

const SECONDS = 3;
const PIECE = 61;
const built = join(dirname(fileURLToPath(import.meta.url)), "../built");
const { BsmError, Decoder, END_OF_STREAM, Kernels, NEED_DATA } = await import(
    pathToFileURL(join(built, "bsm.js")).href
);
const kernels = new Kernels(await WebAssembly.compile(readFileSync(join(built, "kernels.wasm"))));
const limits = JSON.parse(process.argv[2]);
const input = readFileSync(0);
const tally = { outcomes: {}, problems: [] };

function decode(data, way) {
    const decoder = new Decoder(kernels, limits, { tolerant: way === 2 });
    for (let at = 0; at < data.length; at += way === 1 ? PIECE : data.length) {
        decoder.receiveData(data.subarray(at, way === 1 ? at + PIECE : data.length));
        for (let event; (event = decoder.nextEvent()) !== NEED_DATA;) check(event, way);
    }
    decoder.receiveEof();
    for (let event; (event = decoder.nextEvent()) !== END_OF_STREAM;) check(event, way);
}

/** What a strict decoder shows is finite. */
function check(event, way) {
    const positions = event.positions ?? [];
    if (way !== 2 && event.type !== "attribute" && !positions.every(Number.isFinite))
        throw new Error(`${event.type} with positions that are not finite`);
}

for (let at = 0, number = 0; at < input.length; number++) {
    const end = at + 4 + input.readUInt32LE(at);
    const [begin, stream] = [process.cpuUsage(), new Uint8Array(input.subarray(at + 4, end))];
    let outcome = "decoded";
    try {
        decode(stream, number % 3);
    } catch (error) {
        outcome = error.name;
        if (!(error instanceof BsmError)) tally.problems.push([number, `in the browser's decoder: ${error.stack}`]);
    }
    const { user, system } = process.cpuUsage(begin);
    if ((user + system) / 1e6 > SECONDS)
        tally.problems.push([number, `in the browser's decoder: ${(user + system) / 1e6} s of processor time`]);
    tally.outcomes[outcome] = (tally.outcomes[outcome] ?? 0) + 1;
    at = end;
}
console.log(JSON.stringify(tally));
