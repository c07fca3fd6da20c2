// The objects of each overlay agree with each other.
import assert from 'node:assert/strict';
import { describe, test } from 'node:test';
import { named, of, one, overlays, podsOf, portNumber, render, sequence, settings, workloads } from './manifests.mjs';

const pod = (workload) => workload.spec.template.spec;
const bytes = (quantity) =>
  Number.parseFloat(quantity) *
  { '': 1, Ki: 2 ** 10, Mi: 2 ** 20, Gi: 2 ** 30, M: 2 ** 20, G: 2 ** 30 }[quantity.replace(/^[\d.]+/, '')];
const host = 'kubernetes.io/hostname';

function assertNoRights(workload) {
  const { securityContext, automountServiceAccountToken, enableServiceLinks, volumes, hostNetwork, hostPID } =
    pod(workload);
  assert.equal(automountServiceAccountToken, false, named(workload));
  assert.equal(enableServiceLinks, false, named(workload));
  assert.equal(securityContext.runAsNonRoot, true, named(workload));
  assert.ok(securityContext.runAsUser > 0 && securityContext.runAsGroup > 0, named(workload));
  assert.deepEqual(securityContext.seccompProfile, { type: 'RuntimeDefault' }, named(workload));
  assert.ok(!hostNetwork && !hostPID && !volumes.some(({ hostPath }) => hostPath), named(workload));
  for (const { name, securityContext: own, ports = [] } of pod(workload).containers) {
    assert.equal(own.allowPrivilegeEscalation, false, name);
    assert.equal(own.readOnlyRootFilesystem, true, name);
    assert.deepEqual(own.capabilities, { drop: ['ALL'] }, name);
    assert.ok(
      ports.every(({ hostPort }) => !hostPort),
      name,
    );
  }
}

for (const overlay of overlays) {
  describe(overlay, () => {
    const all = render(overlay);
    const server = one(all, 'StatefulSet');
    const [container] = pod(server).containers;
    const config = settings(one(all, 'ConfigMap').data['meniscus.conf']);
    const mounts = Object.fromEntries(
      container.volumeMounts.map(({ mountPath, name }) => [
        mountPath,
        pod(server).volumes.find((volume) => volume.name === name),
      ]),
    );
    const mountOf = (path) =>
      Object.entries(mounts).find(([mountPath]) => path === mountPath || path.startsWith(`${mountPath}/`))?.[1];

    test('is in a namespace of its own, which holds pods to the restricted profile', () => {
      for (const object of all.filter(({ kind }) => kind !== 'Namespace'))
        assert.equal(object.metadata.namespace, 'meniscus', named(object));
      assert.equal(one(all, 'Namespace').metadata.labels['pod-security.kubernetes.io/enforce'], 'restricted');
    });

    test('gives its pods no rights', () => workloads(all).forEach(assertNoRights));

    test('bounds what its pods take', () => {
      for (const workload of workloads(all)) {
        for (const { name, resources } of pod(workload).containers) {
          assert.ok(resources.requests.cpu && resources.requests.memory, name);
          assert.ok(bytes(resources.limits.memory) >= bytes(resources.requests.memory), name);
        }
        for (const { name, emptyDir } of pod(workload).volumes) assert.ok(!emptyDir || emptyDir.sizeLimit, name);
      }
      assert.ok(
        bytes(config['total-memory-limit']) + bytes(config['max-bytes-in-flight']) <
          bytes(container.resources.limits.memory),
      );
    });

    test('has a GPU where the server wants one', () => {
      const wanted = config.backend === 'cuda' ? '1' : undefined;
      assert.equal(container.resources.limits['nvidia.com/gpu'], wanted);
      assert.equal(container.image, wanted ? 'meniscus:cuda' : 'meniscus:cpu');
    });

    test('mounts what the settings name, read-only but the recordings', () => {
      const file = container.env.find(({ name }) => name === 'MENISCUS_CONFIG').value;
      assert.equal(mountOf(file).configMap.name, one(all, 'ConfigMap').metadata.name);
      assert.match(
        mountOf(file).configMap.name,
        /^meniscus-[a-z0-9]{10}$/,
        'with a hash, so that a change starts new pods',
      );
      for (const name of ['tls-cert', 'tls-key', 'tokens']) {
        if (config[name]) assert.equal(mountOf(config[name]).secret.defaultMode, 0o440, name);
      }
      if (config.record) assert.ok(bytes(mountOf(config.record).emptyDir.sizeLimit) > bytes(config['record-limit']));
      for (const { mountPath, readOnly } of container.volumeMounts)
        assert.equal(readOnly ?? false, mountPath !== '/recordings', mountPath);
    });

    test('asks for TLS where others can connect', () => {
      assert.equal(config.insecure === 'true', !config['tls-cert']);
      const open = of(all, 'NetworkPolicy').filter(({ spec }) => spec.ingress.some(({ from }) => !from));
      for (const { spec } of open) {
        for (const workload of podsOf(all, spec.podSelector.matchLabels))
          assert.ok(
            pod(workload).volumes.some(({ name }) => name === 'tls'),
            named(workload),
          );
      }
    });

    test('probes the port that has no TLS, by names that the container has', () => {
      const { startupProbe, livenessProbe, readinessProbe } = container;
      assert.deepEqual(startupProbe.httpGet, { path: '/healthz', port: 'probes' });
      assert.deepEqual(livenessProbe.httpGet, { path: '/healthz', port: 'probes' });
      assert.deepEqual(readinessProbe.httpGet, { path: '/readyz', port: 'probes' });
      for (const [name, setting] of [
        ['grpc', 'listen'],
        ['http', 'http'],
        ['probes', 'probes'],
      ])
        assert.equal(config[setting], `0.0.0.0:${portNumber(server, name)}`);
      for (const workload of workloads(all)) {
        for (const { name, ...probes } of pod(workload).containers) {
          for (const probe of [probes.startupProbe, probes.livenessProbe, probes.readinessProbe].filter(Boolean))
            assert.ok(portNumber(workload, (probe.httpGet ?? probe.tcpSocket).port), name);
        }
      }
    });

    test('selects pods that there are, by ports that they have', () => {
      const selected = (labels, object) => {
        const pods = podsOf(all, labels);
        assert.equal(pods.length, 1, named(object));
        return pods[0];
      };
      for (const workload of workloads(all)) {
        assert.equal(selected(workload.spec.selector.matchLabels, workload), workload);
        for (const { labelSelector, topologyKey } of pod(workload).topologySpreadConstraints ?? []) {
          assert.equal(selected(labelSelector.matchLabels, workload), workload);
          assert.equal(topologyKey, host);
        }
      }
      for (const service of of(all, 'Service')) {
        const workload = selected(service.spec.selector, service);
        for (const { targetPort } of service.spec.ports)
          assert.ok(portNumber(workload, targetPort), `${named(service)}: ${targetPort}`);
      }
      for (const budget of of(all, 'PodDisruptionBudget')) selected(budget.spec.selector.matchLabels, budget);
      for (const { spec } of of(all, 'HorizontalPodAutoscaler')) {
        assert.equal(
          one(all, spec.scaleTargetRef.kind, spec.scaleTargetRef.name).apiVersion,
          spec.scaleTargetRef.apiVersion,
        );
        assert.equal(
          one(all, spec.scaleTargetRef.kind, spec.scaleTargetRef.name).spec.replicas,
          undefined,
          'the autoscaler chooses the number',
        );
      }
      for (const monitor of of(all, 'ServiceMonitor')) {
        const services = of(all, 'Service').filter(({ metadata }) =>
          Object.entries(monitor.spec.selector.matchLabels).every(([key, value]) => metadata.labels?.[key] === value),
        );
        assert.deepEqual(
          services.map(({ metadata }) => metadata.name),
          ['meniscus'],
        );
        for (const { port } of monitor.spec.endpoints)
          assert.ok(
            services[0].spec.ports.some(({ name }) => name === port),
            port,
          );
      }
      const service = one(all, 'Service', server.spec.serviceName);
      assert.equal(service.spec.clusterIP, 'None');
    });

    test('lets in what its pods serve, and them out to nobody but each other', () => {
      for (const workload of workloads(all)) {
        const policies = of(all, 'NetworkPolicy').filter(({ spec }) =>
          podsOf(all, spec.podSelector.matchLabels).includes(workload),
        );
        assert.equal(policies.length, 1, named(workload));
        const { policyTypes, ingress, egress } = policies[0].spec;
        assert.deepEqual(policyTypes, ['Ingress', 'Egress']);
        const let_in = ingress.flatMap(({ ports }) => ports.map(({ port }) => portNumber(workload, port)));
        const served = pod(workload).containers.flatMap(({ ports }) => ports.map(({ containerPort }) => containerPort));
        assert.deepEqual([...new Set(let_in)].sort(), served.sort(), named(workload));
        for (const { to, ports } of egress) {
          const [{ podSelector, namespaceSelector }] = to;
          if (namespaceSelector)
            assert.deepEqual(
              ports.map(({ port }) => port),
              [53, 53],
            );
          else for (const { port } of ports) assert.ok(portNumber(podsOf(all, podSelector.matchLabels)[0], port), port);
        }
      }
    });
  });
}

