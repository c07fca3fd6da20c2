// One thing that vertices have, as it is shown: a number, a color, or an id.
import { isId, type AttributeForm, type VertexAttribute } from '../bricks/attributes';
import type { Shown } from '../bricks/brick_store';
import { pointCount, type DecodedBrick } from '../decode/decoded_brick';
import { componentNames, type ColorChoice } from './color_choice';
import { colorOfId } from './id_palette';
import { unionOfRanges, valueText, type ValueRange } from './value_range';

export type QuantityKind = 'number' | 'color' | 'id';

/** The values of a brick's points. */
export interface PointValues {
  /** Numbers; or red, green, blue and a padding each, 0 to 255. */
  readonly values: Float32Array | Uint8Array;
  /** The range of numbers. */
  readonly range: ValueRange | undefined;
}

const colorNames = ['color', 'rgb', 'rgba'];

export class Quantity {
  readonly kind: QuantityKind;
  /** For people. */
  readonly title: string;
  private readonly component: number | undefined;
  private readonly known = new WeakMap<DecodedBrick, PointValues>();

  /** choice: a component that the attribute does not have is as if it were not there. */
  constructor(
    readonly form: AttributeForm,
    choice: Pick<ColorChoice, 'component'>,
  ) {
    const { name, type, components } = form;
    const chosen = choice.component === undefined ? -1 : componentNames.indexOf(choice.component);
    if (isId(type)) this.kind = 'id';
    else if (type === 'uint8' && components > 1 && colorNames.includes(name)) this.kind = 'color';
    else this.kind = 'number';
    const vector = this.kind === 'number' && components > 1;
    this.component = !vector ? 0 : chosen >= 0 && chosen < components ? chosen : undefined;
    this.title = !vector ? name : this.component === undefined ? `${name}, magnitude` : `${name}.${choice.component!}`;
  }

  /** None if the brick was decoded without it. */
  of(brick: DecodedBrick): PointValues | undefined {
    if (brick.attribute?.name !== this.form.name) return undefined;
    let values = this.known.get(brick);
    if (!values) this.known.set(brick, (values = this.evaluate(brick)));
    return values;
  }

  /** The range of a frame's numbers; none without any. */
  rangeOf({ frame, bricks }: Shown): ValueRange | undefined {
    if (this.kind !== 'number') return undefined;
    const attribute = frame.attributes.find(({ name }) => name === this.form.name);
    if (this.component !== undefined) return attribute && announced(attribute, this.component);
    return unionOfRanges([...bricks.values()].map(({ decoded }) => this.of(decoded)?.range));
  }

  /** For people: within the triangle of these points, of an id that of the nearest. extent: of the range that is shown. */
  textAt(
    brick: DecodedBrick,
    points: readonly [number, number, number],
    weights: readonly [number, number, number],
    extent: number,
  ): string | undefined {
    const values = this.of(brick)?.values;
    if (!values || !brick.attribute) return undefined;
    if (this.kind === 'id') return String(brick.attribute.values[points[weights.indexOf(Math.max(...weights))]!]);
    const stride = this.kind === 'color' ? 4 : 1;
    const mean = (channel: number): number =>
      points.reduce((sum, point, i) => sum + weights[i]! * values[stride * point + channel]!, 0);
    if (this.kind === 'number') return valueText(mean(0), extent);
    return [0, 1, 2].map((channel) => Math.round(mean(channel))).join(', ');
  }

  private evaluate(brick: DecodedBrick): PointValues {
    const { values } = brick.attribute!;
    const { components } = this.form;
    const points = pointCount(brick);
    if (this.kind !== 'number') {
      const colors = new Uint8Array(4 * points);
      for (let point = 0; point < points; ++point)
        colors.set(
          this.kind === 'id' ? colorOfId(values[point]!) : values.subarray(components * point, components * point + 3),
          4 * point,
        );
      return { values: colors, range: undefined };
    }
    const numbers = new Float32Array(points);
    let [low, high] = [Infinity, -Infinity];
    for (let point = 0; point < points; ++point) {
      const number =
        this.component === undefined
          ? magnitude(values, components * point, components)
          : values[components * point + this.component]!;
      numbers[point] = number;
      low = Math.min(low, number);
      high = Math.max(high, number);
    }
    return { values: numbers, range: points > 0 ? { low, high } : undefined };
  }
}

function magnitude(values: ArrayLike<number>, from: number, components: number): number {
  let sum = 0;
  for (let i = from; i < from + components; ++i) sum += values[i]! ** 2;
  return Math.sqrt(sum);
}

function announced({ minimum, maximum }: VertexAttribute, component: number): ValueRange | undefined {
  const [low, high] = [minimum[component], maximum[component]];
  return low === undefined || high === undefined ? undefined : { low, high };
}
