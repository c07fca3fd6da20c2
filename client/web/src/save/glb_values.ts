// The values of the surface's colors, in glTF's form. It has no 32-bit integers at vertices: ids are float32 where that holds all of them exactly,
// otherwise two uint16, the low one first, as `meniscus` writes them.
import type { AttributeForm } from '../bricks/attributes';
import type { AttributeArray } from '../decode/attribute_values';
import type { DecodedBrick } from '../decode/decoded_brick';

const unsignedByte = 5121;
const unsignedShort = 5123;
const float = 5126;

/** Whole numbers up to it are float32 exactly. */
const exactIds = 2 ** 24;

/** One attribute of all bricks. */
export interface GlbValues {
  readonly name: string;
  readonly componentType: number;
  readonly type: string;
  /** Bytes of one vertex. */
  readonly stride: number;
  /** The values of each brick. */
  readonly bytes: readonly Uint8Array[];
}

/** form: of the attribute that every brick was decoded with. */
export function glbValues(form: AttributeForm, bricks: readonly DecodedBrick[]): GlbValues {
  const name = `_${form.name.toUpperCase()}`;
  const values = bricks.map(({ attribute }) => attribute!.values);
  const of = (componentType: number, components: number, stride: number, arrays: AttributeArray[]): GlbValues => ({
    name,
    componentType,
    type: components === 1 ? 'SCALAR' : `VEC${components}`,
    stride,
    bytes: arrays.map((array) => new Uint8Array(array.buffer, array.byteOffset, array.byteLength)),
  });
  switch (form.type) {
    case 'float32':
      return of(float, form.components, 4 * form.components, values);
    case 'uint8':
      return of(
        unsignedByte,
        form.components,
        4,
        values.map((array) => wholeWords(array, form.components)),
      );
    case 'int32':
    case 'uint32':
      if (values.every((array) => array.every((id) => Math.abs(id) <= exactIds)))
        return of(
          float,
          1,
          4,
          values.map((array) => Float32Array.from(array)),
        );
      return of(unsignedShort, 2, 4, values);
  }
}

/** Four bytes for each vertex. */
function wholeWords(values: AttributeArray, components: number): Uint8Array {
  const padded = new Uint8Array((4 * values.length) / components);
  for (let point = 0; 4 * point < padded.length; ++point)
    padded.set(values.subarray(components * point, components * (point + 1)), 4 * point);
  return padded;
}
