// What the viewer cannot do, which only reads: the commands that do it. host: of the page's address, as addresses write it.
import { recordingNameText, type RecordingName } from '../recordings/recording_name';

/** Gives the server a session to look at. */
export function fillCommand(host: string): string {
  return `meniscus simulate --particles 16000 --frames 2000 --server ${host}`;
}

/** Deletes a recording, with a token that may. */
export function deleteCommand(host: string, name: RecordingName): string {
  return `meniscus recordings --server ${host} --delete ${recordingNameText(name)}`;
}
