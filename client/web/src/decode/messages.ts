// What the page and its decoding workers say to each other: one answer per request, in order.
import type { EncodedBrick } from '../bricks/frame';
import type { DecodedBrick } from './decoded_brick';

export interface DecodeRequest {
  readonly brick: EncodedBrick;
  readonly offsetBits: number;
}

export type DecodeAnswer = { readonly decoded: DecodedBrick } | { readonly error: string };
