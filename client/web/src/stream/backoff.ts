// Waits between attempts: doubling, with a random part, so that many viewers do not return at the same moment.

export interface BackoffLimits {
  /** ms */
  readonly first: number;
  readonly longest: number;
}

/** For a server that is out of reach: soon after it is back, so is its viewer. */
export const reconnecting: BackoffLimits = { first: 250, longest: 1000 };
/** For a session that has ended, and may never come again. */
export const resting: BackoffLimits = { first: 500, longest: 8000 };

export class Backoff {
  private attempts = 0;

  /** random: 0 to 1. */
  constructor(
    private readonly limits: BackoffLimits,
    private readonly random: () => number = Math.random,
  ) {}

  /** Until the next attempt, ms: between half and all of the doubled wait. */
  next(): number {
    const whole = Math.min(this.limits.longest, this.limits.first * 2 ** this.attempts++);
    return whole * (0.5 + 0.5 * this.random());
  }

  reset(): void {
    this.attempts = 0;
  }
}