describe('the proxy', () => {
  const all = render('cluster');
  const proxy = one(all, 'Deployment', 'meniscus-proxy');

  test('has the shipped configuration, which names the servers as the cluster does', () => {
    const configuration = one(all, 'ConfigMap', 'meniscus-proxy');
    const addresses = [...configuration.data['envoy.yaml'].matchAll(/address: ([\w.-]+), port_value: (\d+)/g)].map(
      ([, address, port]) => [address, Number(port)],
    );
    const upstream = addresses.filter(([address]) => address !== '0.0.0.0');
    assert.ok(upstream.length > 0);
    const server = one(all, 'StatefulSet');
    for (const [address, port] of upstream) {
      assert.equal(address, server.spec.serviceName);
      assert.ok(portNumber(server, port), port);
    }
    const [envoy] = pod(proxy).containers;
    assert.equal(pod(proxy).volumes[0].configMap.name, configuration.metadata.name);
    assert.ok(envoy.args.includes(`${envoy.volumeMounts[0].mountPath}/envoy.yaml`));
    const listener = addresses.find(([address]) => address === '0.0.0.0')[1];
    assert.match(envoy.args.at(-1), new RegExp(`address: 127.0.0.1, port_value: ${listener} `), 'whom its TLS is for');
    assert.match(envoy.args.at(-1), new RegExp(`address: 0.0.0.0, port_value: ${portNumber(proxy, 'tls')} `));
  });

  test('is whom others ask', () => {
    const services = of(all, 'Service').filter(({ spec }) => spec.type);
    assert.deepEqual(
      services.map(({ metadata }) => metadata.name),
      ['meniscus-proxy'],
    );
  });
});

describe('the job of a sequence', () => {
  const [job] = sequence();
  const [container] = pod(job).containers;

  test('gives its pods no rights', () => assertNoRights(job));

  test('tells each pod of how many it is', () => {
    assert.equal(job.spec.completionMode, 'Indexed');
    const { value } = container.env.find(({ name }) => name === 'JOB_COMPLETIONS');
    assert.equal(value, String(job.spec.completions));
    assert.ok(container.args.includes('--share=auto') && container.args.includes('--skip-existing'));
  });
});
