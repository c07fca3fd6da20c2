// A dam break, recorded once, and played where a test needs frames at a rate that software drawing keeps up with.
import { mkdtempSync, readdirSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after } from 'node:test';
import { startServer, startSimulator, startUploader } from './programs.mjs';

export const frameCount = 240;
/** Frames a second. */
const rate = 16;

const folder = mkdtempSync(join(tmpdir(), 'meniscus-web-'));
after(() => rmSync(folder, { recursive: true }));
let recorded;

async function record() {
  const server = await startServer({ args: ['--record', folder] });
  const stats = join(folder, 'stats.json');
  const simulator = startSimulator(server, { frames: frameCount, stats });
  const began = performance.now();
  await simulator.finished();
  const seconds = (performance.now() - began) / 1000;
  await server.kill('SIGTERM');
  const session = join(folder, simulator.session);
  return {
    file: join(
      session,
      readdirSync(session).find((name) => name.endsWith('.recording')),
    ),
    speed: (seconds * rate) / frameCount,
    /** By frame. */
    triangles: JSON.parse(readFileSync(stats, 'utf8')).frames.map((frame) => frame.triangles),
  };
}

/** The recording's file, and its frames' triangles. */
export function recordedFile() {
  return (recorded ??= record());
}

/** faster: times the rate above. loop: for ever. frames: number of the first ones to send. session: its name. */
export async function startReplay(server, { faster = 1, loop = true, frames = frameCount, session } = {}) {
  const { file, speed, triangles } = await recordedFile();
  const args = ['replay', file, '--speed', `${speed * faster}`, '--to', `${frames - 1}`];
  const replay = startUploader(server, loop ? [...args, '--loop'] : args, session);
  return { ...replay, triangles };
}
