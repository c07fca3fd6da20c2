import { App } from './app';
import { Banner } from './ui/banner';
import { element } from './ui/page';

if (document.createElement('canvas').getContext('webgl2')) {
  new App();
} else {
  element('list', HTMLElement).hidden = true;
  new Banner().say(
    'This browser does not offer WebGL 2, which the viewer draws with. Try another browser, or turn on hardware acceleration in its settings.',
  );
}
