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
  const narrow = panels.width > controls.width / 2;
  const below = panels.height > 0 && narrow ? panels.top : controls.top;
  const right = beside ? canvas.right - figures.left : 0;
  const left = panels.height > 0 && !narrow && panels.left < canvas.right ? panels.right - canvas.left : 0;
  return {
    top: there && !beside ? Math.max(0, figures.bottom - canvas.top) : 0,
    right,
    // Where that leaves less than half, the water is rather under the panels than small.
    left: left + right < canvas.width / 2 ? Math.max(0, left) : 0,
    // Neither is there in a frame of another page.
    bottom: controls.height > 0 ? Math.max(0, canvas.bottom - below) : 0,
  };
}

/** Scrolls to the panel of a tool, if it has one that is open: with several open, it may lie below the others. */
export function scrollToPanel(tool: string): void {
  document.getElementById(`${tool}-panel`)?.scrollIntoView({ block: 'nearest' });
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
