// Makes one page of the viewer's files, which opens without a server: node single_page.mjs FOLDER OUT.html. A publication's files
// are written into it before </body>, as <script type="text/plain" data-file="NAME">BASE64</script>.
import { Buffer } from 'node:buffer';
import { createHash } from 'node:crypto';
import { readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

const [folder, output] = process.argv.slice(2);
const files = readdirSync(join(folder, 'assets'));

function only(pattern) {
  const found = files.filter((name) => pattern.test(name));
  if (found.length !== 1) throw new Error(`assets/${pattern}: ${found.length} files, must be one`);
  return readFileSync(join(folder, 'assets', found[0]), 'utf8');
}

/** page: with exactly one match of the pattern. */
function replaced(page, pattern, by) {
  if (page.split(pattern).length !== 2) throw new Error(`index.html: ${pattern} is not there exactly once`);
  return page.replace(pattern, () => by);
}

function inline(code, what) {
  if (/<\/script|<!--|<\/style/i.test(code)) throw new Error(`${what} has what would end it within a page`);
  return code;
}

const hash = (text) => `'sha256-${createHash('sha256').update(text).digest('base64')}'`;

const script = inline(only(/^index-.*\.js$/), 'the script');
const style = inline(only(/^index-.*\.css$/), 'the style');
const worker = Buffer.from(only(/^worker-.*\.js$/)).toString('base64');
// Nothing is loaded from anywhere: not even the page that the file may lie beside.
const policy = [
  "default-src 'none'",
  `script-src ${hash(script)} 'wasm-unsafe-eval'`,
  'worker-src blob:',
  `style-src ${hash(style)}`,
  'img-src data: blob:',
  'connect-src data:',
  "base-uri 'none'",
  "form-action 'none'",
].join('; ');

let page = readFileSync(join(folder, 'index.html'), 'utf8');
page = replaced(page, /<script type="module"[^>]*><\/script>/, `<script type="module">${script}</script>`);
page = replaced(page, /<link rel="stylesheet"[^>]*>/, `<style>${style}</style>`);
page = replaced(
  page,
  '<meta charset="utf-8" />',
  `<meta charset="utf-8" /><meta http-equiv="Content-Security-Policy" content="${policy}" />`,
);
// It has no file beside it.
page = replaced(page, /<link rel="icon"[^>]*>/, '');
page = replaced(page, '</body>', `<script type="text/plain" id="decode-worker">${worker}</script></body>`);
writeFileSync(output, page);
