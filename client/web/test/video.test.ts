import { describe, expect, it } from 'vitest';
import { recordedFrames } from '../src/recordings/recorded_frames';
import { whyNoRecorder } from '../src/save/live_video';
import { whyNoEncoder } from '../src/save/video_encoder';
import { frame, type FrameOptions } from './support/messages';

describe('a video', () => {
  it('of a recording gets every frame once, in order, and no more of them than are taken', async () => {
    let sent = 0;
    async function* answers() {
      for (let index = 0; index < 5; ++index)
        for (const message of frame({ index: 10 * index, bricks: [{ place: [0, 0, 0] }] } satisfies FrameOptions)) {
          ++sent;
          yield await Promise.resolve({ message, bytes: 1 });
        }
    }
    const taken: bigint[] = [];
    for await (const { index } of recordedFrames(answers())) {
      taken.push(index);
      // Of three messages each.
      expect(sent).toBe(3 * taken.length);
    }
    expect(taken).toEqual([0n, 10n, 20n, 30n, 40n]);
  });

  it('that the browser cannot make is told of, and why', () => {
    expect(whyNoEncoder({ VideoEncoder: Object, isSecureContext: true })).toBeUndefined();
    expect(whyNoEncoder({ isSecureContext: true })).toMatch(/no WebCodecs/);
    expect(whyNoEncoder({ isSecureContext: false })).toMatch(/HTTPS/);
    expect(whyNoRecorder({ MediaRecorder: Object })).toBeUndefined();
    expect(whyNoRecorder({})).toMatch(/no MediaRecorder/);
  });
});
