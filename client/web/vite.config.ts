import { defineConfig } from 'vite';

// A server to develop against: npm run dev, with meniscusd's HTTP port here.
const server = process.env.MENISCUS_SERVER ?? 'http://127.0.0.1:9464';

export default defineConfig({
  base: './',
  build: {
    target: 'es2022',
    // No file is written into another: the page's policy forbids data: scripts, and hashes are what caches go by.
    assetsInlineLimit: 0,
    chunkSizeWarningLimit: 1500,
  },
  worker: { format: 'es' },
  server: { proxy: { '^/meniscus\\.v1\\.': server } },
});
