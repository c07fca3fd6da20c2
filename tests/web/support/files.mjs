// The files that the viewer saves.
import { readFileSync } from 'node:fs';
import { pixelsOf } from './pictures.mjs';

/** Its bytes and its name. */
export async function save(page, button) {
  const [download] = await Promise.all([page.waitForEvent('download'), page.click(button)]);
  return { bytes: readFileSync(await download.path()), name: download.suggestedFilename() };
}

/** A PNG's size, and the colors at some places, parts of its width and height. */
export async function readPng(page, bytes, places) {
  return page.evaluate(
    ([[{ width, height, data }], at]) => {
      const colors = at.map(([x, y]) => {
        const first = 4 * (Math.floor(x * width) + width * Math.floor(y * height));
        return [...data.slice(first, first + 4)];
      });
      return { width, height, colors };
    },
    [await pixelsOf(page, bytes), places],
  );
}

/** A video's size, its seconds, and whether its middle can be sought. page: a blank one, since the viewer's policy lets no video in. */
export async function readVideo(page, bytes) {
  return page.evaluate(async (base64) => {
    const video = document.createElement('video');
    video.muted = true;
    const event = (name) =>
      new Promise((resolve, reject) => {
        video.addEventListener(name, resolve, { once: true });
        video.addEventListener('error', () => reject(new Error(video.error.message)), { once: true });
      });
    const loaded = event('loadeddata');
    video.src = `data:video/webm;base64,${base64}`;
    await loaded;
    const { videoWidth: width, videoHeight: height, duration: seconds } = video;
    if (Number.isFinite(seconds)) {
      const sought = event('seeked');
      video.currentTime = seconds / 2;
      await sought;
    }
    return { width, height, seconds };
  }, bytes.toString('base64'));
}
