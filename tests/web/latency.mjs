// From the push of a frame to its mesh in the page's memory, by codec: server, simulator and browser on this machine.
//
//   node latency.mjs PARTICLES NUMBER [FRAMES [ROUNDS]]
//
// PARTICLES: a particle file of radius 0.025, of whose water NUMBER particles are pushed. MENISCUSD, MENISCUS and PYTHONPATH
// as for the tests. Codecs take turns. Prints the median of each, its share of Draco's, and the frames that the page has
// not shown.
import { spawn } from 'node:child_process';
import { createInterface } from 'node:readline';
import { launch, openPage } from './support/browser.mjs';
import { startServer, stopAll } from './support/programs.mjs';

const [path, number, frames = '16', rounds = '3'] = process.argv.slice(2);
const pushes = new URL('support/pushes.py', import.meta.url).pathname;
const warm = 3; // frames that are not counted
const patience = 20_000; // milliseconds for one frame

const median = (values) => values.sort((a, b) => a - b)[Math.floor(values.length / 2)];

/** The times at which workers have sent something to the page: the decoded bricks among it. */
function recordWorkers() {
  window.sent = [];
  window.Worker = class extends Worker {
    constructor(...args) {
      super(...args);
      this.addEventListener('message', () => window.sent.push((performance.timeOrigin + performance.now()) / 1000));
    }
  };
}

/** Seconds from each push to the last brick of its mesh; the pushes that no mesh has followed. */
async function latencies(browser, codec) {
  const server = await startServer();
  const python = spawn('/usr/bin/python3', [pushes, server.address, path, number, frames], {
    stdio: ['pipe', 'pipe', 'inherit'],
  });
  const lines = createInterface({ input: python.stdout })[Symbol.asyncIterator]();
  const session = (await lines.next()).value;
  const page = await openPage(browser, { viewport: { width: 64, height: 64 } });
  await page.addInitScript(recordWorkers);
  await page.goto(`${server.url}?embed&codec=${codec}#session=${session}`);
  await page.waitForFunction(() => document.getElementById('view').dataset.state === 'connected');
  const seconds = [];
  let lost = 0;
  for (let i = 0; i < Number(frames); ++i) {
    python.stdin.write('\n');
    const begun = Number((await lines.next()).value.split(' ')[1]);
    // The frame is drawn once its bricks are there. The page is at rest when the next one comes.
    const drawn = await page
      .waitForFunction((frame) => Number(document.getElementById('view').dataset.frame) >= frame, i, {
        timeout: patience,
      })
      .catch(() => null);
    if (!drawn) ++lost;
    else if (i >= warm) seconds.push((await page.evaluate(() => window.sent.at(-1))) - begun);
  }
  await page.context().close();
  python.kill();
  await server.kill();
  return { seconds, lost };
}

const browser = await launch();
const all = { draco: [], packed: [], entropy: [] };
const lost = { draco: 0, packed: 0, entropy: 0 };
for (let round = 0; round < Number(rounds); ++round)
  for (const codec of Object.keys(all)) {
    const measured = await latencies(browser, codec);
    all[codec].push(...measured.seconds);
    lost[codec] += measured.lost;
  }
const draco = median(all.draco);
for (const [codec, seconds] of Object.entries(all)) {
  const ratio = (median(seconds) / draco).toFixed(2);
  console.log(
    `${number} particles, ${codec}: ${(1000 * median(seconds)).toFixed(1)} ms, ${ratio} of Draco's, ` +
      `${seconds.length} frames, ${lost[codec]} not shown`,
  );
}
await browser.close();
await stopAll();
