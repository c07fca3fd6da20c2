// The bricks in the scene. A new state replaces the old one between two pictures: no picture shows a part of it.
import { Group, LineSegments, Mesh, type LineBasicMaterial, type Material } from 'three';
import type { ShownBrick, Shown } from '../bricks/brick_store';
import { brickEdge, type BrickKey, type Frame } from '../bricks/frame';
import type { Quantity } from '../color/quantity';
import { surfaceGeometry, wireGeometry } from './brick_geometry';
import { pictureLayer } from './thickness_pass';

interface BrickMesh {
  readonly shown: ShownBrick;
  readonly surface: Mesh;
  wires: LineSegments | undefined;
}

export class BrickMeshes {
  readonly group = new Group();
  private readonly meshes = new Map<BrickKey, BrickMesh>();
  private wired = false;
  private quantity: Quantity | undefined;

  constructor(
    private surfaceMaterial: Material,
    private wireMaterials: LineBasicMaterial[],
  ) {}

  /** origin: of the scene, world units. */
  show({ frame, bricks }: Shown, origin: readonly [number, number, number]): void {
    for (const [key, mesh] of this.meshes)
      if (bricks.get(key) !== mesh.shown) {
        this.dispose(mesh);
        this.meshes.delete(key);
      }
    for (const [key, shown] of bricks) {
      let mesh = this.meshes.get(key);
      if (!mesh) {
        const geometry = surfaceGeometry(shown.decoded, this.quantity?.of(shown.decoded));
        mesh = { shown, surface: new Mesh(geometry, this.surfaceMaterial), wires: undefined };
        this.meshes.set(key, mesh);
        this.group.add(mesh.surface);
      }
      place(mesh.surface, frame, shown, origin);
    }
    this.updateWires();
  }

  clear(): void {
    for (const mesh of this.meshes.values()) this.dispose(mesh);
    this.meshes.clear();
  }

  /** That the points have; all bricks go, and are to be shown again. */
  setQuantity(quantity: Quantity | undefined): void {
    this.quantity = quantity;
    this.clear();
  }

  /** wireMaterials: one for each level; none: no wires. */
  setLook(surfaceMaterial: Material, wireMaterials: LineBasicMaterial[] | undefined): void {
    this.surfaceMaterial = surfaceMaterial;
    this.wired = wireMaterials !== undefined;
    if (wireMaterials) this.wireMaterials = wireMaterials;
    for (const { surface } of this.meshes.values()) surface.material = surfaceMaterial;
    this.updateWires();
  }

  private updateWires(): void {
    for (const mesh of this.meshes.values()) {
      if (!this.wired) {
        removeWires(mesh);
      } else {
        if (!mesh.wires) {
          mesh.wires = new LineSegments(wireGeometry(mesh.shown.decoded, mesh.surface.geometry), this.wireMaterials);
          mesh.wires.layers.set(pictureLayer);
          this.group.add(mesh.wires);
        }
        mesh.wires.material = this.wireMaterials;
        mesh.wires.position.copy(mesh.surface.position);
        mesh.wires.scale.copy(mesh.surface.scale);
      }
    }
  }

  private dispose(mesh: BrickMesh): void {
    removeWires(mesh);
    mesh.surface.geometry.dispose();
    mesh.surface.removeFromParent();
  }
}

function place(mesh: Mesh, frame: Frame, { encoded }: ShownBrick, origin: readonly [number, number, number]): void {
  const edge = brickEdge(frame);
  mesh.position.set(
    encoded.place[0] * edge - origin[0],
    encoded.place[1] * edge - origin[1],
    encoded.place[2] * edge - origin[2],
  );
  mesh.scale.setScalar(frame.cellSize / 2 ** frame.offsetBits);
}

function removeWires(mesh: BrickMesh): void {
  mesh.wires?.geometry.dispose();
  mesh.wires?.removeFromParent();
  mesh.wires = undefined;
}
