/** What an ATTRIBUTE frame declares (specification, D 1). */
import { DECLARATION_FIELDS } from "./constants";
import { CorruptError } from "./errors";
import { parseFields, type Fields } from "./record";

export const [VERTEX, CORNER, FACE] = [0, 1, 2];
export const [LEVELS, OCTAHEDRAL, BITS, RECOMPUTED] = [0, 1, 2, 3];
export const TEXCOORD = 3;
const FLOAT32 = 6;
const FLOAT64 = 7;
const MOST_LEVEL = 2 ** 32 - 1;
const LARGEST_SINGLE = 2 ** 128 - 2 ** 104;
/** Of whole numbers, kind by kind. */
export const RANGES: (readonly number[] | undefined)[] = [[0, 2 ** 8 - 1], [-(2 ** 7), 2 ** 7 - 1], [0, 2 ** 16 - 1], [-(2 ** 15), 2 ** 15 - 1], [0, 2 ** 32 - 1], [-(2 ** 31), 2 ** 31 - 1]];

/** An attribute, but for its values; the names are those of the specification. */
export interface Declaration {
    name: string;
    domain: number;
    origin: number;
    semantic: number;
    kind: number;
    components: number;
    coding: number;
    rows: number;
    largest: number[];
    offset: number[];
    step: number[];
    leans: number;
    moves: number;
    seamsOf: number;
}

const FIELDS: Fields<keyof Declaration> = DECLARATION_FIELDS;

/** Bytes of the map (F 5.8). */
const MOST_DECLARATION = 2 ** 16;

/** The declaration in a map; contradictions are errors (D 1.4). */
export function parseDeclaration(payload: Uint8Array): Declaration {
    if (payload.length > MOST_DECLARATION) throw new CorruptError(`a declaration of ${payload.length} bytes, where ${MOST_DECLARATION} are legal`);
    const declaration = parseFields(payload, FIELDS, "attribute") as unknown as Declaration;
    const problem = contradiction(declaration) ?? rangeProblem(declaration);
    if (problem) throw new CorruptError(`attribute "${declaration.name}" contradicts itself: ${problem}`);
    return declaration;
}

/** Numbers in a coded value (D 1.3). */
export function wordsOf({ coding, kind, components }: Declaration): number {
    if (coding === OCTAHEDRAL) return 2;
    if (coding === RECOMPUTED) return 0;
    return coding === BITS && kind === FLOAT64 ? 2 * components : components;
}

/** What level 0 stands for, of each word, and one level. */
export function scaleOf(declaration: Declaration): { offsets: number[]; steps: number[] } {
    const { offset, step } = declaration;
    const words = wordsOf(declaration);
    const steps = step.length === 1 ? Array<number>(words).fill(step[0]) : step;
    return { offsets: offset.length > 0 ? offset : Array<number>(words).fill(0), steps: steps.length > 0 ? steps : Array<number>(words).fill(1) };
}

/** Whether the user is given values by vertices. */
export function isByVertex({ domain, origin }: Declaration): boolean {
    return (domain === VERTEX && origin === 0) || (domain === CORNER && origin === 1);
}

function contradiction(d: Declaration): string | undefined {
    const words = wordsOf(d);
    const unit = d.components === 3 && d.kind >= FLOAT32;
    const [first, second] = d.largest;
    const even = d.largest.length === 2 && first === second && first >= 2 && first < 2 ** 16 && first % 2 === 0;
    const rules: [string, boolean][] = [
        ["faces that are given by something else", d.domain === FACE && d.origin !== 0],
        ["octahedral or recomputed values that are not three floats", (d.coding === OCTAHEDRAL || d.coding === RECOMPUTED) && !unit],
        ["recomputed values of faces, or coded ones", d.coding === RECOMPUTED && (d.domain === FACE || d.rows > 0 || d.leans > 0)],
        ["bits of integers", d.coding === BITS && d.kind < FLOAT32],
        ["no values", d.coding !== RECOMPUTED && d.rows === 0],
        ["other than a largest level for each number", d.largest.length !== words],
        ["offsets or steps of octahedral or recomputed values", (d.coding === OCTAHEDRAL || d.coding === RECOMPUTED) && d.offset.length + d.step.length > 0],
        ["steps of bits", d.coding === BITS && d.step.length > 0],
        ["other than an offset for each number", d.offset.length !== 0 && d.offset.length !== words],
        ["other than a step for all or for each number", d.step.length > 1 && d.step.length !== words],
        ["octahedral levels that are not two of the same even number", d.coding === OCTAHEDRAL && !even],
        ["values of faces that lean on positions", d.domain === FACE && d.leans > 0],
        ["values that move and are not levels of vertices", d.moves > 0 && (d.domain !== VERTEX || d.origin > 0 || d.coding !== LEVELS)],
        ["seams where there are no corners", d.seamsOf > 0 && d.domain !== CORNER],
    ];
    return rules.find(([, broken]) => broken)?.[0];
}

/** Why the values that levels stand for are none of the kind. */
function rangeProblem(d: Declaration): string | undefined {
    const { offsets, steps } = scaleOf(d);
    const legal = d.largest.every((largest, i) => {
        const [first, last] = [offsets[i], offsets[i] + steps[i] * largest];
        if (d.coding === BITS) return first >= 0 && Number.isInteger(first) && last <= MOST_LEVEL;
        if (d.coding !== LEVELS) return true;
        if (d.kind >= FLOAT32) {
            const most = d.kind === FLOAT32 ? LARGEST_SINGLE : 1e308;
            return Math.abs(first) <= most && Math.abs(last) <= most;
        }
        const [low, high] = RANGES[d.kind] ?? [];
        return Number.isInteger(first) && Number.isInteger(steps[i]) && first >= low && last <= high;
    });
    return legal ? undefined : "values outside of their range";
}
