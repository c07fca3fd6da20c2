// The messages between the page and its decoding workers: one answer per request, in order.
import type { EncodedBrick } from '../bricks/frame';
import type { DecodedBrick } from './decoded_brick';

export interface DecodeRequest {
  readonly brick: EncodedBrick;
  readonly offsetBits: number;
  /** The one attribute that is decoded, of those that the brick carries. */
  readonly attribute: string | undefined;
}

export type DecodeAnswer = { readonly decoded: DecodedBrick } | { readonly error: string };
