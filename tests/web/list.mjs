import assert from 'node:assert/strict';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { describe, it } from 'node:test';
import { missing, screenshot } from './support/browser.mjs';
import { answer, protobuf } from './support/grpc_web.mjs';
import { startServer } from './support/programs.mjs';
import { startReplay } from './support/recording.mjs';
import { link, open, says, state, surface } from './support/viewer.mjs';

const id = (n) => `00000000-0000-4000-8000-00000000000${n}`;
/** In microseconds, as the contract has times. */
const now = () => Date.now() * 1000;
/** As in session_service.proto. */
const session = (n, name, uploading, createdAt) =>
  protobuf([1, id(n)], [3, Number(uploading)], [5, 12], [12, protobuf([1, name])], [13, createdAt]);
const hostile = '<img src=x onerror="document.title=1">';
const arabic = 'كسر السد';

describe('the list', { skip: missing }, () => {
  it('has names as they are, live sessions first, and what is searched for', async () => {
    const server = await startServer();
    const page = await open();
    const listed = [
      session(1, hostile, false, now() - 90e6),
      session(2, arabic, true, now() - 7200e6),
      session(3, 'wave tank', false, now() - 5e6),
    ];
    await page.route('**/ListSessions', (route) =>
      route.fulfill(answer(protobuf(...listed.map((bytes) => [1, bytes])))),
    );
    await page.route('**/GetSession', (route) => route.fulfill(answer(protobuf([1, listed[2]]))));
    await page.goto(server.url);
    const cards = page.locator('#sessions > li');
    await cards.nth(2).waitFor();
    assert.deepEqual(await page.locator('#sessions bdi').allInnerTexts(), [arabic, 'wave tank', hostile]);
    assert.deepEqual(await page.locator('#sessions .live:visible').count(), 1);
    assert.match(await cards.nth(2).innerText(), /not streaming, 12 frames, .*made 1 min ago/);
    await screenshot(page, 'list-names');

    await page.fill('#search', 'TANK');
    await cards.nth(1).waitFor({ state: 'detached' });
    assert.equal(await cards.count(), 1);
    await page.fill('#search', 'tanks');
    await page.waitForSelector('#no-match:not([hidden])');
    await page.fill('#search', '');
    const entry = page.locator(`[data-session="${id(3)}"]`);
    await entry.focus();
    // The next list leaves the focus where it is, and its order does.
    listed.push(session(4, 'new', true, now()));
    await page.locator(`[data-session="${id(4)}"]`).waitFor();
    assert.equal(await page.evaluate(() => document.activeElement.dataset.session), id(3));
    await entry.click();
    await page.waitForFunction(() => document.title === 'wave tank – Meniscus');
    assert.equal(await page.locator('#title').innerText(), 'wave tank');
    await page.click('#leave');
    await page.waitForFunction(() => document.title === 'Meniscus');
  });

  it('has a picture of the newest mesh, asked for once in a while, and frames a second', async () => {
    const server = await startServer();
    const { session } = await startReplay(server);
    const page = await open(undefined, { colorScheme: 'dark', viewport: { width: 1200, height: 750 } });
    const asked = [];
    page.on('request', (request) => {
      if (/\/(Snapshot|Watch)$/.test(request.url())) asked.push([new URL(request.url()).pathname, performance.now()]);
    });
    await page.goto(server.url);
    const card = page.locator(`[data-session="${session}"]`);
    await card.locator('.thumbnail[data-drawn]').waitFor();
    await card.getByText(/[0-9.]+ frames\/s/).waitFor();
    const colors = await card.locator('.thumbnail').evaluate((canvas) => {
      const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
      return new Set(new Uint32Array(data.buffer)).size;
    });
    assert.ok(colors > 100, `${colors} colors`);
    await screenshot(page, 'list-pictures-dark');
    await page.click('#theme');
    await card.locator('.thumbnail[data-drawn="2"]').waitFor();
    await screenshot(page, 'list-pictures-light');
    assert.deepEqual(
      asked.map(([path]) => path),
      ['/meniscus.v1.SurfaceService/Snapshot', '/meniscus.v1.SurfaceService/Snapshot'],
    );
  });

  it('has another text for an address that cannot be than for a session that has gone', async () => {
    const server = await startServer();
    const page = await open(`${server.url}#session=0000-not-a-uuid`);
    await page.getByText('names the session "0000-not-a-uuid", which cannot be').waitFor();
    await page.waitForSelector('#no-sessions:not([hidden])');
    await screenshot(page, 'address-problem');
    const other = await open(link(server, id(1)));
    await says(other, /There is no such session: it has ended, or has not begun/);
  });
});

describe('a session', { skip: missing }, () => {
  it('is live while it is streamed; when it has ended, that and its time are said, and its recording is offered', async () => {
    const folder = mkdtempSync(join(tmpdir(), 'meniscus-web-'));
    try {
      const server = await startServer({ args: ['--record', folder] });
      const page = await open(link(server, id(1)), { viewport: { width: 480, height: 400 } });
      await state(page, 'absent');
      const replay = await startReplay(server, { session: id(1), frames: 60, loop: false });
      await page.locator('#liveness', { hasText: /^Live$/ }).waitFor();
      await surface(page);
      await screenshot(page, 'live');
      await replay.finished();
      await page.locator('#liveness', { hasText: /^Ended [0-9:]{8}$/ }).waitFor();
      await says(page, /has ended at [0-9:]{8}/);
      await page.locator('#open-recording').waitFor();
      await screenshot(page, 'ended');
      await page.click('#open-recording');
      await state(page, 'live');
      await surface(page);
      assert.match(page.url(), new RegExp(`#recording=${replay.session}/1`));
      assert.equal(await page.locator('#open-recording').isVisible(), false);

      // An address in the older form leads there, too.
      await page.context().close();
      const later = await open(link(server, replay.session));
      await later.locator('#open-recording').waitFor();
    } finally {
      rmSync(folder, { recursive: true });
    }
  });
});
