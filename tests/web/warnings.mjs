import assert from 'node:assert/strict';
import { describe, it } from 'node:test';
import { missing, screenshot } from './support/browser.mjs';
import { startServer, startUploader } from './support/programs.mjs';
import { link, open, surface } from './support/viewer.mjs';

describe('a warning', { skip: missing }, () => {
  it("is said in the server's words, and stays away once it was sent away", async () => {
    const server = await startServer();
    const frames = async (count, session) => {
      const args = `simulate --particles 500 --cell-size 1.6 --frames ${count} --keep-session`;
      const simulator = startUploader(server, args.split(' '), session);
      await simulator.finished();
      return simulator.session;
    };
    const session = await frames(3);
    const page = await open(link(server, session));
    await surface(page);
    const warning = page.locator('#warnings li');
    await warning.getByText(/^finest cells of .* are too large to show single particles/).waitFor();
    assert.equal(await warning.count(), 1);
    await screenshot(page, 'warning');
    // The tools' panels, in the same corner, leave it to be read.
    await page.keyboard.press('c');
    const [above, below] = [await warning.boundingBox(), await page.locator('#cut-panel').boundingBox()];
    assert.ok(above.y + above.height <= below.y, JSON.stringify([above, below]));
    await warning.getByRole('button').click();
    await frames(5, session);
    await page.waitForFunction(() => document.getElementById('view').dataset.frame === '4');
    assert.equal(await page.locator('#warnings').isVisible(), false);
  });
});
