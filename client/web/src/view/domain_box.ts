// The edges of the box to which a session's surface is cropped.
import { BoxGeometry, EdgesGeometry, LineBasicMaterial, LineSegments } from 'three';
import { center, type Point, type WorldBox } from './bounds';
import type { Theme } from './environment';
import { pictureLayer } from './thickness_pass';

export class DomainBox {
  private readonly material = new LineBasicMaterial({ toneMapped: false });
  readonly lines = new LineSegments(new EdgesGeometry(new BoxGeometry(1, 1, 1)), this.material);

  constructor() {
    this.lines.visible = false;
    this.lines.layers.set(pictureLayer);
  }

  setTheme(theme: Theme): void {
    this.material.color.set(theme === 'light' ? 0x4b5a68 : 0xa8b6c2);
  }

  /** origin: of the scene, world units. */
  show(box: WorldBox | undefined, origin: Point): void {
    this.lines.visible = box !== undefined;
    if (!box) return;
    const [x, y, z] = center(box);
    this.lines.position.set(x - origin[0], y - origin[1], z - origin[2]);
    this.lines.scale.set(box.max[0] - box.min[0], box.max[1] - box.min[1], box.max[2] - box.min[2]);
  }
}
