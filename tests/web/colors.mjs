import assert from 'node:assert/strict';
import { mkdtempSync, readdirSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { describe, it } from 'node:test';
import { missing, screenshot } from './support/browser.mjs';
import { readPng, save } from './support/files.mjs';
import { vertexProperties, verticesOfPly } from './support/meshes.mjs';
import { run, startServer, startUploader } from './support/programs.mjs';
import { link, open, surface } from './support/viewer.mjs';

const small = { viewport: { width: 800, height: 480 } };
const speedOf = ([x, y, z]) => Math.hypot(x, y, z);
const velocities = (ply) => vertexProperties(ply, ['velocity_x', 'velocity_y', 'velocity_z']);
/** "velocity, magnitude: 0.1 to 2.5" */
const ends = (legend) => /: (\S+) to (\S+)$/.exec(legend).slice(1).map(Number);
const legend = (page) => page.getAttribute('#annotations', 'data-legend');
const colored = (page, pattern) =>
  page.waitForFunction(
    (source) => new RegExp(source).test(document.getElementById('annotations').dataset.legend ?? ''),
    pattern.source,
  );

/** A session that stays with its last frame, the same in every run, and that frame as the command line receives it, exactly. */
async function restingSession(server, folder) {
  const args =
    'simulate --scene dam-break --particles 1500 --frames 30 --attribute velocity --attribute age --keep-session';
  const { session, finished } = startUploader(server, args.split(' '));
  await finished();
  const to = mkdtempSync(join(folder, 'received-'));
  const watch = ['watch', session, '--server', server.address, '-o', to, '--frames', '1'];
  await run([...watch, '--format', 'ply', '--attribute', 'velocity', '--attribute-bits', '0']);
  const [name] = readdirSync(to);
  return { session, ply: readFileSync(join(to, name)) };
}

describe('colors', { skip: missing }, () => {
  it('show speeds with their legend, which the probe and the saved mesh agree with', async () => {
    const folder = mkdtempSync(join(tmpdir(), 'meniscus-web-'));
    try {
      const server = await startServer();
      const { session, ply } = await restingSession(server, folder);
      const places = verticesOfPly(ply);
      const known = velocities(ply);
      const speeds = known.map(speedOf);
      const [slowest, fastest] = [Math.min(...speeds), Math.max(...speeds)];
      // Twelve bits of a range that is rounded outward, and what the legend is rounded to.
      const near = (a, b) => assert.ok(Math.abs(a - b) < 0.003 * fastest, `${a}, not ${b}`);
      const top = places.reduce((best, place, i) => (place[1] > places[best][1] ? i : best), 0);
      const camera = [places[top][0] + 0.1, places[top][1] + 2, places[top][2] + 0.2, ...places[top]];
      const page = await open(`${link(server, session)}&camera=${camera}&color=velocity&map=plasma`, small);
      await surface(page);
      await colored(page, /^velocity, magnitude:/);
      const [low, high] = ends(await legend(page));
      near(low, slowest);
      near(high, fastest);

      await page.click('#probe');
      await page.click('#probe-middle');
      const value = page.locator('#probe-value', { hasText: /\d/ });
      near(Number(await value.innerText()), speeds[top]);
      assert.equal(await page.locator('#probe-title').innerText(), 'velocity, magnitude');
      await screenshot(page, 'colors');

      const saved = velocities((await save(page, '#ply')).bytes).map(speedOf);
      near(Math.min(...saved), slowest);
      near(Math.max(...saved), fastest);

      await page.click('#color');
      await page.selectOption('#color-component', 'y');
      await colored(page, /^velocity\.y:/);
      await page.locator('#probe-title', { hasText: 'velocity.y' }).waitFor();
      near(Number(await value.innerText()), known[top][1]);
      const [least, greatest] = ends(await legend(page));
      near(least, Math.min(...known.map(([, y]) => y)));
      near(greatest, Math.max(...known.map(([, y]) => y)));
      await page.selectOption('#color-range', 'hand');
      await page.fill('#color-low', '-1');
      await page.fill('#color-high', '3');
      await page.keyboard.press('Enter');
      await colored(page, /: -1 to 3$/);
      const fields = new URLSearchParams(new URL(page.url()).hash.slice(1));
      assert.deepEqual(
        ['color', 'map', 'range'].map((name) => fields.get(name)),
        ['velocity.y', 'plasma', '-1,3'],
      );
      await page.reload();
      await surface(page);
      await colored(page, /^velocity\.y: -1 to 3$/);
      await page.click('#color');
      await page.fill('#color-unit', 'm/s');
      await page.keyboard.press('Enter');
      await colored(page, /^velocity\.y \(m\/s\): -1 to 3$/);
      // Below all values: without light every point has the map's first color.
      await page.fill('#color-high', '200');
      await page.fill('#color-low', '100');
      await page.keyboard.press('Enter');
      await colored(page, /: 100 to 200$/);
      const grid = Array.from({ length: 900 }, (_, i) => [((i % 30) + 0.5) / 30, (Math.floor(i / 30) + 0.5) / 30]);
      const picture = async () => (await readPng(page, (await save(page, '#picture')).bytes, grid)).colors.map(String);
      const plasma = String([13, 8, 135, 255]);
      const lit = await picture();
      await page.check('#color-unlit');
      // All but its edges, which are blended with what is behind them.
      const water = (await picture()).filter((color, i) => color !== lit[i]);
      const plain = water.filter((color) => color === plasma);
      assert.ok(water.length >= 20 && plain.length >= 0.9 * water.length, `${plain.length} of ${water.length}`);
      assert.match(page.url(), /&unit=m\/s&light=off/);
      await page.selectOption('#color-attribute', '');
      await page.waitForFunction(() => document.getElementById('annotations').dataset.legend === undefined);
      assert.equal(new URLSearchParams(new URL(page.url()).hash.slice(1)).get('color'), null);
    } finally {
      rmSync(folder, { recursive: true });
    }
  });

  it('show what a recording has, frame by frame, and its link reopens them', async () => {
    const folder = mkdtempSync(join(tmpdir(), 'meniscus-web-'));
    try {
      const server = await startServer({ args: ['--record', folder] });
      const args = 'simulate --scene dam-break --particles 800 --frames 12 --attribute velocity --out';
      const local = join(folder, 'local');
      const simulator = startUploader(server, [...args.split(' '), local]);
      await simulator.finished();
      // The speeds of a frame's vertices, as the simulator received them.
      const fastest = (frame) => {
        const file = join(local, `frame_${String(frame).padStart(6, '0')}.ply`);
        return Math.max(...velocities(readFileSync(file)).map(speedOf));
      };
      const page = await open(server.url, small);
      await page.locator(`[data-recording="${simulator.session}/1"]`).click();
      await page.waitForFunction(() => Number(document.getElementById('view').dataset.frame) >= 2);
      const shows = async (frame) => {
        await page.waitForFunction((wanted) => Number(document.getElementById('view').dataset.frame) === wanted, frame);
        await page.waitForFunction(
          ([pattern, wanted]) => {
            const found = new RegExp(pattern).exec(document.getElementById('annotations').dataset.legend ?? '');
            return found && Math.abs(Number(found[1]) - wanted) < 0.01 * wanted;
          },
          ['^velocity, magnitude: \\S+ to (\\S+)$', fastest(frame)],
        );
      };
      await page.click('#color');
      await page.selectOption('#color-attribute', 'velocity');
      await page.selectOption('#color-range', 'frame');
      for (const frame of [3, 11]) {
        await page.fill('#scrub', String(frame));
        await shows(frame);
      }
      assert.ok(fastest(11) > 1.5 * fastest(3), 'or both frames have one legend');
      assert.match(page.url(), /#recording=.*color=velocity/);
      await page.reload();
      await shows(11);
      await screenshot(page, 'colored-recording');
    } finally {
      rmSync(folder, { recursive: true });
    }
  });

  it('that a session does not have are reported in the panel, and its own are offered', async () => {
    const server = await startServer();
    const args = 'simulate --scene dam-break --particles 500 --frames 10 --attribute age --keep-session';
    const simulator = startUploader(server, args.split(' '));
    await simulator.finished();
    const page = await open(`${link(server, simulator.session)}&color=pressure`, small);
    await surface(page);
    await page.getByText('This session has no attribute "pressure".').waitFor();
    const offered = () => page.locator('#color-attribute option').evaluateAll((all) => all.map(({ value }) => value));
    assert.deepEqual(await offered(), ['', 'age', 'pressure']);
    await page.selectOption('#color-attribute', 'age');
    await colored(page, /^age:/);
    assert.deepEqual(await offered(), ['', 'age']);
  });
});
