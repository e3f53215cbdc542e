/** What is asked for only behind something else. */

/** What there is, once it has begun; a decoder that is asked for it before that is wrong. */
export function begun<Thing>(thing: Thing | undefined): Thing {
    if (thing === undefined) throw new RangeError("a stage of the decoder is asked for what it has not begun");
    return thing;
}
