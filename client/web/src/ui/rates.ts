// Events of the last second.

export class Rate {
  private readonly events: { at: number; amount: number }[] = [];

  add(now: number, amount: number): void {
    this.events.push({ at: now, amount });
  }

  /** Sum of the amounts within the second before `now` (ms). */
  perSecond(now: number): number {
    while (this.events.length > 0 && this.events[0]!.at <= now - 1000) this.events.shift();
    return this.events.reduce((sum, event) => sum + event.amount, 0);
  }
}
