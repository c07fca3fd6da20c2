import { defineConfig } from 'vite';

// The module for pages of others: one file that stands alone, under a name that stays.
export default defineConfig({
  build: {
    target: 'es2022',
    emptyOutDir: false,
    // To be read before it is copied.
    minify: false,
    lib: { entry: 'src/frame/meniscus_frame.ts', formats: ['es'], fileName: () => 'meniscus-frame.js' },
  },
});
