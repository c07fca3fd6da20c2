// One picture on the page: its water, and over it its annotations.
import type { PicturePane } from '../save/picture';
import { Annotations, type Marks } from '../view/annotations';
import type { Margins } from '../view/fit';
import type { Viewer } from '../view/viewer';

export class Pane implements PicturePane {
  private readonly over: Annotations;

  constructor(
    readonly water: HTMLCanvasElement,
    readonly annotations: HTMLCanvasElement,
    readonly viewer: Viewer,
    covered: () => Margins,
  ) {
    this.over = new Annotations(annotations, viewer, covered);
  }

  /** Both; the viewer's event `rendered` draws the annotations. */
  render(): void {
    this.viewer.render();
  }

  annotate(marks: Marks): void {
    this.over.draw(marks, this.viewer.box === undefined);
  }
}
