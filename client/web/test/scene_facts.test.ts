import { create } from '@bufbuild/protobuf';
import { describe, expect, it } from 'vitest';
import { RecordingSchema } from '../src/gen/meniscus/v1/recording_service_pb';
import { SessionSchema, UpAxis } from '../src/gen/meniscus/v1/session_service_pb';
import { factsOfRecording, factsOfSession, noFacts } from '../src/scene_facts';

describe('the facts of a scene', () => {
  it('are the description of the session, and its domain', () => {
    const session = create(SessionSchema, {
      description: { upAxis: UpAxis.Z, lengthUnit: 'mm' },
      settings: { domain: { min: { x: 0, y: -1, z: 0.5 }, max: { x: 3, y: 2, z: 1 } } },
    });
    expect(factsOfSession(session)).toEqual({ up: 'z', unit: 'mm', domain: { min: [0, -1, 0.5], max: [3, 2, 1] } });
  });

  it('are none where nothing is said, or what this viewer does not know', () => {
    expect(factsOfSession(create(SessionSchema, {}))).toEqual(noFacts);
    expect(factsOfSession(create(SessionSchema, { settings: { domain: { max: { x: 1 } } } }))).toEqual(noFacts);
    expect(factsOfRecording(create(RecordingSchema, { description: { upAxis: 9 as UpAxis } }))).toEqual(noFacts);
  });
});
