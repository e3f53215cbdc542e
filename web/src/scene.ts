/** Scenes of three.js, which are loaded only where they are asked for. */
import { BufferGeometry, Group, Mesh, type Material } from "three";
import type { BSMGeometry } from "./geometry";
import type { Piece } from "./index";
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
    if (parts.size < 2) group.add(new Mesh(geometry, all));
    else
        for (const piece of pieces)
            group.add(meshOf(geometry, piece, materials[piece.material], nameOf(metadata, "part", piece.part)));
    group.rotation.set(...turnOf(metadata));
    return group;
}

/** A mesh of some of the faces; the arrays are those of all. */
function meshOf(geometry: BSMGeometry, { start, count }: Piece, material: Material, name: string): Mesh {
    const piece = new BufferGeometry();
    for (const key of Object.keys(geometry.attributes)) piece.setAttribute(key, geometry.getAttribute(key));
    piece.setIndex(geometry.getIndex());
    piece.setDrawRange(start, count);
    [piece.boundingBox, piece.boundingSphere] = [geometry.boundingBox, geometry.boundingSphere];
    const mesh = new Mesh(piece, material);
    mesh.name = name;
    return mesh;
}
