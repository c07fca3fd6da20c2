// Numbers as people read them.

export function bytesText(bytes: number): string {
  const units = ['B', 'kB', 'MB', 'GB'];
  let unit = 0;
  while (bytes >= 1000 && unit < units.length - 1) {
    bytes /= 1000;
    ++unit;
  }
  return `${unit === 0 || bytes >= 100 ? Math.round(bytes) : bytes.toFixed(1)} ${units[unit]!}`;
}

export function millisecondsText(ms: number): string {
  return ms < 10 ? `${ms.toFixed(1)} ms` : `${Math.round(ms)} ms`;
}

/** In groups of three digits. */
export function countText(count: number | bigint): string {
  return count.toLocaleString('en-US');
}

interface Timed {
  readonly index: bigint;
  /** Seconds; zero in frames of simulators that give none. */
  readonly simulationTime: number;
}

export function frameText(frame: Timed): string {
  return withTime(`frame ${frame.index}`, frame);
}

export function withTime(text: string, { simulationTime }: Timed): string {
  return simulationTime === 0 ? text : `${text}, ${simulationTime.toFixed(2)} s`;
}

/** Digits after the point that show a hundredth of `step`, and no more. */
export function decimalsOf(step: number): number {
  return Math.min(12, Math.max(0, Math.ceil(2 - Math.log10(step))));
}

/** unit: may be empty. */
export function lengthText(length: number, unit: string, decimals?: number): string {
  return withUnit(decimals === undefined ? String(length) : length.toFixed(decimals), unit);
}

export function placeText(place: readonly number[], unit: string, decimals: number): string {
  return withUnit(place.map((x) => x.toFixed(decimals)).join(', '), unit);
}

function withUnit(text: string, unit: string): string {
  return unit === '' ? text : `${text} ${unit}`;
}

/** A mesh's volume, and its ratio to that of the particles. */
export function volumeText(volume: number, particles: number): string {
  return `${Number(volume.toPrecision(3))} (${(volume / particles).toFixed(2)})`;
}

/** Since then, in the largest unit that fits. */
export function ageText(seconds: number): string {
  const units = [
    [86_400, 'd'],
    [3600, 'h'],
    [60, 'min'],
  ] as const;
  // Clocks of two machines differ.
  const age = Math.max(0, seconds);
  const [length, name] = units.find(([unit]) => age >= unit) ?? ([1, 's'] as const);
  return `${Math.floor(age / length)} ${name}`;
}

export function rateText(perSecond: number): string {
  return `${perSecond < 10 ? Number(perSecond.toFixed(1)) : Math.round(perSecond)} frames/s`;
}

/** A time of this day, on this machine's clock. at: ms since 1970. */
export function clockText(at: number): string {
  return new Date(at).toLocaleTimeString('en-GB');
}
