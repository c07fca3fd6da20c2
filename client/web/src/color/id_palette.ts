// Ids as colors: the same for the same id, different ones for neighbors. client/picture/id_palette.cpp has the same colors.
import type { Rgb } from './color_maps';

/** id: int32 or uint32. */
export function colorOfId(id: number): Rgb {
  // Steps of the golden ratio: ids in a row have hues far apart.
  const hash = Math.imul(id, 0x9e3779b9) >>> 0;
  const hue = (6 * hash) / 2 ** 32;
  const lightness = 0.42 + 0.06 * ((hash >>> 3) & 3);
  const chroma = (1 - Math.abs(2 * lightness - 1)) * 0.65;
  const channel = (shift: number): number => {
    const away = Math.abs(((hue + shift) % 6) - 3) - 1;
    return Math.round(255 * (lightness + chroma * (Math.min(1, Math.max(0, away)) - 0.5)));
  };
  return [channel(0), channel(4), channel(2)];
}
