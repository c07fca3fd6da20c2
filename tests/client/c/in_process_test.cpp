// The C interface in process: the library's meshes, and its refusals for whatever a caller does wrong.
#include <gtest/gtest.h>

#include <clocale>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <limits>
#include <regex>
#include <span>
#include <thread>

#include "in_process.hpp"
#include "support/particles.hpp"

namespace meniscus::test {
namespace {

TEST(CInProcess, GivesTheLibrarysMeshToTheByte) {
    Particles particles = splash(3, 8);
    for (std::size_t i = 0; i < particles.count(); ++i) particles.levels.push_back(i % 5 == 0 ? 1 : 0);
    const Mesh expected = reconstruct(default_settings(), particles.frame());
    const CReconstructor reconstructor = default_reconstructor();
    const CMesh mesh = empty_mesh();
    for (int frame = 0; frame < 2; ++frame) {
        const meniscus_particles input = c_frame(particles);
        ASSERT_EQ(meniscus_reconstruct(reconstructor.get(), &input, mesh.get()), MENISCUS_OK);
        EXPECT_EQ(sha256(mesh), mesh_sha256(expected));
        char digits[MENISCUS_SHA256_SIZE];
        EXPECT_EQ(meniscus_mesh_bricks_sha256(mesh.get(), digits), MENISCUS_OK) << meniscus_error_message();
        EXPECT_EQ(digits, bricks_sha256(expected));

        const double* vertices = nullptr;
        const float* rounded = nullptr;
        const float* normals = nullptr;
        const std::uint32_t* triangles = nullptr;
        const std::uint8_t* levels = nullptr;
        std::size_t count = 0;
        ASSERT_EQ(meniscus_mesh_vertices(mesh.get(), &vertices, &count), MENISCUS_OK);
        ASSERT_EQ(count, expected.vertices.size());
        ASSERT_EQ(meniscus_mesh_vertices_float(mesh.get(), &rounded, &count), MENISCUS_OK);
        ASSERT_EQ(count, expected.vertices.size());
        for (std::size_t i = 0; i < 3 * count; ++i) {
            ASSERT_EQ(vertices[i], expected.world(expected.vertices[i / 3])[i % 3]);
            ASSERT_EQ(rounded[i], static_cast<float>(vertices[i]));
        }
        ASSERT_EQ(meniscus_mesh_normals(mesh.get(), &normals, &count), MENISCUS_OK);
        ASSERT_EQ(count, expected.normals.size());
        EXPECT_EQ(std::memcmp(normals, expected.normals.data(), count * sizeof(Normal)), 0);
        ASSERT_EQ(meniscus_mesh_triangles(mesh.get(), &triangles, &count), MENISCUS_OK);
        ASSERT_EQ(count, expected.triangles.size());
        EXPECT_EQ(std::memcmp(triangles, expected.triangles.data(), count * sizeof(Triangle)), 0);
        ASSERT_EQ(meniscus_mesh_triangle_levels(mesh.get(), &levels, &count), MENISCUS_OK);
        ASSERT_EQ(count, expected.triangles.size());
        for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(levels[i], level_byte(expected.level_of(i)));
    }
}

TEST(CInProcess, ArraysAreThoseOfTheFrameThatCameLast) {
    const CReconstructor reconstructor = default_reconstructor();
    const CMesh mesh = empty_mesh();
    for (const int side : {8, 3, 6}) {
        const Particles particles = splash(4, side);
        const meniscus_particles input = c_frame(particles);
        ASSERT_EQ(meniscus_reconstruct(reconstructor.get(), &input, mesh.get()), MENISCUS_OK);
        const Mesh expected = reconstruct(default_settings(), particles.frame());
        const double* vertices = nullptr;
        const std::uint8_t* levels = nullptr;
        std::size_t count = 0;
        ASSERT_EQ(meniscus_mesh_triangle_levels(mesh.get(), &levels, &count), MENISCUS_OK);
        EXPECT_EQ(count, expected.triangles.size());
        EXPECT_EQ(levels[count - 1], level_byte(expected.level_of(count - 1)));
        ASSERT_EQ(meniscus_mesh_vertices(mesh.get(), &vertices, &count), MENISCUS_OK);
        ASSERT_EQ(count, expected.vertices.size());
        EXPECT_EQ(vertices[3 * count - 1], expected.world(expected.vertices.back())[2]);
    }
}

TEST(CInProcess, TakesFloat64AndPositionsWithinRecordsAndAxesApart) {
    const Particles particles = splash(5, 5);
    const std::string expected = mesh_sha256(reconstruct(default_settings(), particles.frame()));
    const CReconstructor reconstructor = default_reconstructor();
    const CMesh mesh = empty_mesh();
    const std::vector<double> wide(particles.positions.begin(), particles.positions.end());
    meniscus_particles input = MENISCUS_PARTICLES_INIT;
    input.count = particles.count();
    input.positions_double = wide.data();
    ASSERT_EQ(meniscus_reconstruct(reconstructor.get(), &input, mesh.get()), MENISCUS_OK) << meniscus_error_message();
    EXPECT_EQ(sha256(mesh), expected);

    struct Record {
        float mass, position[3], velocity[3];
    };
    std::vector<Record> records(particles.count());
    for (std::size_t i = 0; i < particles.positions.size(); ++i)
        records[i / 3].position[i % 3] = particles.positions[i];
    input = MENISCUS_PARTICLES_INIT;
    input.count = records.size();
    input.positions = records[0].position;
    input.stride = sizeof(Record);
    ASSERT_EQ(meniscus_reconstruct(reconstructor.get(), &input, mesh.get()), MENISCUS_OK) << meniscus_error_message();
    EXPECT_EQ(sha256(mesh), expected);

    std::vector<float> axes[3];
    std::vector<double> wide_axes[3];
    for (std::size_t i = 0; i < particles.positions.size(); ++i) {
        axes[i % 3].push_back(particles.positions[i]);
        wide_axes[i % 3].insert(wide_axes[i % 3].end(), {particles.positions[i], 1e9});
    }
    input = MENISCUS_PARTICLES_INIT;
    input.count = particles.count();
    for (std::size_t axis = 0; axis < 3; ++axis) input.axes[axis] = axes[axis].data();
    ASSERT_EQ(meniscus_reconstruct(reconstructor.get(), &input, mesh.get()), MENISCUS_OK) << meniscus_error_message();
    EXPECT_EQ(sha256(mesh), expected);

    input = MENISCUS_PARTICLES_INIT;
    input.count = particles.count();
    input.stride = 2 * sizeof(double);
    for (std::size_t axis = 0; axis < 3; ++axis) input.axes_double[axis] = wide_axes[axis].data();
    ASSERT_EQ(meniscus_reconstruct(reconstructor.get(), &input, mesh.get()), MENISCUS_OK) << meniscus_error_message();
    EXPECT_EQ(sha256(mesh), expected);
}

TEST(CInProcess, OptionsAreTheLibrarysSettingsInAnyOrder) {
    Settings settings = default_settings();
    settings.field = Field::color;
    settings.smoothing_length = 1.5;
    settings.criterion = CountCriterion{3};
    settings.edge_points = Bisection{4};
    settings.normals = false;
    settings.domain = Box{{0.01, 0.0, -0.125}, {0.2, 0.3, 1e-1}};
    const Particles particles = splash(6, 6);
    const CReconstructor reconstructor = reconstructor_of({{"bisection-steps", "4"},
                                                           {"count-threshold", "3"},
                                                           {"domain", "0.01 0 -0.125  0.2 0.3 1e-1"},
                                                           {"smoothing-length", "1.5"},
                                                           {"particle-radius", "0.025"},
                                                           {"normals", "false"},
                                                           {"field", "color"},
                                                           {"edge-points", "bisect"},
                                                           {"criterion", "count"}});
    const CMesh mesh = empty_mesh();
    const meniscus_particles input = c_frame(particles);
    ASSERT_EQ(meniscus_reconstruct(reconstructor.get(), &input, mesh.get()), MENISCUS_OK);
    EXPECT_EQ(sha256(mesh), mesh_sha256(reconstruct(settings, particles.frame())));
    const float* normals = nullptr;
    std::size_t count = 1;
    EXPECT_EQ(meniscus_mesh_normals(mesh.get(), &normals, &count), MENISCUS_OK);
    EXPECT_EQ(count, 0U);
    EXPECT_EQ(normals, nullptr);
}

/// Flag to default, as the document has it.
std::vector<std::pair<std::string, std::string>> documented_settings() {
    std::ifstream file(MENISCUS_CLIENT_DOCUMENT);
    const std::regex row(R"(\| `--([a-z-]+)` \| ([^|]*)\|.*)");
    std::vector<std::pair<std::string, std::string>> settings;
    std::smatch match;
    std::string line;
    while (std::getline(file, line) && line != "## Settings") {
    }
    while (std::getline(file, line) && line != "### Presets")
        if (std::regex_match(line, match, row)) settings.emplace_back(match[1], match[2]);
    return settings;
}

TEST(CInProcess, TakesEverySettingOfTheDocument) {
    const auto documented = documented_settings();
    ASSERT_GT(documented.size(), 10U);
    for (const auto& [flag, written] : documented) {
        SCOPED_TRACE(flag);
        if (flag == "positions") continue;  // of uploads by the command line
        if (flag == "attribute") continue;  // any words are names
        const std::string name = flag == "no-normals" ? "normals" : flag;
        const COptions options = options_of({{"particle-radius", "0.025"}});
        ASSERT_EQ(meniscus_options_set(options.get(), name.c_str(), "no such value"), MENISCUS_OK);
        CReconstructor reconstructor;
        const meniscus_result result = meniscus_reconstructor_create(options.get(), reconstructor.out());
        EXPECT_TRUE(refused(result, MENISCUS_INVALID_INPUT, "option '" + name + "' is 'no such value'"));
    }
}

TEST(CInProcess, NumbersAreReadWhateverTheLocale) {
    const std::string before = std::setlocale(LC_NUMERIC, nullptr);
    // Where that is not installed, the test says nothing, but is right.
    std::setlocale(LC_NUMERIC, "de_DE.UTF-8");
    COptions options = options_of({{"cell-size", "0.75"}});
    EXPECT_EQ(meniscus_options_set_number(options.get(), "particle-radius", 0.025), MENISCUS_OK);
    CReconstructor reconstructor;
    EXPECT_EQ(meniscus_reconstructor_create(options.get(), reconstructor.out()), MENISCUS_OK)
        << meniscus_error_message();
    std::setlocale(LC_NUMERIC, before.c_str());
}

TEST(CInProcess, RoundNumbersAreWholeOnes) {
    auto options = options_of({{"backend", "cpu"}});
    CReconstructor reconstructor;
    for (const auto& [name, value] :
         std::initializer_list<std::pair<const char*, double>>{{"particle-radius", 1e5},
                                                               {"memory-limit", 1e9},
                                                               {"memory-limit", 4503599627370496.0},
                                                               {"threads", 10.0}}) {
        EXPECT_EQ(meniscus_options_set_number(options.get(), name, value), MENISCUS_OK);
        EXPECT_EQ(meniscus_reconstructor_create(options.get(), reconstructor.out()), MENISCUS_OK)
            << meniscus_error_message();
    }
}

TEST(CInProcess, RefusesWrongOptionsNamingValueAndLimit) {
    struct Case {
        std::initializer_list<std::pair<const char*, const char*>> values;
        std::string named;
    };
    const Case cases[] = {
        {{{"policy", "latest"}}, "option 'policy' is not known here, must be backend, threads"},
        {{{"cell-size", "wide"}}, "option 'cell-size' is 'wide', must be a number"},
        {{{"cell-size", "0.5 "}}, "option 'cell-size' is '0.5 '"},
        {{{"cell-size", "0,5"}}, "option 'cell-size' is '0,5'"},
        {{{"cell-size", ""}}, "option 'cell-size' is ''"},
        {{{"cell-size", "-1"}}, "cell size is -1, must be finite and greater than 0"},
        {{{"cell-size", "nan"}}, "cell size is nan"},
        {{{"field", "colour"}}, "option 'field' is 'colour', must be color, density or smooth"},
        {{{"tolerance", "0.2"}, {"criterion", "count"}}, "'tolerance' is '0.2', but 'criterion' is count"},
        {{{"bisection-steps", "3"}}, "'bisection-steps' is '3', but 'edge-points' is interpolate"},
        {{{"preset", "paper"}, {"bisection-steps", "8"}}, "bisection steps are 8, must be 1 to 7"},
        {{{"smoothness", "8"}}, "the smoothness is 8, must be 5 to 7"},
        {{{"smoothness", "5.5"}}, "option 'smoothness' is '5.5', must be a whole number"},
        {{{"smoothness", "-5"}}, "option 'smoothness' is '-5', must be a whole number, 0 or more"},
        {{{"smoothness", "5000000000"}}, "option 'smoothness' is '5000000000', must be a whole number"},
        {{{"normals", "yes"}}, "option 'normals' is 'yes', must be true or false"},
        {{{"domain", "0 0 0 1 1"}}, "option 'domain' is '0 0 0 1 1', must be 6 numbers"},
        {{{"domain", "0 0 0 1 1 1 1"}}, "must be 6 numbers"},
        {{{"domain", "0 0 0 1 1 -1"}}, "domain runs from 0 to -1 along z"},
        {{{"threads", "4000000000"}}, "the threads are 4000000000, must be at most 1024"},
        {{{"backend", "gpu"}}, "option 'backend' is 'gpu', must be auto, cpu or cuda"},
    };
    for (const Case& c : cases) {
        const std::string message = refusal_of(c.values);
        EXPECT_NE(message.find(c.named), std::string::npos) << "wanted: " << c.named << "\ngot: " << message;
    }
    CReconstructor reconstructor;
    EXPECT_TRUE(refused(meniscus_reconstructor_create(nullptr, reconstructor.out()), MENISCUS_INVALID_INPUT,
                        "option 'particle-radius' is not set"));
}

TEST(CInProcess, RefusesAnOptionThatNoFunctionKnowsWhereItIsSet) {
    const COptions options = options_of({{"particle-radius", "0.025"}});
    for (const char* value : {"1", static_cast<const char*>(nullptr)})
        EXPECT_TRUE(refused(meniscus_options_set(options.get(), "cel-size", value), MENISCUS_INVALID_INPUT,
                            "option 'cel-size' is not known, did you mean cell-size?"));
    EXPECT_TRUE(refused(meniscus_options_set_number(options.get(), "frobnicate", 1.0), MENISCUS_INVALID_INPUT,
                        "option 'frobnicate' is not known; see meniscus.h"));
    CReconstructor reconstructor;
    EXPECT_EQ(meniscus_reconstructor_create(options.get(), reconstructor.out()), MENISCUS_OK);
    // Those of sessions, streams, connections and watchers are known, too.
    for (const char* name : {"preset", "attribute", "attribute-bits", "tolerance", "backend", "name", "policy", "codec",
                             "reconnect", "token", "max-level"})
        EXPECT_EQ(meniscus_options_set(options.get(), name, "1"), MENISCUS_OK) << meniscus_error_message();
}

TEST(CInProcess, AnOptionThatIsUnsetIsNotSet) {
    const COptions options = options_of({{"particle-radius", "0.025"}, {"cell-size", "wrong"}});
    CReconstructor reconstructor;
    EXPECT_EQ(meniscus_reconstructor_create(options.get(), reconstructor.out()), MENISCUS_INVALID_INPUT);
    ASSERT_EQ(meniscus_options_set(options.get(), "cell-size", nullptr), MENISCUS_OK);
    EXPECT_EQ(meniscus_reconstructor_create(options.get(), reconstructor.out()), MENISCUS_OK);
}

TEST(CInProcess, RefusesWrongParticlesAndGoesOn) {
    const CReconstructor reconstructor = default_reconstructor();
    const CMesh mesh = empty_mesh();
    const Particles good = splash(7, 4);
    const std::string expected = mesh_sha256(reconstruct(default_settings(), good.frame()));
    const auto expect_refused = [&](const meniscus_particles& particles, const std::string& words) {
        EXPECT_TRUE(
            refused(meniscus_reconstruct(reconstructor.get(), &particles, mesh.get()), MENISCUS_INVALID_INPUT, words));
        const meniscus_particles input = c_frame(good);
        ASSERT_EQ(meniscus_reconstruct(reconstructor.get(), &input, mesh.get()), MENISCUS_OK);
        EXPECT_EQ(sha256(mesh), expected);
    };

    Particles bad = good;
    bad.positions[7] = std::numeric_limits<float>::quiet_NaN();
    expect_refused(c_frame(bad), "particle 2 has y = nan, positions must be finite");
    bad.positions[7] = 1e30F;
    expect_refused(c_frame(bad), "farther from the origin");
    bad = good;
    bad.levels.assign(bad.count(), 4);
    expect_refused(c_frame(bad), "particle 0 has level 4, must be 0 to 3");

    meniscus_particles particles = c_frame(good);
    particles.positions = nullptr;
    expect_refused(particles, "are all NULL");
    const double numbers[] = {0.0, 0.0, std::numeric_limits<double>::max()};
    particles = c_frame(good);
    particles.positions_double = numbers;
    expect_refused(particles, "positions and positions_double are both set");
    particles = c_frame(good);
    particles.axes[2] = good.positions.data();
    expect_refused(particles, "positions and axes are both set");
    particles.positions = nullptr;
    expect_refused(particles, "particles->axes[0] is NULL, must point to the x of");
    particles = MENISCUS_PARTICLES_INIT;
    particles.count = 1;
    for (const double*& axis : particles.axes_double) axis = numbers;
    particles.stride = 7;
    expect_refused(particles, "the stride is 7 bytes, must be at least 8: one number of 8 bytes");
    particles = MENISCUS_PARTICLES_INIT;
    particles.count = 1;
    particles.positions_double = numbers;
    expect_refused(particles, "particle 0");
    particles.stride = 8;
    expect_refused(particles, "stride");
    particles = c_frame(good);
    particles.count = std::numeric_limits<std::size_t>::max();
    expect_refused(particles, "particles->count is 18446744073709551615");
    particles = c_frame(good);
    particles.struct_size = 0;
    expect_refused(particles, "particles->struct_size is 0, must be sizeof(meniscus_particles)");
    particles.struct_size = offsetof(meniscus_particles, array_count) - 1;
    expect_refused(particles, "struct_size");
    // An end within a member, or between two of them.
    for (std::size_t size = offsetof(meniscus_particles, array_count) + 1; size < sizeof particles; ++size) {
        particles.struct_size = size;
        expect_refused(particles, "particles->struct_size is " + std::to_string(size));
    }
    particles.struct_size = std::size_t{1} << 40;
    expect_refused(particles, "struct_size");
}

TEST(CInProcess, TakesStructsOfTheFirstHeader) {
    const Particles particles = splash(7, 4);
    meniscus_particles input = c_frame(particles);
    input.struct_size = offsetof(meniscus_particles, array_count);
    input.array_count = 99;  // beyond the struct
    const CReconstructor reconstructor = default_reconstructor();
    const CMesh mesh = empty_mesh();
    EXPECT_EQ(meniscus_reconstruct(reconstructor.get(), &input, mesh.get()), MENISCUS_OK) << meniscus_error_message();
    meniscus_statistics statistics = MENISCUS_STATISTICS_INIT;
    statistics.struct_size = offsetof(meniscus_statistics, vertices_without_particles);
    statistics.vertices_without_particles = 99;
    EXPECT_EQ(meniscus_reconstructor_statistics(reconstructor.get(), &statistics), MENISCUS_OK);
    EXPECT_EQ(statistics.vertices_without_particles, 99U);
}

TEST(CInProcess, TakesStructsOfNewerHeadersAsLongAsTheySayNothingNew) {
    struct Newer {
        meniscus_particles known;
        const float* velocities;
    };
    const Particles particles = splash(7, 4);
    Newer newer{c_frame(particles), nullptr};
    newer.known.struct_size = sizeof newer;
    const CReconstructor reconstructor = default_reconstructor();
    const CMesh mesh = empty_mesh();
    EXPECT_EQ(meniscus_reconstruct(reconstructor.get(), &newer.known, mesh.get()), MENISCUS_OK);
    newer.velocities = particles.positions.data();
    EXPECT_TRUE(refused(meniscus_reconstruct(reconstructor.get(), &newer.known, mesh.get()), MENISCUS_INVALID_INPUT,
                        "members that this version of the library does not know"));

    struct NewerStatistics {
        meniscus_statistics known;
        double more = 5.0;
    };
    NewerStatistics statistics{};
    statistics.known.struct_size = sizeof statistics;
    ASSERT_EQ(meniscus_reconstructor_statistics(reconstructor.get(), &statistics.known), MENISCUS_OK);
    EXPECT_EQ(statistics.more, 0.0);
    EXPECT_EQ(statistics.known.struct_size, sizeof statistics);
}

TEST(CInProcess, ANullIsAnErrorAndNoCrash) {
    const CReconstructor reconstructor = default_reconstructor();
    const COptions options = options_of({});
    const CMesh mesh = empty_mesh();
    const meniscus_particles particles = MENISCUS_PARTICLES_INIT;
    meniscus_statistics statistics = MENISCUS_STATISTICS_INIT;
    const double* vertices = nullptr;
    std::size_t count = 0;
    char digits[MENISCUS_SHA256_SIZE];
    const meniscus_result results[] = {
        meniscus_options_create(nullptr),
        meniscus_options_set(nullptr, "iso", "1"),
        meniscus_options_set(options.get(), nullptr, "1"),
        meniscus_options_set_number(nullptr, "iso", 1.0),
        meniscus_options_set_number(options.get(), nullptr, 1.0),
        meniscus_reconstructor_create(options.get(), nullptr),
        meniscus_reconstruct(nullptr, &particles, mesh.get()),
        meniscus_reconstruct(reconstructor.get(), nullptr, mesh.get()),
        meniscus_reconstruct(reconstructor.get(), &particles, nullptr),
        meniscus_reconstructor_statistics(nullptr, &statistics),
        meniscus_reconstructor_statistics(reconstructor.get(), nullptr),
        meniscus_mesh_create(nullptr),
        meniscus_mesh_vertices(nullptr, &vertices, &count),
        meniscus_mesh_vertices(mesh.get(), nullptr, &count),
        meniscus_mesh_vertices(mesh.get(), &vertices, nullptr),
        meniscus_mesh_sha256(nullptr, digits),
        meniscus_mesh_sha256(mesh.get(), nullptr),
        meniscus_mesh_bricks_sha256(nullptr, digits),
    };
    for (const meniscus_result result : results) EXPECT_TRUE(refused(result, MENISCUS_INVALID_INPUT, "is NULL"));
    meniscus_options_destroy(nullptr);
    meniscus_mesh_destroy(nullptr);
    meniscus_reconstructor_destroy(nullptr);
}

TEST(CInProcess, AFrameBeyondTheMemoryLimitIsRefusedAndTheNextOneWorks) {
    const CReconstructor reconstructor = reconstructor_of({{"particle-radius", "0.025"}, {"memory-limit", "4000000"}});
    const CMesh mesh = empty_mesh();
    const Particles large = splash(8, 40);
    const Particles small = splash(8, 3);
    meniscus_particles input = c_frame(large);
    EXPECT_TRUE(
        refused(meniscus_reconstruct(reconstructor.get(), &input, mesh.get()), MENISCUS_LIMIT_EXCEEDED, "4000000"));
    const std::uint32_t* triangles = nullptr;
    std::size_t count = 1;
    EXPECT_EQ(meniscus_mesh_triangles(mesh.get(), &triangles, &count), MENISCUS_OK);
    EXPECT_EQ(count, 0U);
    input = c_frame(small);
    EXPECT_EQ(meniscus_reconstruct(reconstructor.get(), &input, mesh.get()), MENISCUS_OK) << meniscus_error_message();
}

TEST(CInProcess, StatisticsAreThoseOfTheMesh) {
    const CReconstructor reconstructor = default_reconstructor();
    const CMesh mesh = empty_mesh();
    const Particles particles = splash(9, 6);
    const meniscus_particles input = c_frame(particles);
    ASSERT_EQ(meniscus_reconstruct(reconstructor.get(), &input, mesh.get()), MENISCUS_OK);
    meniscus_statistics statistics = MENISCUS_STATISTICS_INIT;
    ASSERT_EQ(meniscus_reconstructor_statistics(reconstructor.get(), &statistics), MENISCUS_OK);
    const std::uint8_t* levels = nullptr;
    std::size_t triangles = 0;
    ASSERT_EQ(meniscus_mesh_triangle_levels(mesh.get(), &levels, &triangles), MENISCUS_OK);
    EXPECT_EQ(statistics.particles, particles.count());
    EXPECT_EQ(statistics.triangles, triangles);
    std::uint64_t by_level[4] = {};
    for (std::size_t i = 0; i < triangles; ++i) ++by_level[levels[i] == 0 ? 3 : levels[i] - 1];
    for (int level = 0; level < 4; ++level) EXPECT_EQ(statistics.triangles_by_level[level], by_level[level]);
    EXPECT_NEAR(statistics.volume, statistics.particle_volume, 0.5 * statistics.particle_volume);
    EXPECT_GT(statistics.total_seconds, 0.0);
    EXPECT_EQ(statistics.encoded_bytes, 0U);
}

TEST(CInProcess, MessagesBelongToTheirThread) {
    meniscus_mesh_create(nullptr);
    const std::string here = meniscus_error_message();
    std::thread([] {
        EXPECT_STREQ(meniscus_error_message(), "");
        meniscus_options_create(nullptr);
        EXPECT_STREQ(meniscus_error_message(), "options is NULL, must point to something");
    }).join();
    EXPECT_EQ(meniscus_error_message(), here);
    // A call that succeeds leaves the message.
    EXPECT_EQ(empty_mesh().get() != nullptr, true);
    EXPECT_EQ(meniscus_error_message(), here);
}

TEST(CInProcess, ALongMessageEndsBetweenCharacters) {
    for (std::size_t before = 0; before < 4; ++before) {
        std::string name(before, 'x');
        for (int i = 0; i < 1000; ++i) name += "\u20ac";  // three bytes each
        const COptions options = options_of({{"tls-cert", name.c_str()}, {"tls-key", "key"}});
        CClient client;
        const meniscus_result result = meniscus_client_connect("127.0.0.1:1", options.get(), client.out());
        if (result == MENISCUS_UNIMPLEMENTED) GTEST_SKIP() << meniscus_error_message();
        ASSERT_EQ(result, MENISCUS_INVALID_INPUT);
        const std::string message = meniscus_error_message();
        EXPECT_GT(message.size(), 1017U);
        EXPECT_LT(message.size(), 1024U);
        EXPECT_EQ(message.substr(message.size() - 3), "\u20ac");
    }
}

TEST(CInProcess, EveryResultHasItsName) {
    for (int result = MENISCUS_UNKNOWN + 1; result <= MENISCUS_WOULD_WAIT; ++result)
        EXPECT_STRNE(meniscus_result_name(static_cast<meniscus_result>(result)), "unknown") << result;
    EXPECT_STREQ(meniscus_result_name(static_cast<meniscus_result>(-18)), "unknown");
    EXPECT_STREQ(meniscus_result_name(static_cast<meniscus_result>(4)), "unknown");
    EXPECT_EQ(std::string(meniscus_version()), version());
}

}  // namespace
}  // namespace meniscus::test
