/** The runs of a sequence, and the meshes that are kept for later ones (specification, S 9). */
import type { Allowance, Counted } from "./chain";
import { BsmError, CorruptError } from "./errors";
import type { Header } from "./header";
import type { Memory } from "./kernels";
import type { Item, Stages } from "./stages";
import { runCost } from "./work";

const KEPT_MESHES = 8;

/** How far a sequence has come, over all of its runs. */
export class Course {
    /** The frame that comes next in the stream. */
    next = 0;
    /** Whether a loss was reported. */
    lossy = false;
    private lost = 0;
    private damage?: BsmError;

    constructor(private readonly tolerant: boolean) {}

    /** Whether any frame has come. */
    get given(): boolean {
        return this.next > this.lost;
    }

    /** Take note that frames are lost; how many is known when the next ones come. */
    lose(error: BsmError): void {
        this.damage ??= error;
    }

    /** Report the frames that are missing before frame `index`, or before the end, that nobody may know (0); whether any are. */
    tellLost(index: number, ended: boolean, queue: Item[]): boolean {
        const first = this.next;
        const count = Math.max(index - first, 0);
        if (count === 0 && !(ended && index === 0 && this.damage)) return false;
        const error = this.damage ?? new CorruptError(`${count} frames from number ${first} on are missing`);
        if (!this.tolerant) throw error;
        this.damage = undefined;
        this.lossy = true;
        this.lost += count;
        this.next += count;
        queue.push({ type: "loss", frames: { first, count }, error: error.described });
        return true;
    }
}

/** A mesh that a run has had, and what is kept for later runs of it. */
interface Kept {
    stages: Stages;
    /** What they have in memory. */
    bytes: Uint8Array;
    counted: Counted;
}

/** Begins one run behind the other; each has a mesh of its own, or one that an earlier run has had. */
export class Runs {
    readonly course: Course;
    /** Why the present run is lost. */
    private lost?: BsmError;
    private readonly kept = new Map<number, Kept>();
    /** The run that brought the present mesh. */
    private mesh = 0;
    private present?: Stages;
    private frames = 0;
    private before: Counted;
    private readonly mark: number;

    /** All runs have the same `memory`, one after the other. */
    constructor(
        private readonly memory: Memory,
        private readonly allowance: Allowance,
        private readonly tolerant: boolean,
    ) {
        this.course = new Course(tolerant);
        this.before = allowance.counted;
        this.mark = memory.mark();
    }

    /** The stages of a run that begins; `open` makes those of a mesh of its own. */
    begin(header: Header, open: (course: Course) => Stages): Stages {
        this.leave();
        this.allowance.spend(runCost(header.again === undefined));
        this.lost = undefined;
        this.frames = header.frames;
        this.mesh = header.again ?? header.run;
        if (header.again !== undefined) return (this.present = this.resumed(header));
        if (this.kept.size === KEPT_MESHES) this.giveUpOldest();
        return (this.present = open(this.course));
    }

    /** Whether it is borne that the present run is lost. */
    bears(error: unknown): boolean {
        if (!this.tolerant || !(error instanceof BsmError)) return false;
        this.lost = error;
        this.course.lose(error);
        return true;
    }

    /** Whether the present run is lost. */
    get isLost(): boolean {
        return this.lost !== undefined;
    }

    /** Nothing follows a run that is lost. */
    end(queue: Item[]): void {
        if (this.lost && !this.course.given) throw this.lost;
        this.course.tellLost(this.frames, true, queue);
        queue.push({ type: "end", missing: new Int32Array(0), degraded: new Int32Array(0) });
    }

    private resumed(header: Header): Stages {
        const kept = this.kept.get(this.mesh);
        if (!kept) throw new CorruptError(`run ${header.run} has the mesh of run ${this.mesh}, which is not there any more`);
        this.kept.delete(this.mesh);
        this.kept.set(this.mesh, kept);
        this.memory.putBack(kept.bytes, this.mark);
        kept.stages.resume(header);
        return kept.stages;
    }

    /** Keep of the present run what later ones may need, and give back all else. */
    private leave(): void {
        const { allowance, present, memory, before } = this;
        const now = allowance.counted;
        const counted = { memory: now.memory - before.memory, vertices: now.vertices - before.vertices };
        const kept = this.kept.get(this.mesh);
        if (present?.suspend()) {
            const bytes = memory.takeOut(this.mark);
            const all = { memory: counted.memory + (kept?.counted.memory ?? 0), vertices: counted.vertices + (kept?.counted.vertices ?? 0) };
            this.kept.set(this.mesh, { stages: present, bytes, counted: all });
        } else {
            allowance.giveBack(counted);
            memory.release(this.mark);
        }
        this.before = allowance.counted;
        this.present = undefined;
    }

    private giveUpOldest(): void {
        const [oldest, { bytes, counted }] = this.kept.entries().next().value as [number, Kept];
        this.kept.delete(oldest);
        this.memory.forget(bytes);
        this.allowance.giveBack(counted);
        this.before = this.allowance.counted;
    }
}
