import assert from 'node:assert/strict';
import { describe, it } from 'node:test';
import { missing, screenshot } from './support/browser.mjs';
import { startServer, startUploader } from './support/programs.mjs';
import { link, open, surface } from './support/viewer.mjs';

describe('a warning', { skip: missing }, () => {
  it("is said in the server's words, and stays away once it was sent away", async () => {
    const server = await startServer();
    const simulator = startUploader(server, 'simulate --particles 500 --frames 100000 --cell-size 1.6'.split(' '));
    const page = await open(link(server, simulator.session));
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
    const drawn = await page.getAttribute('#view', 'data-frame');
    await page.waitForFunction((frame) => document.getElementById('view').dataset.frame !== frame, drawn);
    assert.equal(await page.locator('#warnings').isVisible(), false);
  });
});
