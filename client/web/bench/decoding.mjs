// What it takes a worker of the viewer to decode a mesh, by codec, in Chromium: npm run bench -- FILE [ROUNDS]
// FILE: of codec-bricks, which the build has in tests/benchmarks.
import { readFileSync } from 'node:fs';
import { createServer } from 'vite';
import { launch } from '../../../tests/web/support/browser.mjs';

const [path, rounds = '15'] = process.argv.slice(2);
const file = JSON.parse(readFileSync(path, 'utf8'));
const names = { 1: 'Draco', 2: 'packed', 3: 'entropy' };

const server = await createServer({
  server: { port: 0 },
  logLevel: 'error',
  // Found later, it would load the page again.
  optimizeDeps: { include: ['draco3d/draco_decoder_nodejs.js'] },
});
await server.listen();
const browser = await launch();
try {
  const page = await browser.newPage();
  await page.goto(`${server.resolvedUrls.local[0]}bench/`);
  await page.waitForFunction(() => 'measure' in window);
  const measured = await page.evaluate(([mesh, count]) => window.measure(mesh, count), [file, Number(rounds)]);
  const median = (times) => times.sort((a, b) => a - b)[Math.floor(times.length / 2)];
  const medians = new Map(measured.map(([codec, times]) => [codec, median(times)]));
  console.log("codec     bytes/triangle   ms a mesh   ns a triangle   of Draco's speed");
  for (const [codec, ms] of medians) {
    const bricks = file.bricks[codec];
    const sum = (of) => bricks.reduce((total, brick) => total + of(brick), 0);
    const triangles = sum((brick) => brick.triangles);
    const bytes = sum((brick) => 0.75 * (brick.data.length + brick.cell_levels.length));
    console.log(
      [
        names[codec].padEnd(9),
        (bytes / triangles).toFixed(3).padStart(14),
        ms.toFixed(1).padStart(11),
        ((1e6 * ms) / triangles).toFixed(1).padStart(15),
        (medians.get(1) / ms).toFixed(2).padStart(18),
      ].join(' '),
    );
  }
} finally {
  await browser.close();
  await server.close();
}
