import assert from 'node:assert/strict';
import { createRequire } from 'node:module';
import { readFileSync } from 'node:fs';
import { describe, it } from 'node:test';
import { missing, screenshot } from './support/browser.mjs';
import { startServer } from './support/programs.mjs';
import { startReplay } from './support/recording.mjs';
import { link, open, state, surface } from './support/viewer.mjs';

const axe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');

/** The violations of WCAG 2.2, levels A and AA. */
async function violations(page) {
  await page.evaluate(axe);
  return page.evaluate(async () => {
    const tags = ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa', 'best-practice'];
    const { violations } = await window.axe.run(document, { runOnly: { type: 'tag', values: tags } });
    return violations.flatMap(({ id, nodes }) =>
      nodes.map(({ target, failureSummary }) => `${id}: ${target.join(' ')}: ${failureSummary}`),
    );
  });
}

describe('the page', { skip: missing }, () => {
  for (const colorScheme of ['light', 'dark'])
    it(`is accessible by its rules, ${colorScheme}`, async () => {
      const server = await startServer();
      const page = await open(server.url, { colorScheme });
      const { session } = await startReplay(server);
      const entry = page.locator(`[data-session="${session}"]`);
      await entry.waitFor();
      assert.deepEqual(await violations(page), []);
      await entry.click();
      await surface(page);
      assert.deepEqual(await violations(page), []);
      for (const tool of ['color', 'cut', 'probe', 'ruler', 'beside']) await page.click(`#${tool}`);
      assert.deepEqual(await violations(page), []);
      await server.kill();
      await state(page, 'waiting');
      assert.deepEqual(await violations(page), []);
    });

  it('leads by the keyboard alone from the list to every control and back', async () => {
    const server = await startServer();
    const { session } = await startReplay(server);
    const page = await open(server.url);
    const entry = page.locator(`[data-session="${session}"]`);
    await entry.waitFor();
    await entry.focus();
    await page.keyboard.press('Enter');
    await surface(page);
    const reached = [];
    for (let i = 0; i < 50; ++i) {
      reached.push(await page.evaluate(() => document.activeElement.id));
      await page.keyboard.press('Tab');
    }
    const controls = await page.evaluate(() =>
      [...document.querySelectorAll('button, input, select, canvas[tabindex]')]
        .filter((control) => control.checkVisibility())
        .map(({ id }) => id),
    );
    assert.deepEqual(
      controls.filter((id) => !reached.includes(id)),
      [],
    );
    await page.focus('#leave');
    await page.keyboard.press('Enter');
    await entry.waitFor();
    assert.equal(await page.evaluate(() => document.activeElement.id), 'list-heading');
  });

  it('fits a phone', async () => {
    const server = await startServer();
    const { session } = await startReplay(server);
    const options = {
      viewport: { width: 360, height: 740 },
      colorScheme: 'dark',
      hasTouch: true,
      isMobile: true,
      deviceScaleFactor: 2,
    };
    const page = await open(link(server, session), options);
    await surface(page);
    const covered = await page.evaluate(() => {
      const boxes = [...document.querySelectorAll('header button, #overlay, footer button, #scrub')].filter((e) =>
        e.checkVisibility(),
      );
      return boxes
        .filter((e) => {
          e.scrollIntoView({ behavior: 'instant' });
          const { left, right, top, bottom } = e.getBoundingClientRect();
          return left < 0 || right > innerWidth || top < 0 || bottom > innerHeight;
        })
        .map(({ id }) => id);
    });
    assert.deepEqual(covered, []);
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 360);
    const rows = await page.evaluate(() => {
      const buttons = [...document.querySelectorAll('#toolbar button')].filter((e) => e.checkVisibility());
      return new Set(buttons.map((e) => e.getBoundingClientRect().top)).size;
    });
    assert.equal(rows, 1);
    await page.evaluate(() => document.getElementById('toolbar').scrollTo(0, 0));
    await screenshot(page, 'phone');
    // The figures wait until they are asked for.
    assert.equal(await page.locator('#overlay').isVisible(), false);
    // A finger that rests on an icon learns its name, and does not press it.
    const finger = { pointerType: 'touch', bubbles: true };
    await page.dispatchEvent('#look', 'pointerdown', finger);
    await page.locator('#hint', { hasText: 'Water or wires (W)' }).waitFor();
    await page.dispatchEvent('#look', 'pointerup', finger);
    await page.dispatchEvent('#look', 'click');
    assert.equal(await page.getAttribute('#look', 'aria-pressed'), 'false');
    await page.locator('#hint').waitFor({ state: 'hidden' });
    await page.tap('#look');
    assert.equal(await page.getAttribute('#look', 'aria-pressed'), 'true');
    await page.tap('#leave');
    const field = await page.locator('#search').boundingBox();
    assert.ok(field.x >= 0 && field.x + field.width <= 360, JSON.stringify(field));
  });
});
