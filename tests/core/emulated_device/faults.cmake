# The faults that a test can put in force (faults.hpp), as changes of single places in copies of core's sources:
# plant(fault file right wrong). `right` stands once in the file, else the build fails. FAULTY(name) says whether the fault
# is in force.

# Each vertex lies where the next one of its block would.
plant(index_off_by_one steps/place_vertices/place_vertices.cu
  [=[Vertex v(edges, place.i);]=]
  [=[Vertex v(edges, std::min(place.i + (FAULTY(index_off_by_one) ? 1 : 0), edges.count() - 1));]=])

# A brick's rows of cells are written before all warps have marked theirs.
plant(missing_barrier codec/lattice/pack_bricks.cu
  [=[    __syncthreads();
    rows.write(]=]
  [=[    if (!FAULTY(missing_barrier)) __syncthreads();
    rows.write(]=])

# A kernel stops the frame while blocks of it have yet to begin.
plant(early_stop steps/register_particles/sort_particles.cu
  [=[state.counts->needed[static_cast<int>(Resource::particle_bricks)] = brick + 1;]=]
  [=[state.counts->needed[static_cast<int>(Resource::particle_bricks)] = brick + 1;
            if (FAULTY(early_stop)) state.need(Resource::particle_bricks, brick + 1);]=])

# A ballot does not name the warp's last lane.
plant(wrong_mask neighbors/cuda/neighbor_list.hpp
  [=[__ballot_sync(all_lanes, has_one ? 1 : 0);]=]
  [=[__ballot_sync(FAULTY(wrong_mask) ? all_lanes >> 1 : all_lanes, has_one ? 1 : 0);]=])

# The normal of each cluster's last vertex is not written.
plant(unset_word steps/place_vertices/place_vertices.cu
  [=[if (i < count) state.normals[place.number] =]=]
  [=[if (i < count - (FAULTY(unset_word) ? 1 : 0)) state.normals[place.number] =]=])

# The sum of counts of vertices goes on one behind the array.
plant(guard_overrun steps/place_vertices/place_vertices.cu
  [=[state.first_vertex, blocks + 1, launch.stream);]=]
  [=[state.first_vertex, blocks + (FAULTY(guard_overrun) ? 2 : 1), launch.stream);]=])

# Spray is given to the caller before it has come down.
plant(missing_wait pipeline/cuda_frame_run.cu
  [=[stream_.get()),
          "cudaMemcpyAsync");
    stream_.synchronize();]=]
  [=[stream_.get()),
          "cudaMemcpyAsync");
    if (!FAULTY(missing_wait)) stream_.synchronize();]=])

# A cooperative grid has a block more than run at once.
plant(wrong_block_count engine/cuda/launch.hpp
  [=[launch(blocks_for(elements, block_threads, most), true, kernel, arguments...);]=]
  [=[launch(FAULTY(wrong_block_count) ? static_cast<unsigned>(most + 1) : blocks_for(elements, block_threads, most), true,
               kernel, arguments...);]=])

# Cells that other blocks than the grid's first have found in a search are not listed.
plant(lost_flag steps/adjust_levels/sweeps.hpp
  [=[if ((cell.put_into(state_.raised) & cell.bit) == 0) list(block);]=]
  [=[if ((cell.put_into(state_.raised) & cell.bit) == 0 && !(FAULTY(lost_flag) && blockIdx.x != 0)) list(block);]=])

# Triangles of a cell lie in the order in which its lanes come by.
plant(unstable_order steps/emit_triangles/emit_triangles.cu
  [=[own[c].list(triangles.list + first + below[c]);]=]
  [=[if (FAULTY(unstable_order)) {
                    std::uint32_t& come_by = triangles.list[WarpTriangles::room - 1];
                    if (lane == 0) come_by = 0;
                    __syncwarp();
                    below[c] = atomicAdd(&come_by, std::uint32_t{own[c].all()});
                    __syncwarp();
                }
                own[c].list(triangles.list + first + below[c]);]=])

# The largest sums are forgotten where scratch memory is measured.
plant(scratch_too_small engine/cuda/scans.cu
  [=[scan_bytes<LevelCounts>(sums)});]=]
  [=[FAULTY(scratch_too_small) ? 0 : scan_bytes<LevelCounts>(sums)});]=])
