// The files that the viewer saves.
import { readFileSync } from 'node:fs';
import { pixelsOf } from './pictures.mjs';

/** Its bytes and its name. */
export async function save(page, button) {
  const [download] = await Promise.all([page.waitForEvent('download'), page.click(button)]);
  return { bytes: readFileSync(await download.path()), name: download.suggestedFilename() };
}

/** The same bytes where the browser does not report its downloads, as Firefox: what the page hands to it. */
export async function handed(page, button) {
  const base64 = await page.evaluate(async (selector) => {
    const { createObjectURL } = URL;
    const { click } = HTMLAnchorElement.prototype;
    HTMLAnchorElement.prototype.click = () => undefined;
    const blob = await new Promise((resolve) => {
      URL.createObjectURL = (file) => {
        resolve(file);
        return createObjectURL(file);
      };
      document.querySelector(selector).click();
    });
    Object.assign(URL, { createObjectURL });
    Object.assign(HTMLAnchorElement.prototype, { click });
    const reader = new FileReader();
    await new Promise((resolve) => {
      reader.addEventListener('load', resolve);
      reader.readAsDataURL(blob);
    });
    return reader.result.slice(reader.result.indexOf(',') + 1);
  }, button);
  return Buffer.from(base64, 'base64');
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
