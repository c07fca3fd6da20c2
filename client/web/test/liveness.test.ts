import { expect, it } from 'vitest';
import { livenessOf } from '../src/ui/liveness';

const at = new Date(2026, 0, 2, 14, 3, 22).getTime();

it('live is said of what is being streamed and shown, and of nothing else', () => {
  expect(livenessOf({ kind: 'live' }, true, undefined)).toEqual({ text: 'Live', live: true });
  const others = [
    livenessOf({ kind: 'live' }, false, undefined),
    livenessOf({ kind: 'live' }, false, at),
    livenessOf({ kind: 'paused' }, true, undefined),
    livenessOf({ kind: 'ended', at, reason: '' }, true, undefined),
    livenessOf({ kind: 'absent', retryAt: 0, reason: '' }, true, undefined),
    livenessOf({ kind: 'waiting', retryAt: 0, reason: '' }, true, undefined),
  ];
  expect(others.map((liveness) => liveness?.live)).toEqual(others.map(() => false));
  expect(others.map((liveness) => liveness?.text)).toEqual([
    'Not streaming',
    'No stream since 14:03:22',
    'Paused',
    'Ended 14:03:22',
    '',
    '',
  ]);
});

it('while meshes of another quality are asked for, what was said holds', () => {
  expect(livenessOf({ kind: 'connecting' }, true, undefined)).toBeUndefined();
  expect(livenessOf({ kind: 'live' }, undefined, undefined)).toBeUndefined();
});
