import assert from 'node:assert/strict';
import { existsSync, mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { describe, it } from 'node:test';
import { missing } from './support/browser.mjs';
import { pixelsOf } from './support/pictures.mjs';
import { startServer, startUploader } from './support/programs.mjs';
import { recordedFile, startReplay } from './support/recording.mjs';
import { open, shown, surface } from './support/viewer.mjs';

const decoder = new URL('../../client/web/src/gen/lattice_decoder.wasm', import.meta.url);
const without = existsSync(decoder) ? false : 'the viewer was built without the lattice codecs';
const small = { viewport: { width: 640, height: 480 } };

/** The water alone, with the answer that its meshes came by. query: of the address, after `embed`. */
async function picture(server, query, what) {
  const page = await open(undefined, small);
  const answered = page.waitForResponse((response) => /\/(Watch|ReadRecording)$/.test(response.url()));
  await page.goto(`${server.url}?embed${query}#${what}`);
  await surface(page);
  const drawn = await shown(page);
  const png = await page.screenshot();
  const answer = await answered;
  await page.close();
  return { answer, drawn, png };
}

/** Whether a call to read a recording has asked for codecs of these numbers: the field 5 of its request. */
function hasAsked(answer, ...codecs) {
  return answer
    .request()
    .postDataBuffer()
    .includes(Buffer.from([(5 << 3) | 2, codecs.length, ...codecs]));
}

/** The largest difference of two pictures in a channel of a pixel, its mean over all pixels, and how many pixels differ. */
async function difference(a, b) {
  const page = await open(undefined, small);
  return page.evaluate(
    ([{ data: one }, { data: other }]) => {
      let most = 0;
      let sum = 0;
      let pixels = 0;
      for (let i = 0; i < one.length; i += 4) {
        const here = Math.max(...[0, 1, 2].map((channel) => Math.abs(one[i + channel] - other[i + channel])));
        most = Math.max(most, here);
        sum += here;
        if (here > 0) ++pixels;
      }
      return { most, mean: (4 * sum) / one.length, pixels };
    },
    await pixelsOf(page, a, b),
  );
}

describe('codecs', { skip: missing || without }, () => {
  // Of a recording, which comes whole however slow the link is.
  for (const name of ['packed', 'entropy'])
    it(`show the same picture: Draco and ${name}`, async () => {
      const folder = mkdtempSync(join(tmpdir(), 'meniscus-web-'));
      try {
        const { file } = await recordedFile();
        const server = await startServer({ args: ['--record', folder, '--record-codec', name] });
        const replay = startUploader(server, ['replay', file, '--speed', 'max', '--to', '31']);
        await replay.finished();
        for (const look of ['water', 'levels']) {
          const what = `recording=${replay.session}/1&position=30&look=${look}`;
          const draco = await picture(server, '&codec=draco', what);
          const other = await picture(server, '', what);
          // Who names the codec of the recording gets it, others get Draco.
          assert.ok(hasAsked(draco.answer, 1));
          assert.ok(hasAsked(other.answer, 2, 3, 1));
          assert.deepEqual(other.drawn, draco.drawn);
          const { most, pixels } = await difference(draco.png, other.png);
          console.log(`${look}, ${name}: ${pixels} pixels differ from Draco's, by ${most} at most`);
          // Draco's normals are rounded from double precision.
          assert.ok(most <= 2);
        }
      } finally {
        rmSync(folder, { recursive: true });
      }
    });

  it('need not bring normals: with those of the viewer the picture is nearly the same', async () => {
    const server = await startServer();
    // Cells that are the same whatever the default: the larger they are, the less is known of the normals between.
    const dam = ['simulate', '--scene', 'dam-break', '--particles', '2000', '--frames', '32', '--tolerance', '0.15'];
    const simulator = startUploader(server, [...dam, '--keep-session']);
    await simulator.finished();
    const sent = await picture(server, '', `session=${simulator.session}`);
    const own = await picture(server, '&normals-by=receiver', `session=${simulator.session}`);
    assert.ok(
      own.answer
        .request()
        .postDataBuffer()
        .includes(Buffer.from([2 << 3, 0])),
    );
    assert.deepEqual(own.drawn, sent.drawn);
    const { mean, pixels } = await difference(sent.png, own.png);
    console.log(`normals of the viewer: ${pixels} pixels differ, all by ${mean} in the mean`);
    assert.ok(pixels > 0);
    assert.ok(mean < 1);
  });

  it('are chosen by the address, and else for speed on the machine of the server', async () => {
    const server = await startServer();
    const { session } = await startReplay(server);
    for (const [query, codec] of [
      ['', 'CODEC_LATTICE_PACKED'],
      ['&codec=entropy', 'CODEC_LATTICE_ENTROPY'],
      ['&codec=packed', 'CODEC_LATTICE_PACKED'],
      ['&codec=draco', 'CODEC_DRACO'],
    ]) {
      const { answer } = await picture(server, query, `session=${session}`);
      assert.equal(answer.headers()['x-codec'], codec);
    }
  });
});
