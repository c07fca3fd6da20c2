// The proxy's configuration is one that Envoy understands: Debian has no Envoy to ask.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { parse } from 'yaml';
import { envoyProblems } from './envoy.mjs';
import { one, render } from './manifests.mjs';

const all = render('cluster');
const shipped = parse(one(all, 'ConfigMap', 'meniscus-proxy').data['envoy.yaml'], { merge: true });
const withTls = parse(one(all, 'Deployment', 'meniscus-proxy').spec.template.spec.containers[0].args.at(-1));
const bootstraps = [shipped, withTls];

test('it consists of what Envoy has', () => {
  for (const bootstrap of bootstraps) assert.deepEqual(envoyProblems(bootstrap), []);
  for (const { '@type': _, ...secret } of parse(one(all, 'ConfigMap', 'meniscus-proxy-tls').data['certificate.yaml'])
    .resources)
    assert.deepEqual(envoyProblems(secret, 'envoy.extensions.transport_sockets.tls.v3.Secret'), []);
});

test('its listeners and clusters have names of their own, and it names no other cluster', () => {
  const names = (kind) => bootstraps.flatMap(({ static_resources }) => static_resources[kind].map(({ name }) => name));
  for (const kind of ['listeners', 'clusters']) assert.equal(new Set(names(kind)).size, names(kind).length, kind);
  const named = [...JSON.stringify(bootstraps).matchAll(/"cluster":"(\w+)"/g)].map(([, name]) => name);
  assert.deepEqual([...new Set(named)].sort(), names('clusters').sort());
});

test('a setting that Envoy does not understand is reported', () => {
  const cases = [
    [
      (cluster) => {
        cluster.lb_polcy = 'RING_HASH';
      },
      /clusters\[0\].lb_polcy: Cluster has no such field/,
    ],
    [
      (cluster) => {
        cluster.lb_policy = 'RINGHASH';
      },
      /clusters\[0\].lb_policy is RINGHASH, none of .*RING_HASH/,
    ],
    [
      (cluster) => {
        cluster.connect_timeout = 1;
      },
      /connect_timeout is 1, no duration/,
    ],
    [
      (cluster) => {
        cluster.load_assignment.endpoints = {};
      },
      /endpoints is no list/,
    ],
    [
      (cluster) => {
        delete cluster.name;
      },
      /clusters\[0\] needs name/,
    ],
    [
      (_, listener) => {
        listener.filter_chains[0].filters[0].typed_config.stat_prefix = 1;
      },
      /stat_prefix is 1, no string/,
    ],
    [
      (_, listener) => {
        delete listener.filter_chains[0].filters[0].typed_config.route_config;
      },
      /needs one of .*route_config/,
    ],
  ];
  for (const [spoil, words] of cases) {
    const spoiled = structuredClone(shipped);
    spoil(spoiled.static_resources.clusters[0], spoiled.static_resources.listeners[0]);
    assert.match(envoyProblems(spoiled).join('\n'), words);
  }
});
