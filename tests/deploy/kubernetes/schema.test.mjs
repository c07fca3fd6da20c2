// Every object of every overlay is one that Kubernetes knows.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { objects, overlays, render, sequence } from './manifests.mjs';
import { problemsOf } from './schema.mjs';

for (const overlay of overlays) {
  test(`${overlay} keeps to the schemas`, async () => assert.deepEqual(await problemsOf(render(overlay)), []));
}

test('the job of a sequence keeps to the schemas', async () => assert.deepEqual(await problemsOf(sequence()), []));

test('objects that do not keep to them are reported', async () => {
  const pod = (spec) =>
    objects(`
apiVersion: v1
kind: Pod
metadata: { name: wrong }
spec: ${spec}`);
  const cases = [
    ['{ containers: [{ name: a, image: b }] }', null],
    ['{ containers: [{ name: a, image: b, livenesProbe: {} }] }', /livenesProbe.* does not exist/],
    ['{ containers: [{ name: a, image: b, livenessProbe: { httpGet: { path: /, port: 1, sheme: HTTP } } }] }', /sheme/],
    ['{ containers: [{ image: b }] }', /name.* is missing/],
    [
      '{ containers: [{ name: a, resources: { limits: { memory: 4 gigabytes } } }] }',
      /limits\/memory must match format "quantity"/,
    ],
    [
      '{ containers: [{ name: a }], terminationGracePeriodSeconds: soon }',
      /'string' is not assignable to type 'number'/,
    ],
    ['{ containers: [{ name: a }], restartPolicy: Sometimes }', /Sometimes.* is not assignable/],
  ];
  for (const [spec, words] of cases) {
    const problems = (await problemsOf(pod(spec))).join('\n');
    if (words) assert.match(problems, words, spec);
    else assert.equal(problems, '');
  }
  assert.match(
    (await problemsOf(objects('{ apiVersion: apps/v1, kind: StatefullSet, metadata: { name: wrong } }'))).join('\n'),
    /StatefullSet/,
  );
});
