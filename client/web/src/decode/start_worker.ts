// A worker that decodes: a file of the viewer's, or, in a page that is a file of its own, a part of the page.
import { fromBase64 } from '../base64';

let inPage: string | undefined;

export function startDecodeWorker(): Worker {
  const code = document.getElementById('decode-worker')?.textContent;
  if (code === undefined)
    return new Worker(new URL('./worker.ts', import.meta.url), { type: 'module', name: 'decode' });
  inPage ??= URL.createObjectURL(new Blob([fromBase64(code)], { type: 'text/javascript' }));
  return new Worker(inPage, { name: 'decode' });
}
