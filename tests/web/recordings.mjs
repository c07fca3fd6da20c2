import assert from 'node:assert/strict';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { describe, it } from 'node:test';
import { missing, screenshot } from './support/browser.mjs';
import { startServer, startUploader } from './support/programs.mjs';
import { recordedFile } from './support/recording.mjs';
import { open, shown, state, stepBack } from './support/viewer.mjs';

describe('a recording', { skip: missing }, () => {
  it('opens, plays, scrubs, steps, and reopens by its link', async () => {
    const folder = mkdtempSync(join(tmpdir(), 'meniscus-web-'));
    try {
      const { file, triangles } = await recordedFile();
      const server = await startServer({ args: ['--record', folder] });
      const replay = startUploader(server, ['replay', file, '--speed', 'max', '--to', '59']);
      await replay.finished();
      const page = await open(server.url);
      const entry = page.locator(`[data-recording="${replay.session}/1"]`);
      await entry.getByText('60 frames').waitFor();
      await entry.locator('.thumbnail[data-drawn]').waitFor();
      const colors = await entry.locator('.thumbnail').evaluate((canvas) => {
        const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
        return new Set(new Uint32Array(data.buffer)).size;
      });
      assert.ok(colors > 100, `${colors} colors`);
      assert.equal(await entry.locator('code').innerText(), `${replay.session.slice(0, 8)}/1`);
      const [above, heading] = await page.evaluate(() =>
        ['no-sessions', 'recordings-heading'].map((id) => document.getElementById(id).getBoundingClientRect()),
      );
      assert.ok(heading.top - above.bottom >= 16, 'the heading has room above it');
      await screenshot(page, 'recordings');
      // Pages may not delete: the command that does is named.
      await page.getByRole('button', { name: `Delete ${replay.session.slice(0, 8)}/1` }).click();
      assert.match(
        await page.locator('#delete-command').innerText(),
        new RegExp(`^meniscus recordings --server 127\\.0\\.0\\.1 --delete ${replay.session}/1$`),
      );
      await page.keyboard.press('Escape');
      await entry.click();
      await state(page, 'live');
      await page.waitForFunction(() => Number(document.getElementById('view').dataset.frame) >= 2);
      assert.equal(await page.getAttribute('#scrub', 'max'), '59');

      await stepBack(page);
      const shows = async (frame) => {
        await page.waitForFunction((wanted) => Number(document.getElementById('view').dataset.frame) === wanted, frame);
        assert.deepEqual(await shown(page), { frame, triangles: triangles[frame] });
      };
      await page.fill('#scrub', '45');
      await shows(45);
      await state(page, 'paused');
      await page.click('#back');
      await shows(44);
      await page.focus('#view');
      await page.keyboard.press('.');
      await page.keyboard.press('.');
      await shows(46);
      await screenshot(page, 'recording');
      // A stream's figures are not those of a frame that rests.
      for (const row of ['rate', 'latency', 'bytes', 'skipped', 'quality'])
        assert.equal(await page.locator(`#${row}-row`).isVisible(), false, row);

      assert.match(page.url(), new RegExp(`#recording=${replay.session}/1&position=46`));
      await page.reload();
      await shows(46);
      await state(page, 'paused');
      await page.fill('#scrub', '50');
      await shows(50);
      // Figures and slider name the frame that is on the screen, also while it plays.
      await page.evaluate(() => {
        const view = document.getElementById('view');
        const number = (id) => Number(document.getElementById(id).textContent.match(/[0-9]+/)?.[0]);
        window.seen = [];
        new MutationObserver(() => {
          window.seen.push([Number(view.dataset.frame), number('frame'), number('at')]);
        }).observe(view, { attributeFilter: ['data-frame'] });
      });
      await page.click('#pause');
      await page.locator('#rate-row').waitFor();
      await shows(59);
      await state(page, 'paused');
      const seen = await page.evaluate(() => window.seen);
      assert.ok(seen.length >= 9);
      for (const [drawn, inFigures, atSlider] of seen) assert.deepEqual([inFigures, atSlider], [drawn, drawn]);
    } finally {
      rmSync(folder, { recursive: true });
    }
  });

  it('says that there is none where there is none', async () => {
    const server = await startServer();
    const page = await open(`${server.url}#recording=00000000-0000-4000-8000-000000000000/1`);
    await page.getByText('There are no recordings (this server keeps no recordings').waitFor();
    await page.click('#leave');
    await page.waitForSelector('#no-sessions:not([hidden])');
    assert.equal(await page.locator('#recordings-section').isVisible(), false);
  });
});
