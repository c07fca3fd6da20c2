// What splashsurf's options are here.
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace meniscus::cli {

/// A row of the table in client/README.md, which has the same words.
struct SplashsurfRow {
    std::string_view options;  ///< with commas between them; of another command than reconstruct behind its name
    std::string_view here;     ///< what has its place; empty: nothing
    std::string_view differs;
};

inline constexpr auto splashsurf_rows = std::to_array<SplashsurfRow>({
    {"-o, {}", "the same", "the output's name is required, and has {}, too"},
    {"--output-dir", "", "the folder is part of -o"},
    {"-s, -e", "--start, --end", "also --step, --skip-missing, --skip-existing"},
    {"-r, -l", "the same", "-l belongs to the fields color and density; the default field has --smoothness"},
    {"-c, --cube-size", "-c, --cell-size",
     "the edge of the finest cells; flat parts get larger ones. --mode uniform: everywhere the finest"},
    {"-t, --surface-threshold", "-t, --iso", "less than 1 in the default field"},
    {"--rest-density", "", "particles of radius r have the volume (2 r)³, whatever their mass"},
    {"--particle-aabb-min, --particle-aabb-max", "--particle-aabb", "six numbers; the border belongs to the box"},
    {"--mesh-aabb-min, --mesh-aabb-max", "--mesh-aabb", "six numbers; triangles with a corner in the box stay whole"},
    {"--mesh-aabb-clamp-verts", "",
     "moved vertices would tear the levels apart: --domain cuts the surface at a box, and closes it"},
    {"-d, --double-precision", "",
     "vertices are whole numbers on a lattice, in every run; positions far from 0: --origin"},
    {"--mt-files, --mt-particles", "--jobs", "both at once, and the result does not depend on them"},
    {"-n, --num-threads", "--threads", ""},
    {"--simd", "MENISCUS_INSTRUCTIONS",
     "a variable of the environment; by itself the fastest that there is, all with the same bits"},
    {"--subdomain-grid, --subdomain-grid-auto-disable, --subdomain-cubes", "", "work and memory follow the surface"},
    {"--normals, --sph-normals", "--normals", "on by default, from the field"},
    {"--normals-smoothing-iters, --output-raw-normals", "", "the field is smooth: --smoothness"},
    {"-a, --interpolate_attribute", "--attribute", "weighted as the field is; also all, ids and bytes"},
    {"--mesh-cleanup, --mesh-cleanup-snap-dist, --decimate-barnacles, --keep-verts", "",
     "the adaptive grid takes the place of decimation"},
    {"--mesh-smoothing-iters, --mesh-smoothing-weights, --mesh-smoothing-weights-normalization, "
     "--output-smoothing-weights, --output-raw-mesh",
     "--field smooth", "the default: a smooth field (measured) instead of a smoothed mesh"},
    {"--generate-quads", "--quads", "within a level of the grid; the criteria's defaults, fixed"},
    {"--quad-max-edge-diag-ratio, --quad-max-normal-angle, --quad-max-interior-angle", "",
     "those of --quads are 1.75, 10° and 135°"},
    {"--check-mesh, --check-mesh-closed, --check-mesh-manifold, --check-mesh-orientation, --check-mesh-debug",
     "--check, meniscus check", "all of them at once; orientation is by edges; exit code 4"},
    {"convert --particles, --mesh", "convert IN", "known by the file, with flags of these names to force it"},
    {"convert --domain-min, --domain-max", "reconstruct --particle-aabb", ""},
    {"convert --overwrite", "", "an output that is there is replaced, one that is an input is refused"},
    {"-q, -v", "the same", ""},
});

/// What has the place of an option of splashsurf, for one that this command does not know; empty if splashsurf does not
/// know it either. option: without its value, but for a number behind a letter: "-n4".
std::string splashsurf_option(std::string_view command, std::string_view option);

}  // namespace meniscus::cli
