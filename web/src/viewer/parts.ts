/** The list of the parts of a mesh, or of its materials: how large they are, and which are drawn. */
import type { BufferAttribute } from "three";
import type { BSMGeometry } from "../geometry";
import { nameOf } from "../materials";
import { counted, element } from "./facts";
import type { Form } from "./form";

/** All corners, of what draws some. */
const wholes = new WeakMap<BufferAttribute, BufferAttribute["array"]>();

/** Draw the faces of some pieces, and points in place of the others. */
function reduce(geometry: BSMGeometry, isHidden: (piece: BSMGeometry["pieces"][number]) => boolean): void {
    const index = geometry.getIndex()!;
    const whole = wholes.get(index) ?? index.array;
    wholes.set(index, whole);
    index.array = whole.slice();
    for (const piece of geometry.pieces.filter(isHidden)) index.array.fill(0, piece.start, piece.start + piece.count);
    index.needsUpdate = true;
}

/** List the parts of a mesh, which are those of the meshes beside it, too; `changed` is called when others are drawn. */
export function listParts(form: Form, { metadata, pieces }: BSMGeometry, meshes: BSMGeometry[], changed: () => void): void {
    const kind = pieces.some(({ part }) => part > 0) ? "part" : "material";
    const faces = new Map<number, number>();
    for (const piece of pieces) faces.set(piece[kind], (faces.get(piece[kind]) ?? 0) + piece.count / 3);
    const rows = [...faces].map(([number, count]) => {
        const box = Object.assign(document.createElement("input"), { type: "checkbox", checked: true });
        const only = Object.assign(document.createElement("button"), { type: "button", textContent: "Only" });
        box.onchange = () => show();
        only.onclick = () => {
            const isAlone = rows.every((row) => row.box.checked === (row.box === box));
            for (const row of rows) row.box.checked = isAlone || row.box === box;
            show();
        };
        const label = element("label", "", box, new Text(nameOf(metadata, kind, number)), element("small", `${counted(count)} triangles`));
        return { number, box, line: element("li", "", label, only) };
    });
    const show = (): void => {
        const hidden = new Set(rows.flatMap(({ box, number }) => (box.checked ? [] : number)));
        for (const mesh of meshes) reduce(mesh, (piece) => hidden.has(piece[kind]));
        changed();
    };
    form.part("parts").hidden = rows.length < 2;
    form.part("parts").querySelector("ul")!.replaceChildren(...rows.map(({ line }) => line));
}
