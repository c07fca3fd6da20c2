import assert from 'node:assert/strict';
import { describe, it } from 'node:test';
import { missing, screenshot } from './support/browser.mjs';
import { startServer, startSimulator } from './support/programs.mjs';
import { startReplay } from './support/recording.mjs';
import { link, open, shown, surface } from './support/viewer.mjs';

/** ms: software drawing, on a core that the simulator and the server share. */
const limit = 10_000;

describe('the first surface', { skip: missing }, () => {
  it('of 16,000 particles is there within ten seconds, from the list and from a link', async () => {
    const server = await startServer();
    const page = await open(server.url);
    await page.waitForSelector('#no-sessions:not([hidden])');
    await screenshot(page, 'list-empty');
    const command = await page.locator('#fill-command').innerText();
    assert.match(command, /^meniscus simulate .* --server 127\.0\.0\.1$/);
    const { session } = startSimulator(server, { particles: 16000 });
    const entry = page.locator(`[data-session="${session}"]`);
    await entry.waitFor();
    await screenshot(page, 'list');
    const listed = performance.now();
    await entry.click();
    await surface(page);
    const fromList = performance.now() - listed;
    await page.context().close();
    const opened = performance.now();
    const direct = await open(link(server, session));
    await surface(direct);
    const fromLink = performance.now() - opened;
    console.log(
      `first surface of 16,000 particles: ${fromList.toFixed(0)} ms from the list, ${fromLink.toFixed(0)} ms from a link`,
    );
    assert.ok(fromList < limit && fromLink < limit);
  });

  it('looks like water, and like wires colored by level', async () => {
    const server = await startServer();
    const simulator = startSimulator(server, { particles: 4000 });
    const page = await open(link(server, simulator.session), { viewport: { width: 1200, height: 750 } });
    await page.waitForFunction(() => Number(document.getElementById('view').dataset.frame) > 40);
    await page.click('#pause');
    await simulator.kill();
    await screenshot(page, 'water-light');
    await page.click('#theme');
    await screenshot(page, 'water-dark');
    await page.click('#look');
    await screenshot(page, 'wireframe-dark');
    await page.click('#theme');
    await screenshot(page, 'wireframe-light');
  });

  it('gives way to the particles that it was made of, asked for only while they are shown', async () => {
    const server = await startServer();
    const { session } = await startReplay(server);
    const page = await open(link(server, session), { viewport: { width: 1200, height: 750 } });
    await surface(page);
    const calls = [];
    page.on('request', (request) => {
      if (request.url().endsWith('/WatchParticles')) calls.push(request);
    });
    await page.waitForFunction(() => Number(document.getElementById('view').dataset.frame) > 30);
    assert.equal(calls.length, 0);
    await page.focus('#view');
    await page.keyboard.press('p');
    await page.waitForFunction(
      () => document.getElementById('view').dataset.particles === document.getElementById('view').dataset.frame,
    );
    assert.equal(await page.getAttribute('#show-particles', 'aria-pressed'), 'true');
    await screenshot(page, 'particles-light');
    await page.click('#theme');
    await page.click('#look');
    await screenshot(page, 'particles-wireframe-dark');
    await page.click('#look');
    await screenshot(page, 'particles-dark');
    const ended = page.waitForEvent('requestfailed', (request) => request === calls[0]);
    await page.click('#show-particles');
    await ended;
    await surface(page);
    assert.equal(calls.length, 1);
    assert.equal(await page.getAttribute('#view', 'data-particles'), null);
  });

  it('of another session has nothing of the one before', async () => {
    const server = await startServer();
    const [first, second] = [await startReplay(server), await startReplay(server)];
    const page = await open(link(server, first.session));
    await surface(page);
    await page.click('#pause');
    await page.click('#leave');
    const entry = page.locator(`[data-session="${second.session}"]`);
    await entry.waitFor();
    await second.kill();
    await entry.click();
    await surface(page);
    assert.equal(await page.locator('#title').innerText(), second.session);
    assert.equal(await page.inputValue('#scrub'), '0');
    assert.equal(await page.evaluate(() => document.activeElement.id), 'view');
    const { frame } = await shown(page);
    assert.match(await page.locator('#frame').innerText(), new RegExp(`^${frame.toLocaleString('en-US')}\\b`));
  });
});
