import assert from 'node:assert/strict';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { once } from 'node:events';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, describe, it } from 'node:test';
import { missing, screenshot } from './support/browser.mjs';
import { startServer } from './support/programs.mjs';
import { startReplay } from './support/recording.mjs';
import { open } from './support/viewer.mjs';

/** Somebody's page: it shows what its test asks for. */
const html = `<!doctype html><title>A page</title><link rel="icon" href="data:,">
<style>#water { width: 480px; height: 320px; border: 4px solid; }</style><div id="water"></div>`;

describe('the viewer in a page of others', { skip: missing }, () => {
  let module = '';
  let pages;
  let port;

  before(async () => {
    pages = createServer((request, response) => {
      const script = request.url === '/meniscus-frame.js';
      response.setHeader('Content-Type', script ? 'text/javascript' : 'text/html').end(script ? module : html);
    });
    pages.listen(0, '127.0.0.1');
    await once(pages, 'listening');
    ({ port } = pages.address());
  });
  after(() => pages?.close());

  /** With a frame of the viewer. host: one of two names of this machine, which are two origins. */
  async function pageWithFrame(host, server, view) {
    module = await (await fetch(`${server.url}meniscus-frame.js`)).text();
    const page = await open();
    // For tests that do not wait as long as a page does.
    await page.clock.install();
    await page.goto(`http://${host}:${port}/`);
    await page.evaluate(
      async ([url, shown]) => {
        const { showMeniscus } = await import('/meniscus-frame.js');
        window.frame = showMeniscus(document.getElementById('water'), url, shown);
        window.frame.ready.catch(() => undefined);
      },
      [server.url, view],
    );
    return page;
  }
  const listed = () => ['--web-frame-ancestors', `http://localhost:${port}`];
  const drawn = (frame) => frame.waitForFunction(() => Number(document.getElementById('view')?.dataset.triangles) > 0);

  it('shows the water alone where the page is listed, with session, camera and token handed over and kept nowhere', async () => {
    const folder = mkdtempSync(join(tmpdir(), 'meniscus-web-'));
    try {
      const token = 'token-of-eve-0123456789';
      const tokens = join(folder, 'tokens');
      writeFileSync(tokens, `watcher eve ${token}\nadmin root token-of-root-0123456789\n`, { mode: 0o600 });
      const server = await startServer({ args: [...listed(), '--tokens', tokens] });
      process.env.MENISCUS_TOKEN = 'token-of-root-0123456789';
      const { session } = await startReplay(server).finally(() => delete process.env.MENISCUS_TOKEN);
      const camera = { position: [3, 2, 4], target: [0.5, 0.5, 0.5] };
      const page = await pageWithFrame('localhost', server, { session, camera });
      await page.evaluate(() => window.frame.ready);
      const frame = page.frames().find((one) => one !== page.mainFrame());
      // Without a token nothing is asked for, in the frame or around it.
      await frame.waitForFunction(() => /asks for a token/.test(document.getElementById('banner').innerText));
      assert.equal(await frame.locator('dialog[open]').count(), 0);

      await page.evaluate((view) => window.frame.show(view), { session, camera, token });
      await drawn(frame);
      await screenshot(page, 'embedded');
      for (const id of ['list', 'controls', 'overlay', 'leave'])
        assert.equal(await frame.locator(`#${id}`).isVisible(), false, id);
      assert.equal(await frame.locator('#banner').isVisible(), false);
      assert.equal(frame.url(), `${server.url}?embed=${encodeURIComponent(`http://localhost:${port}`)}`);
      // The browser may keep nothing at all for another site's frame.
      const kept = await frame.evaluate(() => {
        try {
          return sessionStorage.length + localStorage.length;
        } catch {
          return 0;
        }
      });
      assert.equal(kept, 0);

      // The camera may be moved again and again: the water stays alone, and the server is not asked each time.
      let asked = 0;
      page.on('request', (request) => (asked += /(GetSession|Watch)$/.test(request.url()) ? 1 : 0));
      for (let i = 0; i < 20; ++i) await page.evaluate((view) => window.frame.show(view), { session, camera, token });
      assert.ok(asked < 10, `${asked} calls`);
      for (const tool of ['scale', 'domain'])
        assert.equal(await frame.getAttribute(`#${tool}`, 'aria-pressed'), 'false', tool);

      // A window that the viewer does not know says nothing to it, and hears nothing.
      await frame.evaluate(() =>
        window.postMessage({ meniscus: 'show', nonce: '', number: 9, session: '', token: '' }),
      );
      await page.evaluate((view) => window.frame.show(view), { session: 'none', token });
      await frame.waitForFunction(() => /session "none"/.test(document.getElementById('banner').innerText));
      assert.equal(await page.evaluate(() => document.title), 'A page');
    } finally {
      rmSync(folder, { recursive: true });
    }
  });

  it('is not shown where the page is not listed, nor where none is', async () => {
    for (const args of [listed(), []]) {
      const server = await startServer({ args });
      const page = await pageWithFrame('127.0.0.1', server, { session: '00000000-0000-4000-8000-000000000000' });
      const refused = () => page.errors.some((text) => /frame-ancestors/.test(text));
      while (!refused()) await page.waitForEvent('console');
      const frame = page.frames().find((one) => one !== page.mainFrame());
      assert.equal(await frame.locator('#view').count(), 0);
      // A sentence comes in place of the browser's page, which does not say what is wrong.
      await page.clock.fastForward(10_000);
      await page.locator('#water > p').getByText(`--web-frame-ancestors http://127.0.0.1:${port}`).waitFor();
      assert.equal(await page.locator('#water > iframe').isVisible(), false);
      page.errors.length = 0;
    }
  });

  it('shows what the address names, alone, where nobody is around', async () => {
    const server = await startServer();
    const { session } = await startReplay(server);
    const page = await open(`${server.url}?embed#session=${session}`, { viewport: { width: 320, height: 240 } });
    await drawn(page);
    assert.equal(await page.locator('header').isVisible(), false);
    for (const key of ['c', 'i', 'r', 'm']) await page.keyboard.press(key);
    for (const panel of ['#controls', '#panels', '#overlay', '#warnings'])
      assert.equal(await page.locator(panel).isVisible(), false, panel);
    await page.context().close();
    const other = await open(`${server.url}?embed`);
    await other.getByText('No session is chosen.').waitFor();
    assert.equal(await other.locator('#list').isVisible(), false);
  });
});
