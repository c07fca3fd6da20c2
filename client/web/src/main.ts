import { App } from './app';
import { element } from './ui/page';

try {
  new App();
} catch (error) {
  const line = element('banner', HTMLElement);
  line.hidden = false;
  line.textContent =
    'This browser does not offer WebGL 2, which the viewer draws with. ' +
    'Try another browser, or turn on hardware acceleration in its settings.';
  element('list', HTMLElement).hidden = true;
  console.info(error);
}
