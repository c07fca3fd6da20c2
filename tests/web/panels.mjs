import assert from 'node:assert/strict';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { describe, it } from 'node:test';
import { missing, screenshot } from './support/browser.mjs';
import { lattice, writeParticles } from './support/particles.mjs';
import { measureWater } from './support/pictures.mjs';
import { startServer, startUploader } from './support/programs.mjs';
import { open, surface } from './support/viewer.mjs';

describe('the panels', { skip: missing }, () => {
  it('have titles, name no time where there is none, and say how attributes are named', async () => {
    const folder = mkdtempSync(join(tmpdir(), 'meniscus-web-'));
    try {
      writeParticles(join(folder, 'frame.ply'), lattice(10, 6, 6, 0.05));
      const server = await startServer({ args: ['--record', join(folder, 'recordings')] });
      const args = ['reconstruct', join(folder, 'frame.ply'), '-r', '0.025', '--stats', join(folder, 'stats.json')];
      const upload = startUploader(server, args);
      await upload.finished();
      const viewport = { width: 1200, height: 750 };
      const page = await open(`${server.url}#recording=${upload.session}/1&position=0`, { viewport });
      await surface(page);
      assert.equal(await page.locator('#frame').innerText(), '0');
      assert.equal(await page.locator('#at').innerText(), 'frame 0');
      // The camera that follows leaves room for a panel that opens.
      await page.click('#color');
      const panel = await page.locator('#color-panel').boundingBox();
      const clip = { x: 0, y: 60, width: viewport.width, height: viewport.height - 200 };
      const drawn = () => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => setTimeout(done))));
      const looks = [];
      for (let look = 0; look < 2; ++look) {
        await page.click('#look');
        await drawn();
        looks.push(await page.screenshot({ clip }));
      }
      const { left } = await measureWater(await open(), ...looks);
      assert.ok(left > panel.x + panel.width, `the water begins at ${left}, below ${JSON.stringify(panel)}`);
      await page.click('#color');
      for (const tool of ['color', 'cut', 'probe', 'ruler', 'beside']) {
        await page.click(`#${tool}`);
        // The one that was opened lies where it is seen, however many are open.
        const [corner, title] = await Promise.all(
          ['#corner', `#${tool}-panel h2`].map((selector) => page.locator(selector).boundingBox()),
        );
        const bottom = title.y + title.height;
        assert.ok(title.y >= corner.y && bottom <= corner.y + corner.height, `${tool}: ${bottom}`);
      }
      const titles = await page.locator('#overlay h2, .panel h2').allInnerTexts();
      assert.deepEqual(titles, ['Figures', 'Color', 'Cut', 'Probe', 'Ruler', 'Beside']);
      await page.getByText('No attribute is named in this session: --attribute velocity names one.').waitFor();
      // The ring of what has the focus leaves its name to be read.
      const [name, field] = await page.evaluate(() => {
        const select = document.getElementById('color-attribute');
        const range = document.createRange();
        range.selectNode(select.parentElement.firstChild);
        const { outlineOffset, outlineWidth } = getComputedStyle(select);
        const ring = parseFloat(outlineOffset) + parseFloat(outlineWidth);
        return [range.getBoundingClientRect().bottom, select.getBoundingClientRect().top - ring];
      });
      assert.ok(field >= name, `the ring begins at ${field}, the name ends at ${name}`);
      await screenshot(page, 'panels');
    } finally {
      rmSync(folder, { recursive: true });
    }
  });
});
