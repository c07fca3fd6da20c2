// The overlays, as kubectl renders them.
import { spawnSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { parseAllDocuments } from 'yaml';

export const overlays = ['laptop', 'gpu-host', 'cluster'];
export const kubectl = process.env.KUBECTL ?? 'kubectl';
const root = new URL('../../../deploy/kubernetes/', import.meta.url).pathname;
const folder = `${root}overlays/`;

/** The job that shares a sequence out, which no overlay has. */
export const sequence = () => objects(readFileSync(`${root}sequence/job.yaml`, 'utf8'));

export function render(overlay) {
  const { status, stdout, stderr } = spawnSync(kubectl, ['kustomize', folder + overlay], { encoding: 'utf8' });
  if (status !== 0) throw new Error(`${overlay} cannot be rendered: ${stderr}`);
  return objects(stdout);
}

export function objects(text) {
  return parseAllDocuments(text).map((document) => {
    if (document.errors.length > 0) throw document.errors[0];
    return document.toJS();
  });
}

export const named = ({ kind, metadata }) => `${kind} ${metadata.name}`;

/** All of a kind. */
export const of = (all, kind) => all.filter((object) => object.kind === kind);

/** The one of that kind and name; a generated name may have a hash behind it. */
export function one(all, kind, name = 'meniscus') {
  const found = of(all, kind).filter(
    ({ metadata }) => metadata.name === name || new RegExp(`^${name}-[a-z0-9]{10}$`).test(metadata.name),
  );
  if (found.length !== 1) throw new Error(`there are ${found.length} objects ${kind} ${name}`);
  return found[0];
}

/** Whatever starts pods. */
export const workloads = (all) => all.filter(({ spec }) => spec?.template?.spec?.containers);

export const podsOf = (all, labels) =>
  workloads(all).filter(({ spec }) =>
    Object.entries(labels).every(([key, value]) => spec.template.metadata.labels[key] === value),
  );

/** Of a named or numbered port of the pods, its number; undefined if they have none of that name. */
export function portNumber(workload, port) {
  const ports = workload.spec.template.spec.containers.flatMap((container) => container.ports ?? []);
  return ports.find(({ name, containerPort }) => port === name || port === containerPort)?.containerPort;
}

/** meniscus.conf of an overlay, as the server's settings. */
export function settings(text) {
  const lines = text.split('\n').filter((line) => line && !line.startsWith('#'));
  return Object.fromEntries(lines.map((line) => line.split(/\s*=\s*/)));
}
