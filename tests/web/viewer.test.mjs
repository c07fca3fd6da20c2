// The viewer in a real browser, against real servers and simulators: in one process, so that one browser and one recording do for all.
import './first_surface.mjs';
import './frames.mjs';
import './recovery.mjs';
import './playback.mjs';
import './recordings.mjs';
import './camera.mjs';
import './water.mjs';
import './tools.mjs';
import './codecs.mjs';
import './panels.mjs';
import './colors.mjs';
import './accessibility.mjs';
import './keyboard.mjs';
import './list.mjs';
import './embed.mjs';
import './warnings.mjs';
import './latest_mesh.mjs';
