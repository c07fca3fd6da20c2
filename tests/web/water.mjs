import assert from 'node:assert/strict';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { describe, it } from 'node:test';
import { missing, screenshot } from './support/browser.mjs';
import { lattice, writeParticles } from './support/particles.mjs';
import { contrast, measureWater } from './support/pictures.mjs';
import { startServer, startUploader } from './support/programs.mjs';
import { open, surface } from './support/viewer.mjs';

const radius = 0.025;
/** least: of the contrast between the water and what is beside it. */
const frames = [
  // Some drops have flown far: they are not what a picture is of.
  { name: 'block', least: 2, points: [...lattice(24, 12, 12, 0.05), [0, 2, 0]] },
  { name: 'sheet', least: 1.5, points: lattice(60, 30, 1, 0.05) },
  { name: 'drops', least: 1.5, points: lattice(5, 3, 4, 0.2) },
];

describe('water', { skip: missing }, () => {
  it('stands out from the floor and fills the picture: a block, a sheet, drops, dark and light', async () => {
    const folder = mkdtempSync(join(tmpdir(), 'meniscus-web-'));
    try {
      frames.forEach(({ points }, i) => writeParticles(join(folder, `frame_${i}.ply`), points));
      const server = await startServer({ args: ['--record', join(folder, 'recordings')] });
      const files = join(folder, 'frame_{}.ply');
      const args = ['reconstruct', files, '-r', `${radius}`, '--stats', join(folder, 'stats.json')];
      const upload = startUploader(server, args);
      await upload.finished();
      const page = await open(undefined, { viewport: { width: 480, height: 300 } });
      const drawn = () => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => setTimeout(done))));
      for (const [position, { name, least }] of frames.entries()) {
        await page.goto(`${server.url}?embed#recording=${upload.session}/1&position=${position}`);
        await page.reload();
        await surface(page);
        for (const theme of ['dark', 'light']) {
          await page.emulateMedia({ colorScheme: theme });
          await drawn();
          const water = await page.screenshot();
          await screenshot(page, `${name}-${theme}`);
          await page.keyboard.press('w');
          await drawn();
          const wires = await page.screenshot();
          await page.keyboard.press('w');
          const measured = await measureWater(await open(), water, wires);
          const found = contrast(measured.water, measured.beside);
          console.log(
            `${name}, ${theme}: contrast ${found.toFixed(2)}, ${(100 * measured.wide).toFixed(0)} % x ${(100 * measured.tall).toFixed(0)} %`,
          );
          assert.ok(found >= least, `${name}, ${theme}: contrast ${found}, not ${least}: ${JSON.stringify(measured)}`);
          assert.ok(Math.max(measured.wide, measured.tall) >= 0.5, `${name}: ${JSON.stringify(measured)}`);
        }
      }
    } finally {
      rmSync(folder, { recursive: true });
    }
  });
});
