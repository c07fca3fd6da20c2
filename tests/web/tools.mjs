import assert from 'node:assert/strict';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { describe, it } from 'node:test';
import { missing, screenshot } from './support/browser.mjs';
import { readPng, readVideo, save } from './support/files.mjs';
import { verticesOfPly } from './support/meshes.mjs';
import { startServer, startUploader } from './support/programs.mjs';
import { recordedFile, startReplay } from './support/recording.mjs';
import { link, open, surface } from './support/viewer.mjs';

const small = { viewport: { width: 480, height: 400 } };
const frames = 6;

const numbers = (text) => text.match(/-?[\d.]+(e-?\d+)?/g).map(Number);
const fields = (page) => new URLSearchParams(new URL(page.url()).hash.slice(1));
/** Of pictures and videos, which are of even sizes. */
const sizeOfView = (page) =>
  page.evaluate(() => {
    const { width, height } = document.getElementById('view');
    return [width, height].map((length) => 2 * Math.floor(length / 2));
  });

describe('the tools', { skip: missing }, () => {
  it('measure a recording, cut through it, and keep pictures and videos of it', async () => {
    const folder = mkdtempSync(join(tmpdir(), 'meniscus-web-'));
    try {
      const { file } = await recordedFile();
      const server = await startServer({ args: ['--record', folder] });
      const replay = startUploader(server, ['replay', file, '--speed', 'max', '--to', `${frames - 1}`]);
      await replay.finished();
      const page = await open(undefined, small);
      const show = async (more) => {
        await page.goto(`${server.url}#recording=${replay.session}/1&position=${frames - 1}${more}`);
        await surface(page);
      };

      await show('');
      const vertices = verticesOfPly((await save(page, '#ply')).bytes);
      const top = vertices.reduce((a, b) => (b[1] > a[1] ? b : a));
      const isTop = (place) => place.forEach((x, i) => assert.ok(Math.abs(x - top[i]) < 2e-3, `${place}, not ${top}`));
      // Seen from above, nothing lies before it.
      await show(`&camera=${[top[0] + 0.1, top[1] + 2, top[2] + 0.2, ...top]}&ruler=0,0,0,0.3,0,-0.4`);
      await page.click('#probe');
      await page.click('#probe-middle');
      const place = page.locator('#probe-place', { hasText: /\d/ });
      isTop(numbers(await place.innerText()));
      assert.match(await page.locator('#probe-level').innerText(), /^(level [123]|crack filling)$/);
      assert.deepEqual(numbers(await page.locator('#ruler-text').innerText()), [0.5, 0.3, 0, -0.4]);
      await page.click('#ruler-middle');
      await page.click('#ruler-middle');
      isTop(fields(page).get('ruler').split(',').slice(0, 3).map(Number));

      const [x, y, z] = [0, 1, 2].map((axis) => vertices.reduce((sum, v) => sum + v[axis], 0) / vertices.length);
      await show(`&camera=${[x, y, z + 3, x, y, z]}&cut=z,${z},beyond&scale=off`);
      await page.click('#probe');
      await page.click('#probe-middle');
      await page.locator('#probe-level', { hasText: 'on the cut' }).waitFor();
      assert.ok(Math.abs(numbers(await place.innerText())[2] - z) < 1e-3);
      await page.click('#probe');
      const { bytes, name } = await save(page, '#picture');
      assert.equal(name, `meniscus-${frames - 1}.png`);
      await screenshot(page, 'cut');
      const png = await readPng(page, bytes, [
        [0.5, 0.4],
        [0.02, 0.02],
      ]);
      const size = await sizeOfView(page);
      assert.deepEqual([png.width, png.height], size);
      // The face of the cut has two colors; what is behind it has others.
      const ofFace = ([red, green, blue]) =>
        red >= 0x2e && red <= 0x50 && green >= 0x7b && green <= 0xa0 && blue >= 0xa2 && blue <= 0xc5;
      assert.deepEqual(png.colors.map(ofFace), [true, false], JSON.stringify(png.colors));

      await page.click('#view-x');
      await page.click('#view-x');
      const [px, py, pz, tx, ty, tz] = fields(page).get('camera').split(',').map(Number);
      assert.ok(px < tx && Math.abs(py - ty) < 1e-6 && Math.abs(pz - tz) < 1e-6, page.url());

      await page.click('#video');
      await page.fill('#video-rate', '24');
      const video = await readVideo(await open(), (await save(page, '#video-begin')).bytes);
      assert.deepEqual(video, { width: size[0], height: size[1], seconds: frames / 24 });
      await page.waitForSelector('#video-dialog', { state: 'hidden' });
    } finally {
      rmSync(folder, { recursive: true });
    }
  });

  it('show two sessions from one place, as the link does, and make a video of both', async () => {
    const server = await startServer();
    const [first, second] = [await startReplay(server), await startReplay(server)];
    const page = await open(link(server, first.session), small);
    await surface(page);
    await page.click('#beside');
    await page.selectOption('#beside-session', second.session);
    const both = (at) =>
      at.waitForFunction(() =>
        ['view', 'view-beside'].every((id) => Number(document.getElementById(id).dataset.triangles) > 0),
      );
    await both(page);
    // They stay, each with its last frame.
    await Promise.all([first.kill(), second.kill()]);
    const before = page.url();
    await page.click('#video');
    await page.focus('#view-beside');
    await page.keyboard.press('ArrowLeft');
    await page.waitForFunction((address) => location.href !== address, before);
    const video = await readVideo(await open(), (await save(page, '#video')).bytes);
    const stage = await page.locator('#stage').boundingBox();
    const short = [stage.width - video.width, stage.height - video.height];
    assert.ok(
      short.every((pixels) => pixels >= 0 && pixels <= 2),
      `${short} pixels less than both pictures`,
    );
    await screenshot(page, 'beside');
    assert.equal(fields(page).get('beside'), second.session);

    const camera = fields(page).get('camera');
    await page.reload();
    await both(page);
    assert.equal(fields(page).get('camera'), camera);
    await page.click('#beside');
    await page.waitForSelector('#view-beside', { state: 'hidden' });
    assert.equal(fields(page).get('beside'), null);
  });
});
