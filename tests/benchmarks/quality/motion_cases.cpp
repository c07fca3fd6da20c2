#include <cmath>

#include "compare/comparison.hpp"
#include "compare/vector_math.hpp"
#include "quality/cases.hpp"
#include "quality/heights.hpp"
#include "quality/random.hpp"
#include "quality/rest.hpp"
#include "quality/sampling.hpp"

namespace meniscus::benchmarks::quality {
namespace {

constexpr int moves = 8;
constexpr int pool_frames = 6;
constexpr double pool_jitter = 0.05;  ///< radii
constexpr std::size_t samples = 20000;

/// Root of the mean of squares.
double rms_of(const std::vector<double>& values) {
    double squares = 0.0;
    for (const double value : values) squares += value * value;
    return values.empty() ? 0.0 : std::sqrt(squares / static_cast<double>(values.size()));
}

/// The surfaces of a moved ball, each moved back, against that of the ball in its first place.
std::vector<Figure> judge_ball(const std::vector<Point>& movements, const std::vector<Surface>& surfaces) {
    std::vector<double> distances;
    for (std::size_t i = 1; i < surfaces.size(); ++i) {
        Surface back = surfaces[i];
        for (Point& p : back.positions) p = compare::subtract(p, movements[i]);
        distances.push_back(compare::compare_surfaces(back.view(), surfaces[0].view(), samples).distance().rms);
    }
    return {{"rms_motion_radii", rms_of(distances)}};
}

/// cell_size: radii.
Case moved_ball(double radius, double cell_size) {
    const std::vector<Point> places = sample(make_ball("ball10", 10.0), Sampling::relaxed);
    Case out;
    out.subject = {"motion", "moved ball", ""};
    std::vector<Point> movements;
    for (int i = 0; i < moves; ++i) {
        const double along = cell_size * i / moves;
        movements.push_back({along, 0.6 * along, 0.3 * along});
        std::vector<Point> moved = places;
        for (Point& p : moved) p = compare::add_scaled(p, 1.0, movements.back());
        out.clouds.push_back(make_cloud("motion-ball-" + std::to_string(i), moved, radius));
    }
    out.judge = [movements](const std::vector<Surface>& surfaces) { return judge_ball(movements, surfaces); };
    return out;
}

Case resting_pool(double radius) {
    const Shape pool = make_pool();
    const std::vector<Point> places = sample(pool, Sampling::relaxed);
    Case out;
    out.subject = {"motion", "resting pool", ""};
    Random random(pool.name);
    for (int i = 0; i < pool_frames; ++i) {
        std::vector<Point> jittered = places;
        for (Point& p : jittered) p = compare::add_scaled(p, 1.0, random.next_point(pool_jitter));
        out.clouds.push_back(make_cloud("motion-pool-" + std::to_string(i), jittered, radius));
    }
    out.judge = [inner = pool.layer->inner](const std::vector<Surface>& surfaces) {
        std::vector<double> motions;
        for (std::size_t i = 1; i < surfaces.size(); ++i)
            motions.push_back(height_motion(surfaces[i - 1].view(), surfaces[i].view(), inner));
        return std::vector<Figure>{{"rms_motion_radii", rms_of(motions)}};
    };
    return out;
}

/// Two frames, one after the other, with the same particles in the same order.
Case resting_water(const FrameFiles& files, unsigned number, double radius) {
    Case out;
    out.clouds = {files.read(number), files.read(number + 1)};
    out.subject = {"motion", out.clouds[0].name, ""};
    out.judge = [radius, clouds = out.clouds](const std::vector<Surface>& surfaces) {
        const Rest rest = find_rest(surfaces[0].view(), places_of(clouds[0], radius), places_of(clouds[1], radius));
        return std::vector<Figure>{{"rms_motion_radii", motion_at(rest.places, surfaces[1].view())},
                                   {"resting_share", rest.share}};
    };
    return out;
}

}  // namespace

std::vector<Case> motion_cases(double radius, double cell_size) {
    return {moved_ball(radius, cell_size), resting_pool(radius)};
}

std::vector<Case> rest_cases(const FrameFiles& files, const std::vector<unsigned>& numbers, double radius) {
    std::vector<Case> cases;
    for (const unsigned number : numbers)
        if (files.has(number + 1)) cases.push_back(resting_water(files, number, radius));
    return cases;
}

}  // namespace meniscus::benchmarks::quality
