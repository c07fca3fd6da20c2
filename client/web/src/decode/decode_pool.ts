// Spreads bricks over workers, each of which decodes one at a time.
import type { EncodedBrick } from '../bricks/frame';
import { startDecodeWorker } from './start_worker';
import type { DecodedBrick } from './decoded_brick';
import type { DecodeAnswer, DecodeRequest } from './messages';

/** The part of a Worker that is needed. */
export interface DecodeWorker {
  postMessage(request: DecodeRequest): void;
  onmessage: ((event: MessageEvent<DecodeAnswer>) => void) | null;
  onerror: ((event: ErrorEvent) => void) | null;
}

interface Job {
  readonly request: DecodeRequest;
  readonly resolve: (brick: DecodedBrick) => void;
  readonly reject: (error: Error) => void;
}

export class DecodePool {
  private readonly idle: DecodeWorker[];
  private readonly queue: Job[] = [];

  constructor(workers: DecodeWorker[]) {
    this.idle = [...workers];
  }

  /** attribute: of those that the brick carries, the one that is decoded, too. */
  decode(brick: EncodedBrick, offsetBits: number, attribute?: string): Promise<DecodedBrick> {
    return new Promise((resolve, reject) => {
      this.queue.push({ request: { brick, offsetBits, attribute }, resolve, reject });
      this.next();
    });
  }

  private next(): void {
    if (this.queue.length === 0) return;
    const worker = this.idle.pop();
    if (!worker) return;
    const job = this.queue.shift()!;
    const settle = (answer: DecodeAnswer): void => {
      worker.onmessage = null;
      worker.onerror = null;
      this.idle.push(worker);
      if ('decoded' in answer) job.resolve(answer.decoded);
      else job.reject(new Error(answer.error));
      this.next();
    };
    worker.onmessage = (event) => {
      settle(event.data);
    };
    worker.onerror = (event) => {
      settle({ error: event.message || 'a decoding worker failed' });
    };
    worker.postMessage(job.request);
  }
}

/** One worker for each processor but the page's own. */
export function startDecodePool(): DecodePool {
  const count = Math.min(4, Math.max(1, navigator.hardwareConcurrency - 1));
  return new DecodePool(Array.from({ length: count }, startDecodeWorker));
}
