import { describe, expect, it } from 'vitest';
import { FrameRates } from '../src/list/frame_rates';
import { givenName } from '../src/list/session_name';
import { inOrder, matches } from '../src/list/session_order';
import { newestOf } from '../src/ui/recording_offer';

const named = (name: string) => givenName({ description: { name } });

describe('a name', () => {
  it('is what the description says, without what would turn the text around it', () => {
    expect(named('dam break')).toBe('dam break');
    expect(named('سد')).toBe('سد');
    expect(named('\u202egnp.exe\u2066\u0007\n')).toBe('gnp.exe');
    expect(named('👨‍👩‍👧')).toBe('👨‍👩‍👧');
    expect(named(' \u200f ')).toBe('');
    expect(givenName({})).toBe('');
  });

  it('has 64 characters at most, none of them cut in two', () => {
    expect(named('🌊'.repeat(70))).toBe('🌊'.repeat(64));
  });
});

describe('the list of sessions', () => {
  const session = (id: string, uploading: boolean, createdAt: number) => ({
    id,
    uploading,
    createdAt: BigInt(createdAt),
  });

  it('has those that are live first, then the newest, in an order that is always the same', () => {
    const sessions = [
      session('a', false, 9),
      session('b', true, 1),
      session('d', false, 0),
      session('c', false, 0),
      session('e', true, 2),
    ];
    const order = ['e', 'b', 'a', 'c', 'd'];
    expect(inOrder(sessions).map(({ id }) => id)).toEqual(order);
    expect(inOrder([...sessions].reverse()).map(({ id }) => id)).toEqual(order);
    expect(sessions[0]!.id).toBe('a');
  });

  it('is searched by words, whatever their case and form', () => {
    const texts = ['Dam Break', '01234567-89ab-cdef-0123-456789abcdef', 'eve'];
    for (const found of ['', '  ', 'dam', 'BREAK dam', '0123', 'eve break', 'ｄａｍ', 'a'])
      expect(matches(found, ...texts), found).toBe(true);
    for (const not of ['dams', 'dam wave', 'k0', '.*', '\\']) expect(matches(not, ...texts), not).toBe(false);
  });

  it('knows frames a second from two lists', () => {
    const rates = new FrameRates();
    rates.update([{ id: 'a', frames: 100n }], 1000);
    expect(rates.of('a')).toBeUndefined();
    rates.update(
      [
        { id: 'a', frames: 130n },
        { id: 'b', frames: 5n },
      ],
      3000,
    );
    expect([rates.of('a'), rates.of('b'), rates.of('c')]).toEqual([15, undefined, undefined]);
    // Made again: its frames count from zero.
    rates.update([{ id: 'a', frames: 3n }], 5000);
    expect([rates.of('a'), rates.of('b')]).toEqual([undefined, undefined]);
    rates.update([{ id: 'a', frames: 3n }], 7000);
    expect(rates.of('a')).toBe(0);
  });
});

it('the recording that is offered is the newest of that session with frames', () => {
  const recordings = [
    { sessionId: 'a', number: 3, frames: 0n },
    { sessionId: 'a', number: 1, frames: 9n },
    { sessionId: 'a', number: 2, frames: 1n },
    { sessionId: 'b', number: 7, frames: 1n },
  ];
  expect(newestOf('a', recordings)).toEqual({ session: 'a', number: 2 });
  expect(newestOf('c', recordings)).toBeUndefined();
  expect(newestOf('a', recordings.slice(0, 1))).toBeUndefined();
});
