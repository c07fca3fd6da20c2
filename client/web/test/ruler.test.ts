import { describe, expect, it } from 'vitest';
import { decimalsOf, frameText, lengthText, placeText } from '../src/ui/texts';
import { measure } from '../src/view/ruler';

describe('the ruler', () => {
  it('measures the distance, and its part along each axis', () => {
    expect(measure([1, 2, 3], [3, -1, 9])).toEqual({ distance: 7, along: [2, -3, 6] });
    expect(measure([1e6, 0, 0], [1e6 + 0.001, 0, 0]).distance).toBeCloseTo(0.001, 9);
  });
});

describe('lengths', () => {
  it('have the digits that show a hundredth of a cell, and their unit where there is one', () => {
    expect([1, 0.0125, 1e-9, 500].map(decimalsOf)).toEqual([2, 4, 11, 0]);
    expect(lengthText(1.23456, 'm', 3)).toBe('1.235 m');
    expect(lengthText(0.2, '')).toBe('0.2');
    expect(placeText([1, -2.5, 1e6 + 0.001], 'mm', 3)).toBe('1.000, -2.500, 1000000.001 mm');
  });
});

describe('the slider', () => {
  it('has frame and time', () => {
    expect(frameText({ index: 1234n, simulationTime: 24.678 })).toBe('frame 1234, 24.68 s');
  });
});
