// Whose picture is drawn next: those on the screen, one after the other, each once in a while, and only where there is something new.

interface Entry {
  frames: bigint;
  /** When its picture was asked for last, and of how many frames the session was then. */
  asked: { readonly at: number; readonly frames: bigint } | undefined;
}

export class ThumbnailSchedule {
  private readonly entries = new Map<string, Entry>();
  /** Ids of sessions on the screen; they may come before the list that has them. */
  private readonly visible = new Set<string>();

  /** every: ms between two pictures of one session. */
  constructor(private readonly every: number) {}

  /** Takes the sessions that the list holds now. */
  update(sessions: readonly { readonly id: string; readonly frames: bigint }[]): void {
    const ids = new Set(sessions.map(({ id }) => id));
    for (const kept of [this.entries, this.visible]) for (const id of kept.keys()) if (!ids.has(id)) kept.delete(id);
    for (const { id, frames } of sessions) {
      const entry = this.entries.get(id);
      if (entry) entry.frames = frames;
      else this.entries.set(id, { frames, asked: undefined });
    }
  }

  setVisible(id: string, visible: boolean): void {
    if (visible) this.visible.add(id);
    else this.visible.delete(id);
  }

  /** As if the session's picture had not been asked for; without one: all pictures. */
  forget(session?: string): void {
    for (const [id, entry] of this.entries) if (session === undefined || id === session) entry.asked = undefined;
  }

  /** Its picture was asked for, and did not come: it falls due again in its time, also without a newer frame. */
  missed(session: string): void {
    const entry = this.entries.get(session);
    if (entry?.asked) entry.asked = { at: entry.asked.at, frames: -1n };
  }

  /** The session that has waited longest, of those that are due; it counts as asked for. now: ms. */
  next(now: number): string | undefined {
    let next: string | undefined;
    let longest = -1;
    for (const [id, { frames, asked }] of this.entries) {
      if (!this.visible.has(id) || frames === 0n || frames === asked?.frames) continue;
      const waited = asked ? now - asked.at : Infinity;
      if (waited < this.every || waited <= longest) continue;
      next = id;
      longest = waited;
    }
    if (next !== undefined) {
      const entry = this.entries.get(next)!;
      entry.asked = { at: now, frames: entry.frames };
    }
    return next;
  }
}
