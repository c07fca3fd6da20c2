// libcatalyst-meniscus.so in a simulation of one process.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "catalyst_fixture.hpp"
#include "meniscus/meniscus.hpp"
#include "support/particles.hpp"

namespace meniscus::test {
namespace {

TEST_F(Catalyst, TakesPositionsInEveryLayoutToTheSameMesh) {
    start();
    const CWatcher watcher = watch();
    const Particles particles = splash(1, 5);
    const std::size_t count = particles.count();
    const std::string mesh_of_it = expected(particles);
    const std::vector<double> doubles(particles.positions.begin(), particles.positions.end());
    std::vector<float> floats_apart[3];
    std::vector<double> doubles_apart[3];
    struct Record {
        std::int32_t id;
        float place[3];
        float mass;
    };
    std::vector<Record> records(count);
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            floats_apart[axis].push_back(particles.positions[3 * i + axis]);
            doubles_apart[axis].push_back(doubles[3 * i + axis]);
            records[i].place[axis] = particles.positions[3 * i + axis];
        }
    std::int64_t step = 10;
    const auto give = [&](const char* layout, const auto& set) {
        SCOPED_TRACE(layout);
        conduit_node params;
        conduit_node& mesh = points_mesh(params, step);
        for (std::size_t axis = 0; axis < 3; ++axis)
            set(mesh["coordsets/coords/values/" + std::string(1, "xyz"[axis])], axis);
        ASSERT_EQ(execute(params), catalyst_status_ok);
        const CFrame frame = next(watcher, static_cast<std::uint64_t>(step));
        double time = 0.0;
        EXPECT_EQ(meniscus_frame_simulation_time(frame.get(), &time), MENISCUS_OK);
        EXPECT_EQ(time, 0.5 * static_cast<double>(step));
        EXPECT_EQ(sha256_of(frame), mesh_of_it);
        ++step;
    };
    give("float32 together",
         [&](conduit_node& node, std::size_t axis) { node.point(particles.positions.data(), count, 4 * axis, 12); });
    give("float64 together",
         [&](conduit_node& node, std::size_t axis) { node.point(doubles.data(), count, 8 * axis, 24); });
    give("float32 apart", [&](conduit_node& node, std::size_t axis) { node.point(floats_apart[axis].data(), count); });
    give("float64 apart", [&](conduit_node& node, std::size_t axis) { node.point(doubles_apart[axis].data(), count); });
    give("both types", [&](conduit_node& node, std::size_t axis) {
        if (axis == 1)
            node.point(doubles_apart[axis].data(), count);
        else
            node.point(floats_apart[axis].data(), count);
    });
    give("within records", [&](conduit_node& node, std::size_t axis) {
        node.point(&records[0].place[0], count, sizeof(float) * axis, sizeof(Record));
    });
    std::vector<char> memory(1 + 13 * count);
    for (std::size_t i = 0; i < count; ++i) std::memcpy(&memory[1 + 13 * i], &particles.positions[3 * i], 12);
    give("unaligned", [&](conduit_node& node, std::size_t axis) {
        node.point(reinterpret_cast<const float*>(memory.data()), count, 1 + 4 * axis, 13);
    });
    EXPECT_EQ(results().sent, step - 10);
    EXPECT_EQ(finalize(), catalyst_status_ok);
}

TEST_F(Catalyst, MakesFieldsAttributesAsTheCInterfaceDoes) {
    start("attribute=density velocity color id");
    const CWatcher watcher = watch("density velocity color id");
    const Particles particles = splash(2, 5);
    const std::size_t count = particles.count();
    std::vector<float> density;
    std::vector<double> velocity_apart[3];
    std::vector<float> velocity;
    std::vector<std::uint8_t> color;
    std::vector<std::int32_t> ids_with_gaps;
    std::vector<std::int32_t> ids;
    for (std::size_t i = 0; i < count; ++i) {
        density.push_back(1000.0F + static_cast<float>(i));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            velocity_apart[axis].push_back(0.1 * static_cast<double>(i + axis));
            velocity.push_back(static_cast<float>(velocity_apart[axis].back()));
            color.push_back(static_cast<std::uint8_t>(i * (axis + 1)));
        }
        ids.push_back(static_cast<std::int32_t>(7 * i));
        ids_with_gaps.insert(ids_with_gaps.end(), {ids.back(), -1});
    }
    conduit_node params;
    conduit_node& mesh = points_mesh(params, 0);
    set_positions(mesh, particles.positions);
    point_field(mesh, "Density").point(density.data(), count);
    conduit_node& components = point_field(mesh, "velocity");
    components["u"].point(velocity_apart[0].data(), count);
    components["v"].point(velocity_apart[1].data(), count);
    components["w"].point(velocity_apart[2].data(), count);
    conduit_node& colors = point_field(mesh, "color");
    for (std::size_t i = 0; i < 3; ++i) colors[std::string(1, "rgb"[i])].point(color.data(), count, i, 3);
    point_field(mesh, "id").point(ids_with_gaps.data(), count, 0, 8);
    ASSERT_EQ(execute(params), catalyst_status_ok);
    const CMesh got = empty_mesh();
    ASSERT_EQ(meniscus_frame_mesh(next(watcher, 0).get(), got.get()), MENISCUS_OK) << meniscus_error_message();

