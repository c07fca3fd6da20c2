// A bar of a round length: the scale at the place that the camera looks at.
import { drawLine, drawText, type Pen } from './pen';

/** CSS pixels. */
const widest = 120;

/** The longest of 1, 2 and 5 times the powers of ten that is not longer than the limit. */
export function roundLength(limit: number): number {
  const exponent = Math.floor(Math.log10(limit));
  // As decimals are read, so that they are written the same again.
  const candidates = [`1e${exponent + 1}`, `5e${exponent}`, `2e${exponent}`, `1e${exponent}`, `5e${exponent - 1}`];
  return candidates.map(Number).find((length) => length <= limit)!;
}

/** World units per CSS pixel. distance: from the camera, world units. fov: degrees, of the height. height: of the picture, CSS pixels. */
export function worldPerPixel(distance: number, fov: number, height: number): number {
  return (2 * distance * Math.tan((fov * Math.PI) / 360)) / height;
}

export function scaleBar(perPixel: number): { readonly length: number; readonly pixels: number } {
  const length = roundLength(widest * perPixel);
  return { length, pixels: length / perPixel };
}

/** From its left end. text: of the length. */
export function drawScaleBar(pen: Pen, [x, y]: readonly [number, number], pixels: number, text: string): void {
  drawLine(pen, [
    [x, y - 5],
    [x, y],
    [x + pixels, y],
    [x + pixels, y - 5],
  ]);
  drawText(pen, text, [x + pixels / 2, y - 13]);
}
