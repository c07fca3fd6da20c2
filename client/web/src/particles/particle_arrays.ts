// Where the arrays of a frame's particles lie among its bytes.
import { ElementType, type ParticleArray } from '../gen/meniscus/v1/surface_service_pb';

const maxArrays = 18;
const maxComponents = 16;

const elementBytes: ReadonlyMap<ElementType, number> = new Map([
  [ElementType.FLOAT32, 4],
  [ElementType.UINT8, 1],
  [ElementType.UINT16, 2],
  [ElementType.INT32, 4],
  [ElementType.UINT32, 4],
]);

/** The arrays that the viewer draws. */
const forms: ReadonlyMap<string, { readonly type: ElementType; readonly components: number }> = new Map([
  ['position', { type: ElementType.UINT16, components: 3 }],
  ['level', { type: ElementType.UINT8, components: 1 }],
]);

export interface ParticleLayout {
  /** The size of all arrays, bytes per particle. */
  readonly particleBytes: number;
  /** Bytes per particle of the arrays before the levels; undefined: without levels. Positions come first. */
  readonly levelsAfter: number | undefined;
}

/** Skips arrays that the viewer does not know. Throws an Error that names the array, the value and what is allowed. */
export function particleLayout(arrays: readonly ParticleArray[]): ParticleLayout {
  if (arrays.length > maxArrays) throw new Error(`${arrays.length} arrays; at most ${maxArrays} are taken`);
  if (arrays[0]?.name !== 'position')
    throw new Error(`the first array is '${arrays[0]?.name ?? ''}'; it must be 'position'`);
  const seen = new Map<string, number>();
  let particleBytes = 0;
  for (const { name, type, components } of arrays) {
    const bytes = elementBytes.get(type);
    if (bytes === undefined) throw new Error(`array '${name}' has the element type ${type}, which is not known`);
    if (components < 1 || components > maxComponents)
      throw new Error(`array '${name}' has ${components} components; it must have 1 to ${maxComponents}`);
    if (seen.has(name)) throw new Error(`array '${name}' comes twice`);
    const form = forms.get(name);
    if (form && (form.type !== type || form.components !== components))
      throw new Error(
        `array '${name}' is ${ElementType[type]} x ${components}; it must be ${ElementType[form.type]} x ${form.components}`,
      );
    seen.set(name, particleBytes);
    particleBytes += bytes * components;
  }
  return { particleBytes, levelsAfter: seen.get('level') };
}
