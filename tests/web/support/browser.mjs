// Debian's Chromium, headless, drawing in software.
import { existsSync, mkdirSync } from 'node:fs';
import { join } from 'node:path';
import { chromium } from 'playwright-core';

const executablePath = process.env.CHROMIUM ?? '/usr/bin/chromium';
export const artifacts = process.env.ARTIFACTS ?? 'artifacts';
mkdirSync(artifacts, { recursive: true });

export const missing = existsSync(executablePath) ? false : `${executablePath} is not there`;

export function launch(...args) {
  return chromium.launch({ executablePath, args: ['--no-sandbox', '--enable-unsafe-swiftshader', '--use-angle=swiftshader', ...args] });
}

/** A page that fails the test by any error in its console. Errors of the network are what some tests are about. */
export async function openPage(browser, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1000, height: 640 }, acceptDownloads: true, ...options });
  const page = await context.newPage();
  page.errors = [];
  page.on('pageerror', (error) => page.errors.push(String(error)));
  page.on('console', (message) => {
    if (['error', 'warning'].includes(message.type()) && !/ERR_|GPU stall|status of 4|status of 5/.test(message.text())) page.errors.push(message.text());
  });
  page.setDefaultTimeout(60_000);
  return page;
}

export function screenshot(page, name) {
  return page.screenshot({ path: join(artifacts, `${name}.png`) });
}

/** Waits until a picture with a surface has been drawn. */
export function surface(page) {
  return page.waitForFunction(() => Number(document.getElementById('view').dataset.triangles) > 0);
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