    const meniscus_array arrays[] = {{"density", MENISCUS_FLOAT32, 1, density.data()},
                                     {"velocity", MENISCUS_FLOAT32, 3, velocity.data()},
                                     {"color", MENISCUS_UINT8, 3, color.data()},
                                     {"id", MENISCUS_INT32, 1, ids.data()}};
    meniscus_particles same = MENISCUS_PARTICLES_INIT;
    same.count = count;
    same.positions = particles.positions.data();
    same.array_count = 4;
    same.arrays = arrays;
    const COptions settings = options_of({{"particle-radius", "0.025"}, {"attribute", "density velocity color id"}});
    CSession session;
    ASSERT_EQ(meniscus_session_open(client_.get(), settings.get(), session.out()), MENISCUS_OK);
    const CWatcher other = watch("density velocity color id", meniscus_session_id(session.get()));
    ASSERT_EQ(meniscus_session_push(session.get(), &same, 0, 0.0), MENISCUS_OK) << meniscus_error_message();
    const CMesh wanted = empty_mesh();
    ASSERT_EQ(meniscus_frame_mesh(next(other, 0).get(), wanted.get()), MENISCUS_OK) << meniscus_error_message();
    EXPECT_EQ(sha256(got), sha256(wanted));

    const meniscus_array* got_arrays = nullptr;
    const meniscus_array* wanted_arrays = nullptr;
    std::size_t got_count = 0;
    std::size_t wanted_count = 0;
    std::size_t vertices = 0;
    const float* places = nullptr;
    ASSERT_EQ(meniscus_mesh_vertices_float(got.get(), &places, &vertices), MENISCUS_OK);
    ASSERT_EQ(meniscus_mesh_attributes(got.get(), &got_arrays, &got_count), MENISCUS_OK);
    ASSERT_EQ(meniscus_mesh_attributes(wanted.get(), &wanted_arrays, &wanted_count), MENISCUS_OK);
    ASSERT_GT(vertices, 0U);
    ASSERT_EQ(got_count, 4U);
    ASSERT_EQ(wanted_count, 4U);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_STREQ(got_arrays[i].name, wanted_arrays[i].name);
        ASSERT_EQ(got_arrays[i].components, wanted_arrays[i].components);
        const std::size_t bytes = (i == 2 ? 1 : 4) * got_arrays[i].components * vertices;
        EXPECT_EQ(std::memcmp(got_arrays[i].data, wanted_arrays[i].data, bytes), 0) << got_arrays[i].name;
    }
}

