import { chromium } from "playwright-core";
const [url, out] = process.argv.slice(2);
const FLAGS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", headless: true, args: FLAGS });
try {
  const page = await browser.newPage({ viewport: { width: 900, height: 700 } });
  page.on("console", (m) => console.log("console:", m.text())); page.on("pageerror", (e) => console.log("error:", e.message));
  await page.goto(url);
  await page.waitForSelector("body[data-state=complete]", { timeout: 60000 });
  await page.waitForTimeout(2500);
  console.log(JSON.stringify(await page.evaluate(() => ({ ...document.body.dataset }))));
  await page.screenshot({ path: out });
} finally { await browser.close(); }
