// Writes a folder's files, and the page that is all of them, as C++: node embed.mjs FOLDER PAGE.html FILE.cpp. Each is compressed
// once, here.
import { readdirSync, readFileSync, statSync, writeFileSync } from 'node:fs';
import { extname, join } from 'node:path';
import { gzipSync } from 'node:zlib';

const types = {
  '.html': 'text/html; charset=utf-8',
  '.js': 'text/javascript; charset=utf-8',
  '.css': 'text/css; charset=utf-8',
  '.wasm': 'application/wasm',
  '.svg': 'image/svg+xml',
};

const [folder, single, output] = process.argv.slice(2);
const paths = readdirSync(folder, { recursive: true })
  .filter((path) => statSync(join(folder, path)).isFile())
  .sort();

let arrays = '';
let table = '';
let scriptBytes = 0;
let decoderBytes = 0;
paths.forEach((path, i) => {
  const type = types[extname(path)];
  if (!type) throw new Error(`${path}: no content type is known for ${extname(path)}`);
  const gzip = gzipSync(readFileSync(join(folder, path)), { level: 9 });
  arrays += `constexpr unsigned char file${i}[] = {${gzip.join(',')}};\n`;
  const name = path === 'index.html' ? '/' : `/${path}`;
  table += `    {"${name}", "${type}", ${path.startsWith('assets/')}, true, file${i}},\n`;
  if (/worker|decoder/.test(path)) decoderBytes += gzip.length;
  else if (extname(path) === '.js') scriptBytes += gzip.length;
});
const singlePage = gzipSync(readFileSync(single), { level: 9 });
arrays += `constexpr unsigned char single[] = {${singlePage.join(',')}};\n`;
writeFileSync(
  output,
  `#include "viewer_files.hpp"\n\nnamespace meniscus::viewer {\n\nnamespace {\n\n${arrays}\nconstexpr File all[] = {\n${table}};\n\n}  // namespace\n\n` +
    'std::span<const File> files() {\n    return all;\n}\n\nstd::span<const unsigned char> single_page() {\n    return single;\n}\n\n}  // namespace meniscus::viewer\n',
);
const kilobytes = (bytes) => `${(bytes / 1000).toFixed(0)} kB`;
console.log(`viewer: ${kilobytes(scriptBytes)} of script compressed, decoder ${kilobytes(decoderBytes)} apart`);