TEST_F(Catalyst, SaysOnceOfEachFieldThatIsNoAttributeAndGoesOn) {
    start("attribute=all");
    const Particles particles = splash(1, 4);
    const std::vector<std::int64_t> wide(particles.count());
    const std::vector<float> values(particles.count());
    conduit_node params;
    conduit_node& mesh = points_mesh(params, 0);
    set_positions(mesh, particles.positions);
    point_field(mesh, "wide").point(wide.data(), wide.size());
    point_field(mesh, "pressure").point(values.data(), values.size());
    point_field(mesh, "Pressure").point(values.data(), values.size());
    point_field(mesh, "level").point(values.data(), values.size());
    for (const char* const component : {"a", "b"})
        point_field(mesh, "pair")[component].point(values.data(), values.size());
    point_field(mesh, "cells").point(values.data(), values.size());
    mesh["fields/cells/association"].set(std::string("element"));
    point_field(mesh, "others").point(values.data(), 1);
    mesh["fields/others/topology"].set(std::string("walls"));
    mesh["topologies/walls/type"].set(std::string("unstructured"));
    mesh["topologies/walls/elements/shape"].set(std::string("tri"));
    testing::internal::CaptureStderr();
    EXPECT_EQ(execute(params), catalyst_status_ok);
    params["catalyst/state/timestep"].set(std::int64_t{1});
    EXPECT_EQ(execute(params), catalyst_status_ok);
    const std::string said = testing::internal::GetCapturedStderr();
    EXPECT_EQ(times(said, "field 'wide' is passed over: 1 of int64, must be 1, 3 or 4 of float32"), 1U) << said;
    EXPECT_EQ(times(said, "field 'Pressure' is passed over: the name of another field"), 1U) << said;
    EXPECT_EQ(times(said, "field 'level' is passed over: a name with another meaning"), 1U) << said;
    EXPECT_EQ(times(said, "field 'pair' is passed over: 2 of float32"), 1U) << said;
    EXPECT_EQ(times(said, "field 'cells' is passed over: its association is 'element', must be vertex"), 1U) << said;
    EXPECT_EQ(times(said, "topology 'walls' is passed over: its elements are no points"), 1U) << said;
    EXPECT_EQ(times(said, "passed over"), 6U) << said;
    EXPECT_EQ(results().sent, 2);
}

TEST_F(Catalyst, RefusesAFrameThatIsNoneAndTakesTheNext) {
    start("attribute=pressure");
    const CWatcher watcher = watch();
    Particles particles = splash(1, 4);
    const auto fresh = [&](conduit_node& params, std::int64_t step) -> conduit_node& {
        conduit_node& mesh = points_mesh(params, step);
        set_positions(mesh, particles.positions);
        static const std::vector<float> values(particles.count());
        point_field(mesh, "pressure").point(values.data(), particles.count());
        return mesh;
    };
    std::int64_t step = 5;
    const auto refused_after = [&](const auto& change, const std::string& words) {
        conduit_node params;
        change(fresh(params, step++));
        return refuses_frame(params, words);
    };
    const std::vector<std::int32_t> whole(particles.count());
    EXPECT_TRUE(refused_after([](conduit_node& m) { m["topologies/particles/type"].set(std::string("structured")); },
                              "the mesh has no topology of points"));
    EXPECT_TRUE(refused_after([](conduit_node& m) { m["topologies/particles/coordset"].set(std::string("c")); },
                              "topology 'particles' names coordset 'c', which is not there"));
    EXPECT_TRUE(refused_after([](conduit_node& m) { m["coordsets/coords/type"].set(std::string("uniform")); },
                              "coordset 'coords' is of type 'uniform', must be explicit"));
    EXPECT_TRUE(refused_after([](conduit_node& m) { m["coordsets/coords/values"].children.pop_back(); },
                              "coordset values/z is missing"));
    EXPECT_TRUE(
        refused_after([&](conduit_node& m) { m["coordsets/coords/values/y"].point(whole.data(), whole.size()); },
                      "coordset values/y is int32, must be float32 or float64"));
    EXPECT_TRUE(refused_after([](conduit_node& m) { m["coordsets/coords/values/y"].type.is_swapped = true; },
                              "coordset values/y is of another type"));
    EXPECT_TRUE(refused_after([](conduit_node& m) { --m["coordsets/coords/values/z"].type.count; },
                              "must have " + std::to_string(particles.count()) + " as values/x has"));
    EXPECT_TRUE(refused_after([](conduit_node& m) { --m["fields/pressure/values"].type.count; },
                              "field 'pressure' has " + std::to_string(particles.count() - 1) + " numbers"));
    EXPECT_TRUE(refused_after([](conduit_node& m) { m["fields"].children.clear(); }, "no array 'pressure'"));
    conduit_node nothing;
    EXPECT_TRUE(refuses_frame(nothing, "the channels are none"));
    conduit_node before;
    fresh(before, -1);
    EXPECT_TRUE(refuses_frame(before, "catalyst/state/timestep is not a whole number from 0 on"));
    Particles bad = particles;
    bad.positions[4] = std::numeric_limits<float>::quiet_NaN();
    conduit_node params;
    set_positions(fresh(params, step++), bad.positions);
    EXPECT_TRUE(refuses_frame(params, "particle 1 has y = nan"));

    conduit_node good;
    fresh(good, step);
    EXPECT_EQ(execute(good), catalyst_status_ok);
    EXPECT_EQ(sha256_of(next(watcher, static_cast<std::uint64_t>(step))), expected(particles));
    EXPECT_TRUE(
        refuses_frame(good, "catalyst/state/timestep is " + std::to_string(step) + " after " + std::to_string(step)));
}

