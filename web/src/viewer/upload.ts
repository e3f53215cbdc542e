/** Show a file that is opened or dropped on the page, or compare two of them: its server or a thread encodes meshes. */
import { messageOf } from "../fetched";
import type { Content } from "./facts";
import type { Form } from "./form";
import { bytesOf, served } from "./inlined";

/** Encode a file, or compare two; `report` is called with each stage and the share done. */
export type Encode = (
    files: File[],
    preset: string,
    report: (stage: string, share: number) => void,
    signal: AbortSignal,
) => Promise<Content>;

export const isStream = ({ name }: File): boolean => /\.bsm$/i.test(name);
export const bytesIn = async (file: File): Promise<Uint8Array> => new Uint8Array(await file.arrayBuffer());

/** A file, or one beside its original, as the streams that they are. */
export function contentOf(files: File[], streams: Uint8Array[], facts: Content["facts"]): Content {
    const main = files.length - 1;
    const layers = files.map(({ name, size }, i) => {
        const title = i < main ? "Original" : /[^.]*$/.exec(name)![0].toUpperCase();
        return { title, detail: main > 0 ? name : "", size, bytes: streams[i] };
    });
    return { name: files[main].name, main, facts, layers };
}

const paths = new WeakMap<File, string>();
/** The place of a file in the folder that was dropped. */
export const pathOf = (file: File): string => paths.get(file) ?? file.name;
const namesOf = (files: File[]): string =>
    files.length > 3 ? `${files.length} files` : files.map(({ name }) => name).join(" and ");

/** The files of folders and of all in these. */
async function filesIn(entries: FileSystemEntry[]): Promise<File[]> {
    const found = entries.map(async (entry): Promise<File[]> => {
        if (entry.isFile) {
            const file = await new Promise<File>((keep, fail) => (entry as FileSystemFileEntry).file(keep, fail));
            paths.set(file, entry.fullPath);
            return [file];
        }
        const reader = (entry as FileSystemDirectoryEntry).createReader();
        const next = (): Promise<FileSystemEntry[]> => new Promise((keep, fail) => reader.readEntries(keep, fail));
        const inside: FileSystemEntry[] = [];
        for (let some; (some = await next()).length > 0;) inside.push(...some);
        return filesIn(inside);
    });
    return (await Promise.all(found)).flat();
}

/** Take files that are opened or dropped; `show` gets what they hold. Returns what cancels the work on them. */
export function takeFiles(
    form: Form,
    show: (content: Content, bytes: Uint8Array) => void,
    encode?: Encode,
): () => void {
    const { root } = form;
    let working = new AbortController();
    const cancel = (): void => working.abort();

    const encoded = (files: File[], signal: AbortSignal): Promise<Content> => {
        const [first, second] = files.map(({ name }) => name);
        const command = second ? `bsm view ${second} --original ${first}` : `bsm view ${first}`;
        if (!encode) throw new Error(`This page opens only .bsm files. To view this mesh, run: ${command}`);
        [form.part("invite").hidden, form.part("work").hidden] = [true, false];
        const bar = root.querySelector("progress")!;
        const report = (stage: string, share: number): void => {
            form.say("stage", `${namesOf(files)}: ${stage}`);
            if (share > 0) bar.value = share;
            else bar.removeAttribute("value");
        };
        report(served ? "sending" : "reading", 0);
        return encode(files, form.control<HTMLSelectElement>("preset").value, report, signal);
    };

    const take = async (files: File[]): Promise<void> => {
        if (files.length === 0) return;
        cancel();
        const { signal } = (working = new AbortController());
        form.say("problem", "");
        try {
            if (files.length > 2 && (!encode || files.every(isStream)))
                throw new Error("Open one file, or two to compare them.");
            if (files.length === 2 && isStream(files[0]) && !isStream(files[1])) files.reverse(); // a mesh is the original of a stream
            const isHere = files.every(isStream) && (files.length === 1 || !encode);
            const content = isHere
                ? contentOf(files, await Promise.all(files.map(bytesIn)), {})
                : await encoded(files, signal);
            const bytes = await bytesOf(content.layers[content.main]);
            if (!signal.aborted) show(content, bytes);
        } catch (error) {
            if (!signal.aborted) form.say("problem", `${namesOf(files)} cannot be shown. ${messageOf(error)}`);
        } finally {
            if (working.signal === signal) {
                form.part("work").hidden = true;
                form.part("invite").hidden = root.dataset.state !== "empty";
            }
        }
    };

    form.on("cancel", "click", cancel);
    form.on("file", "change", (input) => {
        const files = [...(input.files ?? [])];
        input.value = ""; // the same file, changed meanwhile, may be opened again
        void take(files);
    });
    const drop = form.part("drop");
    root.addEventListener("dragover", (event) => {
        event.preventDefault();
        drop.hidden = false;
    });
    root.addEventListener("dragleave", ({ relatedTarget }) => {
        drop.hidden = !root.contains(relatedTarget as Node | null);
    });
    root.addEventListener("drop", (event) => {
        event.preventDefault();
        drop.hidden = true;
        const entries = [...(event.dataTransfer?.items ?? [])].flatMap((item) => item.webkitGetAsEntry() ?? []);
        const given = [...(event.dataTransfer?.files ?? [])];
        void (entries.some(({ isDirectory }) => isDirectory) ? filesIn(entries).then(take) : take(given));
    });
    return cancel;
}
