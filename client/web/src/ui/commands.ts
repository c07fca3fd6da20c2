// What the viewer cannot do, which only reads: the commands that do it. host: of the page's address, as addresses write it.
import { recordingNameText, type RecordingName } from '../recordings/recording_name';

/** Gives the server a session to look at. */
export function fillCommand(host: string): string {
  return `meniscus simulate --particles 16000 --frames 2000 --server ${host}`;
}

/** Writes it so that no option is broken at its hyphens; what is selected of it stays. */
export function writeCommand(place: HTMLElement, command: string): void {
  if (place.textContent === command) return;
  const words = command.split(' ').map((word) => {
    if (!word.startsWith('-')) return word;
    const whole = document.createElement('span');
    whole.textContent = word;
    return whole;
  });
  place.replaceChildren(...words.flatMap((word, i) => (i === 0 ? [word] : [' ', word])));
}

/** Deletes a recording, with a token that may. */
export function deleteCommand(host: string, name: RecordingName): string {
  return `meniscus recordings --server ${host} --delete ${recordingNameText(name)}`;
}
