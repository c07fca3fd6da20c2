// All frames of publications in a browser against the meshes that were published: `node frame_hashes.mjs [--firefox] MESHES URL...`.
// MESHES: a folder of frame_000000.ply ..., as `meniscus convert RECORDING -o MESHES` or `meniscus reconstruct` writes them of the
// source; URL: of a page that `meniscus publish --page` or `--single-file` has made of it. Each frame is shown, in order and then at
// random places, and saved; its triangles must be those of the file. In Chromium, or in Firefox, on a display: `xvfb-run -a node
// frame_hashes.mjs --firefox ...`. Leaves with 1 where a frame differs.
import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { launch, launchFirefox, openPage } from './support/browser.mjs';
import { handed, save } from './support/files.mjs';
import { hashOfPly } from './support/mesh_hash.mjs';

const randomSeeks = 40;

function* places(count) {
  for (let place = 0; place < count; ++place) yield place;
  let state = 1;
  for (let i = 0; i < randomSeeks; ++i) {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    yield Math.floor((state / 2 ** 32) * count);
  }
}

const args = process.argv.slice(2);
const inFirefox = args[0] === '--firefox';
const [folder, ...urls] = inFirefox ? args.slice(1) : args;

async function differences(browser, url, expected) {
  const page = await openPage(browser);
  await page.goto(`${url}#position=0`);
  await page.waitForSelector('#view[data-frame]');
  const found = [];
  for (const place of places(expected.length)) {
    await page.fill('#scrub', String(place));
    await page.waitForFunction((frame) => document.getElementById('view').dataset.frame === frame, String(place));
    const saved = inFirefox ? await handed(page, '#ply') : (await save(page, '#ply')).bytes;
    if (hashOfPly(saved) !== expected[place]) found.push(place);
  }
  await page.context().close();
  return found;
}

const files = readdirSync(folder).sort();
const expected = files.map((name) => hashOfPly(readFileSync(join(folder, name))));
const browser = await (inFirefox ? launchFirefox() : launch());
try {
  for (const url of urls) {
    const found = await differences(browser, url, expected);
    console.log(`${url}: ${expected.length} frames, whole and at ${randomSeeks} random places: ${found.length} differ`);
    if (found.length > 0) process.exitCode = 1;
  }
} finally {
  await browser.close();
}
