// The lattice's constants: those of core/include/meniscus/mesh.hpp, with its names. The golden bricks hold both to the same
// values.

/** Edge of a base cell, in finest cells. */
export const baseCellSize = 4;
/** Edge of a brick, in base cells and in finest cells. */
export const brickBaseCells = 16;
export const brickCells = brickBaseCells * baseCellSize;
/** Neither triangles nor vertices of a brick are more: sixteen for each of its finest cells. */
export const maxBrickTriangles = 16 * brickCells ** 3;
/** Vertices lie on multiples of a cell's edge / 2^offsetBits. */
export const minOffsetBits = 2;
export const maxOffsetBits = 8;
