// The maker of normals: the server, or this viewer (`?normals-by=receiver` in the page's address).

/** What meshes are asked for with: nothing in particular, or no normals, so that they are computed here. */
export function normalWish({ search }: Pick<Location, 'search'>): { normalBits?: number } {
  return new URLSearchParams(search).get('normals-by') === 'receiver' ? { normalBits: 0 } : {};
}
