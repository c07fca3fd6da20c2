// What the page and its decoding workers say to each other: one answer per request, in order.
import type { EncodedBrick } from '../bricks/frame';
import type { DecodedBrick } from './decoded_brick';

export interface DecodeRequest {
  readonly brick: EncodedBrick;
  readonly offsetBits: number;
  /** Of those that the brick carries, the one that is decoded. */
  readonly attribute: string | undefined;
}

export type DecodeAnswer = { readonly decoded: DecodedBrick } | { readonly error: string };
