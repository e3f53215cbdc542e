/** Scenes of three.js, which are loaded only where they are asked for. */
import { Group, Mesh, type Material } from "three";
import type { BSMGeometry } from "./geometry";
import { materialsOf, nameOf, turnOf } from "./materials";

/** A whole geometry as a group of meshes: materials, textures, names of parts, and y up, as its metadata say. */
export async function sceneOf(geometry: BSMGeometry): Promise<Group> {
    const { metadata, pieces } = geometry;
    const materials = await materialsOf(geometry);
    const group = new Group();
    group.name = String(metadata.get("name") ?? "");
    group.userData = Object.fromEntries([...metadata].filter(([, value]) => !(value instanceof Uint8Array)));
    const parts = new Set(pieces.map(({ part }) => part));
    const all: Material | Material[] = materials.length > 1 ? materials : materials[0];
    if (parts.size < 2 && !pieces.some((piece) => geometry.isHidden(piece))) group.add(new Mesh(geometry, all));
    else
        for (const [number, piece] of pieces.entries()) {
            if (geometry.isHidden(piece)) continue;
            const { part, material } = piece;
            const mesh = new Mesh(geometry.partOf(number), materials[material]);
            mesh.name = nameOf(metadata, "part", part);
            group.add(mesh);
        }
    group.rotation.set(...turnOf(metadata));
    return group;
}
