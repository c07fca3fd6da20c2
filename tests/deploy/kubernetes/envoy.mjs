// Envoy's verdict on its configuration, by the messages that it is made of, as @grpc/grpc-js-xds has them.
import { existsSync, readdirSync } from 'node:fs';
import { createRequire } from 'node:module';
import { dirname, join } from 'node:path';
import protobuf from 'protobufjs';

const packageFolder = (name) => dirname(createRequire(import.meta.url).resolve(`${name}/package.json`));
const protos = join(packageFolder('@grpc/grpc-js-xds'), 'deps');
const folders = [...readdirSync(protos).map((name) => join(protos, name)), packageFolder('protobufjs')];
const root = new protobuf.Root();
root.resolvePath = (_, target) => folders.map((folder) => join(folder, target)).find(existsSync) ?? target;

/** name: as "envoy.config.bootstrap.v3.Bootstrap". */
function messageType(name) {
  const folder = name.split('.').slice(0, -1).join('/');
  root.loadSync(
    readdirSync(join(protos, 'envoy-api', folder)).map((file) => `${folder}/${file}`),
    { keepCase: true },
  );
  return root.lookupType(name);
}

const scalars = { string: 'string', bytes: 'string', bool: 'boolean' };
const wrappers = { StringValue: 'string', BytesValue: 'string', BoolValue: 'boolean' };

function scalarProblems(value, expected, path) {
  return typeof value === expected ? [] : [`${path} is ${JSON.stringify(value)}, no ${expected}`];
}

function fieldProblems(value, field, path) {
  if (field.resolvedType instanceof protobuf.Enum)
    return value in field.resolvedType.values
      ? []
      : [`${path} is ${value}, none of ${Object.keys(field.resolvedType.values)}`];
  return field.resolvedType
    ? problemsOf(value, field.resolvedType, path)
    : scalarProblems(value, scalars[field.type] ?? 'number', path);
}

function problemsOf(value, type, path) {
  const name = type.fullName.replace(/^\.google\.protobuf\./, '');
  if (name === 'Any') {
    const { '@type': url, ...rest } = value;
    return problemsOf(rest, messageType(url.replace('type.googleapis.com/', '')), path);
  }
  if (name === 'Duration') return /^\d+(\.\d+)?s$/.test(value) ? [] : [`${path} is ${value}, no duration`];
  if (name.endsWith('Value') && name in root.nested.google.nested.protobuf.nested)
    return scalarProblems(value, wrappers[name] ?? 'number', path);
  if (value === null || typeof value !== 'object' || Array.isArray(value))
    return [`${path} is ${JSON.stringify(value)}, no ${type.name}`];
  if (name === 'Struct') return []; // its names are free: Envoy's runtime keys
  const problems = type.oneofsArray
    .map((oneof) => [oneof, oneof.oneof.filter((key) => key in value)])
    .filter(([oneof, given]) => given.length > 1 || (given.length === 0 && oneof.options?.['(validate.required)']))
    .map(([oneof]) => `${path} needs one of ${oneof.oneof}`);
  const needed = Object.values(type.fields).filter(
    ({ partOf, options }) =>
      !partOf && (options?.['(validate.rules).message.required'] || options?.['(validate.rules).string.min_len']),
  );
  problems.push(...needed.filter((field) => !(field.name in value)).map((field) => `${path} needs ${field.name}`));
  for (const [key, entry] of Object.entries(value)) {
    const field = type.fields[key]?.resolve();
    const place = `${path}.${key}`;
    if (!field) problems.push(`${place}: ${type.name} has no such field`);
    else if (field.repeated && !Array.isArray(entry)) problems.push(`${place} is no list`);
    else if (field.repeated) problems.push(...entry.flatMap((item, i) => fieldProblems(item, field, `${place}[${i}]`)));
    else if (field.map)
      problems.push(
        ...Object.entries(entry).flatMap(([label, item]) => fieldProblems(item, field, `${place}.${label}`)),
      );
    else problems.push(...fieldProblems(entry, field, place));
  }
  return problems;
}

/** What is wrong with it, a line each. */
export const envoyProblems = (configuration, message = 'envoy.config.bootstrap.v3.Bootstrap') =>
  problemsOf(configuration, messageType(message), message.split('.').at(-1));
