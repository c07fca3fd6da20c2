import { describe, expect, it, vi } from 'vitest';
import { ProtocolError } from '../src/bricks/protocol_error';
import { readManifest } from '../src/publications/manifest';
import { Publication } from '../src/publications/publication';
import { FileMissing, filesAt, FileUnavailable, TokenNeeded } from '../src/publications/publication_files';
import { next } from '../src/publications/publication_view';
import { readDamaged } from './support/damaged_publications';
import { bytesOf, golden, inMemory, segmentOf, textOf, withSegment, type Files } from './support/published';

const { signal } = new AbortController();

async function indices(files: Files, place = 0, count = 2): Promise<bigint[]> {
  const publication = await Publication.open(inMemory(files), signal);
  const read: bigint[] = [];
  for await (const frame of publication.frames(place, count, signal)) read.push(frame.index);
  return read;
}

/** With something of the manifest that is something else. */
function changed(what: string, by: string): Files {
  const files = golden();
  const manifest = textOf(files['manifest.json']!);
  expect(manifest).toContain(what);
  return { ...files, 'manifest.json': bytesOf(manifest.replace(what, by)) };
}

describe('a publication', () => {
  it('gives the frames that were published, from any place on', async () => {
    expect(await indices(golden())).toEqual([3n, 4n]);
    expect(await indices(golden(), 1, 1)).toEqual([4n]);
    await expect(indices(golden(), 2, 1)).rejects.toThrow(FileMissing);
    const { first, end, live, description, settings } = readManifest(golden()['manifest.json']!);
    expect([first, end, live, description?.name, settings?.particleRadius]).toEqual([0, 2, false, 'five', 0.125]);
  });

  it('counts places from the frames that have left', async () => {
    const files = changed('"left_frames": "0"', '"left_frames": "70"');
    expect(await indices(files, 71, 1)).toEqual([4n]);
    await expect(indices(files, 1, 1)).rejects.toThrow(FileMissing);
  });

  it('takes what a later version adds, and refuses a later version', async () => {
    expect(await indices(changed('"version": 1', '"version": 1, "later": {"a": [1]}'))).toEqual([3n, 4n]);
    expect(await indices(changed('FIELD_SMOOTH', 'FIELD_OF_LATER'))).toEqual([3n, 4n]);
    await expect(indices(changed('"version": 1', '"version": 2'))).rejects.toThrow('format version 2');
  });

  it('refuses a manifest that is none, or that contradicts itself', async () => {
    const sha256 = segmentOf(golden()).replace('.segment', '');
    const cases: [string, string][] = [
      [sha256, '../../secret'],
      [sha256, sha256.toUpperCase()],
      ['"frames": "2"', '"frames": "3"'],
      ['"frames": 2', '"frames": 0'],
      ['"frames": 2', '"frames": 4294967295'],
      ['"seconds": 0.08', '"seconds": -1'],
      ['"seconds": 0.08', '"seconds": "NaN"'],
      ['"last_frame": "4"', '"last_frame": "3"'],
      ['"left_frames": "0"', '"left_frames": "18446744073709551615"'],
      ['{', '[{'],
    ];
    for (const [what, by] of cases) await expect(indices(changed(what, by)), by).rejects.toThrow(ProtocolError);
    for (const text of ['', '{}', '[]', 'null', '<html>', '{"format": 1}'])
      expect(() => readManifest(bytesOf(text)), text).toThrow(ProtocolError);
  });

  it('refuses a segment that is cut, changed, or another one', async () => {
    const files = golden();
    const name = segmentOf(files);
    const bytes = files[name]!;
    for (const length of [0, 5, bytes.length - 1])
      await expect(indices({ ...files, [name]: bytes.subarray(0, length) })).rejects.toThrow('was cut or changed');
    for (let at = 0; at < bytes.length; at += 101) {
      const other = bytes.slice();
      other[at]! ^= 1;
      await expect(indices({ ...files, [name]: other })).rejects.toThrow('SHA-256');
    }
    const later = bytes.slice();
    later[textOf(bytes).indexOf('\n') + 3] = 9;
    await expect(indices(withSegment(files, later))).rejects.toThrow('format version 9');
    expect(await indices(withSegment(files, bytes))).toEqual([3n, 4n]);
  });

  it('takes any damage for what it is', async () => {
    const { manifests, segments } = await readDamaged(1500, 1);
    expect(manifests.refused).toBeGreaterThan(0);
    expect(segments.refused).toBeGreaterThan(0);
  });
});

