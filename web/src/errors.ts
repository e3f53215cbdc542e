/** Every failure of the decoder: one base class, and a class for each thing a caller may want to do about it. */

/** Where in a stream something was noticed: byte offset, number of the section, index of the block. */
export interface Place {
    offset?: number;
    frame?: number;
    block?: number;
}

/** What messages call the places. */
const WORDS = [
    ["offset", "byte"],
    ["frame", "section"],
    ["block", "block"],
] as const;

/** An error as it goes from one thread to another. */
export interface Described {
    name: string;
    problem: string;
    place: Place;
}

/** Base of all errors of this package. */
export class BsmError extends Error {
    override readonly name: string = "BsmError";
    readonly place: Place = {};

    constructor(
        readonly problem: string,
        place: Place = {},
    ) {
        super(problem);
        this.located(place);
    }

    /** Files of this package have classes of their own, where that saves a request: errors are told by their names. */
    static override [Symbol.hasInstance](error: unknown): boolean {
        const { name, problem } = Object(error) as BsmError;
        return problem !== undefined && (this === BsmError || name === new this("").name);
    }

    get described(): Described {
        return { name: this.name, problem: this.problem, place: this.place };
    }

    /** Fill in the places that are not known yet, and return the same error. */
    located(place: Place): this {
        const problem = this.problem || "see bsm.js";
        let where = "";
        for (const [key, word] of WORDS) {
            const value = (this.place[key] ??= place[key]);
            if (value !== undefined) where += `${where && ", "}${word} ${value}`;
        }
        this.message = where ? `${problem} [${where}]` : problem;
        return this;
    }
}

/** A class of errors; its name is written out, because bundlers shorten those of classes. */
function named(name: string): typeof BsmError {
    return class extends BsmError {
        override readonly name = name;
    };
}

/** The data is not a BSM stream at all. */
export class FormatError extends named("FormatError") {}

/** Well formed as far as it can be read, but of a version or method that this decoder does not know. */
export class UnsupportedError extends named("UnsupportedError") {}

/** A BSM stream that contradicts itself or its checksums. */
export class CorruptError extends named("CorruptError") {}

/** The data ends before the stream does. */
export class TruncatedError extends named("TruncatedError") {}

/** The stream asks for more memory or work than the caller's limits allow. */
export class LimitError extends named("LimitError") {}

/** The mathematics broke down: a value that is not finite. */
export class NumericError extends named("NumericError") {}

const CLASSES = [FormatError, UnsupportedError, CorruptError, TruncatedError, LimitError, NumericError];

/** The error that another thread described. */
export function errorLike({ name, problem, place }: Described): BsmError {
    const kind = CLASSES.find((kind) => new kind("").name === name) ?? BsmError;
    return new kind(problem, place);
}
