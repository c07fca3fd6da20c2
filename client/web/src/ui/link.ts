// The page's address holds the session or the recording, and the place of the camera.
import { readRecordingName, recordingNameText, type RecordingName } from '../recordings/recording_name';
import type { Point } from '../view/bounds';
import type { CameraPlace } from '../view/camera_place';
import type { Look } from '../view/viewer';
import { isAxis, type UpAxis } from '../view/up_axis';
import { sessionForm } from './session_form';
import { linkNumber, numbers, readToolsLink, writeToolsLink, type ToolsState } from './tools_link';

export interface PageState extends ToolsState {
  readonly session?: string;
  readonly recording?: RecordingName;
  /** The place of a recording's frame, or of a publication's. */
  readonly position?: number;
  /** Of a recording or a publication, relative to its own. */
  readonly speed?: number;
  /** Begins again after the last frame. */
  readonly loop?: 'on';
  readonly camera?: CameraPlace;
  readonly look?: Look;
  /** None: what the session says. */
  readonly up?: UpAxis;
  /** A session or a recording in it that cannot be, in words. */
  readonly problem?: string;
}

export function isSessionId(text: string): boolean {
  return sessionForm.test(text);
}

/** Fields that cannot be read are left out; for a session or a recording there is a problem. hash: with or without its sign. */
export function readLink(hash: string): PageState {
  const fields = new URLSearchParams(hash.replace(/^#/, ''));
  const session = fields.get('session');
  const recording = readRecordingName(fields.get('recording') ?? '');
  const problem = problemOf(session, fields.get('recording'));
  const position = fields.get('position') ?? '';
  const [speed] = numbers(fields.get('speed')) ?? [];
  const camera = readCamera(fields.get('camera'));
  const up = fields.get('up') ?? '';
  return {
    ...(session !== null && isSessionId(session) ? { session } : {}),
    ...(recording ? { recording } : {}),
    ...(session === null && /^[0-9]{1,15}$/.test(position) ? { position: Number(position) } : {}),
    ...(speed === undefined ? {} : { speed }),
    ...(fields.get('loop') === 'on' ? { loop: 'on' as const } : {}),
    ...(camera ? { camera } : {}),
    ...(fields.get('look') === 'levels' ? { look: 'levels' as const } : {}),
    ...(isAxis(up) ? { up } : {}),
    ...readToolsLink(fields),
    ...(problem === undefined ? {} : { problem }),
  };
}

function problemOf(session: string | null, recording: string | null): string | undefined {
  if (session !== null && !isSessionId(session))
    return `This address names the session "${short(session)}", which cannot be: addresses have a session's id, a UUID, as 01234567-89ab-cdef-0123-456789abcdef. It may have been cut off.`;
  if (recording !== null && !readRecordingName(recording))
    return `This address names the recording "${short(recording)}", which cannot be: addresses have its session's id and a number, as 01234567-89ab-cdef-0123-456789abcdef/1. It may have been cut off.`;
  return undefined;
}

/** For a sentence. */
function short(text: string): string {
  return text.length > 64 ? `${text.slice(0, 64)}…` : text;
}

/** The views of a page without a server. */
export function withoutServer(state: PageState): PageState {
  const kept: { -readonly [Field in keyof PageState]: PageState[Field] } = { ...state };
  delete kept.session;
  delete kept.recording;
  delete kept.beside;
  return kept;
}

/** The address itself has the other parts of a publication's page. */
export function writeLink(state: PageState): string {
  const { session, recording, position, speed, loop, camera, look, up, ...tools } = state;
  const fields = new URLSearchParams();
  if (session !== undefined) fields.set('session', session);
  if (recording) fields.set('recording', recordingNameText(recording));
  if (session === undefined && position !== undefined) fields.set('position', String(position));
  if (speed !== undefined && speed !== 1) fields.set('speed', String(linkNumber(speed)));
  if (loop) fields.set('loop', loop);
  if (camera) fields.set('camera', [...camera.position, ...camera.target].map(linkNumber).join(','));
  if (look === 'levels') fields.set('look', look);
  if (up) fields.set('up', up);
  writeToolsLink(fields, tools);
  return `#${fields.toString().replaceAll('%2C', ',').replaceAll('%2F', '/')}`;
}

function readCamera(text: string | null): CameraPlace | undefined {
  const read = numbers(text);
  if (read?.length !== 6) return undefined;
  return { position: read.slice(0, 3) as Point, target: read.slice(3) as Point };
}
