// The real programs, as processes of the test.
import { spawn } from 'node:child_process';
import { once, setMaxListeners } from 'node:events';
import { randomUUID } from 'node:crypto';

const meniscusd = process.env.MENISCUSD;
const meniscus = process.env.MENISCUS;
if (!meniscusd || !meniscus) throw new Error('MENISCUSD and MENISCUS name the programs to test');

const running = new Set();

function start(program, args) {
  const child = spawn(program, args, { stdio: ['ignore', 'pipe', 'pipe'] });
  child.output = '';
  for (const stream of [child.stdout, child.stderr]) stream.on('data', (bytes) => (child.output += bytes));
  running.add(child);
  child.ended = once(child, 'exit').then(() => running.delete(child));
  return child;
}

export async function stopAll() {
  for (const child of running) child.kill('SIGKILL');
  await Promise.all([...running].map((child) => child.ended));
}

/** Resolves with the first match of what the process prints. */
async function printed(child, pattern) {
  const guard = AbortSignal.timeout(60_000);
  setMaxListeners(0, guard);
  for (;;) {
    const match = pattern.exec(child.output);
    if (match) return match;
    if (child.exitCode !== null) throw new Error(`${child.spawnfile} ended: ${child.output}`);
    await Promise.race([
      ...[child.stdout, child.stderr].map((stream) => once(stream, 'data', { signal: guard })),
      once(child, 'exit', { signal: guard }),
    ]);
  }
}

/** ports: of a server before it, which it takes the place of. */
export async function startServer({ ports = { grpc: 0, http: 0 }, args = [] } = {}) {
  const child = start(meniscusd, [
    '--listen',
    `127.0.0.1:${ports.grpc}`,
    '--http',
    `127.0.0.1:${ports.http}`,
    '--threads',
    '2',
    '--shutdown-grace',
    '2',
    ...args,
  ]);
  const [, grpc] = await printed(child, /listening on 127\.0\.0\.1:(\d+)/);
  const [, http] = await printed(child, /http:\/\/127\.0\.0\.1:(\d+)/);
  return {
    ports: { grpc, http },
    address: `127.0.0.1:${grpc}`,
    url: `http://127.0.0.1:${http}/`,
    kill: async (signal = 'SIGKILL') => {
      child.kill(signal);
      await child.ended;
    },
  };
}

/** args: of `meniscus`. Resolves when it has ended well. */
export async function run(args) {
  const child = start(meniscus, args);
  await child.ended;
  if (child.exitCode !== 0)
    throw new Error(`${args[0]} ended with ${child.exitCode ?? child.signalCode}: ${child.output}`);
}

/** Streams a dam break as fast as it can. Its session goes when it ends, and stays when it is killed. */
export function startSimulator(server, { session, particles = 2000, frames = 100_000, stats, publish } = {}) {
  const args = ['simulate', '--scene', 'dam-break', '--particles', `${particles}`, '--frames', `${frames}`];
  if (stats) args.push('--stats', stats);
  if (publish) args.push('--publish');
  return startUploader(server, args, session);
}

/** args: of `meniscus`, without the server and the session. */
export function startUploader(server, args, session = randomUUID()) {
  const child = start(meniscus, [...args, '--session', session, '--server', server.address]);
  return {
    session,
    /** Resolves once a frame has been answered: the session is there. */
    begun: () => printed(child, /^frame \d+/m),
    /** Resolves when all has been sent. */
    finished: async () => {
      await child.ended;
      if (child.exitCode !== 0)
        throw new Error(`${args[0]} ended with ${child.exitCode ?? child.signalCode}: ${child.output}`);
    },
    kill: async () => {
      child.kill('SIGKILL');
      await child.ended;
    },
  };
}

/** Publishes a session to a folder. Resolves once the manifest is there. */
export async function startPublisher(server, session, folder, ...args) {
  const child = start(meniscus, ['publish', session, '--server', server.address, '--to', folder, ...args]);
  await printed(child, /publishing/);
  return {
    kill: async () => {
      child.kill('SIGKILL');
      await child.ended;
    },
  };
}

/** Writes the meshes of a session as they come. */
export function startWatcher(server, session, folder) {
  start(meniscus, ['watch', session, '--server', server.address, '-o', folder, '--format', 'bricks', '-q']);
}