describe('its files', () => {
  const answer = (response: Response) => vi.fn<typeof fetch>(() => Promise.resolve(response));

  it('lie beside the manifest, which alone is asked for again', async () => {
    for (const [url, manifest, segment] of [
      ['https://a.example/water', 'https://a.example/water/manifest.json', 'https://a.example/water/x.segment'],
      ['https://a.example/water/', 'https://a.example/water/manifest.json', 'https://a.example/water/x.segment'],
      ['https://a.example/w.json?v=1', 'https://a.example/w.json?v=1', 'https://a.example/x.segment'],
    ] as const) {
      const get = answer(new Response('ab'));
      const files = filesAt(new URL(url), get);
      expect(await files.read('manifest.json', 2, signal)).toEqual(bytesOf('ab'));
      get.mockResolvedValue(new Response('cd'));
      await files.read('x.segment', 2, signal);
      expect(get.mock.calls.map(([to, how]) => [to, how?.cache, how?.redirect])).toEqual([
        [manifest, 'no-cache', 'manual'],
        [segment, 'default', 'manual'],
      ]);
    }
  });

  it('are read no further than was announced', async () => {
    let pulled = 0;
    const endless = new ReadableStream({
      pull: (controller) => {
        ++pulled;
        controller.enqueue(new Uint8Array(1000));
      },
    });
    const files = filesAt(new URL('https://a.example/'), answer(new Response(endless)));
    await expect(files.read('x.segment', 2500, signal)).rejects.toThrow(ProtocolError);
    expect(pulled).toBeLessThan(6);
  });

  it('say what keeps them away', async () => {
    const at = (response: Response) => filesAt(new URL('https://a.example/'), answer(response)).read('x', 9, signal);
    await expect(at(new Response('', { status: 404 }))).rejects.toThrow(FileMissing);
    await expect(at(new Response('', { status: 503 }))).rejects.toThrow(FileUnavailable);
    await expect(at({ type: 'opaqueredirect', status: 0, ok: false } as Response)).rejects.toThrow('leads elsewhere');
    const away = filesAt(new URL('https://a.example/'), () => Promise.reject(new TypeError('Failed to fetch')));
    await expect(away.read('x', 9, signal)).rejects.toThrow('a.example cannot be reached');
  });

  it('are asked for with the token of the server that the viewer comes from, and of no other', async () => {
    const headers = (get: ReturnType<typeof answer>) => new Headers(get.mock.calls.at(-1)?.[1]?.headers);
    const refusing = answer(new Response('', { status: 401 }));
    let token = '';
    const own = (get: typeof fetch) => filesAt(new URL('https://a.example/'), get, () => token);
    await expect(own(refusing).read('x', 9, signal)).rejects.toThrow(TokenNeeded);
    expect(headers(refusing).has('authorization')).toBe(false);
    token = 'secret';
    const get = answer(new Response('ab'));
    await own(get).read('x', 9, signal);
    expect(headers(get).get('authorization')).toBe('Bearer secret');
    const other = filesAt(new URL('https://b.example/'), answer(new Response('', { status: 401 })));
    await expect(other.read('x', 9, signal)).rejects.toThrow(FileUnavailable);
  });
});

describe('a publication that grows', () => {
  it('is followed frame by frame, until too much is still to be shown', () => {
    const segments = [0, 1, 2, 3, 4].map((i) => ({
      sha256: '',
      bytes: 1,
      first: 10 * i,
      frames: 10,
      seconds: 1,
      firstFrame: 0n,
      lastFrame: 0n,
    }));
    expect(next({ segments }, 49, 0)).toBe(50);
    expect(next({ segments }, 20, 0.9)).toBe(21);
    expect(next({ segments }, 18, 0)).toBe(40);
    expect(next({ segments }, 0, 0)).toBe(40);
  });

  it('is followed at its pace by a page that takes longer for a frame', () => {
    const segments = [
      { sha256: '', bytes: 1, first: 0, frames: 25, seconds: 1, firstFrame: 0n, lastFrame: 24n },
      { sha256: '', bytes: 1, first: 25, frames: 25, seconds: 1, firstFrame: 25n, lastFrame: 49n },
    ];
    expect(next({ segments }, 10, 1)).toBe(12);
    expect(next({ segments }, 10, 7.5)).toBe(18);
    expect(next({ segments }, 40, 100)).toBe(49);
    expect(next({ segments }, 49, 100)).toBe(50);
  });
});
