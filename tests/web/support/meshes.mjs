// Saved meshes, read by others than those that wrote them.
import { readFile } from 'node:fs/promises';
import { extname, join } from 'node:path';

const three = new URL('../../../client/web/node_modules/three/', import.meta.url).pathname;
const types = {
  '.js': 'text/javascript',
  '.wasm': 'application/wasm',
  '.glb': 'model/gltf-binary',
  '.html': 'text/html',
};
const html = `<!doctype html><link rel="icon" href="data:,"><script type="importmap">
  {"imports": {"three": "/build/three.module.js", "three/addons/": "/examples/jsm/"}}</script>`;

/** Loads the GLB with three.js in the page: its triangles, and its box as min x y z, max x y z. */
export async function reload(page, glb) {
  await page.route('http://reload.test/**', async (route) => {
    const path = new URL(route.request().url()).pathname;
    const body = path === '/page.html' ? html : path === '/mesh.glb' ? glb : await readFile(join(three, path));
    await route.fulfill({ body, contentType: types[extname(path)] });
  });
  await page.goto('http://reload.test/page.html');
  return page.evaluate(async () => {
    const { Box3 } = await import('three');
    const { GLTFLoader } = await import('three/addons/loaders/GLTFLoader.js');
    const { DRACOLoader } = await import('three/addons/loaders/DRACOLoader.js');
    const draco = new DRACOLoader().setDecoderPath('/examples/jsm/libs/draco/gltf/');
    const { scene } = await new GLTFLoader().setDRACOLoader(draco).loadAsync('/mesh.glb');
    let triangles = 0;
    scene.traverse(({ geometry }) => {
      triangles += (geometry?.index.count ?? 0) / 3;
    });
    const { min, max } = new Box3().setFromObject(scene, true);
    return { triangles, bounds: [...min.toArray(), ...max.toArray()] };
  });
}

/** Of a binary PLY of floats as the viewer writes it: min x y z, max x y z. */
export function boundsOfPly(ply) {
  const end = 'end_header\n';
  const header = ply.subarray(0, ply.indexOf(end) + end.length);
  const text = header.toString('latin1');
  const count = Number(/element vertex (\d+)/.exec(text)[1]);
  const stride = 4 * text.slice(0, text.indexOf('element face')).match(/property float/g).length;
  const bounds = [Infinity, Infinity, Infinity, -Infinity, -Infinity, -Infinity];
  for (let vertex = 0; vertex < count; ++vertex)
    for (let axis = 0; axis < 3; ++axis) {
      const x = ply.readFloatLE(header.length + vertex * stride + 4 * axis);
      bounds[axis] = Math.min(bounds[axis], x);
      bounds[3 + axis] = Math.max(bounds[3 + axis], x);
    }
  return bounds;
}
