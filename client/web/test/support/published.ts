// The golden publication, as this build's first wrote it, and files in memory.
import { createHash } from 'node:crypto';
import { readFileSync } from 'node:fs';
import { FileMissing, type PublicationFiles } from '../../src/publications/publication_files';

export type Files = Record<string, Uint8Array>;

const folder = new URL('../../../../tests/client/formats/golden_files/version_1_publication/', import.meta.url);

export function golden(): Files {
  const manifest = new Uint8Array(readFileSync(new URL('manifest.json', folder)));
  const files: Files = { 'manifest.json': manifest };
  for (const { sha256 } of (JSON.parse(textOf(manifest)) as { segments: { sha256: string }[] }).segments)
    files[`${sha256}.segment`] = new Uint8Array(readFileSync(new URL(`${sha256}.segment`, folder)));
  return files;
}

export function inMemory(files: Files): PublicationFiles {
  return {
    read: (name) => {
      const bytes = files[name];
      return bytes ? Promise.resolve(bytes) : Promise.reject(new FileMissing(name));
    },
  };
}

export function textOf(bytes: Uint8Array): string {
  return new TextDecoder().decode(bytes);
}

export function bytesOf(text: string): Uint8Array {
  return new TextEncoder().encode(text);
}

/** The name of the only segment. */
export function segmentOf(files: Files): string {
  return Object.keys(files).find((name) => name.endsWith('.segment'))!;
}

/** The same publication with other bytes of its segment, of which the manifest knows. */
export function withSegment(files: Files, bytes: Uint8Array): Files {
  const name = segmentOf(files);
  const sha256 = createHash('sha256').update(bytes).digest('hex');
  const manifest = textOf(files['manifest.json']!)
    .replace(name.replace('.segment', ''), sha256)
    .replaceAll(String(files[name]!.length), String(bytes.length));
  return { 'manifest.json': bytesOf(manifest), [`${sha256}.segment`]: bytes };
}
