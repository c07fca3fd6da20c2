// The table's keys on this page.
import { KeysDialog } from '../ui/keys_dialog';
import { element } from '../ui/page';
import type { CameraControls } from '../view/camera_controls';
import { keysOf } from './key_table';
import { Keyboard } from './keyboard';

/** embedded: whether the viewer is to show the water alone. looking: whether a session or a recording is looked at. */
export function bindKeys(camera: CameraControls, embedded: boolean, looking: () => boolean): void {
  const table = keysOf(embedded);
  new KeysDialog(table);
  new Keyboard(
    document,
    table,
    {
      turn: (key) => {
        camera.turn(key);
      },
      shift: (key) => {
        camera.shift(key);
      },
      zoom: (key) => {
        camera.zoom(key);
      },
    },
    {
      press: (id) => {
        const button = element(id, HTMLButtonElement);
        // Where the toolbar is not shown its keys do what they do; a button that is not offered does nothing.
        if (!button.hidden) button.click();
      },
      looking,
      dialogOpen: () => document.querySelector('dialog[open]') !== null,
    },
  );
}
