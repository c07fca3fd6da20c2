// Warnings about the newest frame, in the server's words. Each kind can be sent away for as long as the page
// lives.

/** The parts of the contract's Warning that are shown. */
export interface FrameWarning {
  readonly code: number;
  readonly text: string;
}

/** A server that means well sends one of each kind, a sentence each. */
const limits = { lines: 8, characters: 300 };

/** Which warnings are to be seen, of what comes. */
export class WarningChoice {
  private readonly dismissed = new Set<number>();

  dismiss(code: number): void {
    this.dismissed.add(code);
  }

  /** One of each kind that has not been dismissed. */
  of(warnings: readonly FrameWarning[]): FrameWarning[] {
    const chosen = new Map<number, FrameWarning>();
    for (const { code, text } of warnings) {
      if (chosen.size === limits.lines) break;
      if (this.dismissed.has(code) || chosen.has(code)) continue;
      const short = text.length > limits.characters ? `${text.slice(0, limits.characters)}…` : text;
      chosen.set(code, { code, text: short });
    }
    return [...chosen.values()];
  }
}

export class WarningList {
  private readonly choice = new WarningChoice();
  private lines = new Map<number, HTMLElement>();

  constructor(private readonly list: HTMLElement) {}

  /** In place of those of the frame before. */
  show(warnings: readonly FrameWarning[]): void {
    const chosen = this.choice.of(warnings);
    const same = chosen.length === this.lines.size && chosen.every(({ code }) => this.lines.has(code));
    if (!same) {
      // Frame by frame the same kinds come, with other numbers: a button under the pointer stays.
      this.lines = new Map(chosen.map(({ code }) => [code, document.createElement('span')]));
      this.list.replaceChildren(...[...this.lines].map(([code, line]) => this.row(code, line)));
      this.list.hidden = chosen.length === 0;
    }
    for (const { code, text } of chosen) {
      const line = this.lines.get(code)!;
      if (line.textContent !== text) line.textContent = text;
    }
  }

  private row(code: number, line: HTMLElement): HTMLElement {
    const row = document.createElement('li');
    const dismiss = document.createElement('button');
    dismiss.type = 'button';
    dismiss.textContent = '✕';
    dismiss.title = 'Do not show this again';
    dismiss.setAttribute('aria-label', 'Do not show this warning again');
    dismiss.addEventListener('click', () => {
      this.choice.dismiss(code);
      row.remove();
      this.lines.delete(code);
      this.list.hidden = this.lines.size === 0;
    });
    row.append(line, dismiss);
    return row;
  }
}
