/** What one asks of a mesh: a section, distances, what is below the pointer, edges that are wrong, views, and files of it. */
import {
    BufferAttribute,
    BufferGeometry,
    LineBasicMaterial,
    LineSegments,
    type Object3D,
    Points,
    PointsMaterial,
    Vector3,
} from "three";
import { GLTFExporter } from "three/addons/exporters/GLTFExporter.js";
import { OBJExporter } from "three/addons/exporters/OBJExporter.js";
import { PLYExporter } from "three/addons/exporters/PLYExporter.js";
import { STLExporter } from "three/addons/exporters/STLExporter.js";
import { BSMGeometry } from "../geometry";
import { disposeOf, materialsIn, nameOf } from "../materials";
import { sceneOf } from "../scene";
import type { Comparison } from "./comparison";
import { percent } from "./facts";
import type { Form } from "./form";
import type { Hit, Overlay, Stage } from "./stage";

const [REST, STILL] = [80, 6]; // milliseconds before the place below the pointer is looked up; pixels of a click
const SHORT = 4; // digits of places
const MARK = 0xd6006f;
/** From where standard views look: degrees around the upward axis, and down from it. */
const SIDES: Record<string, [theta: number, phi: number]> = {
    front: [0, 90],
    back: [180, 90],
    left: [-90, 90],
    right: [90, 90],
    top: [0, 0.01],
    bottom: [0, 179.99],
};

const short = (number: number): string => `${Number(number.toPrecision(SHORT))}`;

export class Inspector {
    private geometry?: BSMGeometry;
    private readonly points: Vector3[] = [];
    private readonly marks = [
        new Points(
            new BufferGeometry(),
            new PointsMaterial({ color: MARK, size: 9, sizeAttenuation: false, depthTest: false }),
        ),
        new LineSegments(new BufferGeometry(), new LineBasicMaterial({ color: MARK, depthTest: false })),
    ];
    private timer = 0;

    constructor(
        private readonly form: Form,
        private readonly stage: Stage,
        private readonly meshes: Comparison,
        private readonly save: (blob: Blob, suffix: string) => void,
    ) {
        const { canvas, camera } = stage;
        const picked = (name: string): string => form.control<HTMLSelectElement>(name).value;
        for (const name of ["axis", "depth", "flip"]) form.on(name, "input", () => this.cut());
        form.on("side", "change", ({ value }) => stage.look(SIDES[value]));
        form.on("parallel", "change", ({ checked }) => (camera.setParallel(checked), stage.fit()));
        form.on("overlay", "change", ({ value }) => stage.overlay(value as Overlay));
        form.on("measure", "change", () => this.mark([]));
        form.on("export", "click", () => void this.write(picked("format")));
        let [x, y] = [0, 0];
        canvas.addEventListener("pointerdown", (event) => ([x, y] = [event.offsetX, event.offsetY]));
        canvas.addEventListener("click", ({ offsetX, offsetY }) => {
            const isStill = Math.hypot(offsetX - x, offsetY - y) < STILL;
            const hit = isStill && form.control("measure").checked ? stage.pick(offsetX, offsetY, true) : undefined;
            if (hit) this.mark([...(this.points.length < 2 ? this.points : []), hit.point]);
        });
        const tip = form.part("tip");
        const leave = (): void => {
            clearTimeout(this.timer);
            tip.hidden = true;
        };
        canvas.addEventListener("pointerleave", leave);
        canvas.addEventListener("pointermove", ({ offsetX, offsetY, buttons, pointerType }) => {
            leave();
            if (buttons > 0 || pointerType === "touch") return;
            this.timer = window.setTimeout(() => {
                const hit = stage.pick(offsetX, offsetY, form.control("measure").checked);
                tip.hidden = !hit;
                if (!hit) return;
                tip.textContent = this.describe(hit);
                tip.style.left = `${Math.min(offsetX + 14, canvas.clientWidth - tip.offsetWidth - 4)}px`;
                tip.style.top = `${Math.min(offsetY + 16, canvas.clientHeight - tip.offsetHeight - 4)}px`;
            }, REST);
        });
    }

    /** Ask of another mesh. */
    open(geometry: BSMGeometry): void {
        this.geometry = geometry;
        this.mark([]);
        this.cut();
    }

