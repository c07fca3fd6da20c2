import assert from 'node:assert/strict';
import { describe, it } from 'node:test';
import validator from 'gltf-validator';
import { missing, screenshot } from './support/browser.mjs';
import { save } from './support/files.mjs';
import { boundsOfPly, reload } from './support/meshes.mjs';
import { startServer } from './support/programs.mjs';
import { startReplay } from './support/recording.mjs';
import { link, open, shown, state, stepBack, surface } from './support/viewer.mjs';

describe('playback', { skip: missing }, () => {
  it('pauses, steps and scrubs through what has been seen, and goes on', async () => {
    const server = await startServer();
    const page = await open(link(server, (await startReplay(server)).session));
    await surface(page);
    await page.waitForFunction(() => Number(document.getElementById('scrub').max) >= 5);
    await page.focus('#view');
    await page.keyboard.press(' ');
    await state(page, 'paused');
    /** Waits until the frame that the slider stands at has been drawn. */
    const chosen = async () => {
      await page.waitForFunction(
        () =>
          document
            .getElementById('scrub')
            .getAttribute('aria-valuetext')
            ?.match(/[0-9]+/)?.[0] === document.getElementById('view').dataset.frame,
      );
      return (await shown(page)).frame;
    };
    const newest = await chosen();
    const last = Number(await page.inputValue('#scrub'));
    await page.click('#back');
    const earlier = await chosen();
    assert.ok(earlier < newest, `${earlier} after ${newest}`);
    await page.focus('#view');
    await page.keyboard.press(',');
    assert.equal(Number(await page.inputValue('#scrub')), last - 2);
    const skipped = await page.locator('#skipped').innerText();
    await page.fill('#scrub', '0');
    assert.ok((await chosen()) < earlier);
    assert.equal(await page.locator('#skipped').innerText(), skipped);
    assert.equal(await page.locator('#latency').innerText(), '–');
    await screenshot(page, 'paused');
    await page.click('#pause');
    await state(page, 'live');
    await page.waitForFunction((before) => Number(document.getElementById('view').dataset.frame) > before, newest);
  });

  it('saves a GLB that the Khronos validator passes and three.js reloads, the same mesh as the PLY and the screen', async () => {
    const server = await startServer();
    const simulator = await startReplay(server);
    const page = await open(link(server, simulator.session));
    await surface(page);
    await stepBack(page);
    await page.click('#pause');
    await state(page, 'paused');
    const { bytes: glb } = await save(page, '#glb');
    const { bytes: ply } = await save(page, '#ply');
    const { triangles } = await shown(page);

    const { issues } = await validator.validateBytes(new Uint8Array(glb));
    assert.deepEqual(
      issues.messages.filter(({ severity }) => severity < 2),
      [],
    );
    const reloaded = await reload(await open(), glb);
    assert.equal(reloaded.triangles, triangles);
    assert.match(ply.subarray(0, 400).toString('latin1'), new RegExp(`element face ${triangles}\\n`));
    boundsOfPly(ply).forEach((x, i) =>
      assert.ok(Math.abs(x - reloaded.bounds[i]) < 1e-5, `${x} in the PLY, ${reloaded.bounds[i]} in the GLB`),
    );
  });
});
