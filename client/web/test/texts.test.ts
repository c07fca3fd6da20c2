import { describe, expect, it } from 'vitest';
import { volumeText } from '../src/ui/texts';

describe('a volume', () => {
  it('has three digits at any scale, and its ratio to the particles beside it', () => {
    expect(volumeText(0.123456, 0.12)).toBe('0.123 (1.03)');
    expect(volumeText(1234.5, 1371.6)).toBe('1230 (0.90)');
    expect(volumeText(4.2e-9, 4e-9)).toBe('4.2e-9 (1.05)');
    expect(volumeText(0, 1)).toBe('0 (0.00)');
  });
});
