import assert from 'node:assert/strict';
import { describe, it } from 'node:test';
import { missing } from './support/browser.mjs';
import { startServer, startSimulator } from './support/programs.mjs';
import { open, shown, surface } from './support/viewer.mjs';

const small = { viewport: { width: 640, height: 480 } };

/** The water alone of a session. codec: that the address names, if any. */
async function picture(server, session, look, codec) {
  const page = await open(undefined, small);
  const codecs = [];
  page.on('response', (response) => {
    if (response.url().endsWith('/Watch')) codecs.push(response.headers()['x-codec']);
  });
  await page.goto(`${server.url}?embed${codec ? `&codec=${codec}` : ''}#session=${session}&look=${look}`);
  await surface(page);
  const { frame, triangles } = await shown(page);
  const png = await page.screenshot();
  await page.close();
  return { frame, triangles, png, codec: codecs[0] };
}

/** The largest difference of two pictures in a channel of a pixel, and how many pixels differ. */
async function difference(a, b) {
  const page = await open(undefined, small);
  return page.evaluate(
    async (pictures) => {
      const [one, other] = await Promise.all(
        pictures.map(async (base64) => {
          const image = new Image();
          image.src = `data:image/png;base64,${base64}`;
          await image.decode();
          const canvas = new OffscreenCanvas(image.width, image.height).getContext('2d');
          canvas.drawImage(image, 0, 0);
          return canvas.getImageData(0, 0, image.width, image.height).data;
        }),
      );
      let most = 0;
      let pixels = 0;
      for (let i = 0; i < one.length; i += 4) {
        const here = Math.max(...[0, 1, 2].map((channel) => Math.abs(one[i + channel] - other[i + channel])));
        most = Math.max(most, here);
        if (here > 0) ++pixels;
      }
      return { most, pixels };
    },
    [a, b].map((png) => png.toString('base64')),
  );
}

/** A session that stays with its last frame. */
async function restingSession(server) {
  const simulator = startSimulator(server, { particles: 4000 });
  const page = await open(`${server.url}#session=${simulator.session}`, small);
  await page.waitForFunction(() => Number(document.getElementById('view').dataset.frame) >= 20);
  await simulator.kill();
  await page.close();
  // Frames that the server still works on come first.
  for (let before; ;) {
    const { frame } = await picture(server, simulator.session, 'water');
    if (frame === before) return simulator.session;
    before = frame;
  }
}

describe('codecs', { skip: missing }, () => {
  it('show the same picture, and the fastest is chosen on the machine of the server', async () => {
    const server = await startServer();
    const session = await restingSession(server);
    for (const look of ['water', 'levels']) {
      const draco = await picture(server, session, look, 'draco');
      assert.equal(draco.codec, 'CODEC_DRACO');
      for (const [named, codec] of [
        ['packed', 'CODEC_LATTICE_PACKED'],
        ['entropy', 'CODEC_LATTICE_ENTROPY'],
        [undefined, 'CODEC_LATTICE_PACKED'],
      ]) {
        const other = await picture(server, session, look, named);
        assert.deepEqual([other.codec, other.frame, other.triangles], [codec, draco.frame, draco.triangles]);
        const { most, pixels } = await difference(draco.png, other.png);
        console.log(`${look}, ${codec}: ${pixels} pixels differ from Draco's, by ${most} at most`);
        // Draco's normals are rounded from double precision.
        assert.ok(most <= 2);
      }
    }
  });
});
