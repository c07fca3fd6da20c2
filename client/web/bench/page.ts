// Reads the file of `codec-bricks`, and has a worker decode it.
import type { EncodedBrick } from '../src/bricks/frame';
import type { CodedMesh, Times } from './messages';

interface BrickFile {
  readonly offset_bits: number;
  readonly bricks: Readonly<
    Record<
      string,
      { place: [number, number, number]; vertices: number; triangles: number; cell_levels: string; data: string }[]
    >
  >;
}

declare global {
  interface Window {
    measure(file: BrickFile, rounds: number): Promise<[codec: number, times: readonly number[]][]>;
  }
}

const bytes = (base64: string): Uint8Array => Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));

window.measure = (file, rounds) => {
  const codecs = Object.entries(file.bricks).map(([codec, bricks]): [number, EncodedBrick[]] => [
    Number(codec),
    bricks.map(({ place, vertices, triangles, cell_levels, data }) => ({
      place,
      vertexCount: vertices,
      triangleCount: triangles,
      cellLevels: bytes(cell_levels),
      codec: Number(codec),
      data: bytes(data),
      attributes: [],
    })),
  ]);
  const mesh: CodedMesh = { offsetBits: file.offset_bits, bricks: new Map(codecs), rounds };
  const worker = new Worker(new URL('./worker.ts', import.meta.url), { type: 'module' });
  return new Promise((resolve, reject) => {
    worker.onmessage = ({ data }: MessageEvent<Times>) => {
      resolve([...data]);
    };
    worker.onerror = (event) => {
      reject(new Error(event.message));
    };
    worker.postMessage(mesh);
  });
};
