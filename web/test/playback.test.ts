/** Which frame of a sequence is shown when. */
import assert from "node:assert/strict";
import test from "node:test";
import type { BSMGeometry } from "../src/geometry";
import { Playback } from "../src/playback";
import { BSMSequence } from "../src/sequences";

/** Frames that are shown in 120 pictures of a screen of 60 Hz, whose clock is a tenth of a millisecond off. */
function shown(rate: number): number[] {
    const playback = new Playback(rate, true);
    const clock = (k: number): number => k / 60 + 1e-4 * ((k % 3) - 1);
    return Array.from({ length: 120 }, (_, k) => {
        playback.step(clock(k) - clock(k - 1), 1000, true);
        return playback.frame;
    });
}

test("time that runs backwards holds still", () => {
    const playback = new Playback(30, true);
    for (const seconds of [0, 0.1, -0.05, -1.05]) playback.step(seconds, 1000, true);
    assert.equal(playback.frame, 3);
    playback.step(0.1, 1000, true);
    assert.equal(playback.frame, 6);
});

for (const rate of [60, 30, 20, 120]) {
    test(`a clock that trembles skips none of ${rate} frames a second`, () => {
        assert.deepEqual(
            shown(rate),
            Array.from({ length: 120 }, (_, k) => Math.floor((rate * k) / 60 + 0.01)),
        );
    });
}

for (const rate of [24, 25, 30000 / 1001, 30, 60])
    test(`seeking to the time of a frame shows it, of ${rate} a second`, () => {
        const geometry = {
            frameRate: rate,
            frames: Array(1000),
            shown: -1,
            showFrame: (i: number) => (geometry.shown = i),
        };
        const sequence = new BSMSequence(geometry as unknown as BSMGeometry);
        for (let frame = 0; frame < 1000; frame++) assert.equal(sequence.seek((frame / rate) * rate).frame, frame);
        assert.equal(sequence.seek(7.9).frame, 7);
        assert.equal(sequence.seek(NaN).frame, 0);
        assert.equal(sequence.seek(Infinity).frame, 999);
    });

test("loops keep what is over at their end, however long a step is", () => {
    const playback = new Playback(24, true);
    playback.step(0, 60, true);
    for (let t = 0; t < 200; t += 0.07) playback.step(0.07, 60, true);
    assert.equal(playback.loops, Math.floor((200 * 24) / 60));
    playback.seek(10);
    playback.step(60 / 24 + 20 / 24, 60, true); // as after a hidden tab
    assert.equal(playback.frame, 30);
});
