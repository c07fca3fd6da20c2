import assert from 'node:assert/strict';
import { describe, it } from 'node:test';
import { missing, screenshot } from './support/browser.mjs';
import { startServer } from './support/programs.mjs';
import { frameCount, startReplay } from './support/recording.mjs';
import { link, open, recordFrames, says, state, stepBack, surface } from './support/viewer.mjs';

describe('frames', { skip: missing }, () => {
  const small = { viewport: { width: 480, height: 400 } };
  const drawnFrames = (page) => page.evaluate(() => window.drawn);

  it('are drawn whole, as the server counted them, 200 of them, in order', async () => {
    const server = await startServer();
    const replay = await startReplay(server);
    const page = await open(link(server, replay.session), small);
    await surface(page);
    await stepBack(page);
    await recordFrames(page);
    await page.waitForFunction(() => new Set(window.drawn.map(([frame]) => frame)).size >= 200, undefined, {
      polling: 500,
      timeout: 180_000,
    });
    const drawn = await drawnFrames(page);
    console.log(`200 frames drawn of ${drawn.at(-1)[0] - drawn[0][0] + 1} that were sent`);
    for (const [frame, count] of drawn) assert.equal(count, replay.triangles[frame % frameCount], `frame ${frame}`);
    for (let i = 1; i < drawn.length; ++i)
      assert.ok(drawn[i][0] >= drawn[i - 1][0], `${drawn[i]} after ${drawn[i - 1]}`);
  });

  it('are skipped in a slow tab, which ends with the newest as soon as it comes', async () => {
    const server = await startServer();
    const replay = await startReplay(server, { faster: 2, loop: false });
    const page = await open(link(server, replay.session), small);
    await surface(page);
    await recordFrames(page);
    // Four fifths of the page's time are taken away.
    await page.evaluate(() => {
      window.slow = setInterval(() => {
        const end = performance.now() + 400;
        while (performance.now() < end);
      }, 500);
    });
    await replay.finished();
    const sent = performance.now();
    await page.waitForFunction((last) => window.drawn.at(-1)?.[0] >= last, frameCount - 2);
    const late = performance.now() - sent;
    await page.evaluate(() => clearInterval(window.slow));
    await says(page, /session has ended/);
    await screenshot(page, 'session-ended');
    const drawn = await drawnFrames(page);
    const distinct = new Set(drawn.map(([frame]) => frame)).size;
    const skipped = Number(await page.locator('#skipped').innerText());
    console.log(
      `slow tab: ${distinct} of ${frameCount} frames drawn, ${skipped} skipped, the last ${late.toFixed(0)} ms after it was sent`,
    );
    assert.ok(distinct < frameCount / 2);
    assert.ok(skipped > frameCount / 4);
    assert.ok(late < 5000);
  });

  it('are not asked for while the tab is hidden', async () => {
    const server = await startServer();
    const { session } = await startReplay(server);
    const page = await open(link(server, session), small);
    await surface(page);
    const watchers = () =>
      fetch(`${server.url}metrics`).then(async (answer) =>
        Number(/^meniscus_watchers(?:{[^}]*})? (\d+)/m.exec(await answer.text())[1]),
      );
    const hide = (hidden) =>
      page.evaluate((value) => {
        Object.defineProperty(document, 'hidden', { value, configurable: true });
        document.dispatchEvent(new Event('visibilitychange'));
      }, hidden);
    const becomes = async (count) => {
      while ((await watchers()) !== count) await new Promise((resolve) => setTimeout(resolve, 50));
    };
    await becomes(1);
    await hide(true);
    await state(page, 'paused');
    await becomes(0);
    await hide(false);
    await state(page, 'live');
    await becomes(1);
  });
});
