// Debian's browsers, drawing in software: Chromium, headless, and Firefox.
import { existsSync, mkdirSync } from 'node:fs';
import { join } from 'node:path';
import { chromium, firefox } from 'playwright-core';

const executablePath = process.env.CHROMIUM ?? '/usr/bin/chromium';
const artifacts = process.env.ARTIFACTS ?? 'artifacts';
mkdirSync(artifacts, { recursive: true });

/** Why there is no browser; false if there is one. */
export const missing = existsSync(executablePath) ? false : `${executablePath} is not there`;

export function launch(...args) {
  return chromium.launch({
    executablePath,
    args: ['--no-sandbox', '--enable-unsafe-swiftshader', '--use-angle=swiftshader', ...args],
  });
}

/** On a display, as `xvfb-run -a` gives one: without one it has no WebGL. */
export function launchFirefox() {
  return firefox.launch({
    channel: 'moz-firefox',
    executablePath: process.env.FIREFOX ?? '/usr/bin/firefox-esr',
    headless: false,
    firefoxUserPrefs: { 'webgl.force-enabled': true },
  });
}

/** A page that keeps what its console says is wrong. Errors of the network are what some tests are about. */
export async function openPage(browser, options = {}) {
  const context = await browser.newContext({
    viewport: { width: 720, height: 480 },
    acceptDownloads: true,
    ...options,
  });
  const page = await context.newPage();
  page.errors = [];
  page.on('pageerror', (error) => page.errors.push(String(error)));
  page.on('console', (message) => {
    if (['error', 'warning'].includes(message.type()) && !/ERR_|GPU stall|status of 4|status of 5/.test(message.text()))
      page.errors.push(message.text());
  });
  page.setDefaultTimeout(60_000);
  return page;
}

export function screenshot(page, name) {
  return page.screenshot({ path: join(artifacts, `${name}.png`) });
}
