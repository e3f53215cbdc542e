/**
 * A page of somebody else, whose name leads to this machine (DNS rebinding), reads nothing of `bsm view`, and encodes
 * nothing.
 */
import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import test from "node:test";
import { CHROMIUM, chromiumFor } from "./shared";

const address = process.env.BSM_FOREIGN;

test(
    "a foreign page",
    { skip: !address || (!existsSync(CHROMIUM) && `no Chromium at ${CHROMIUM}`) },
    async (context) => {
        const browser = await chromiumFor(context, "--host-resolver-rules=MAP evil.test 127.0.0.1");
        const page = await browser.newPage();
        const { port, pathname } = new URL(address!);
        const evil = `http://evil.test:${port}`;
        // Its first answer is its own page; then the name leads to the server of this machine, which even knows the
        // token here.
        await page.route(`${evil}/`, (route) =>
            route.fulfill({ contentType: "text/html", body: "<!doctype html><p>evil</p>" }),
        );
        await page.goto(`${evil}/`);
        const asked = (
            url: string,
            start: { method?: string; body?: string; mode?: "no-cors" } = {},
        ): Promise<string> =>
            page.evaluate(
                async ({ url, start }) =>
                    fetch(url, start).then(
                        async (answer) => `${answer.type} ${answer.status} ${(await answer.text()).length > 2000}`,
                        () => "refused",
                    ),
                { url, start },
            );
        const [rebound, across] = [`${evil}${pathname}`, address!];
        assert.match(await asked(rebound), /403 false|refused/);
        assert.match(
            await asked(`${rebound}upload?preset=small&name=a.ply`, { method: "POST", body: "ply" }),
            /403 false|refused/,
        );
        assert.equal(await asked(across), "refused");
        assert.match(await asked(across, { mode: "no-cors" }), /opaque 0 false|refused/); // browsers may keep foreign pages from this machine
        assert.equal(
            await asked(`${across}upload?preset=small&name=a.ply`, { method: "POST", body: "ply" }),
            "refused",
        );
        const framed = await page.evaluate(async (url) => {
            const frame = Object.assign(document.createElement("iframe"), { src: url });
            const loaded = new Promise((keep) => frame.addEventListener("load", keep));
            document.body.append(frame);
            await loaded;
            return frame.contentDocument?.title ?? "hidden";
        }, across);
        assert.equal(framed, "hidden");
        assert.equal((await page.goto(rebound))!.status(), 403); // the name does lead here
        const own = await browser.newPage();
        assert.equal((await own.goto(address!))!.status(), 200);
    },
);
