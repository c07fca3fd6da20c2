import { describe, expect, it } from 'vitest';
import { ageText, frameText, rateText, volumeText } from '../src/ui/texts';

describe('a volume', () => {
  it('has three digits at any scale, and its ratio to the particles beside it', () => {
    expect(volumeText(0.123456, 0.12)).toBe('0.123 (1.03)');
    expect(volumeText(1234.5, 1371.6)).toBe('1230 (0.90)');
    expect(volumeText(4.2e-9, 4e-9)).toBe('4.2e-9 (1.05)');
    expect(volumeText(0, 1)).toBe('0 (0.00)');
  });
});

it('an age has its largest unit, and is never in the future', () => {
  const ages = [-5, 0.9, 59, 60, 3599, 3600, 86_399, 86_400, 1e7].map(ageText);
  expect(ages).toEqual(['0 s', '0 s', '59 s', '1 min', '59 min', '1 h', '23 h', '1 d', '115 d']);
});

it('a rate has a digit behind the point where it is slow', () => {
  expect([0, 0.25, 9.96, 10.4, 240].map(rateText)).toEqual([
    '0 frames/s',
    '0.3 frames/s',
    '10 frames/s',
    '10 frames/s',
    '240 frames/s',
  ]);
});

it('a frame has its time, unless its simulator gives none', () => {
  expect(frameText({ index: 12n, simulationTime: 0.216 })).toBe('frame 12, 0.22 s');
  expect(frameText({ index: 12n, simulationTime: 0 })).toBe('frame 12');
});
