/** Show files that are opened or dropped on the page: its server encodes meshes. */
import type { Content } from "./facts";
import type { Form } from "./form";
import { bytesOf } from "./inlined";

/** Encode a file; `report` is called with each stage and the share done. */
export type Encode = (file: File, preset: string, report: (stage: string, share: number) => void, signal: AbortSignal) => Promise<Content>;

export class Upload {
    private working = new AbortController();

    constructor(
        private readonly form: Form,
        private readonly show: (content: Content, bytes: Uint8Array) => void,
        private readonly encode?: Encode,
    ) {
        const { root } = form;
        form.on("cancel", "click", () => this.cancel());
        form.on("file", "change", ({ files }) => files?.[0] && void this.take(files[0]));
        const drop = form.part("drop");
        root.addEventListener("dragover", (event) => {
            event.preventDefault();
            drop.hidden = false;
        });
        root.addEventListener("dragleave", (event) => (drop.hidden = !event.relatedTarget || !root.contains(event.relatedTarget as Node)));
        root.addEventListener("drop", (event) => {
            event.preventDefault();
            drop.hidden = true;
            const file = event.dataTransfer?.files[0];
            if (file) void this.take(file);
        });
    }

    cancel(): void {
        this.working.abort();
    }

    private async take(file: File): Promise<void> {
        const { form } = this;
        this.cancel();
        const { signal } = (this.working = new AbortController());
        form.say("problem", "");
        try {
            const isStream = /\.bsm$/i.test(file.name);
            const content = isStream ? { name: file.name, main: 0, facts: {}, layers: [{ title: "BSM", detail: "", size: file.size }] } : await this.encoded(file, signal);
            const bytes = isStream ? new Uint8Array(await file.arrayBuffer()) : await bytesOf(content.layers[content.main]);
            if (!signal.aborted) this.show(content, bytes);
        } catch (error) {
            if (!signal.aborted) form.say("problem", `${file.name} cannot be shown. ${error instanceof Error ? error.message : error}`);
        } finally {
            if (this.working.signal === signal) {
                form.part("work").hidden = true;
                form.part("invite").hidden = form.root.dataset.state !== "empty";
            }
        }
    }

    private encoded(file: File, signal: AbortSignal): Promise<Content> {
        const { form } = this;
        if (!this.encode) throw new Error(`This page opens only .bsm files. To view this mesh, run: bsm view ${file.name}`);
        [form.part("invite").hidden, form.part("work").hidden] = [true, false];
        const bar = form.root.querySelector("progress")!;
        const report = (stage: string, share: number): void => {
            form.say("stage", `${file.name}: ${stage}`);
            if (share > 0) bar.value = share;
            else bar.removeAttribute("value");
        };
        report("sending", 0);
        return this.encode(file, form.control<HTMLSelectElement>("preset").value, report, signal);
    }
}
