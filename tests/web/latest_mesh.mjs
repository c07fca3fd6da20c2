import assert from 'node:assert/strict';
import { readFileSync, mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { describe, it } from 'node:test';
import validator from 'gltf-validator';
import { lattice, writeParticles } from './support/particles.mjs';
import { run, startServer, startUploader } from './support/programs.mjs';

/** The complaints of Khronos's validator about a file, hints left out. */
async function complaints(bytes) {
  const { issues } = await validator.validateBytes(new Uint8Array(bytes));
  return issues.messages.filter(({ severity }) => severity < 2);
}

describe('a mesh as GLB', () => {
  it('comes from the server as the Khronos validator passes it: plain, with attributes, by Draco', async () => {
    const server = await startServer();
    const { session } = startUploader(
      server,
      'simulate --scene dam-break --particles 2000 --frames 100000 --attribute velocity'.split(' '),
    );
    const address = `${server.url}sessions/${session}/latest.glb`;
    let answer = await fetch(address);
    const guard = AbortSignal.timeout(60_000);
    while (answer.status === 404) {
      guard.throwIfAborted();
      answer = await fetch(address);
    }
    assert.equal(answer.status, 200, await answer.clone().text());
    assert.equal(answer.headers.get('content-type'), 'model/gltf-binary');
    assert.deepEqual(await complaints(await answer.arrayBuffer()), []);
    for (const query of ['?attribute=velocity', '?draco']) {
      const other = await fetch(address + query);
      assert.equal(other.status, 200);
      const bytes = await other.arrayBuffer();
      assert.equal(Buffer.from(bytes).includes('_VELOCITY'), query !== '?draco');
      assert.deepEqual(await complaints(bytes), [], query);
    }
  });

  it('is written by meniscus reconstruct as the Khronos validator passes it', async () => {
    const folder = mkdtempSync(join(tmpdir(), 'meniscus-glb-'));
    try {
      const particles = join(folder, 'particles.ply');
      writeParticles(particles, lattice(4, 4, 4, 0.05));
      const mesh = join(folder, 'mesh.glb');
      await run(['reconstruct', particles, '-o', mesh, '--particle-radius', '0.025']);
      assert.deepEqual(await complaints(readFileSync(mesh)), []);
    } finally {
      rmSync(folder, { recursive: true });
    }
  });
});
