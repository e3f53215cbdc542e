/** A mesh that is dropped on the page of `bsm view` is encoded by its server, and shown beside its stream. */
import assert from "node:assert/strict";
import { existsSync, readFileSync } from "node:fs";
import { basename } from "node:path";
import { describe, test } from "node:test";
import { CHROMIUM, chromiumFor, drop as dropped, PATIENCE, tableOf } from "./shared";

const given = process.env.BSM_DROP;

describe("a mesh that is dropped", { skip: !given || (!existsSync(CHROMIUM) && `no Chromium at ${CHROMIUM}`) }, () => {
    const { address, mesh, pairs } = JSON.parse(given ?? "{}") as {
        address: string;
        mesh: string;
        pairs: [paths: string[], title: string, row: string, percent: number][];
    };

    test("is encoded with a bar, and both are shown; another one can be canceled while it is sent and while it is encoded", async (context) => {
        const browser = await chromiumFor(context);
        const page = await browser.newPage();
        const complaints: string[] = [];
        page.on("pageerror", (error) => complaints.push(error.message));
        page.on("console", (message) => message.type() === "error" && complaints.push(message.text()));
        await page.goto(address);
        await page.getByText("nothing leaves it").waitFor();
        const drop = (): Promise<void> => dropped(page, { "ball.ply": readFileSync(mesh) });
        await drop();
        await page.getByRole("progressbar").waitFor();
        assert.ok(
            await page.getByText("nothing leaves it").isHidden(),
            "the card that asks for a mesh hides the progress",
        );
        await page.waitForFunction(() => Number(document.body.dataset.layers) >= 2, undefined, { timeout: PATIENCE });
        assert.equal(await page.locator("h1").textContent(), "ball.ply");
        assert.match(await page.locator("[data-part=claim]").innerText(), /^Looks the same, [\d.]+ times smaller$/);
        assert.ok(await page.getByRole("radio", { name: "Wipe" }).isChecked());
        for (const [paths, title, row, percent] of pairs) {
            await dropped(page, Object.fromEntries(paths.map((path) => [basename(path), readFileSync(path)])));
            await page.waitForFunction(
                (name) =>
                    document.querySelector("h1")!.textContent === name && Number(document.body.dataset.layers) >= 2,
                title,
                { timeout: PATIENCE },
            );
            assert.match(
                await page.locator("[data-part=claim]").innerText(),
                /^(Looks the same|Close: differences show side by side|A preview: differences show at a glance)/,
            );
            const found = parseFloat((await tableOf(page))[row]);
            assert.ok(Math.abs(found / percent - 1) < 0.01, `${paths}: ${row} ${found}, not ${percent}`);
        }
        for (const stage of ["sending$", ": (?!sending)"]) {
            await page.evaluate((stage) => {
                const line = document.querySelector("[data-part=stage]")!;
                line.textContent = "";
                const observer = new MutationObserver(() => {
                    if (!new RegExp(stage).test(line.textContent!)) return;
                    observer.disconnect();
                    document.querySelector<HTMLButtonElement>("[name=cancel]")!.click();
                });
                observer.observe(line, { childList: true });
            }, stage);
            await drop();
            await page.getByRole("progressbar").waitFor({ state: "hidden" });
        }
        assert.equal(await page.locator("[role=alert]").textContent(), "");
        assert.deepEqual(complaints, []);
    });
});
