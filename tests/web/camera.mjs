import assert from 'node:assert/strict';
import { describe, it } from 'node:test';
import { missing } from './support/browser.mjs';
import { startServer, startUploader } from './support/programs.mjs';
import { recordedFile, startReplay } from './support/recording.mjs';
import { link, open, state, surface } from './support/viewer.mjs';

const cameraOf = (address) => new URLSearchParams(new URL(address).hash.slice(1)).get('camera')?.split(',').map(Number);

describe('the camera', { skip: missing }, () => {
  it('moves by the keyboard, and a link brings it back', async () => {
    const server = await startServer();
    const simulator = await startReplay(server);
    const page = await open(link(server, simulator.session));
    await surface(page);
    await page.focus('#view');
    for (const key of ['ArrowLeft', 'ArrowUp', '+', 'Shift+ArrowRight', 'w']) {
      const before = page.url();
      await page.keyboard.press(key);
      await page.waitForFunction((address) => location.href !== address, before);
    }
    const address = page.url();
    const again = await open(address);
    await surface(again);
    await again.focus('#view');
    await again.keyboard.press('w');
    await again.waitForFunction(() => !/look=/.test(location.hash));
    cameraOf(again.url()).forEach((x, i) => assert.ok(Math.abs(x - cameraOf(address)[i]) < 1e-4, again.url()));
  });

  it('has the water in view from the first picture on', async () => {
    const server = await startServer();
    const { file } = await recordedFile();
    const replay = startUploader(server, ['replay', file, '--speed', 'max', '--to', '31', '--keep-session']);
    await replay.finished();
    const page = await open(undefined);
    // Bricks beside a picture are not drawn. All pictures are of one frame.
    await page.addInitScript(() => {
      window.counts = [];
      addEventListener('DOMContentLoaded', () => {
        const view = document.getElementById('view');
        new MutationObserver(() => window.counts.push(Number(view.dataset.triangles))).observe(view, {
          attributeFilter: ['data-triangles'],
        });
      });
    });
    await page.goto(`${server.url}?embed#session=${replay.session}`);
    await surface(page);
    await state(page, 'live');
    const [first, ...others] = await page.evaluate(async () => {
      for (let picture = 0; picture < 10; ++picture) await new Promise(requestAnimationFrame);
      return window.counts;
    });
    assert.ok(first > 0);
    assert.deepEqual(
      others.filter((count) => count !== first),
      [],
    );
  });

  it('keeps spreading water in view until a person moves it', async () => {
    const server = await startServer();
    // However late the page opens, it sees the water before it has spread.
    const { file } = await recordedFile();
    const first = startUploader(server, ['replay', file, '--speed', 'max', '--to', '1', '--keep-session']);
    await first.finished();
    const page = await open(link(server, first.session));
    await surface(page);
    const place = async () => {
      const before = page.url();
      await page.click('#look');
      await page.waitForFunction((address) => location.href !== address, before);
      return cameraOf(page.url());
    };
    const narrow = await place();
    await startReplay(server, { session: first.session });
    const until = (frames) =>
      page.waitForFunction((n) => Number(document.getElementById('view').dataset.frame) > n, frames);
    await until(50);
    assert.notDeepEqual(await place(), narrow);
    await page.focus('#view');
    await page.keyboard.press('ArrowLeft');
    const moved = await place();
    await until(80);
    (await place()).forEach((x, i) => assert.ok(Math.abs(x - moved[i]) < 1e-4));
  });

  it('gets fewer bits while it moves and the full mesh when it rests', async () => {
    const server = await startServer();
    const simulator = await startReplay(server);
    const page = await open(link(server, simulator.session), { viewport: { width: 480, height: 400 } });
    await surface(page);
    const asked = [];
    page.on('request', (request) => {
      if (request.url().endsWith('/Watch')) asked.push(request.postDataBuffer().length);
    });
    const quality = (text) =>
      page.waitForFunction((words) => document.getElementById('quality').textContent.startsWith(words), text);
    await page.mouse.move(200, 200);
    await page.mouse.down();
    await page.mouse.move(260, 220, { steps: 4 });
    await quality('fewer bits');
    await page.mouse.up();
    const released = performance.now();
    await quality('full');
    await state(page, 'live');
    console.log(
      `asked for the full mesh ${(performance.now() - released).toFixed(0)} ms after the camera came to rest`,
    );
    assert.ok(
      asked.length >= 2 && asked[0] > asked.at(-1),
      `requests of ${asked} bytes: some while it moves, none when it rests`,
    );
  });
});
