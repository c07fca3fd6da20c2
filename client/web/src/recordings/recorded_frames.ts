// All frames of a recording, from the first to the last, each once.
import type { Frame } from '../bricks/frame';
import { FrameReceiver } from '../bricks/frame_receiver';
import type { WatchResponse } from '../gen/meniscus/v1/surface_service_pb';
import type { Received } from '../rpc/call';

/** No more is read than is taken. Throws where the recording cannot be read. */
export async function* recordedFrames(answers: AsyncIterable<Received<WatchResponse>>): AsyncGenerator<Frame> {
  const receiver = new FrameReceiver();
  for await (const { message, bytes } of answers) {
    const frame = receiver.take(message, bytes, performance.now());
    if (frame) yield frame;
  }
}
