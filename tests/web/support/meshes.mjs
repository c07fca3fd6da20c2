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

/** The bounds of a binary PLY of floats as the viewer writes it: min x y z, max x y z. */
export function boundsOfPly(ply) {
  const vertices = verticesOfPly(ply);
  const each = (pick) => [0, 1, 2].map((axis) => vertices.reduce((a, v) => pick(a, v[axis]), vertices[0][axis]));
  return [...each(Math.min), ...each(Math.max)];
}

/** The vertices of such a file: x y z each. */
export function verticesOfPly(ply) {
  return vertexProperties(ply, ['x', 'y', 'z']);
}

/** The properties of these names at each vertex of such a file. */
export function vertexProperties(ply, names) {
  const end = 'end_header\n';
  const header = ply.subarray(0, ply.indexOf(end) + end.length);
  const text = header.toString('latin1');
  const count = Number(/element vertex (\d+)/.exec(text)[1]);
  const properties = [...text.slice(0, text.indexOf('element face')).matchAll(/property float (\w+)/g)];
  const places = names.map((name) => 4 * properties.findIndex(([, property]) => property === name));
  if (places.some((at) => at < 0)) throw new Error(`the mesh has not all of ${names.join(', ')}`);
  return Array.from({ length: count }, (_, vertex) =>
    places.map((at) => ply.readFloatLE(header.length + vertex * 4 * properties.length + at)),
  );
}
