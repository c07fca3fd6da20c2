// Kubernetes' verdict on an object, by its schemas as kubernetes-models has them: as types, which know every field there is,
// and as functions, which know how a value must look.
import ts from 'typescript';

function moduleOf({ apiVersion, kind }) {
  const models = apiVersion.startsWith('monitoring.coreos.com/')
    ? '@kubernetes-models/prometheus-operator'
    : 'kubernetes-models';
  return `${models}/${apiVersion}/${kind}`;
}

const textOf = (object) => `import type { I${object.kind} } from '${moduleOf(object)}';
export const object: I${object.kind} = ${JSON.stringify(object, null, 1)};`;

/** Fields that there are not, that are missing, or that are of another type: a line each. */
function wrongTypes(objects) {
  const files = new Map(objects.map((object, i) => [new URL(`object${i}.ts`, import.meta.url).pathname, object]));
  const options = {
    noEmit: true,
    strict: true,
    skipLibCheck: true,
    types: [],
    module: ts.ModuleKind.NodeNext,
    moduleResolution: ts.ModuleResolutionKind.NodeNext,
  };
  const host = ts.createCompilerHost(options);
  const { fileExists, getSourceFile } = host;
  host.fileExists = (name) => files.has(name) || fileExists(name);
  host.getSourceFile = (name, ...rest) =>
    files.has(name)
      ? ts.createSourceFile(name, textOf(files.get(name)), ts.ScriptTarget.ESNext)
      : getSourceFile(name, ...rest);
  return ts.getPreEmitDiagnostics(ts.createProgram([...files.keys()], options, host)).map(({ file, messageText }) => {
    const { kind, metadata } = files.get(file.fileName);
    return `${kind} ${metadata?.name}: ${ts.flattenDiagnosticMessageText(messageText, ' ')}`;
  });
}

async function wrongValues(object) {
  try {
    const model = (await import(moduleOf(object)))[object.kind];
    new model(object).validate();
    return [];
  } catch (error) {
    return [`${object.kind} ${object.metadata?.name}: ${error.message}`];
  }
}

/** What is wrong with the objects, a line each. */
export async function problemsOf(objects) {
  return [...wrongTypes(objects), ...(await Promise.all(objects.map(wrongValues))).flat()];
}
