// Pictures by their pixels, and measures of a picture of water.

/** The pixels of PNGs: a handle of an array of ImageData, in the page. */
export function pixelsOf(page, ...pngs) {
  return page.evaluateHandle(
    (pictures) =>
      Promise.all(
        pictures.map(async (base64) => {
          const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
          const image = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
          const context = new OffscreenCanvas(image.width, image.height).getContext('2d');
          context.drawImage(image, 0, 0);
          return context.getImageData(0, 0, image.width, image.height);
        }),
      ),
    pngs.map((png) => png.toString('base64')),
  );
}

/** WCAG's contrast of two relative luminances. */
export function contrast(a, b) {
  return (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
}

/**
 * Which pixels are water is what two looks of the same mesh differ by. Gives the relative luminance (WCAG) of the mean color of the water, and of
 * what lies from 2 to 8 pixels beside it; the parts of the picture's width and height that the water takes, without the outermost 1 % of it
 * on each side; and the leftmost pixel of it.
 */
export async function measureWater(page, water, wires) {
  return page.evaluate(
    ([one, other]) => {
      const { width, height, data } = one;
      const mask = new Uint8Array(width * height);
      for (let i = 0; i < mask.length; ++i)
        mask[i] = [0, 1, 2].some((c) => Math.abs(data[4 * i + c] - other.data[4 * i + c]) > 3) ? 1 : 0;
      const near = (radius) => {
        const grown = new Uint8Array(mask.length);
        mask.forEach((is, i) => {
          if (!is) return;
          const [x, y] = [i % width, Math.floor(i / width)];
          for (let v = Math.max(0, y - radius); v <= Math.min(height - 1, y + radius); ++v)
            grown.fill(1, v * width + Math.max(0, x - radius), v * width + Math.min(width, x + radius + 1));
        });
        return grown;
      };
      const [close, wide] = [near(1), near(8)];
      const luminance = (taken) => {
        const sum = [0, 0, 0];
        let count = 0;
        for (let i = 0; i < mask.length; ++i)
          if (taken(i)) {
            ++count;
            sum.forEach((_, c) => (sum[c] += data[4 * i + c]));
          }
        const [r, g, b] = sum.map((total) => {
          const x = total / count / 255;
          return x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4;
        });
        return 0.2126 * r + 0.7152 * g + 0.0722 * b;
      };
      const inside = [...mask.keys()].filter((i) => mask[i]);
      const extent = (coordinate, length) => {
        const sorted = Float64Array.from(inside, coordinate).sort();
        const out = Math.floor(sorted.length / 100);
        return (sorted[sorted.length - 1 - out] - sorted[out]) / length;
      };
      return {
        pixels: inside.length,
        left: inside.reduce((least, i) => Math.min(least, i % width), width),
        water: luminance((i) => mask[i]),
        beside: luminance((i) => wide[i] && !close[i]),
        wide: extent((i) => i % width, width),
        tall: extent((i) => Math.floor(i / width), height),
      };
    },
    await pixelsOf(page, water, wires),
  );
}
