// A frame's particles as they are kept: quantized, as they came.

export interface Particles {
  readonly index: bigint;
  readonly runId: bigint;
  /** In the whole frame; every stride-th of them is here. */
  readonly frameCount: number;
  readonly stride: number;
  /** x y z per particle: min + q (max - min) / 65535. */
  readonly positions: Uint16Array;
  readonly min: readonly [number, number, number];
  readonly max: readonly [number, number, number];
  /** One per particle, 0 to 3; none: all of level 0. A particle of level k has 2^k times the radius. */
  readonly levels: Uint8Array | undefined;
  /** The radius at level 0, world units. */
  readonly radius: number;
}
