import assert from 'node:assert/strict';
import { cpSync, mkdtempSync, readdirSync, readFileSync, renameSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, afterEach, before, describe, it } from 'node:test';
import { pathToFileURL } from 'node:url';
import { missing, screenshot } from './support/browser.mjs';
import { hosts, startHost } from './support/plain_host.mjs';
import { run, startPublisher, startServer, startSimulator } from './support/programs.mjs';
import { recordedFile } from './support/recording.mjs';
import { open, recordFrames, says, shown, state, stepBack, surface } from './support/viewer.mjs';

describe('a publication', { skip: missing }, () => {
  let folder;
  let triangles;
  let host;
  before(async () => {
    folder = mkdtempSync(join(tmpdir(), 'meniscus-web-'));
    const recorded = await recordedFile();
    ({ triangles } = recorded);
    const publish = (...args) => run(['publish', recorded.file, '--end', '39', '-q', '--name', 'tank', ...args]);
    await publish('--to', join(folder, 'site'), '--page');
    await publish('--to', join(folder, 'one.html'), '--single-file');
    await publish('--to', join(folder, 'plain'));
    // The viewer alone, for publications elsewhere.
    cpSync(join(folder, 'site', 'assets'), join(folder, 'viewer', 'assets'), { recursive: true });
    const page = readFileSync(join(folder, 'site', 'index.html'), 'utf8');
    writeFileSync(join(folder, 'viewer', 'index.html'), page.replace(/<meta name="meniscus-publication"[^>]*>/, ''));
  });
  after(() => rmSync(folder, { recursive: true }));
  afterEach(() => {
    host?.stop();
    host = undefined;
  });

  const shows = async (page, frame) => {
    await page.waitForFunction((wanted) => Number(document.getElementById('view').dataset.frame) === wanted, frame);
    assert.deepEqual(await shown(page), { frame, triangles: triangles[frame] });
  };

  it('is a web site on any host, which plays, scrubs, and reopens by its link', async () => {
    host = await startHost(folder);
    const page = await open(`${host.url}site/`);
    await surface(page);
    await state(page, 'live');
    assert.equal(await page.title(), 'tank – Meniscus');
    assert.equal(await page.locator('#leave').isVisible(), false);
    await stepBack(page);
    for (const frame of [31, 3, 38, 17]) {
      await page.fill('#scrub', String(frame));
      await shows(page, frame);
    }
    await state(page, 'paused');
    await page.selectOption('#speed', '4');
    await page.click('#loop');
    assert.match(page.url(), /site\/#position=17&speed=4&loop=on&camera=/);
    await screenshot(page, 'publication');
    await page.reload();
    await shows(page, 17);
    assert.equal(await page.inputValue('#speed'), '4');
    // It begins again after the last frame.
    await page.fill('#scrub', '36');
    await shows(page, 36);
    await recordFrames(page);
    await page.click('#pause');
    await page.waitForFunction(() => window.drawn.some(([frame]) => frame < 10));
    assert.ok(
      host.asked.every((path) => path.startsWith('/site/')),
      host.asked.join(),
    );
  });

  for (const [name, rules] of Object.entries(hosts).filter(([each]) => each !== 'plain'))
    it(`is a web site by the rules of ${name}, and found again there after a change`, async () => {
      const site = join(folder, 'changing');
      rmSync(site, { recursive: true, force: true });
      cpSync(join(folder, 'site'), site, { recursive: true });
      host = await startHost(folder, rules);
      const page = await open(`${host.url}changing/#position=7`);
      await shows(page, 7);
      await page.fill('#scrub', '29');
      await shows(page, 29);
      assert.deepEqual(
        host.asked.filter((path) => !path.startsWith(`/${rules.under}changing/`)),
        [],
      );
      // A later run: whatever caches keep of the manifest, the page asks for it.
      const manifest = JSON.parse(readFileSync(join(site, 'manifest.json'), 'utf8'));
      const [first] = manifest.segments.splice(1);
      manifest.frames = String(manifest.segments[0].frames);
      manifest.bytes = String(manifest.segments[0].bytes);
      assert.ok(first);
      writeFileSync(join(site, 'manifest.json'), JSON.stringify(manifest));
      await page.reload();
      await page.waitForFunction((most) => document.getElementById('scrub').max === most, `${manifest.frames - 1}`);
    });

  it('is played from the address that a link names, and says what is wrong with one', async () => {
    host = await startHost(folder);
    const page = await open(`${host.url}viewer/?publication=../plain/#position=20`);
    await shows(page, 20);
    await page.goto(`${host.url}viewer/?publication=../nothing/`);
    await says(page, /There is no manifest\.json at 127\.0\.0\.1/);
    writeFileSync(join(folder, 'other.json'), '{"frames": 3}');
    await page.goto(`${host.url}viewer/?publication=../other.json`);
    await says(page, /The publication cannot be read: this is not the manifest of a publication/);
    const broken = join(folder, 'broken');
    cpSync(join(folder, 'plain'), broken, { recursive: true });
    for (const name of readdirSync(broken).filter((file) => file.endsWith('.segment')))
      writeFileSync(join(broken, name), readFileSync(join(broken, name)).reverse());
    await page.goto(`${host.url}viewer/?publication=../broken/`);
    await says(page, /The publication cannot be read: [0-9a-f]{64}\.segment: it does not have the SHA-256/);
  });

  it('is one file, which opens without a network', async () => {
    const page = await open(undefined, { offline: true });
    const asked = [];
    page.on('request', (request) => asked.push(request.url()));
    await page.goto(`${pathToFileURL(join(folder, 'one.html'))}#position=25`);
    await shows(page, 25);
    await page.fill('#scrub', '9');
    await shows(page, 9);
    assert.deepEqual(
      asked.filter((url) => !/^(file|blob|data):/.test(url)),
      [],
    );
    await screenshot(page, 'publication-single-file');
  });

  it('is shown in a page of somebody else, and on a phone', async () => {
    writeFileSync(
      join(folder, 'paper.html'),
      '<!doctype html><h1>Paper</h1><iframe src="site/?embed#position=12" width="400" height="300"></iframe>',
    );
    host = await startHost(folder);
    const page = await open(`${host.url}paper.html`);
    const frame = page.frameLocator('iframe');
    await frame.locator('#view[data-frame="12"]').waitFor();
    assert.equal(await frame.locator('#scrub').isVisible(), false);
    const phone = await open(`${host.url}site/#position=12`, { viewport: { width: 390, height: 780 }, hasTouch: true });
    await shows(phone, 12);
    for (const id of ['pause', 'scrub', 'speed', 'loop']) {
      const { x, width } = await phone.locator(`#${id}`).boundingBox();
      assert.ok(x >= 0 && x + width <= 390, `${id} is on the screen`);
    }
    await screenshot(phone, 'publication-phone');
  });

  it('is followed while it grows, and goes on after a publisher that was killed', async () => {
    const server = await startServer();
    const simulator = startSimulator(server, { particles: 1000 });
    const to = join(folder, 'live');
    host = await startHost(folder);
    await simulator.begun();
    const first = await startPublisher(server, simulator.session, to);
    const page = await open(`${host.url}viewer/?publication=../live/`);
    await surface(page);
    await recordFrames(page);
    const grows = (by) =>
      page.waitForFunction((more) => {
        window.seen ??= window.drawn.at(-1)?.[0];
        return window.drawn.at(-1)?.[0] >= window.seen + more;
      }, by);
    await grows(10);
    await first.kill();
    const published = JSON.parse(readFileSync(join(to, 'manifest.json'), 'utf8')).segments;
    // A host that has lost its manifest for a while.
    renameSync(join(to, 'manifest.json'), join(to, 'away.json'));
    await says(page, /There is no manifest\.json/);
    renameSync(join(to, 'away.json'), join(to, 'manifest.json'));
    await state(page, 'live');
    const second = await startPublisher(server, simulator.session, to);
    await grows(60);
    await second.kill();
    await simulator.kill();
    const drawn = (await page.evaluate(() => window.drawn)).map(([frame]) => frame);
    assert.deepEqual(
      [...drawn].sort((a, b) => a - b),
      drawn,
    );
    const { segments, live } = JSON.parse(readFileSync(join(to, 'manifest.json'), 'utf8'));
    assert.equal(live, true);
    assert.deepEqual(segments.slice(0, published.length), published, 'what was published stays');
    for (let i = 1; i < segments.length; ++i)
      assert.ok(Number(segments[i].first_frame) > Number(segments[i - 1].last_frame), 'no frame comes twice');
  });

  it('is followed from the server that publishes it, through the death of its simulator', async () => {
    const server = await startServer({ args: ['--publish'] });
    const first = startSimulator(server, { particles: 1000, publish: true });
    const { session } = first;
    await first.begun();
    const page = await open(`${server.url}?publication=/publications/${session}/`);
    await surface(page);
    await recordFrames(page);
    const manifests = [];
    const look = async () => {
      const answer = await fetch(`${server.url}publications/${session}/manifest.json`);
      assert.equal(answer.status, 200);
      manifests.push(await answer.json());
      return manifests.at(-1);
    };
    const drawn = (wanted) => page.waitForFunction((count) => window.drawn.length >= count, wanted);
    await drawn(20);
    await first.kill();
    const before = await look();
    const second = startSimulator(server, { session, particles: 1000, publish: true });
    await second.begun();
    const runs = (manifest) => new Set(manifest.segments.map(({ run_id }) => run_id)).size;
    while (runs(await look()) < 2) await page.waitForEvent('response');
    await page.waitForFunction((last) => {
      window.again ??= window.drawn.findIndex(([frame], i) => i > 0 && frame < window.drawn[i - 1][0]);
      if (window.again < 0) window.again = undefined;
      return window.again !== undefined && window.drawn.length >= window.again + last;
    }, 20);
    await second.kill();
    const { segments, live } = await look();
    assert.equal(live, true, 'its session waits for another simulator');
    // Listed segments stay listed, in their order.
    for (const { segments: earlier } of manifests)
      assert.deepEqual(
        earlier.map(({ sha256 }) => sha256),
        segments.slice(0, earlier.length).map(({ sha256 }) => sha256),
      );
    assert.ok(before.segments.length > 0);
    // Each frame that was reconstructed is there once, of both simulators.
    for (const [i, { run_id, frames, first_frame, last_frame }] of segments.entries()) {
      assert.equal(Number(last_frame) - Number(first_frame) + 1, frames);
      const previous = segments[i - 1];
      assert.equal(Number(first_frame), previous?.run_id === run_id ? Number(previous.last_frame) + 1 : 0);
    }
    const shown = (await page.evaluate(() => window.drawn)).map(([frame]) => frame);
    const backward = shown.filter((frame, i) => i > 0 && frame < shown[i - 1]);
    assert.equal(backward.length, 1, `once, with the second simulator: ${shown.join()}`);
    await screenshot(page, 'publication-of-the-server');
    await run(['sessions', '--server', server.address, '--delete', session]);
    await says(page, /There is no manifest\.json/);
  });

  it('is for those who may watch, and asks them for a token', async () => {
    const tokens = join(folder, 'tokens');
    writeFileSync(tokens, 'admin ada token-of-ada-0123456789\n', { mode: 0o600 });
    const server = await startServer({ args: ['--publish', '--tokens', tokens] });
    process.env.MENISCUS_TOKEN = 'token-of-ada-0123456789';
    const simulator = startSimulator(server, { particles: 1000, publish: true });
    delete process.env.MENISCUS_TOKEN;
    await simulator.begun();
    const page = await open(`${server.url}?publication=/publications/${simulator.session}/`);
    await page.waitForSelector('#token-dialog[open]');
    await page.fill('#token', 'token-of-ada-0123456789');
    await page.press('#token', 'Enter');
    await surface(page);
    await state(page, 'live');
  });
});
