// Reads damaged publications, half of them with a damaged manifest and half with a damaged segment, for as long as that
// takes: npm run fuzz -- [ROUNDS [SEED]]. Leaves with 1 where a reader throws anything else than a refusal.
import { createServer } from 'vite';

const [rounds, seed] = [process.argv[2] ?? '100000', process.argv[3] ?? '1'].map(Number);
const server = await createServer({ server: { middlewareMode: true }, logLevel: 'error' });
try {
  const { readDamaged } = await server.ssrLoadModule('/test/support/damaged_publications.ts');
  const began = performance.now();
  const { manifests, segments } = await readDamaged(rounds, seed, (done) => {
    if (done % 100_000 === 0) console.error(`${done} of ${rounds}`);
  });
  for (const [name, { read, refused }] of Object.entries({ manifests, segments }))
    console.log(`${read + refused} ${name}: ${refused} refused, ${read} read`);
  const seconds = Math.round((performance.now() - began) / 1000);
  console.log(`seed ${seed}, ${seconds} s, ${process.resourceUsage().maxRSS >> 10} MiB at most`);
} finally {
  await server.close();
}