    /** The camera and the section as a text for addresses. */
    get state(): string {
        const { camera } = this.stage;
        const numbers = [...camera.position, ...camera.controls.target].map((number) => number.toFixed(4));
        const { axis, depth, flip } = this.section;
        return `view=${numbers.join()}&section=${axis}${depth}${flip ? "-" : ""}`;
    }

    /** Look as such a text says. */
    set state(text: string) {
        const { camera } = this.stage;
        const entries = new URLSearchParams(text);
        const numbers = (entries.get("view") ?? "").split(",").map(Number);
        const [, axis, depth, flip] = /^([xyz]?)(\d+)(-?)$/.exec(entries.get("section") ?? "") ?? ["", "", "500", ""];
        if (numbers.length !== 6 || !numbers.every((number) => Math.abs(number) < 1e3)) return;
        camera.touched = true;
        camera.position.fromArray(numbers);
        camera.controls.target.fromArray(numbers, 3);
        this.form.control<HTMLSelectElement>("axis").value = axis;
        this.form.control("depth").value = depth;
        this.form.control("flip").checked = flip !== "";
        camera.controls.update();
        this.cut();
    }

    private get unit(): string {
        const unit = this.geometry?.metadata.get("unit");
        return typeof unit === "string" ? ` ${unit}` : "";
    }

    /** Part, place and error of what is below the pointer. */
    private describe({ index, geometry, face, point }: Hit): string {
        const lines = [[...point].map(short).join(", ") + this.unit];
        if (geometry instanceof BSMGeometry) {
            const { metadata, pieces } = geometry;
            const piece = pieces.find(({ start, count }) => 3 * face >= start && 3 * face < start + count);
            const kind = pieces.some(({ part }) => part > 0) ? "part" : "material";
            if (piece && pieces.length > 1) lines.unshift(nameOf(metadata, kind, piece[kind]));
            const corners = [0, 1, 2].map((k) => geometry.index!.getX(3 * face + k));
            const [off, share] = this.meshes.errorAt(index, geometry, corners, point) ?? [];
            if (off !== undefined) lines.push(`Error ${short(off)}${this.unit} (${percent(share!)} of the diagonal)`);
        }
        return lines.join("\n");
    }

    /** Show points, and the line between two of them and its length. */
    private mark(points: Vector3[]): void {
        this.points.splice(0, Infinity, ...points);
        const numbers = new Float32Array(points.flatMap((point) => [...point]));
        for (const [count, mark] of this.marks.entries()) {
            mark.geometry.dispose();
            mark.geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(numbers, 3));
            mark.visible = points.length > count;
            [mark.frustumCulled, mark.renderOrder] = [false, 2];
        }
        this.stage.mark(...this.marks);
        const [a, b] = points;
        const size = this.geometry?.boundingBox?.getSize(new Vector3());
        const box = size ? `Box: ${[...size].map(short).join(" × ")}${this.unit}. ` : "";
        const next = a ? "Click another point." : `${box}Click two points.`;
        this.form.say("measured", b ? `Distance: ${short(a.distanceTo(b))}${this.unit}` : next);
    }

    private get section(): { axis: string; depth: string; flip: boolean } {
        const { form } = this;
        return {
            axis: form.control<HTMLSelectElement>("axis").value,
            depth: form.control("depth").value,
            flip: form.control("flip").checked,
        };
    }

    private cut(): void {
        const { axis, depth, flip } = this.section;
        this.stage.cut("xyz".indexOf(axis || "-"), Number(depth) / 1000, flip);
    }

    /** Save the mesh of the stream, as it is shown, in a format of other programs. */
    private async write(format: string): Promise<void> {
        const { geometry } = this;
        if (!geometry?.getIndex()) return;
        const scene = await sceneOf(geometry);
        if (format !== "glb") scene.rotation.set(0, 0, 0); // the axes stay those of the mesh
        scene.updateMatrixWorld(true);
        try {
            this.save(new Blob([(await exported(scene, format)) as BlobPart]), format);
        } finally {
            disposeOf(materialsIn(scene)); // those on the stage are others
        }
    }
}

/** A scene as a file of other programs. */
async function exported(scene: Object3D, format: string): Promise<unknown> {
    if (format === "glb") return new GLTFExporter().parseAsync(scene, { binary: true });
    if (format === "obj") return new OBJExporter().parse(scene);
    if (format === "stl") return new STLExporter().parse(scene, { binary: true });
    return new PLYExporter().parse(scene, () => {}, { binary: true });
}
