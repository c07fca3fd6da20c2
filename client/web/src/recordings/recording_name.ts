// Names a recording on its server: SESSION/NUMBER.

export interface RecordingName {
  /** UUID. */
  readonly session: string;
  /** The number among the session's recordings, from 1. */
  readonly number: number;
}

const form = /^([0-9a-f]{8}(?:-[0-9a-f]{4}){3}-[0-9a-f]{12})\/([1-9][0-9]{0,8})$/;

export function readRecordingName(text: string): RecordingName | undefined {
  const match = form.exec(text);
  return match ? { session: match[1]!, number: Number(match[2]) } : undefined;
}

export function recordingNameText({ session, number }: RecordingName): string {
  return `${session}/${number}`;
}

export function sameRecording(a: RecordingName, b: RecordingName): boolean {
  return a.session === b.session && a.number === b.number;
}
