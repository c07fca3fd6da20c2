// What of the picture the panels cover.
import type { Margins } from '../view/fit';
import { element } from './page';

/** CSS pixels, of the canvas. On a narrow screen the figures lie above the picture, otherwise beside it. */
export function coveredMargins(): Margins {
  const canvas = element('view', HTMLCanvasElement).getBoundingClientRect();
  const figures = element('overlay', HTMLElement).getBoundingClientRect();
  const controls = element('controls', HTMLElement).getBoundingClientRect();
  const beside = figures.width > 0 && figures.width < canvas.width / 3;
  return {
    top: figures.width > 0 && !beside ? figures.bottom - canvas.top : 0,
    right: beside ? canvas.right - figures.left : 0,
    bottom: controls.height > 0 ? canvas.bottom - controls.top : 0,
  };
}
