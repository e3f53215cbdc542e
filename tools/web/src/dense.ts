/** Dense matrices, for the bases that need them: Householder QR and symmetric eigenvectors. */
import { NumericError } from "./errors";

/** Neighbouring eigenvalues closer than this span one eigenspace (specification, M 8.5). */
const CLUSTER_GAP = 1e-6;
const MOST_SWEEPS = 60;

/** Q of the QR factorisation with positive diagonal of a matrix of `rows` rows, rows >= columns (M 8.1). */
export function householder(matrix: ArrayLike<number>, rows: number, columns: number): Float64Array {
    const work = Float64Array.from(matrix);
    if (!work.every(Number.isFinite)) throw new NumericError("the subspace iteration produced a value that is not finite");
    const reflections: Float64Array[] = [];
    const signs = new Float64Array(columns);
    for (let k = 0; k < columns; k++) {
        const vector = new Float64Array(rows);
        let norm = 0;
        for (let r = k; r < rows; r++) norm = Math.hypot(norm, (vector[r] = work[r * columns + k]));
        const alpha = vector[k] > 0 ? -norm : norm;
        signs[k] = alpha < 0 ? -1 : 1;
        vector[k] -= alpha;
        const length = Math.sqrt(vector.reduce((sum, value) => sum + value * value, 0));
        if (length > 0) for (let r = k; r < rows; r++) vector[r] /= length;
        reflect(work, vector, rows, columns, k);
        reflections.push(vector);
    }
    const q = new Float64Array(rows * columns);
    for (let k = 0; k < columns; k++) q[k * columns + k] = signs[k];
    for (let k = columns - 1; k >= 0; k--) reflect(q, reflections[k], rows, columns, k);
    return q;
}

/** A - 2 v v^T A, v being 0 above row `first`. */
function reflect(matrix: Float64Array, vector: Float64Array, rows: number, columns: number, first: number): void {
    const products = new Float64Array(columns);
    for (let r = first; r < rows; r++) for (let j = 0; j < columns; j++) products[j] += vector[r] * matrix[r * columns + j];
    for (let r = first; r < rows; r++) for (let j = 0; j < columns; j++) matrix[r * columns + j] -= 2 * vector[r] * products[j];
}

/** The `width` lowest eigenvectors of a symmetric matrix of n rows, made unique (M 8.5). */
export function canonicalEigenvectors(matrix: Float64Array, n: number, width: number): Float64Array {
    const { values, vectors } = symmetricEigenvectors(matrix, n);
    const basis = new Float64Array(n * width);
    for (let first = 0; first < width; ) {
        let last = first + 1;
        while (last < n && values[last] - values[last - 1] <= CLUSTER_GAP) last++;
        const canonical = canonicalCluster(vectors.subarray(first * n, last * n), n, last - first);
        for (let j = first; j < Math.min(last, width); j++) {
            for (let r = 0; r < n; r++) basis[r * width + j] = canonical[r * (last - first) + j - first];
        }
        first = last;
    }
    return basis;
}

/** Onorm(V V^T H), V being `count` vectors of n numbers one behind the other. */
function canonicalCluster(vectors: Float64Array, n: number, count: number): Float64Array {
    const result = new Float64Array(n * count);
    for (let j = 0; j < count; j++) {
        const probe = Float64Array.from({ length: n }, (_, row) => hashEntry(row, j));
        for (let k = 0; k < count; k++) {
            const vector = vectors.subarray(k * n, (k + 1) * n);
            const product = vector.reduce((sum, value, row) => sum + value * probe[row], 0);
            for (let r = 0; r < n; r++) result[r * count + j] += vector[r] * product;
        }
    }
    return householder(result, n, count);
}

/** Fixed pseudo-random numbers in [-1, 1) (M 8.6). */
export function hashEntry(row: number, column: number): number {
    const wrap = (value: bigint): bigint => BigInt.asUintN(64, value);
    let z = wrap(((BigInt(row) << 32n) + BigInt(column) + 1n) * 0x9e3779b97f4a7c15n);
    z = wrap((z ^ (z >> 30n)) * 0xbf58476d1ce4e5b9n);
    z = wrap((z ^ (z >> 27n)) * 0x94d049bb133111ebn);
    z ^= z >> 31n;
    return Number(z >> 11n) * 2 ** -52 - 1;
}

/**
 * Eigenvalues, ascending, and eigenvectors one behind the other: Householder tridiagonalisation, then implicit QL
 * (the procedures tred2 and tql2 of Bowdler, Martin, Reinsch and Wilkinson, 1968).
 */
