// From the push of a frame to its mesh in the page's memory, by codec: server, simulator and browser on this machine.
//
//   node latency.mjs PARTICLES TILES [FRAMES [ROUNDS]]
//
// PARTICLES: a particle file of radius 0.025, TILES of which lie side by side. MENISCUSD and PYTHONPATH as for the tests.
// Prints the median of each codec, and its share of Draco's.
import { spawn } from 'node:child_process';
import { createInterface } from 'node:readline';
import { launch, openPage } from './support/browser.mjs';
import { startServer, stopAll } from './support/programs.mjs';

const [path, tiles, frames = '12', rounds = '3'] = process.argv.slice(2);
const pushes = new URL('support/pushes.py', import.meta.url).pathname;
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

/** Seconds from each push to the last brick of its mesh. */
async function latencies(browser, codec) {
  const server = await startServer();
  const python = spawn('/usr/bin/python3', [pushes, server.address, path, tiles, frames], {
    stdio: ['pipe', 'pipe', 'inherit'],
  });
  const lines = createInterface({ input: python.stdout })[Symbol.asyncIterator]();
  const line = async () => (await lines.next()).value.split(' ');
  const [session, particles] = await line();
  const page = await openPage(browser, { viewport: { width: 64, height: 64 } });
  await page.addInitScript(recordWorkers);
  await page.goto(`${server.url}?embed&codec=${codec}#session=${session}`);
  await page.waitForFunction(() => document.getElementById('view').dataset.state);
  const seconds = [];
  python.stdin.write('go\n');
  for (let i = 0; i < Number(frames); ++i) {
    const begun = Number((await line())[1]);
    // The frame is drawn once its bricks are there.
    await page.waitForFunction((frame) => document.getElementById('view').dataset.frame === String(frame), i);
    const last = await page.evaluate(() => window.sent.at(-1));
    if (i > 1) seconds.push(last - begun);
    python.stdin.write('\n');
  }
  await page.close();
  python.kill();
  await server.kill();
  return { particles, seconds };
}

const browser = await launch();
const all = { draco: [], packed: [], entropy: [] };
let count;
for (let round = 0; round < Number(rounds); ++round)
  for (const codec of Object.keys(all)) {
    const { particles, seconds } = await latencies(browser, codec);
    count = particles;
    all[codec].push(...seconds);
  }
const draco = median(all.draco);
for (const [codec, seconds] of Object.entries(all))
  console.log(`${count} particles, ${codec}: ${(1000 * median(seconds)).toFixed(1)} ms, ${(median(seconds) / draco).toFixed(2)} of Draco's`);
await browser.close();
await stopAll();
