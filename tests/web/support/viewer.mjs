// The common parts of the tests of the viewer: one browser, pages that fail by any error, real servers.
import assert from 'node:assert/strict';
import { after, afterEach, before } from 'node:test';
import { launch, missing, openPage } from './browser.mjs';
import { stopAll } from './programs.mjs';

let browser;
let pages = [];

if (!missing) {
  before(async () => {
    browser = await launch();
  });
  after(() => browser?.close());
}
afterEach(async () => {
  const errors = pages.flatMap((page) => page.errors);
  await Promise.all(pages.map((page) => page.context().close()));
  pages = [];
  await stopAll();
  assert.deepEqual(errors, []);
});

/** A page of its own, which fails the test by any error. */
export async function open(url, options) {
  const page = await openPage(browser, options);
  pages.push(page);
  if (url) await page.goto(url);
  return page;
}

export const link = (server, session) => `${server.url}#session=${session}`;

/** Waits until a picture with a surface has been drawn. */
export function surface(page) {
  return page.waitForFunction(() => Number(document.getElementById('view').dataset.triangles) > 0);
}

/** Waits until the watch stands so: one of the kinds of client/web/src/stream/watch_state.ts. */
export function state(page, kind) {
  return page.waitForFunction((k) => document.getElementById('view').dataset.state === k, kind);
}

/** Waits until the banner says so. */
export function says(page, pattern) {
  return page.waitForFunction(
    (source) => new RegExp(source).test(document.getElementById('banner').innerText),
    pattern.source,
  );
}

export function shown(page) {
  return page.evaluate(() => {
    const { frame, triangles } = document.getElementById('view').dataset;
    return { frame: Number(frame), triangles: Number(triangles) };
  });
}

/** Moves the camera away, so that the picture has all of the water: bricks beside it are not drawn. */
export async function stepBack(page) {
  const { x, y, width, height } = await page.locator('#view').boundingBox();
  await page.mouse.move(x + width / 2, y + height / 2);
  await page.mouse.wheel(0, 1500);
}

/** Records every frame that is drawn, with its number of triangles, in the page's `drawn`. */
export function recordFrames(page) {
  return page.evaluate(() => {
    const view = document.getElementById('view');
    window.drawn = [];
    new MutationObserver(() => {
      window.drawn.push([Number(view.dataset.frame), Number(view.dataset.triangles)]);
    }).observe(view, { attributeFilter: ['data-frame', 'data-triangles'] });
  });
}
