// The mesh that a small picture is drawn of: a session's newest one, no finer than it must be.
import type { Frame } from '../bricks/frame';
import { FrameReceiver } from '../bricks/frame_receiver';
import type { WatchResponse } from '../gen/meniscus/v1/surface_service_pb';
import type { Received } from '../rpc/call';
import { Code, RpcError } from '../rpc/status';

/** The coarsest shows as much as a thumbnail can; of water that is thinner than its cells nothing may be left in it. */
const levels = [1, 3];

/** snapshot: the newest mesh with no cell finer than that level. None where the session has no mesh yet. */
export async function newestMesh(
  snapshot: (maxLevel: number) => AsyncIterable<Received<WatchResponse>>,
): Promise<Frame | undefined> {
  let newest: Frame | undefined;
  for (const maxLevel of levels) {
    try {
      newest = await frameOf(snapshot(maxLevel));
    } catch (error) {
      // Of a surface that was made elsewhere there is no coarser one.
      if (maxLevel < 3 && error instanceof RpcError && error.code === Code.failedPrecondition) continue;
      throw error;
    }
    // The statistics are those of the whole surface, whatever the level.
    if (!newest || newest.bricks.size > 0 || newest.statistics.triangles === 0n) break;
  }
  return newest;
}

/** Its one frame. The call is read to its end, which follows at once: one that is broken off costs its connection. */
export async function frameOf(answers: AsyncIterable<Received<WatchResponse>>): Promise<Frame | undefined> {
  const receiver = new FrameReceiver();
  let frame: Frame | undefined;
  for await (const { message, bytes } of answers) frame = receiver.take(message, bytes, performance.now()) ?? frame;
  return frame;
}
