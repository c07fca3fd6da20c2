import { afterEach, describe, expect, it, vi } from 'vitest';
import { recordedFrames } from '../src/recordings/recorded_frames';
import { LiveVideo, whyNoRecorder } from '../src/save/live_video';
import type { Picture } from '../src/save/picture';
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

  it('that the browser cannot make is refused with the reason', () => {
    expect(whyNoEncoder({ VideoEncoder: Object, isSecureContext: true })).toBeUndefined();
    expect(whyNoEncoder({ isSecureContext: true })).toMatch(/no WebCodecs/);
    expect(whyNoEncoder({ isSecureContext: false })).toMatch(/HTTPS/);
    expect(whyNoRecorder({ MediaRecorder: Object })).toBeUndefined();
    expect(whyNoRecorder({})).toMatch(/no MediaRecorder/);
  });
});

/** A browser's recorder, as far as it is used. */
class FakeRecorder extends EventTarget {
  static last: FakeRecorder;
  static isTypeSupported = (): boolean => true;
  readonly mimeType = 'video/webm;codecs=vp9';
  state = 'inactive';
  constructor() {
    super();
    FakeRecorder.last = this;
  }
  start(): void {
    this.state = 'recording';
  }
  stop(): void {
    if (this.state === 'inactive') throw new Error('InvalidStateError');
    this.state = 'inactive';
    const data = new Blob(['picture']);
    this.dispatchEvent(Object.assign(new Event('dataavailable'), { data }));
    this.dispatchEvent(new Event('stop'));
  }
}

describe('a live video', () => {
  const picture = {
    canvas: { width: 2, height: 2, captureStream: () => ({}) },
    takeAll: () => undefined,
  } as unknown as Picture;
  const ended = vi.fn();
  const begin = (): LiveVideo => {
    vi.stubGlobal('MediaRecorder', FakeRecorder);
    vi.stubGlobal('requestAnimationFrame', (draw: () => void) => setTimeout(draw, 0));
    return new LiveVideo(picture, ended);
  };
  afterEach(() => {
    ended.mockClear();
    vi.unstubAllGlobals();
  });

  it('is what was recorded until it is stopped', async () => {
    const { bytes, type } = await begin().stop();
    expect([new TextDecoder().decode(bytes), type]).toEqual(['picture', 'video/webm']);
    expect(ended).not.toHaveBeenCalled();
  });

  it('reports that the browser has stopped it, and gives the part so far', async () => {
    const live = begin();
    FakeRecorder.last.stop();
    expect(ended).toHaveBeenCalledExactlyOnceWith(expect.stringContaining('stopped recording'));
    const { bytes } = await live.stop();
    expect(new TextDecoder().decode(bytes)).toBe('picture');
    expect(ended).toHaveBeenCalledTimes(1);
  });

  it('may be stopped while the browser stops it', async () => {
    const live = begin();
    const stopping = live.stop();
    FakeRecorder.last.stop();
    expect((await stopping).bytes).toHaveLength('picture'.length);
    expect(ended).not.toHaveBeenCalled();
  });
});
