// Frames a second of each session: what two lists differ by.

interface Counted {
  readonly id: string;
  readonly frames: bigint;
}

export class FrameRates {
  private before = new Map<
    string,
    { readonly frames: bigint; readonly at: number; readonly rate: number | undefined }
  >();

  /** now: when the list came, ms. */
  update(sessions: readonly Counted[], now: number): void {
    this.before = new Map(
      sessions.map(({ id, frames }) => {
        const last = this.before.get(id);
        // A session that was made again counts from zero.
        const known = last && frames >= last.frames && now > last.at;
        return [
          id,
          { frames, at: now, rate: known ? (Number(frames - last.frames) * 1000) / (now - last.at) : undefined },
        ];
      }),
    );
  }

  /** Not known before its second list. */
  of(id: string): number | undefined {
    return this.before.get(id)?.rate;
  }
}