// Of several ranks, which number them alike, one may refuse its part.
TEST_F(Catalyst, CountsRefusedFramesWhereNoStateNumbersThem) {
    start();
    const CWatcher watcher = watch();
    const Particles particles = splash(1, 4);
    for (std::uint64_t frame = 0; frame < 5; ++frame) {
        const bool is_wrong = frame % 2 == 1;
        conduit_node params;
        conduit_node& mesh = channel_of_points(params, "fluid");
        if (is_wrong) mesh["topologies/particles/coordset"].set(std::string("others"));
        set_positions(mesh, particles.positions);
        EXPECT_EQ(execute(params), is_wrong ? status_of(MENISCUS_INVALID_INPUT) : catalyst_status_ok);
        if (is_wrong) continue;
        EXPECT_EQ(sha256_of(next(watcher, frame)), expected(particles));
    }
}

TEST_F(Catalyst, SendsFramesWithoutParticles) {
    start("attribute=pressure");
    const CWatcher watcher = watch();
    conduit_node params;
    conduit_node& mesh = points_mesh(params, 3);
    for (const char* const axis : {"x", "y", "z"}) mesh["coordsets/coords/values/" + std::string(axis)];
    ASSERT_EQ(execute(params), catalyst_status_ok);
    EXPECT_EQ(sha256_of(next(watcher, 3)), expected(Particles()));
}

TEST_F(Catalyst, TakesTheFirstChannelOrTheChosenOneAndSaysOnceOfTheOther) {
    const Particles first = splash(1, 4);
    const Particles second = splash(2, 4);
    for (const bool chosen : {false, true}) {
        start(chosen ? "channel=boundary" : "");
        const CWatcher watcher = watch();
        conduit_node params;
        params["catalyst/channels/grid/type"].set(std::string("multimesh"));
        set_positions(points_mesh(params, 0, "fluid"), first.positions);
        set_positions(points_mesh(params, 0, "boundary"), second.positions);
        testing::internal::CaptureStderr();
        EXPECT_EQ(execute(params), catalyst_status_ok);
        EXPECT_EQ(sha256_of(next(watcher, 0)), expected(chosen ? second : first));
        params["catalyst/state/timestep"].set(std::int64_t{1});
        EXPECT_EQ(execute(params), catalyst_status_ok);
        const std::string said = testing::internal::GetCapturedStderr();
        EXPECT_EQ(times(said, "channel 'grid' is passed over: it is of type 'multimesh', must be mesh"), 1U) << said;
        EXPECT_EQ(times(said, chosen ? "channel 'fluid' is passed over" : "channel 'boundary' is passed over"), 1U)
            << said;
        EXPECT_EQ(finalize(), catalyst_status_ok);
    }
    start("channel=nobody");
    conduit_node params;
    set_positions(points_mesh(params, 0), first.positions);
    EXPECT_TRUE(refuses_frame(params, "there is no mesh of channel 'nobody', the channels are 'fluid'"));
}

TEST_F(Catalyst, ReadsOptionsFromScriptsBelowThoseOfTheEnvironment) {
    conduit_node params;
    params["catalyst/scripts/surface/filename"].set(std::string("view.py"));
    conduit_node& args = params["catalyst/scripts/surface/args"];
    args.append().set("server=" + address_);
    args.append().set(std::string("particle-radius=0.9"));
    args.append().set(std::string("name=a standing wave"));
    args.append().set(std::string("particle-raduis=0.1"));
    args.append().set(std::string("--verbose"));
    set_options("particle-radius=0.025 domain=-9 -9 -9 9 9 9");
    testing::internal::CaptureStderr();
    const int status = initialize(params);
    const std::string said = testing::internal::GetCapturedStderr();
    ASSERT_EQ(status, catalyst_status_ok) << said;
    EXPECT_EQ(times(said, "script 'view.py' is passed over"), 1U) << said;
    EXPECT_EQ(times(said, "option 'particle-raduis' is not known, did you mean particle-radius?; passed over"), 1U)
        << said;
    EXPECT_EQ(times(said, "argument '--verbose' of a script is passed over"), 1U) << said;
    const CWatcher watcher = watch();
    const Particles particles = splash(1, 4);
    conduit_node frame;
    set_positions(points_mesh(frame, 0), particles.positions);
    ASSERT_EQ(execute(frame), catalyst_status_ok);
    EXPECT_EQ(sha256_of(next(watcher, 0)), expected(particles));
}

