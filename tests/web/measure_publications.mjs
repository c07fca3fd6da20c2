// Figures of publications in Chromium. `node measure_publications.mjs seeks FOLDER`: ms from a move of the slider to the frame's
// picture, over random frames of a publication that `meniscus publish --page` has made. `node measure_publications.mjs behind`: how
// long after a watcher the viewer shows the frames of a session that `meniscus publish` publishes; `behind-server`: that
// `meniscusd --publish` does. MENISCUSD and MENISCUS name the programs.
import { mkdtempSync, readdirSync, rmSync, statSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { launch, openPage } from './support/browser.mjs';
import { startHost } from './support/plain_host.mjs';

const seeks = 60;
/** Seconds for which a session is watched. */
const watched = 20;

const ordered = (values) => [...values].sort((a, b) => a - b);
const figures = (name, values) => {
  const all = ordered(values);
  console.log(
    `${name}: ${all.length}, median ${all[all.length >> 1].toFixed(0)} ms, worst ${all.at(-1).toFixed(0)} ms`,
  );
};

async function measureSeeks(browser, folder) {
  const host = await startHost(folder);
  const page = await openPage(browser);
  await page.goto(`${host.url}#position=0`);
  await page.waitForSelector('#view[data-frame]');
  const taken = await page.evaluate(async (count) => {
    const view = document.getElementById('view');
    const scrub = document.getElementById('scrub');
    const times = [];
    let state = 1;
    for (let i = 0; i < count; ++i) {
      state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
      const place = Math.floor((state / 2 ** 32) * (Number(scrub.max) + 1));
      if (place === Number(scrub.value)) continue;
      const before = view.dataset.frame;
      const drawn = new Promise((resolve) => {
        const observer = new MutationObserver(() => {
          if (view.dataset.frame === before) return;
          observer.disconnect();
          resolve();
        });
        observer.observe(view, { attributeFilter: ['data-frame'] });
      });
      const began = performance.now();
      scrub.value = String(place);
      scrub.dispatchEvent(new Event('input'));
      await drawn;
      times.push(performance.now() - began);
    }
    return times;
  }, seeks);
  figures('seeks', taken);
  host.stop();
}

/** by: the publisher of the session, a program beside the server or the server itself. */
async function measureBehind(browser, by) {
  const { startPublisher, startServer, startSimulator, startWatcher, stopAll } = await import('./support/programs.mjs');
  const folder = mkdtempSync(join(tmpdir(), 'meniscus-web-'));
  try {
    const served = by === 'server';
    const server = await startServer({ args: served ? ['--publish'] : [] });
    const { session, begun } = startSimulator(server, { particles: 1000, publish: served });
    await begun();
    if (!served) await startPublisher(server, session, join(folder, 'site'), '--page');
    startWatcher(server, session, join(folder, 'watched'));
    const host = served ? undefined : await startHost(join(folder, 'site'));
    const page = await openPage(browser);
    await page.goto(host?.url ?? `${server.url}?publication=/publications/${session}/`);
    await page.waitForSelector('#view[data-frame]');
    const drawn = await page.evaluate(
      (seconds) =>
        new Promise((resolve) => {
          const view = document.getElementById('view');
          const times = [];
          new MutationObserver(() => times.push([Number(view.dataset.frame), Date.now()])).observe(view, {
            attributeFilter: ['data-frame'],
          });
          setTimeout(() => {
            resolve(times);
          }, seconds * 1000);
        }),
      watched,
    );
    const came = new Map(
      readdirSync(join(folder, 'watched')).map((name) => [
        Number(/\d+/.exec(name)[0]),
        statSync(join(folder, 'watched', name)).mtimeMs,
      ]),
    );
    figures(
      'behind a watcher',
      drawn.filter(([frame]) => came.has(frame)).map(([frame, at]) => at - came.get(frame)),
    );
    host?.stop();
  } finally {
    await stopAll();
    rmSync(folder, { recursive: true });
  }
}

const [what, folder] = process.argv.slice(2);
const browser = await launch();
try {
  if (what === 'seeks') await measureSeeks(browser, folder);
  else if (what === 'behind') await measureBehind(browser, 'program');
  else if (what === 'behind-server') await measureBehind(browser, 'server');
  else throw new Error(`'${what}' is none of seeks, behind and behind-server`);
} finally {
  await browser.close();
}
