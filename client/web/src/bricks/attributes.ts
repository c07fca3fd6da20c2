// The attributes that a mesh announces for its vertices.
import { AttributeType, type MeshAttribute } from '../gen/meniscus/v1/mesh_pb';
import { ProtocolError } from './protocol_error';

/** int32 and uint32 are ids: they are never averaged. */
export type ElementType = 'float32' | 'uint8' | 'int32' | 'uint32';

export interface AttributeForm {
  readonly name: string;
  readonly type: ElementType;
  /** Numbers per vertex. */
  readonly components: number;
}

export interface VertexAttribute extends AttributeForm {
  /** Least value of each component over the whole mesh; empty for a mesh without vertices. */
  readonly minimum: readonly number[];
  readonly maximum: readonly number[];
  /** Whether the frame's bricks have it. */
  readonly carried: boolean;
}

/** As bricks have it. */
export interface CodedAttribute extends AttributeForm {
  /** Per component; 0: exact. */
  readonly bits: number;
  /** With bits, of each component: the range that values are coded over. */
  readonly minimum: readonly number[];
  readonly maximum: readonly number[];
}

export const maxAttributes = 16;
const maxBits = 16;

const types: Partial<Record<AttributeType, ElementType>> = {
  [AttributeType.FLOAT32]: 'float32',
  [AttributeType.UINT8]: 'uint8',
  [AttributeType.INT32]: 'int32',
  [AttributeType.UINT32]: 'uint32',
};

export function isId(type: ElementType): boolean {
  return type === 'int32' || type === 'uint32';
}

/** All that are announced, and those that the bricks have. frame: its name, for errors. Throws ProtocolError. */
export function readAttributes(
  announced: readonly MeshAttribute[],
  frame: string,
): { attributes: VertexAttribute[]; coded: CodedAttribute[] } {
  if (announced.length > maxAttributes)
    throw new ProtocolError(`${frame} has ${announced.length} attributes; at most ${maxAttributes} are taken`);
  const attributes: VertexAttribute[] = [];
  const coded: CodedAttribute[] = [];
  for (const attribute of announced) {
    const form = readForm(attribute, frame);
    if (attributes.some(({ name }) => name === form.name))
      throw new ProtocolError(`${frame} has the attribute ${form.name} twice`);
    const { minimum, maximum, bits } = attribute;
    if (minimum.length > 0 || maximum.length > 0) requireRange(minimum, maximum, form, frame);
    attributes.push({ ...form, minimum, maximum, carried: bits !== undefined });
    if (bits !== undefined) coded.push(readCoding(attribute, bits, form, frame));
  }
  return { attributes, coded };
}

function readForm({ name, type: wire, components }: MeshAttribute, frame: string): AttributeForm {
  if (!/^[a-z0-9_]{1,64}$/.test(name))
    throw new ProtocolError(
      `${frame} has an attribute called "${name.slice(0, 64)}"; names are 1 to 64 of a-z, 0-9 and _`,
    );
  const type = types[wire];
  if (!type)
    throw new ProtocolError(`${frame}, attribute ${name}, has the type ${wire}, which this viewer does not know`);
  if (components !== 1 && (isId(type) || (components !== 3 && components !== 4)))
    throw new ProtocolError(
      `${frame}, attribute ${name}, has ${components} components of ${type}; allowed are ${isId(type) ? '1' : '1, 3 and 4'}`,
    );
  return { name, type, components };
}

function readCoding(
  { codedMinimum, codedMaximum }: MeshAttribute,
  bits: number,
  form: AttributeForm,
  frame: string,
): CodedAttribute {
  if (bits > (form.type === 'float32' ? maxBits : 0))
    throw new ProtocolError(`${frame}, attribute ${form.name}, has ${bits} bits per component of ${form.type}`);
  // A mesh without vertices has no range.
  if (bits > 0 && (codedMinimum.length > 0 || codedMaximum.length > 0))
    requireRange(codedMinimum, codedMaximum, form, frame);
  return { ...form, bits, minimum: codedMinimum, maximum: codedMaximum };
}

function requireRange(
  minimum: readonly number[],
  maximum: readonly number[],
  { name, components }: AttributeForm,
  frame: string,
): void {
  const whole =
    minimum.length === components &&
    maximum.length === components &&
    minimum.every((low, i) => Number.isFinite(low) && Number.isFinite(maximum[i]) && low <= maximum[i]!);
  if (!whole)
    throw new ProtocolError(
      `${frame}, attribute ${name}, has the range [${minimum.join(', ')}] to [${maximum.join(', ')}] for ${components} components`,
    );
}
