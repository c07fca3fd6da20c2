// The viewer in a real browser, against real servers and simulators.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { mkdtempSync, writeFileSync } from 'node:fs';
import { after, afterEach, before, describe, it } from 'node:test';
import validator from 'gltf-validator';
import { launch, missing, openPage, recordFrames, screenshot, surface } from './support/browser.mjs';
import { startServer, startSimulator, stopAll } from './support/programs.mjs';

const folder = mkdtempSync(join(tmpdir(), 'meniscus-web-'));

describe('the viewer', { skip: missing }, () => {
  let browser;
  let pages = [];

  before(async () => {
    browser = await launch();
  });
  after(async () => {
    await browser?.close();
  });
  afterEach(async () => {
    for (const page of pages) assert.deepEqual(page.errors, []);
    for (const page of pages) await page.context().close();
    pages = [];
    await stopAll();
  });

  async function open(url, options) {
    const page = await openPage(browser, options);
    pages.push(page);
    await page.goto(url);
    return page;
  }
  const link = (server, session) => `${server.url}#session=${session}`;
  const state = (page, kind) => page.waitForFunction((k) => document.getElementById('view').dataset.state === k, kind);
  const shows = (page, pattern) =>
    page.waitForFunction((source) => new RegExp(source).test(document.getElementById('banner').textContent), pattern.source);

  it('leads from the list of sessions to the first surface of 16,000 particles within 10 seconds', async () => {
    const server = await startServer();
    const page = await open(server.url);
    await page.waitForSelector('#no-sessions:not([hidden])');
    await screenshot(page, 'no-sessions');
    const { session } = startSimulator(server, { particles: 16000 });
    const entry = page.locator(`[data-session="${session}"]`);
    await entry.waitFor();
    await screenshot(page, 'sessions');
    const listed = performance.now();
    await entry.click();
    await surface(page);
    const fromList = performance.now() - listed;
    const opened = performance.now();
    const direct = await open(link(server, session));
    await surface(direct);
    const fromLink = performance.now() - opened;
    console.log(`first surface: ${fromList.toFixed(0)} ms from the list, ${fromLink.toFixed(0)} ms from a link`);
    assert.ok(fromLink < 10_000);
    await screenshot(direct, 'water');
    await direct.click('#look');
    await direct.waitForFunction(() => document.getElementById('look').getAttribute('aria-pressed') === 'true');
    await screenshot(direct, 'wireframe');
  });

  it('draws whole frames, in order, with the triangles that the server counted', async () => {
    const server = await startServer();
    const stats = join(folder, 'stats.json');
    const held = startSimulator(server, { frames: 1000 });
    const page = await open(link(server, held.session));
    await surface(page);
    await held.kill();
    // All of the tank, so that no brick of a later frame lies outside of the picture.
    await page.focus('#view');
    for (let i = 0; i < 5; ++i) await page.keyboard.press('-');
    await page.waitForFunction(() => /camera=/.test(location.hash));
    const camera = new URLSearchParams(new URL(page.url()).hash.slice(1)).get('camera');
    const simulator = startSimulator(server, { frames: 260, stats });
    const watching = await open(`${link(server, simulator.session)}&camera=${camera}`);
    await surface(watching);
    await recordFrames(watching);
    await simulator.ended;
    await state(watching, 'ended');
    await shows(watching, /session has ended/);
    await screenshot(watching, 'ended');
    const drawn = await watching.evaluate(() => window.drawn);
    const { frames } = JSON.parse(readFileSync(stats, 'utf8'));
    console.log(`${drawn.length} of ${frames.length} frames drawn`);
    assert.ok(drawn.length > 10);
    for (const [frame, triangles] of drawn) assert.equal(triangles, frames[frame].triangles, `frame ${frame}`);
    for (let i = 1; i < drawn.length; ++i) assert.ok(drawn[i][0] >= drawn[i - 1][0], `${drawn[i]} after ${drawn[i - 1]}`);
  });

  it('comes back by itself after the server was killed and started again', async () => {
    let server = await startServer();
    const first = startSimulator(server);
    const page = await open(link(server, first.session));
    await surface(page);
    await server.kill();
    await shows(page, /cannot be reached\. Trying again in \d+ s/);
    await screenshot(page, 'server-gone');
    await first.ended;
    server = await startServer({ ports: server.ports });
    await shows(page, /no such session|Trying again/);
    startSimulator(server, { session: first.session });
    await state(page, 'live');
    await page.waitForFunction(() => document.getElementById('banner').hidden);
  });

  it('says that a server shuts down', async () => {
    const server = await startServer();
    const simulator = startSimulator(server);
    const page = await open(link(server, simulator.session));
    await surface(page);
    await server.kill('SIGTERM');
    await shows(page, /shuts down|cannot be reached/);
    await screenshot(page, 'server-stopped');
  });

  it('skips frames in a slow tab and ends with the newest', async () => {
    const server = await startServer();
    const simulator = startSimulator(server, { frames: 300 });
    const page = await open(link(server, simulator.session));
    await surface(page);
    await recordFrames(page);
    // Four fifths of the page's time are taken away.
    await page.evaluate(() => {
      setInterval(() => {
        const end = performance.now() + 200;
        while (performance.now() < end);
      }, 250);
    });
    await simulator.ended;
    await state(page, 'ended');
    await page.waitForFunction(() => window.drawn.length > 0 && window.drawn.at(-1)[0] >= 298);
    const drawn = await page.evaluate(() => new Set(window.drawn.map(([frame]) => frame)).size);
    console.log(`slow tab: ${drawn} frames of 300 drawn`);
    assert.ok(drawn < 300);
  });

  it('asks for nothing while it is hidden', async () => {
    const server = await startServer();
    const simulator = startSimulator(server);
    const page = await open(link(server, simulator.session));
    await surface(page);
    const hide = (hidden) =>
      page.evaluate((value) => {
        Object.defineProperty(document, 'hidden', { value, configurable: true });
        document.dispatchEvent(new Event('visibilitychange'));
      }, hidden);
    await hide(true);
    await state(page, 'paused');
    await hide(false);
    await state(page, 'live');
  });

  it('pauses, steps and scrubs through what it has seen, and saves a GLB that the Khronos validator passes', async () => {
    const server = await startServer();
    const simulator = startSimulator(server);
    const page = await open(link(server, simulator.session));
    await surface(page);
    await page.waitForFunction(() => Number(document.getElementById('scrub').max) >= 5);
    await page.focus('#view');
    await page.keyboard.press(' ');
    await state(page, 'paused');
    const last = Number(await page.inputValue('#scrub'));
    const frame = () => page.evaluate(() => Number(document.getElementById('view').dataset.frame));
    await page.click('#back');
    await page.click('#back');
    assert.equal(Number(await page.inputValue('#scrub')), last - 2);
    await page.fill('#scrub', '0');
    const oldest = await page.waitForFunction((before) => {
      const now = Number(document.getElementById('view').dataset.frame);
      return now < before ? { now } : undefined;
    }, await frame()).then((handle) => handle.jsonValue());
    assert.ok(oldest.now >= 0);
    await screenshot(page, 'paused');

    const [download] = await Promise.all([page.waitForEvent('download'), page.click('#glb')]);
    const bytes = readFileSync(await download.path());
    const report = await validator.validateBytes(new Uint8Array(bytes));
    assert.deepEqual(report.issues.messages.filter(({ severity }) => severity < 2), []);
    const json = JSON.parse(bytes.subarray(20, 20 + bytes.readUInt32LE(12)).toString());
    const triangles = json.meshes.reduce((sum, mesh) => sum + json.accessors[mesh.primitives[0].indices].count / 3, 0);
    const shown = await page.evaluate(() => Number(document.getElementById('view').dataset.triangles));
    assert.equal(triangles, shown);
    const [ply] = await Promise.all([page.waitForEvent('download'), page.click('#ply')]);
    assert.match(readFileSync(await ply.path()).subarray(0, 400).toString('latin1'), new RegExp(`element face ${shown}\\n`));

    await page.click('#pause');
    await state(page, 'live');
  });

  it('moves by the keyboard, and its link reopens the same camera', async () => {
    const server = await startServer();
    const simulator = startSimulator(server);
    const page = await open(link(server, simulator.session));
    await surface(page);
    await page.focus('#view');
    for (const key of ['ArrowLeft', 'ArrowUp', '+', 'Shift+ArrowRight', 'w']) await page.keyboard.press(key);
    await page.waitForFunction(() => /camera=/.test(location.hash) && /look=levels/.test(location.hash));
    await page.waitForTimeout(300);
    const address = page.url();
    const again = await open(address);
    await surface(again);
    await again.focus('#view');
    await again.keyboard.press('m');
    await again.keyboard.press('w');
    await again.keyboard.press('w');
    await again.waitForFunction(() => /camera=/.test(location.hash));
    const camera = (text) => new URLSearchParams(new URL(text).hash.slice(1)).get('camera').split(',').map(Number);
    camera(again.url()).forEach((x, i) => assert.ok(Math.abs(x - camera(address)[i]) < 1e-4, again.url()));
  });

  it('gives fewer bits while the camera moves and the full mesh when it rests', async () => {
    const server = await startServer();
    const simulator = startSimulator(server);
    const page = await open(link(server, simulator.session));
    await surface(page);
    const quality = (text) => page.waitForFunction((words) => document.getElementById('quality').textContent.startsWith(words), text);
    await page.mouse.move(400, 300);
    await page.mouse.down();
    await page.mouse.move(460, 320, { steps: 4 });
    await quality('fewer bits');
    await page.mouse.up();
    await quality('full');
    await state(page, 'live');
  });

  it('asks for the token that the server wants, again if it is wrong', async () => {
    const tokens = join(folder, 'tokens');
    writeFileSync(tokens, 'watcher eve token-of-eve-0123456789\nadmin root token-of-root-0123456789\n', { mode: 0o600 });
    const server = await startServer({ args: ['--tokens', tokens] });
    const page = await open(server.url);
    await page.waitForSelector('#token-dialog[open]');
    await screenshot(page, 'token');
    await page.fill('#token', 'wrong-token-0123456789');
    await page.keyboard.press('Enter');
    await page.waitForFunction(() => document.getElementById('token-dialog').open && document.getElementById('token').value === '');
    await page.fill('#token', 'token-of-eve-0123456789');
    await page.keyboard.press('Enter');
    await page.waitForSelector('#no-sessions:not([hidden])');
  });

  it('fits a phone, in the dark', async () => {
    const server = await startServer();
    const simulator = startSimulator(server);
    const page = await open(link(server, simulator.session), { viewport: { width: 360, height: 740 }, colorScheme: 'dark', hasTouch: true });
    await surface(page);
    const wide = await page.evaluate(() => document.documentElement.scrollWidth);
    assert.ok(wide <= 360, `the page is ${wide} pixels wide`);
    await screenshot(page, 'phone-dark');
    const unnamed = await page.evaluate(() =>
      [...document.querySelectorAll('button, input, canvas')].filter((e) => !(e.textContent.trim() || e.ariaLabel || e.labels?.length)).map((e) => e.id),
    );
    assert.deepEqual(unnamed, []);
  });

  it('says what is missing in a browser without WebGL', async () => {
    const server = await startServer();
    const plain = await launch('--disable-gpu', '--disable-3d-apis');
    try {
      const page = await openPage(plain);
      await page.goto(server.url);
      await page.waitForFunction(() => /does not offer WebGL 2/.test(document.getElementById('banner').textContent));
      await screenshot(page, 'no-webgl');
    } finally {
      await plain.close();
    }
  });
});
