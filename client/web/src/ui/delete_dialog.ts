// Says how a recording is deleted: a server lets pages read, and no more.
import type { RecordingName } from '../recordings/recording_name';
import { deleteCommand, writeCommand } from './commands';
import { element } from './page';

export function showDeletion(name: RecordingName): void {
  writeCommand(element('delete-command', HTMLElement), deleteCommand(location.hostname, name));
  element('delete-dialog', HTMLDialogElement).showModal();
}
