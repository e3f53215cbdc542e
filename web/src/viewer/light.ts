/** The light of a neutral studio, and the soft shadow of a mesh on the ground: both computed, without a file. */
import {
    BufferAttribute,
    type BufferGeometry,
    DataTexture,
    DataUtils,
    EquirectangularReflectionMapping,
    HalfFloatType,
    LightProbe,
    LinearFilter,
    type Matrix4,
    SphericalHarmonics3,
    Vector3,
} from "three";

/** Soft boxes: where they are, how bright, and how narrow. */
const BOXES = [
    [-0.6, 0.65, 0.5, 3.5, 14],
    [0.9, 0.25, 0.35, 0.6, 5],
    [0.35, 0.5, -0.8, 2.5, 10],
];
const [SKY, HORIZON, FLOOR] = [0.62, 0.42, 0.2];
const [WIDE, TALL] = [128, 64];
const SMOOTH = { magFilter: LinearFilter, minFilter: LinearFilter, needsUpdate: true };

/** What surrounds the meshes: a texture for reflections, and what it sheds on all that is rough. */
export function studio(): { texture: DataTexture; probe: LightProbe } {
    const data = new Uint16Array(4 * WIDE * TALL);
    const [from, probe, basis] = [new Vector3(), new LightProbe(), new Array<number>(9)];
    for (let i = 0; i < WIDE * TALL; i++) {
        const [row, column] = [Math.floor(i / WIDE), i % WIDE];
        from.setFromSphericalCoords(1, Math.PI * (1 - (row + 0.5) / TALL), (2 * Math.PI * (column + 0.5)) / WIDE);
        const even = HORIZON + (from.y > 0 ? SKY - HORIZON : HORIZON - FLOOR) * from.y;
        const lightOf = ([x, y, z, bright, narrow]: number[]): number =>
            bright * Math.exp(narrow * (from.dot(new Vector3(x, y, z).normalize()) - 1));
        const light = BOXES.reduce((sum, box) => sum + lightOf(box), even);
        [1.02, 1, 0.97, 1].forEach((tint, c) => (data[4 * i + c] = DataUtils.toHalfFloat(c < 3 ? tint * light : 1)));
        SphericalHarmonics3.getBasisAt(from, basis);
        const angle = ((2 * Math.PI * Math.PI) / WIDE / TALL) * Math.sqrt(1 - from.y * from.y); // that a pixel fills
        probe.sh.coefficients.forEach((sum, k) => sum.addScalar(basis[k] * light * angle));
    }
    const texture = new DataTexture(data, WIDE, TALL);
    Object.assign(texture, SMOOTH, { type: HalfFloatType, mapping: EquirectangularReflectionMapping });
    return { texture, probe };
}

const SIDE = 96; // cells of the shadow
const DARKEST = 0.5;
const FADE = 7; // how fast a shadow fades with the height above the ground, over the diagonal
const MOST = 100_000; // faces that are looked at
export const GROUND = 2; // width of the ground, over the diagonal

/** How dark the ground is below meshes that a matrix puts on it, as an alpha map. */
export function shadowOf(
    geometries: BufferGeometry[],
    matrix: Matrix4,
    ground: number,
    texture = new DataTexture(new Uint8Array(4 * SIDE * SIDE), SIDE, SIDE),
): DataTexture {
    let dark = new Float32Array(SIDE * SIDE);
    const [a, b, c] = [new Vector3(), new Vector3(), new Vector3()];
    const step = 3 * Math.ceil(geometries.reduce((sum, { drawRange }) => sum + drawRange.count, 0) / 3 / MOST);
    for (const geometry of geometries) {
        const [place, index] = [geometry.getAttribute("position") as BufferAttribute, geometry.getIndex()!];
        for (let at = 0; at + 2 < Math.min(geometry.drawRange.count, index.count); at += step) {
            for (const [k, corner] of [a, b, c].entries())
                corner.fromBufferAttribute(place, index.getX(at + k)).applyMatrix4(matrix);
            const longest = Math.max(a.distanceTo(b), b.distanceTo(c), c.distanceTo(a));
            const parts = Math.min(Math.ceil((longest / GROUND) * SIDE), SIDE) || 1;
            for (let i = 0; i <= parts; i++) {
                for (let j = 0; i + j <= parts; j++) {
                    const [u, v] = [i / parts, j / parts];
                    const x = a.x + u * (b.x - a.x) + v * (c.x - a.x);
                    const y = a.y + u * (b.y - a.y) + v * (c.y - a.y);
                    const z = a.z + u * (b.z - a.z) + v * (c.z - a.z);
                    const cell = SIDE * Math.floor((0.5 - z / GROUND) * SIDE) + Math.floor((0.5 + x / GROUND) * SIDE);
                    const value = DARKEST * Math.exp(FADE * (ground - y));
                    if (dark[cell] < value) dark[cell] = value;
                }
            }
        }
    }
    for (const stride of [1, SIDE, 1, SIDE, 1, SIDE]) {
        const five = [-2, -1, 0, 1, 2].map((step) => step * stride);
        dark = dark.map((_, i) => five.reduce((sum, step) => sum + dark[i + step], 0) / 5 || 0);
    }
    const pixels = texture.image.data as Uint8Array;
    dark.forEach((value, i) => (pixels[4 * i + 1] = 255 * value));
    return Object.assign(texture, SMOOTH);
}
