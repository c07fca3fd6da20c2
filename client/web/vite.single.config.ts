import { defineConfig } from 'vite';

// The viewer as single_page.mjs makes one file of it: decoders are written into the worker that uses them.
export default defineConfig({
  base: './',
  build: { target: 'es2022', assetsInlineLimit: 1 << 26, chunkSizeWarningLimit: 1500, modulePreload: false },
  // Browsers start no worker of modules out of a page that is a file.
  worker: { format: 'iife' },
});
