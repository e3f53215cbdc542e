/** What a decoder says instead of an event. */
export const NEED_DATA = "need data";
export const END_OF_STREAM = "end of stream";
/** The next block is one that a helper has to send first. */
export const NEED_BLOCK = "need block";
export type Signal = typeof NEED_DATA | typeof END_OF_STREAM;