TEST_F(Catalyst, RefusesWrongOptions) {
    EXPECT_TRUE(refuses("particle-radius=0.025",
                        "options 'server' and 'output' are missing, must be either server=HOST:PORT of a meniscusd"));
    EXPECT_TRUE(refuses(options("output=x"), "options 'server' and 'output' are both set"));
    EXPECT_TRUE(refuses("server=" + address_, "particle"));
    EXPECT_TRUE(
        refuses(options("cell-sise=1"), "MENISCUS_CATALYST: option 'cell-sise' is not known, did you mean cell-size?"));
    EXPECT_TRUE(refuses(options("cell-size=wide"), "option 'cell-size' is 'wide'"));
    EXPECT_TRUE(refuses(options("policy=sometimes"), "option 'policy' is 'sometimes'"));
    EXPECT_TRUE(refuses(options("timeout=soon"), "option 'timeout' is 'soon'"));
    EXPECT_TRUE(refuses(options("region=0 0 0 1 1 1"), "option 'region' is not known here"));
    EXPECT_TRUE(refuses("fast " + options(), "options begin with 'fast'"));
    conduit_node params;
    EXPECT_EQ(execute(params), status_of(MENISCUS_FAILED_PRECONDITION));
    EXPECT_EQ(finalize(), catalyst_status_ok);
    start();
    EXPECT_EQ(initialize(), status_of(MENISCUS_FAILED_PRECONDITION));
}

TEST_F(Catalyst, MakesSurfacesItselfWhereItIsToldTo) {
    start("reconstruct-ranks=all threads=1 attribute=heat");
    const CWatcher watcher = watch("heat");
    std::vector<Particles> frames;
    for (unsigned step = 0; step < 4; ++step) frames.push_back(splash(step, 4));
    std::vector<float> heat(frames[0].count());
    for (std::size_t i = 0; i < heat.size(); ++i) heat[i] = 0.01F * static_cast<float>(i);
    Settings settings = default_settings();
    settings.attributes = {"heat"};
    const auto expect = [&](std::uint64_t step) {
        ParticleFrame frame = frames[step].frame();
        const std::vector<ParticleArray> arrays{
            {"heat", std::as_bytes(std::span(heat).first(frame.count())), ElementType::float32, 1}};
        frame.arrays = arrays;
        EXPECT_EQ(sha256_of(next(watcher, step)), mesh_sha256(reconstruct(settings, frame)));
    };
    for (std::uint64_t step = 0; step < frames.size(); ++step) {
        conduit_node params;
        conduit_node& mesh = points_mesh(params, static_cast<std::int64_t>(step));
        set_positions(mesh, frames[step].positions);
        point_field(mesh, "heat").point(heat.data(), frames[step].count());
        EXPECT_EQ(execute(params), catalyst_status_ok);
        if (step > 0) expect(step - 1);
    }
    EXPECT_EQ(results().sent, 4);
    EXPECT_EQ(finalize(), catalyst_status_ok);
    expect(3);
}

TEST_F(Catalyst, SaysWhatItIs) {
    conduit_node about;
    EXPECT_EQ(implementation().about(&about), catalyst_status_ok);
    EXPECT_STREQ(reinterpret_cast<const char*>(about.find("catalyst/implementation")->data), "meniscus");
    EXPECT_STREQ(reinterpret_cast<const char*>(about.find("meniscus/version")->data), meniscus_version());
    conduit_node results;
    EXPECT_EQ(implementation().results(&results), status_of(MENISCUS_FAILED_PRECONDITION));
}

}  // namespace
}  // namespace meniscus::test
