/** The page of `bsm view`: a stream as it arrives, cut at any byte, over a link of any speed. */
import { BsmError } from "../errors";
import type { Header } from "../header";
import { inlinedKernels } from "../inlined";
import type { Kernels } from "../kernels";
import { GeometryFiller } from "../three";
import { Stage } from "./stage";

interface Source {
    name: string;
    url?: string;
    data?: string;
}

const SLICE_BYTES = 512;
const SLICE_MS = 24;

function element<Kind extends HTMLElement>(id: string): Kind {
    return document.getElementById(id) as Kind;
}

const [select, cut, rate] = [element<HTMLSelectElement>("stream"), element<HTMLInputElement>("cut"), element<HTMLInputElement>("rate")];
const [colours, wireframe] = [element<HTMLInputElement>("colours"), element<HTMLInputElement>("wireframe")];
const [status, problem, counter] = [element("status"), element("problem"), element<HTMLOutputElement>("bytes")];

/** Middle and diagonal of the box that a mesh fills, about, in its own unit. */
function extentOf({ center, scale, grid, lattice }: Header): { center: number[]; diagonal: number } {
    if (grid.length === 0) return { center, diagonal: scale };
    const cell = lattice.length > 0 ? (scale * lattice[0]) / lattice[1] : scale;
    return { center: center.map((origin, d) => origin + (cell * grid[d]) / 2), diagonal: cell * Math.max(Math.hypot(...grid), 1) };
}

/** Feeds one stream to the decoder, as far as the link and the cut allow. */
class Player {
    private filler!: GeometryFiller;
    private fed = 0;
    private blocks = 0;
    private started = 0;
    private over = false;
    private dirty = false;

    constructor(
        private readonly kernels: Kernels,
        private readonly stage: Stage,
        private readonly stream: Uint8Array,
    ) {
        cut.max = String(stream.length);
        cut.value = cut.max;
        this.restart();
    }

    /** Start from the first byte. */
    restart(): void {
        this.filler = new GeometryFiller(this.kernels, {
            onConnectivity: (geometry) => {
                const { center, diagonal } = extentOf(this.filler.header!);
                this.stage.show(geometry, center, diagonal);
            },
            onBlock: () => (this.dirty = true),
        });
        this.fed = this.blocks = 0;
        this.started = performance.now();
        this.over = false;
        problem.textContent = "";
        document.body.dataset.state = "loading";
    }

    /** Go on for one picture. */
    step(): void {
        if (Number(cut.value) < this.fed) this.restart();
        const until = performance.now() + SLICE_MS;
        const allowed = this.allowed();
        try {
            while (!this.over && this.fed < allowed && performance.now() < until) {
                const end = Math.min(allowed, this.fed + SLICE_BYTES);
                this.blocks = this.filler.receiveData(this.stream.subarray(this.fed, end));
                this.fed = end;
            }
            if (!this.over && this.fed === this.stream.length) this.end();
        } catch (error) {
            this.fail(error);
        }
        if (this.dirty) this.colour();
        this.dirty = false;
        this.report();
    }

    /** Colours of the blocks that are there. */
    colour(): void {
        if (this.filler.header) this.stage.colour(this.filler.origin, this.filler.header.blocks || this.blocks, colours.checked);
    }

    private allowed(): number {
        const link = Number(rate.value) > 0 ? (Number(rate.value) * (performance.now() - this.started)) / 8e-3 : Infinity;
        return Math.floor(Math.min(Number(cut.value), link));
    }

    private end(): void {
        this.filler.finish();
        this.over = true;
        document.body.dataset.state = "complete";
    }

    private fail(error: unknown): void {
        if (!(error instanceof BsmError)) throw error;
        this.over = true;
        problem.textContent = `This stream cannot be decoded further. ${error.name}: ${error.message}`;
        document.body.dataset.state = "failed";
    }

    private report(): void {
        const share = this.stream.length ? Math.round((100 * this.fed) / this.stream.length) : 0;
        counter.textContent = `${this.fed.toLocaleString("en")} of ${this.stream.length.toLocaleString("en")} bytes (${share} %)`;
        const { header } = this.filler;
        const parts = header?.blocks ? `${this.blocks} of ${header.blocks} blocks` : `${this.blocks} chunks of a grid`;
        const text = header ? `${parts}, ${header.vertices.toLocaleString("en")} vertices` : "";
        if (status.textContent !== text) status.textContent = text;
        document.body.dataset.blocks = String(this.blocks);
    }
}

async function bytesOf(source: Source): Promise<Uint8Array> {
    const response = await fetch(source.url ?? `data:application/octet-stream;base64,${source.data}`);
    if (!response.ok) throw new Error(`${source.name}: ${response.status} ${response.statusText}`);
    return new Uint8Array(await response.arrayBuffer());
}

async function start(): Promise<void> {
    const sources = JSON.parse(element("streams").textContent!) as Source[];
    sources.forEach((source, i) => select.add(new Option(source.name, String(i))));
    const kernels = await inlinedKernels();
    const stage = new Stage(element<HTMLCanvasElement>("canvas"));
    let player: Player | undefined;
    const open = async (): Promise<void> => {
        player = undefined;
        try {
            const bytes = await bytesOf(sources[Number(select.value)]);
            player = new Player(kernels, stage, bytes);
        } catch (error) {
            problem.textContent = `The stream could not be fetched. ${error instanceof Error ? error.message : error}`;
            document.body.dataset.state = "failed";
        }
    };
    select.addEventListener("change", open);
    wireframe.addEventListener("change", () => (stage.wireframe = wireframe.checked));
    colours.addEventListener("change", () => player?.colour());
    element("again").addEventListener("click", () => player?.restart());
    const frame = (): void => {
        player?.step();
        requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
    await open();
}

void start();
