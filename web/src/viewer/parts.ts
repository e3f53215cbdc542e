/** The list of the parts of a mesh, or of its materials: how large they are, and which are drawn. */
import type { BSMGeometry } from "../geometry";
import type { Piece } from "../index";
import { nameOf } from "../materials";
import { counted, element } from "./facts";
import type { Form } from "./form";

/** List the parts of a mesh; `hide` gets which pieces are not drawn, whenever others are. */
export function listParts(
    form: Form,
    { metadata, pieces }: BSMGeometry,
    hide: (hidden: (piece: Piece) => boolean) => void,
): void {
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
        const size = element("small", `${counted(count)} triangles`);
        const label = element("label", "", box, new Text(nameOf(metadata, kind, number)), size);
        return { number, box, line: element("li", "", label, only) };
    });
    const show = (): void => {
        const hidden = new Set(rows.flatMap(({ box, number }) => (box.checked ? [] : number)));
        hide((piece) => hidden.has(piece[kind]));
    };
    const part = form.part("parts");
    part.hidden = rows.length < 2;
    part.querySelector("ul")!.replaceChildren(...rows.map(({ line }) => line));
}
