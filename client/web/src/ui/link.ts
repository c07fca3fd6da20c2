// The page's address tells what is looked at: the session or the recording, and from where.
import { readRecordingName, recordingNameText, type RecordingName } from '../recordings/recording_name';
import type { Point } from '../view/bounds';
import type { CameraPlace, Look } from '../view/viewer';
import type { UpAxis } from '../view/up_axis';

export interface PageState {
  readonly session?: string;
  readonly recording?: RecordingName;
  /** Of a recording's frame, by its place. */
  readonly position?: number;
  readonly camera?: CameraPlace;
  readonly look?: Look;
  readonly up?: UpAxis;
}

const sessionForm = /^[0-9a-f]{8}(-[0-9a-f]{4}){3}-[0-9a-f]{12}$/;

/** What is not understood is left out. hash: with or without its sign. */
export function readLink(hash: string): PageState {
  const fields = new URLSearchParams(hash.replace(/^#/, ''));
  const session = fields.get('session');
  const recording = readRecordingName(fields.get('recording') ?? '');
  const position = fields.get('position') ?? '';
  const camera = readCamera(fields.get('camera'));
  return {
    ...(session !== null && sessionForm.test(session) ? { session } : {}),
    ...(recording ? { recording } : {}),
    ...(recording && /^[0-9]{1,15}$/.test(position) ? { position: Number(position) } : {}),
    ...(camera ? { camera } : {}),
    ...(fields.get('look') === 'levels' ? { look: 'levels' as const } : {}),
    ...(fields.get('up') === 'z' ? { up: 'z' as const } : {}),
  };
}

export function writeLink({ session, recording, position, camera, look, up }: PageState): string {
  const fields = new URLSearchParams();
  if (session !== undefined) fields.set('session', session);
  if (recording) fields.set('recording', recordingNameText(recording));
  if (recording && position !== undefined) fields.set('position', String(position));
  if (camera)
    fields.set('camera', [...camera.position, ...camera.target].map((x) => Number(x.toPrecision(7))).join(','));
  if (look === 'levels') fields.set('look', look);
  if (up === 'z') fields.set('up', up);
  return `#${fields.toString().replaceAll('%2C', ',').replaceAll('%2F', '/')}`;
}

function readCamera(text: string | null): CameraPlace | undefined {
  const numbers = (text ?? '').split(',').map((x) => (x === '' ? NaN : Number(x)));
  if (numbers.length !== 6 || !numbers.every(Number.isFinite)) return undefined;
  return { position: numbers.slice(0, 3) as Point, target: numbers.slice(3) as Point };
}
