// Facts about a session or a recording that matter to its picture.
import type { Recording } from './gen/meniscus/v1/recording_service_pb';
import { UpAxis as WireUpAxis, type Session, type SessionDescription } from './gen/meniscus/v1/session_service_pb';
import type { Box } from './gen/meniscus/v1/settings_pb';
import type { Manifest } from './publications/manifest';
import { sameRecording, type RecordingName } from './recordings/recording_name';
import type { Server } from './rpc/server';
import type { WorldBox } from './view/bounds';
import type { UpAxis } from './view/up_axis';

export interface SceneFacts {
  /** None: not said. */
  readonly up: UpAxis | undefined;
  /** The unit of lengths; empty: not said. */
  readonly unit: string;
  /** The box to which the surface is cropped. A recording does not have it. */
  readonly domain: WorldBox | undefined;
}

export const noFacts: SceneFacts = { up: undefined, unit: '', domain: undefined };

const upAxes: Partial<Record<WireUpAxis, UpAxis>> = {
  [WireUpAxis.X]: 'x',
  [WireUpAxis.Y]: 'y',
  [WireUpAxis.Z]: 'z',
};

export function factsOfSession({ description, settings }: Session): SceneFacts {
  return { ...described(description), domain: boxOf(settings?.domain) };
}

export function factsOfRecording({ description }: Recording): SceneFacts {
  return { ...described(description), domain: undefined };
}

export function factsOfPublication({ description, settings }: Pick<Manifest, 'description' | 'settings'>): SceneFacts {
  return { ...described(description), domain: boxOf(settings?.domain) };
}

/** None where the server knows nothing of it, or cannot be asked: the watch reports that. */
export async function askForFacts(
  server: Server,
  { session, recording }: { readonly session?: string; readonly recording?: RecordingName },
): Promise<SceneFacts | undefined> {
  try {
    if (session !== undefined) return factsOfSession(await server.session(session));
    if (!recording) return undefined;
    const found = (await server.recordings()).find((r) =>
      sameRecording({ session: r.sessionId, number: r.number }, recording),
    );
    return found && factsOfRecording(found);
  } catch {
    return undefined;
  }
}

function described(description: SessionDescription | undefined): Pick<SceneFacts, 'up' | 'unit'> {
  return { up: description && upAxes[description.upAxis], unit: description?.lengthUnit ?? '' };
}

function boxOf(box: Box | undefined): WorldBox | undefined {
  if (!box?.min || !box.max) return undefined;
  const { min, max } = box;
  return { min: [min.x, min.y, min.z], max: [max.x, max.y, max.z] };
}
