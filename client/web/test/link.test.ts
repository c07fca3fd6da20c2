import { describe, expect, it } from 'vitest';
import type { Point } from '../src/view/bounds';
import { readLink, writeLink } from '../src/ui/link';

describe('the link', () => {
  const state = {
    session: '01234567-89ab-cdef-0123-456789abcdef',
    camera: { position: [1.5, -2, 3e5] as [number, number, number], target: [0, 0.25, 0] as [number, number, number] },
    look: 'levels' as const,
    up: 'z' as const,
  };

  it('reopens what it was made of', () => {
    expect(readLink(writeLink(state))).toEqual(state);
    expect(readLink(writeLink({ session: state.session }))).toEqual({ session: state.session });
    expect(readLink('')).toEqual({});
  });

  it('reopens a recording at its frame', () => {
    const recorded = { recording: { session: state.session, number: 12 }, position: 34, look: 'levels' as const };
    expect(writeLink(recorded)).toBe(`#recording=${state.session}/12&position=34&look=levels`);
    expect(readLink(writeLink(recorded))).toEqual(recorded);
  });

  it('reopens cut, ruler, the session beside, and what is not to be seen', () => {
    const tools = {
      session: state.session,
      up: 'x' as const,
      cut: { axis: 'z' as const, at: -1000.0625, away: 'before' as const },
      ruler: [
        [1, 2, 3],
        [4, 5, 1e-7],
      ] as [Point, Point],
      beside: '11234567-89ab-cdef-0123-456789abcdef',
      scale: 'off' as const,
      domain: 'off' as const,
    };
    expect(readLink(writeLink(tools))).toEqual(tools);
    expect(writeLink(tools)).toContain('&cut=z,-1000.0625,before&ruler=1,2,3,4,5,1e-7&beside=1123');
  });

  it('reopens what the surface is colored by', () => {
    const { session } = state;
    const by = (color: Parameters<typeof writeLink>[0]['color']): string =>
      writeLink({ session, ...(color ? { color } : {}) });
    const plain = { map: 'viridis', range: 'session', unit: '', unlit: false } as const;
    const cases = {
      '&color=velocity': { ...plain, attribute: 'velocity' },
      '&color=velocity.x&range=frame': { ...plain, attribute: 'velocity', component: 'x', range: 'frame' },
      '&color=age&map=magma&range=-0.5,1e-7': { ...plain, attribute: 'age', map: 'magma', range: [-0.5, 1e-7] },
      '&color=velocity&unit=m/s&light=off': { ...plain, attribute: 'velocity', unit: 'm/s', unlit: true },
    } as const;
    for (const [text, color] of Object.entries(cases)) {
      expect(by(color)).toBe(`#session=${session}${text}`);
      expect(readLink(by(color))).toEqual({ session, color });
    }
    for (const wrong of ['map=jet&range=5,0', `unit=${'x'.repeat(17)}`, 'unit=m%07s&light=on', 'unit=a%E2%80%AEb'])
      expect(readLink(`#color=age&${wrong}`).color).toEqual({ ...plain, attribute: 'age' });
    for (const text of ['', 'Velocity', 'velocity.q', 'a b', 'x'.repeat(65), 'velocity.x.y'])
      expect(readLink(`#color=${text}&map=magma&range=0,5`).color).toBeUndefined();
  });

  it('leaves out what it does not understand', () => {
    expect(readLink('#camera=1,2,3&look=x&up=w')).toEqual({});
    expect(readLink('#camera=1,2,3,4,5,x')).toEqual({});
    for (const fields of ['cut=w,1,beyond', 'cut=x,,beyond', 'cut=x,1', 'ruler=1,2,3', 'beside=all', 'scale=on'])
      expect(readLink(`#${fields}`)).toEqual({});
    expect(readLink(`#recording=${state.session}/1&position=-1`)).toEqual({
      recording: { session: state.session, number: 1 },
    });
    expect(readLink('#camera=1,,3,4,5,6')).toEqual({});
  });

  it('has a problem for a session or a recording that cannot be, and none for one that has gone', () => {
    for (const hash of ['#session=../../etc', '#session=', `#session=${state.session.slice(1)}`]) {
      const { problem, ...rest } = readLink(hash);
      expect(problem).toMatch(/session ".*", which cannot be/);
      expect(rest).toEqual({});
    }
    expect(readLink(`#recording=${state.session}/0&position=1`).problem).toMatch(/recording ".*\/0", which cannot be/);
    expect(readLink(`#session=${'x'.repeat(9999)}`).problem!.length).toBeLessThan(300);
    expect(readLink(`#session=${state.session}`).problem).toBeUndefined();
  });
});
