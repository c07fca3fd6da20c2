// The real server takes the settings of each overlay.
import assert from 'node:assert/strict';
import { spawn, spawnSync } from 'node:child_process';
import { once } from 'node:events';
import { mkdirSync, mkdtempSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { createInterface } from 'node:readline';
import { after, describe, test } from 'node:test';
import { of, one, overlays, render, settings } from './manifests.mjs';

const { MENISCUSD } = process.env;
const token = 'a'.repeat(64);

/** The mounts of the server's container below a folder, as the kubelet makes them; and its settings, which name them there. */
class Mounted {
  constructor(overlay) {
    const all = render(overlay);
    this.folder = mkdtempSync(join(tmpdir(), 'meniscus-mounts-'));
    const pod = one(all, 'StatefulSet').spec.template.spec;
    let text = one(all, 'ConfigMap').data['meniscus.conf'];
    for (const { mountPath, name } of pod.containers[0].volumeMounts) {
      const path = join(this.folder, mountPath);
      mkdirSync(path, { recursive: true });
      this.fill(
        path,
        pod.volumes.find((volume) => volume.name === name),
      );
      text = text.replaceAll(` ${mountPath}`, ` ${path}`);
    }
    this.text = text;
  }

  /** Files of a Secret lie behind a link, so that all of them change at once. */
  fill(path, { secret }) {
    const files = {
      'meniscus-tls': this.certificate,
      'meniscus-tokens': () => ({ tokens: `admin operator ${token}\n` }),
    }[secret?.secretName];
    if (!files) return;
    mkdirSync(join(path, '..first'));
    symlinkSync('..first', join(path, '..data'));
    for (const [name, content] of Object.entries(files.call(this))) {
      writeFileSync(join(path, '..data', name), content, { mode: secret.defaultMode });
      symlinkSync(join('..data', name), join(path, name));
    }
  }

  certificate() {
    const made = spawnSync(
      'openssl',
      [
        'req',
        '-x509',
        '-newkey',
        'ec',
        '-pkeyopt',
        'ec_paramgen_curve:prime256v1',
        '-nodes',
        '-subj',
        '/CN=localhost',
        '-keyout',
        '-',
      ],
      { encoding: 'utf8' },
    );
    const [key, certificate] = made.stdout.split(/(?=-----BEGIN CERTIFICATE)/);
    return { 'tls.crt': certificate, 'tls.key': key };
  }

  /** The settings in a file. This machine need not have a GPU. */
  write(text = this.text) {
    const file = join(this.folder, 'meniscus.conf');
    writeFileSync(file, text);
    return { file, env: { MENISCUS_CONFIG: file, MENISCUS_BACKEND: 'cpu', PATH: process.env.PATH } };
  }

  check(text) {
    return spawnSync(MENISCUSD, ['--check-config'], { encoding: 'utf8', env: this.write(text).env });
  }
}

/** The server, listening on loopback, and where it has its probes. */
async function start(mounted) {
  const ports = { MENISCUS_LISTEN: '127.0.0.1:0', MENISCUS_HTTP: '127.0.0.1:0', MENISCUS_PROBES: '127.0.0.1:0' };
  const server = spawn(MENISCUSD, [], {
    env: { ...mounted.write().env, ...ports },
    stdio: ['ignore', 'ignore', 'pipe'],
  });
  for await (const line of createInterface({ input: server.stderr })) {
    const [probes] =
      /http:\/\/127[\d.:]+(?=")/.exec(line.includes('metrics and probes at') && !line.includes('viewer') ? line : '') ??
      [];
    if (probes) return { server, probes };
  }
  throw new Error('the server has ended');
}

for (const overlay of overlays) {
  describe(overlay, () => {
    const mounted = new Mounted(overlay);
    after(() => rmSync(mounted.folder, { recursive: true }));

    test('has settings that can be used', () => {
      const { status, stdout, stderr } = mounted.check();
      assert.equal(stderr, '');
      assert.equal(stdout, 'the settings can be used\n');
      assert.equal(status, 0);
    });

    test('is refused with a wrong setting, by file, line and value', () => {
      const cases = [
        [/^max-sessions = .*$/m, 'max-sessions = many', /:\d+: max-sessions: .*many/],
        [/^total-memory-limit = .*$/m, 'total-memory-limit = 8 gigabytes', /:\d+: total-memory-limit: .*gigabytes/],
        [/^backend = /m, 'backnd = ', /:\d+: backnd: there is no setting of this name; --backend is near it/],
        [
          /^(insecure|tls-cert|tls-key) = .*$/gm,
          '',
          /--listen 0.0.0.0:50051 can be reached from other machines, without TLS/,
        ],
      ];
      for (const [right, wrong, words] of cases) {
        const changed = mounted.text.replace(right, wrong);
        assert.notEqual(changed, mounted.text);
        const { status, stderr } = mounted.check(changed);
        assert.match(stderr, words);
        assert.equal(status, 2);
      }
    });

    test('gives a pod the time that its server takes to end', () => {
      const { spec } = one(render(overlay), 'StatefulSet').spec.template;
      const printed = spawnSync(MENISCUSD, ['--print-config'], { encoding: 'utf8', env: mounted.write().env });
      const grace = Number(settings(printed.stdout)['shutdown-grace']);
      const sleep = spec.containers[0].lifecycle?.preStop.sleep.seconds;
      assert.ok(spec.terminationGracePeriodSeconds > (sleep ?? 0) + grace);
      assert.equal(sleep !== undefined, overlay === 'cluster', 'only where others take over meanwhile');
    });

    test('starts, answers its probes without TLS, has what is scaled by, and ends at SIGTERM', async (t) => {
      const all = render(overlay);
      const { server, probes } = await start(mounted);
      t.after(() => server.kill('SIGKILL'));
      const [{ startupProbe, livenessProbe, readinessProbe }] = one(all, 'StatefulSet').spec.template.spec.containers;
      for (const { httpGet } of [startupProbe, livenessProbe, readinessProbe])
        assert.equal((await fetch(probes + httpGet.path)).status, 200, httpGet.path);
      const metrics = await (await fetch(`${probes}/metrics`)).text();
      // As a metrics adapter names them: of seconds, their rate.
      const names = of(all, 'HorizontalPodAutoscaler').flatMap(({ spec }) =>
        spec.metrics.map(({ pods }) => pods.metric.name),
      );
      for (const name of names) assert.match(metrics, new RegExp(`^${name}(_seconds_total)? `, 'm'));
      server.kill('SIGTERM');
      assert.deepEqual(await once(server, 'exit'), [0, null]);
    });
  });
}
