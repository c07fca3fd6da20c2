import assert from 'node:assert/strict';
import { describe, it } from 'node:test';
import { missing, screenshot } from './support/browser.mjs';
import { startServer } from './support/programs.mjs';
import { startReplay } from './support/recording.mjs';
import { link, open, state, surface } from './support/viewer.mjs';

describe('the keyboard', { skip: missing }, () => {
  const small = { viewport: { width: 480, height: 400 } };

  it('works wherever the focus is: Space pauses after a click, and presses what Tab has reached', async () => {
    const server = await startServer();
    const simulator = await startReplay(server);
    const page = await open(link(server, simulator.session), small);
    await surface(page);
    const wires = () => page.getAttribute('#look', 'aria-pressed');
    const has = (id) => page.waitForFunction((wanted) => document.activeElement.id === wanted, id);

    await page.click('#look');
    await page.keyboard.press(' ');
    await state(page, 'paused');
    assert.equal(await wires(), 'true');
    await page.keyboard.press(' ');
    await state(page, 'live');
    assert.equal(await wires(), 'true');

    await page.keyboard.press('Shift+Tab');
    await page.keyboard.press('Tab');
    await has('look');
    await page.keyboard.press(' ');
    assert.equal(await wires(), 'false');
    await page.keyboard.press('Enter');
    assert.equal(await wires(), 'true');
    assert.equal(await page.getAttribute('#view', 'data-state'), 'live');

    const moves = async (key) => {
      const before = page.url();
      await page.keyboard.press(key);
      await page.waitForFunction((address) => location.href !== address, before);
    };
    await moves('ArrowLeft');
    await page.evaluate(() => document.activeElement.blur());
    await moves('Shift+ArrowUp');

    await page.waitForFunction(() => Number(document.getElementById('scrub').max) >= 3);
    await page.focus('#scrub');
    const before = page.url();
    await page.keyboard.press('ArrowLeft');
    await state(page, 'paused');
    assert.equal(page.url(), before);
    await page.keyboard.press(' ');
    await state(page, 'live');
  });

  it('says what its keys are', async () => {
    const server = await startServer();
    const page = await open(server.url);
    await page.waitForSelector('#no-sessions:not([hidden])');
    await page.keyboard.press('?');
    const dialog = page.locator('#keys-dialog[open]');
    await dialog.waitFor();
    assert.match(await dialog.innerText(), /Space\s+pause, and go on/);
    assert.equal(await page.getAttribute('#pause', 'title'), 'Pause, and go on (Space)');
    await screenshot(page, 'keys');
    await page.keyboard.press('?');
    await dialog.waitFor({ state: 'hidden' });
    // In a field it is a character like others.
    await page.focus('#search');
    await page.keyboard.press('?');
    assert.equal(await page.inputValue('#search'), '?');
    assert.equal(await dialog.isVisible(), false);
  });
});
