import { describe, expect, it } from 'vitest';
import { WarningChoice } from '../src/ui/warnings';

describe('the warnings to be seen', () => {
  const small = { code: 1, text: 'the particle radius 0.1 is too small' };
  const cells = { code: 4, text: 'finest cells of 3 are too large' };

  it('are those of the frame, and none where it has none', () => {
    const choice = new WarningChoice();
    expect(choice.of([small, cells])).toEqual([small, cells]);
    expect(choice.of([])).toEqual([]);
  });

  it('leave out a kind that was dismissed, whatever its numbers are, and no other', () => {
    const choice = new WarningChoice();
    choice.dismiss(1);
    expect(choice.of([{ code: 1, text: 'the particle radius 0.2 is too small' }, cells])).toEqual([cells]);
    expect(new WarningChoice().of([small])).toEqual([small]);
  });

  it('are one of each kind, few and short, whatever a server sends', () => {
    const flood = Array.from({ length: 1000 }, (_, code) => ({ code, text: 'x'.repeat(100000) }));
    const shown = new WarningChoice().of([small, small, ...flood]);
    expect(shown.filter(({ code }) => code === 1)).toEqual([small]);
    expect(shown.length).toBe(8);
    expect(Math.max(...shown.map(({ text }) => text.length))).toBeLessThan(310);
  });
});
