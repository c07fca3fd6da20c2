import assert from 'node:assert/strict';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { describe, it } from 'node:test';
import { launch, missing, openPage, screenshot } from './support/browser.mjs';
import { startServer, startSimulator } from './support/programs.mjs';
import { startReplay } from './support/recording.mjs';
import { link, open, says, shown, state, surface } from './support/viewer.mjs';

describe('errors', { skip: missing }, () => {
  it('of a server that was killed pass by themselves when it is back', async () => {
    let server = await startServer();
    const simulator = startSimulator(server, { particles: 1000 });
    const page = await open(link(server, simulator.session));
    await surface(page);
    await server.kill();
    await says(page, /cannot be reached\. Trying again in \d+ s/);
    await screenshot(page, 'server-gone');
    // The simulator goes on by itself, too.
    server = await startServer({ ports: server.ports });
    await state(page, 'live');
    const { frame } = await shown(page);
    await page.waitForFunction((before) => Number(document.getElementById('view').dataset.frame) !== before, frame);
    await page.waitForSelector('#banner', { state: 'hidden' });
  });

  it('of the list of sessions pass as well', async () => {
    let server = await startServer();
    const page = await open(server.url);
    await page.waitForSelector('#no-sessions:not([hidden])');
    await server.kill();
    await says(page, /cannot be reached\. Trying again in \d+ s/);
    server = await startServer({ ports: server.ports });
    await page.waitForSelector('#banner', { state: 'hidden' });
  });

  it('say that a server shuts down', async () => {
    const server = await startServer();
    const simulator = await startReplay(server);
    const page = await open(link(server, simulator.session));
    await surface(page);
    await server.kill('SIGTERM');
    await says(page, /shuts down|cannot be reached/);
    await screenshot(page, 'server-stopped');
  });

  it('say that a session is not there, and offer those that are', async () => {
    const server = await startServer();
    const { session } = await startReplay(server);
    const page = await open(link(server, '00000000-0000-4000-8000-000000000000'));
    await says(page, /There is no such session.*Trying again in/);
    const offered = page.locator(`#session-offer [data-session="${session}"]`);
    await offered.waitFor();
    // Figures of nothing are none.
    assert.equal(await page.locator('#overlay').isVisible(), false);
    await screenshot(page, 'no-such-session');
    await offered.click();
    await surface(page);
    assert.match(page.url(), new RegExp(`#session=${session}`));
    assert.equal(await page.locator('#session-offer').isVisible(), false);
    assert.equal(await page.locator('#overlay').isVisible(), true);
  });

  it('ask for the token that the server wants, again if it is wrong, and after a no', async () => {
    const folder = mkdtempSync(join(tmpdir(), 'meniscus-web-'));
    try {
      const tokens = join(folder, 'tokens');
      writeFileSync(tokens, 'watcher eve token-of-eve-0123456789\nadmin root token-of-root-0123456789\n', {
        mode: 0o600,
      });
      const server = await startServer({ args: ['--tokens', tokens] });
      const page = await open(server.url);
      await page.waitForSelector('#token-dialog[open]');
      await screenshot(page, 'token');
      await page.fill('#token', 'wrong-token-0123456789');
      await page.keyboard.press('Enter');
      // What was entered stays, to be mended; what is wrong is said once.
      await page.locator('#token-heading', { hasText: 'Another token is needed' }).waitFor();
      assert.equal(await page.inputValue('#token'), 'wrong-token-0123456789');
      assert.equal(await page.getByText('The server does not know this token.').filter({ visible: true }).count(), 1);
      assert.equal(await page.locator('#banner').isVisible(), false);
      await page.click('#token-cancel');
      await page.waitForSelector('#token-dialog', { state: 'hidden' });
      await says(page, /does not know this token/);
      await screenshot(page, 'token-refused');
      await page.click('#ask-token');
      await page.fill('#token', 'token-of-eve-0123456789');
      await page.keyboard.press('Enter');
      await page.waitForSelector('#no-sessions:not([hidden])');
      assert.equal(await page.locator('#banner').isVisible(), false);
    } finally {
      rmSync(folder, { recursive: true });
    }
  });

  it('say that the browser has taken the graphics away, and pass when it gives them back', async () => {
    const server = await startServer();
    const simulator = await startReplay(server);
    const page = await open(link(server, simulator.session));
    await surface(page);
    const handle = await page.evaluateHandle(() =>
      document.getElementById('view').getContext('webgl2').getExtension('WEBGL_lose_context'),
    );
    await handle.evaluate((extension) => extension.loseContext());
    await page.getByText('taken the graphics away').waitFor();
    await screenshot(page, 'graphics-lost');
    await handle.evaluate((extension) => extension.restoreContext());
    await page.getByText('taken the graphics away').waitFor({ state: 'hidden' });
    const { frame } = await shown(page);
    await page.waitForFunction((before) => Number(document.getElementById('view').dataset.frame) > before, frame);
    assert.ok((await shown(page)).triangles > 0);
  });

  it('name what is missing in a browser without WebGL', async () => {
    const server = await startServer();
    const plain = await launch('--disable-gpu', '--disable-3d-apis');
    try {
      const page = await openPage(plain);
      await page.goto(server.url);
      await says(page, /does not offer WebGL 2/);
      await screenshot(page, 'no-webgl');
      assert.deepEqual(page.errors, []);
    } finally {
      await plain.close();
    }
  });
});
