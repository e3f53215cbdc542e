/** Stages of a decoder that exist only after something else. */

/** Return a stage that must have begun. */
export function required<Thing>(thing: Thing | undefined): Thing {
    if (thing === undefined) throw new RangeError("a stage of the decoder is asked for what it has not begun");
    return thing;
}
