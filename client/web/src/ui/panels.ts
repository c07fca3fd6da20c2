// The part of the picture that the panels cover.
import type { Margins } from '../view/fit';
import { element } from './page';

/** CSS pixels, of the canvas. On a narrow screen the figures lie above the picture, and the tools' panels below it, otherwise beside it. */
export function coveredMargins(water: HTMLCanvasElement): Margins {
  const canvas = water.getBoundingClientRect();
  const figures = element('overlay', HTMLElement).getBoundingClientRect();
  const controls = element('controls', HTMLElement).getBoundingClientRect();
  const panels = element('panels', HTMLElement).getBoundingClientRect();
  const there = figures.width > 0 && figures.left < canvas.right && figures.top < canvas.bottom;
  const beside = there && figures.width < 0.45 * canvas.width;
  const below = panels.height > 0 && panels.width > controls.width / 2 ? panels.top : controls.top;
  return {
    top: there && !beside ? Math.max(0, figures.bottom - canvas.top) : 0,
    right: beside ? canvas.right - figures.left : 0,
    // Neither is there in a frame of another page.
    bottom: controls.height > 0 ? Math.max(0, canvas.bottom - below) : 0,
  };
}

/** Lays the panels above the controls, however many lines these have. */
export function keepPanelsAboveControls(changed: () => void): void {
  const [controls, panels, figures] = ['controls', 'panels', 'overlay'].map((id) => element(id, HTMLElement)) as [
    HTMLElement,
    HTMLElement,
    HTMLElement,
  ];
  const observer = new ResizeObserver(() => {
    element('watch', HTMLElement).style.setProperty('--controls', `${controls.offsetHeight}px`);
    changed();
  });
  observer.observe(controls);
  observer.observe(panels);
  // They come with the first frame; on a narrow screen their height counts, too.
  observer.observe(figures);
}
