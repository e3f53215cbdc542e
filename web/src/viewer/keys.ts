/** Keyboard shortcuts. */
import type { Comparison } from "./comparison";
import type { Form } from "./form";
import type { Stage } from "./stage";

const SHADINGS = ["smooth", "flat", "wire"];

export function listenToKeys(form: Form, stage: Stage, meshes: Comparison): void {
    const mode = (name: string): void => form.pick("mode", stage.mode === name ? "one" : name);
    const acts: Record<string, () => void> = {
        w: () => mode("wipe"),
        s: () => mode("split"),
        f: () => stage.look(),
        home: () => stage.look(),
        m: () => form.control("full").click(),
        d: () => form.pick("shading", SHADINGS[(SHADINGS.indexOf(form.picked("shading")) + 1) % SHADINGS.length]),
        e: () => meshes.toggleErrors(),
        t: () => form.control("spin").click(),
        l: () => {
            const light = form.control("light");
            light.value = String(((Number(light.value) + 210) % 360) - 180);
            stage.light = Number(light.value);
        },
        h: () => form.root.toggleAttribute("data-bare"),
        ",": () => form.control("earlier").click(),
        ".": () => form.control("later").click(),
        " ": () => form.control("play").click(),
        "?": () => form.unfold("keys"),
        escape: () => form.unfold(""),
    };
    ["1", "2", "3"].forEach((digit, i) => (acts[digit] = () => form.pick("layer", String(i))));
    form.root.addEventListener("keydown", ({ key, target, ctrlKey, metaKey, altKey }) => {
        if (ctrlKey || metaKey || altKey || (target as HTMLElement).matches("select, [type=number]")) return;
        if (key === " " && !(target as HTMLElement).matches("canvas, body")) return; // it presses what has the focus
        acts[key.toLowerCase()]?.();
    });
}
