// A host of plain files, as any is, or by the rules of one that authors are told of.
import { createHash } from 'node:crypto';
import { readFileSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { once } from 'node:events';
import { extname, join, normalize } from 'node:path';
import { gzipSync } from 'node:zlib';

const types = {
  '.html': 'text/html',
  '.js': 'text/javascript',
  '.css': 'text/css',
  '.json': 'application/json',
  '.svg': 'image/svg+xml',
  '.wasm': 'application/wasm',
};

/** The rules of hosts, as they document them. under: where a site lies; hides: names that are not there. */
export const hosts = {
  plain: { under: '' },
  // Jekyll leaves names out that begin with these characters, or end with that.
  'GitHub Pages': {
    under: 'repository/',
    headers: { 'Cache-Control': 'max-age=600' },
    compresses: true,
    tags: true,
    hides: /(^|\/)[._#]|~$/,
  },
  Netlify: {
    under: '',
    headers: { 'Cache-Control': 'public,max-age=0,must-revalidate' },
    compresses: true,
    tags: true,
  },
  // Apache sends no type for an ending that it does not know, an old one none for WebAssembly.
  'a university': {
    under: '~author/',
    headers: { 'Last-Modified': 'Thu, 26 Nov 2026 12:00:00 GMT' },
    untyped: /\.(segment|wasm)$/,
  },
};

/** asked: the paths that were asked for. rules: of `hosts`. */
export async function startHost(folder, rules = hosts.plain) {
  const { under, headers = {}, compresses = false, tags = false, hides, untyped } = rules;
  const asked = [];
  const server = createServer((request, response) => {
    const path = decodeURIComponent(new URL(request.url, 'http://h').pathname);
    asked.push(path);
    const name = path.slice(1 + under.length);
    const file = join(folder, normalize(name), path.endsWith('/') ? 'index.html' : '');
    const isThere = path.startsWith(`/${under}`) && statSync(file, { throwIfNoEntry: false })?.isFile();
    if (!isThere || hides?.test(name)) {
      response.writeHead(404).end();
      return;
    }
    const type = types[extname(file)] ?? 'application/octet-stream';
    let bytes = readFileSync(file);
    const sent = { ...headers, ...(untyped?.test(file) ? {} : { 'Content-Type': type }) };
    if (tags) sent.ETag = `"${createHash('sha1').update(bytes).digest('hex')}"`;
    if (tags && request.headers['if-none-match'] === sent.ETag) {
      response.writeHead(304, sent).end();
      return;
    }
    if (compresses && /text|json/.test(type) && /gzip/.test(request.headers['accept-encoding'])) {
      bytes = gzipSync(bytes);
      sent['Content-Encoding'] = 'gzip';
    }
    response.writeHead(200, { ...sent, 'Content-Length': bytes.length }).end(bytes);
  });
  server.listen(0, '127.0.0.1');
  await once(server, 'listening');
  return {
    url: `http://127.0.0.1:${server.address().port}/${under}`,
    asked,
    stop: () => {
      server.closeAllConnections();
      server.close();
    },
  };
}