function symmetricEigenvectors(matrix: Float64Array, n: number): { values: Float64Array; vectors: Float64Array } {
    const reflections: Float64Array[] = [];
    const a = matrix.slice();
    const diagonal = new Float64Array(n);
    const beside = new Float64Array(n);
    for (let k = 0; k + 2 < n; k++) {
        const v = new Float64Array(n);
        let norm = 0;
        for (let r = k + 1; r < n; r++) norm = Math.hypot(norm, (v[r] = a[r * n + k]));
        const alpha = v[k + 1] > 0 ? -norm : norm;
        v[k + 1] -= alpha;
        let length = 0;
        for (let r = k + 1; r < n; r++) length += v[r] * v[r];
        length = Math.sqrt(length);
        if (length > 0) for (let r = k + 1; r < n; r++) v[r] /= length;
        reflections.push(v);
        const p = new Float64Array(n);
        let shared = 0;
        for (let r = k; r < n; r++) {
            let sum = 0;
            for (let j = k + 1; j < n; j++) sum += a[r * n + j] * v[j];
            p[r] = sum;
            shared += sum * v[r];
        }
        for (let r = k; r < n; r++) p[r] -= shared * v[r];
        for (let r = k; r < n; r++) for (let j = k; j < n; j++) a[r * n + j] -= 2 * (v[r] * p[j] + p[r] * v[j]);
    }
    for (let k = 0; k < n; k++) {
        diagonal[k] = a[k * n + k];
        beside[k] = k + 1 < n ? a[(k + 1) * n + k] : 0;
    }
    // Columns of Q, one behind the other.
    const vectors = new Float64Array(n * n);
    for (let j = 0; j < n; j++) {
        const column = vectors.subarray(j * n, (j + 1) * n);
        column[j] = 1;
        for (let k = reflections.length - 1; k >= 0; k--) {
            const v = reflections[k];
            let product = 0;
            for (let r = k + 1; r < n; r++) product += v[r] * column[r];
            for (let r = k + 1; r < n; r++) column[r] -= 2 * product * v[r];
        }
    }
    implicitQl(diagonal, beside, vectors, n);
    const order = Array.from({ length: n }, (_, k) => k).sort((x, y) => diagonal[x] - diagonal[y]);
    const sorted = new Float64Array(n * n);
    order.forEach((from, to) => sorted.set(vectors.subarray(from * n, (from + 1) * n), to * n));
    return { values: Float64Array.from(order, (k) => diagonal[k]), vectors: sorted };
}

function implicitQl(d: Float64Array, e: Float64Array, vectors: Float64Array, n: number): void {
    for (let l = 0; l < n; l++) {
        for (let sweep = 0; ; sweep++) {
            let m = l;
            while (m + 1 < n && Math.abs(e[m]) > Number.EPSILON * (Math.abs(d[m]) + Math.abs(d[m + 1]))) m++;
            if (m === l) break;
            if (sweep === MOST_SWEEPS || !Number.isFinite(d[l])) throw new NumericError("eigenvectors did not converge");
            let g = (d[l + 1] - d[l]) / (2 * e[l]);
            let r = Math.hypot(g, 1);
            g = d[m] - d[l] + e[l] / (g + (g >= 0 ? r : -r));
            let [s, c, p] = [1, 1, 0];
            let i = m - 1;
            for (; i >= l; i--) {
                const f = s * e[i];
                const b = c * e[i];
                e[i + 1] = r = Math.hypot(f, g);
                if (r === 0) {
                    d[i + 1] -= p;
                    e[m] = 0;
                    break;
                }
                s = f / r;
                c = g / r;
                g = d[i + 1] - p;
                r = (d[i] - g) * s + 2 * c * b;
                p = s * r;
                d[i + 1] = g + p;
                g = c * r - b;
                rotate(vectors.subarray(i * n, (i + 1) * n), vectors.subarray((i + 1) * n, (i + 2) * n), s, c);
            }
            if (r === 0 && i >= l) continue;
            d[l] -= p;
            e[l] = g;
            e[m] = 0;
        }
    }
}

function rotate(left: Float64Array, right: Float64Array, s: number, c: number): void {
    for (let k = 0; k < left.length; k++) {
        const f = right[k];
        right[k] = s * left[k] + c * f;
        left[k] = c * left[k] - s * f;
    }
}
