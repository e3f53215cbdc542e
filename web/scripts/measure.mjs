// `node --expose-gc measure.mjs FOLDER`: decode 0.bsm, 1.bsm, ... there, or the stream that is named, and print for
// each, as a line of JSON, what it took:
// bytes of memory beyond what there was before, and seconds of CPU; `escaped` counts errors that are not errors of a stream.
import { readdirSync, readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

const built = join(dirname(fileURLToPath(import.meta.url)), "../built");
const { BsmError, Decoder, END_OF_STREAM, Kernels } = await import(pathToFileURL(join(built, "bsm.js")).href);
const kernels = new Kernels(await WebAssembly.compile(readFileSync(join(built, "kernels.wasm"))));
const seconds = () => process.cpuUsage().user / 1e6 + process.cpuUsage().system / 1e6;
const [given] = process.argv.slice(2);
const paths = given.endsWith(".bsm") ? [given] : readdirSync(given).map((_, number) => join(given, `${number}.bsm`));

for (const path of paths) {
    const data = new Uint8Array(readFileSync(path));
    globalThis.gc();
    const [before, begin] = [process.memoryUsage.rss(), seconds()];
    const result = { vertices: 0, shown: 0, work: 0, memory: 0, seconds: 0, escaped: "", outcome: "decoded" };
    let size = 0;
    const decoder = new Decoder(kernels);
    try {
        decoder.receiveData(data);
        decoder.receiveEof();
        for (let event; (event = decoder.nextEvent()) !== END_OF_STREAM;) {
            if (event.type === "header") size = event.header.vertices;
            if (event.type === "frame") result.shown += size;
            result.memory = Math.max(result.memory, process.memoryUsage.rss() - before);
        }
    } catch (error) {
        result.outcome = `${error}`.slice(0, 100);
        if (!(error instanceof BsmError)) result.escaped = `${error}`;
    }
    [result.vertices, result.work] = [decoder.vertices, decoder.work];
    result.memory = Math.max(result.memory, process.memoryUsage.rss() - before);
    result.seconds = seconds() - begin;
    console.log(JSON.stringify(result));
}
