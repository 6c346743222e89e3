// The C interface against the C++ one: the same results, and every misuse answered by a status and a text.
#include <quadseg/quadseg.h>
#include <quadseg/segmentation.h>

#include "tests/capi/shapes.h"

#include <cstring>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <limits>
#include <thread>

namespace quadseg::capi_test {
namespace {

template <class Struct>
Struct sized() {
    Struct s{};
    s.struct_size = sizeof s;
    return s;
}

quadseg_options default_options() {
    quadseg_options options;
    EXPECT_EQ(quadseg_options_init(&options, sizeof options), QUADSEG_OK);
    return options;
}

/// Owns a segmentation of a mesh.
class Job {
  public:
    explicit Job(const quadseg_mesh_view& mesh, const quadseg_options* options = nullptr,
                 quadseg_context* context = nullptr) {
        status = quadseg_segment(&mesh, options, context, &handle);
    }
    ~Job() { quadseg_segmentation_destroy(handle); }
    Job(const Job&) = delete;
    Job& operator=(const Job&) = delete;

    quadseg_summary summary() const {
        auto s = sized<quadseg_summary>();
        EXPECT_EQ(quadseg_segmentation_summary(handle, &s), QUADSEG_OK) << quadseg_last_error();
        return s;
    }

    quadseg_status status = -1;
    quadseg_segmentation* handle = nullptr;
};

class Context {
  public:
    Context() { EXPECT_EQ(quadseg_context_create(&handle), QUADSEG_OK); }
    ~Context() { quadseg_context_destroy(handle); }
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;
    quadseg_context* handle = nullptr;
};

TEST(CInterface, GivesWhatCppGives) {
    const Arrays mesh = can();
    const Segmentation expected = segment({mesh.positions, mesh.triangles});
    const Job job(mesh.view());
    ASSERT_EQ(job.status, QUADSEG_OK) << quadseg_last_error();
    const auto summary = job.summary();
    ASSERT_EQ(summary.labels, expected.labels.size());
    ASSERT_EQ(summary.regions, expected.regions.size());
    EXPECT_EQ(summary.energy_total, expected.energy.total);
    EXPECT_EQ(summary.merges, expected.history.size());
    EXPECT_STREQ(quadseg_stop_name(summary.stop), to_string(expected.stop));

    std::vector<std::int32_t> labels(summary.labels);
    ASSERT_EQ(quadseg_segmentation_labels(job.handle, labels.data(), labels.size()), QUADSEG_OK);
    EXPECT_EQ(labels, expected.labels);

    std::vector<quadseg_region> regions(summary.regions);
    ASSERT_EQ(quadseg_segmentation_regions(job.handle, regions.data(), sizeof regions[0], regions.size()), QUADSEG_OK);
    for (std::size_t i = 0; i < regions.size(); ++i) {
        const Region& e = expected.regions[i];
        EXPECT_EQ(regions[i].id, e.id);
        EXPECT_EQ(regions[i].faces, e.faces);
        EXPECT_STREQ(quadseg_surface_type_name(regions[i].type), to_string(e.surface.type));
        EXPECT_EQ(0,
                  std::memcmp(regions[i].coefficients, e.surface.coefficients.data(), sizeof e.surface.coefficients));
        EXPECT_EQ(regions[i].radius, e.surface.radius);
        EXPECT_EQ(regions[i].rms, e.rms);
    }
    auto report = sized<quadseg_mesh_report>();
    ASSERT_EQ(quadseg_segmentation_report(job.handle, &report), QUADSEG_OK);
    EXPECT_EQ(report.faces, mesh.triangles.size() / 3);
    EXPECT_EQ(report.diagonal, expected.input.diagonal);

    ASSERT_EQ(summary.regularities, expected.regularities.size());
    for (std::size_t i = 0; i < summary.regularities; ++i) {
        auto regularity = sized<quadseg_regularity>();
        ASSERT_EQ(quadseg_segmentation_regularity(job.handle, i, &regularity, nullptr, 0), QUADSEG_OK);
        std::vector<std::int32_t> members(regularity.regions);
        ASSERT_EQ(quadseg_segmentation_regularity(job.handle, i, &regularity, members.data(), members.size()),
                  QUADSEG_OK);
        EXPECT_EQ(members, expected.regularities[i].regions);
    }
}

TEST(CInterface, DefaultOptionsAreTheDefaultsOfCpp) {
    const quadseg_options options = default_options();
    EXPECT_EQ(options.struct_size, sizeof options);
    const Arrays mesh = can();
    const Job with(mesh.view(), &options), without(mesh.view());
    ASSERT_EQ(with.status, QUADSEG_OK);
    EXPECT_EQ(with.summary().regions, without.summary().regions);
    EXPECT_EQ(with.summary().energy_total, without.summary().energy_total);
}

TEST(CInterface, OptionsReachTheJob) {
    quadseg_options options = default_options();
    options.project = 1;
    options.regions = 3;
    const Arrays mesh = can();
    const Job job(mesh.view(), &options);
    ASSERT_EQ(job.status, QUADSEG_OK) << quadseg_last_error();
    EXPECT_EQ(job.summary().regions, 3U);
    ASSERT_EQ(job.summary().projected, mesh.positions.size());
    std::vector<double> projected(mesh.positions.size());
    EXPECT_EQ(quadseg_segmentation_projected(job.handle, projected.data(), projected.size()), QUADSEG_OK);
    EXPECT_TRUE(std::isfinite(projected.back()));
}

TEST(CInterface, OptionsOutOfRangeAreNamed) {
    const Arrays mesh = can();
    const auto text_of = [&](const auto& change) {
        quadseg_options options = default_options();
        change(options);
        const Job job(mesh.view(), &options);
        EXPECT_EQ(job.status, QUADSEG_INVALID_ARGUMENT);
        EXPECT_EQ(job.handle, nullptr);
        return std::string(quadseg_last_error());
    };
    EXPECT_NE(text_of([](auto& o) { o.preset = 7; }).find("preset"), std::string::npos);
    EXPECT_NE(text_of([](auto& o) { o.smooth = -1; }).find("smooth"), std::string::npos);
    EXPECT_NE(text_of([](auto& o) { o.detail = -1; }).find("detail"), std::string::npos);
    EXPECT_NE(text_of([](auto& o) { o.weight = std::numeric_limits<double>::quiet_NaN(); }).find("weight"),
              std::string::npos);
    EXPECT_NE(text_of([](auto& o) { o.struct_size = 8; }).find("struct_size"), std::string::npos);
}

TEST(CInterface, StructsOfANewerHeaderAreUnderstood) {
    struct Newer {
        quadseg_options options;
        double added;
    } newer;
    ASSERT_EQ(quadseg_options_init(&newer.options, sizeof newer), QUADSEG_OK);
    EXPECT_EQ(newer.added, 0);
    EXPECT_EQ(newer.options.struct_size, sizeof newer);
    const Arrays mesh = can();
    EXPECT_EQ(Job(mesh.view(), &newer.options).status, QUADSEG_OK);
    newer.added = 1;  // something that this library can't do: refused, not ignored
    EXPECT_EQ(Job(mesh.view(), &newer.options).status, QUADSEG_INVALID_ARGUMENT);

    const Job job(mesh.view());
    struct WiderRegion {
        quadseg_region region;
        double added;
    };
    std::vector<WiderRegion> regions(job.summary().regions, WiderRegion{{}, -1});
    ASSERT_EQ(quadseg_segmentation_regions(job.handle, &regions[0].region, sizeof regions[0], regions.size()),
              QUADSEG_OK);
    for (std::size_t i = 0; i < regions.size(); ++i) {
        EXPECT_EQ(regions[i].region.id, static_cast<std::int32_t>(i));
        EXPECT_EQ(regions[i].added, 0);
    }
}

TEST(CInterface, SmallBuffersAreLeftAlone) {
    const Arrays mesh = can();
    const Job job(mesh.view());
    std::vector<std::int32_t> labels(mesh.triangles.size() / 3, -7);
    EXPECT_EQ(quadseg_segmentation_labels(job.handle, labels.data(), labels.size() - 1), QUADSEG_BUFFER_TOO_SMALL);
    EXPECT_NE(std::string(quadseg_last_error()).find(std::to_string(labels.size())), std::string::npos);
    EXPECT_EQ(labels, std::vector<std::int32_t>(labels.size(), -7));
    quadseg_region region{};
    EXPECT_EQ(quadseg_segmentation_regions(job.handle, &region, sizeof region, 1), QUADSEG_BUFFER_TOO_SMALL);
    EXPECT_EQ(quadseg_segmentation_regions(job.handle, &region, 16, 100), QUADSEG_INVALID_ARGUMENT);
}

TEST(CInterface, NullPointersAreNamed) {
    const Arrays mesh = can();
    const auto view = mesh.view();
    quadseg_segmentation* segmentation = nullptr;
    EXPECT_EQ(quadseg_segment(nullptr, nullptr, nullptr, &segmentation), QUADSEG_INVALID_ARGUMENT);
    EXPECT_STREQ(quadseg_last_error(), "mesh: must not be null");
    EXPECT_EQ(quadseg_segment(&view, nullptr, nullptr, nullptr), QUADSEG_INVALID_ARGUMENT);
    EXPECT_EQ(quadseg_context_create(nullptr), QUADSEG_INVALID_ARGUMENT);
    EXPECT_EQ(quadseg_context_set_threads(nullptr, 1), QUADSEG_INVALID_ARGUMENT);
    EXPECT_EQ(quadseg_context_set_time_limit(nullptr, 1), QUADSEG_INVALID_ARGUMENT);
    EXPECT_EQ(quadseg_context_set_memory_limit(nullptr, 1), QUADSEG_INVALID_ARGUMENT);
    EXPECT_EQ(quadseg_context_set_progress(nullptr, nullptr, nullptr), QUADSEG_INVALID_ARGUMENT);
    EXPECT_EQ(quadseg_options_init(nullptr, 160), QUADSEG_INVALID_ARGUMENT);
    EXPECT_EQ(quadseg_mesh_read(nullptr, nullptr, nullptr), QUADSEG_INVALID_ARGUMENT);
    EXPECT_EQ(quadseg_segmentation_labels(nullptr, nullptr, 0), QUADSEG_INVALID_ARGUMENT);
    EXPECT_EQ(quadseg_segmentation_summary(nullptr, nullptr), QUADSEG_INVALID_ARGUMENT);
    EXPECT_EQ(quadseg_write_mesh(nullptr, &view), QUADSEG_INVALID_ARGUMENT);
    EXPECT_EQ(quadseg_write_labels("x", &view, nullptr), QUADSEG_INVALID_ARGUMENT);
    quadseg_context_cancel(nullptr);
    EXPECT_EQ(quadseg_context_cancelled(nullptr), 0);
    quadseg_context_destroy(nullptr);
    quadseg_mesh_destroy(nullptr);
    quadseg_segmentation_destroy(nullptr);

    auto hollow = view;
    hollow.positions = nullptr;
    EXPECT_EQ(Job(hollow).status, QUADSEG_INVALID_ARGUMENT);
    EXPECT_STREQ(quadseg_last_error(), "positions: must not be null");
    auto huge = view;
    huge.face_count = std::numeric_limits<std::uint64_t>::max() / 2;  // 3 × this would wrap around
    EXPECT_EQ(Job(huge).status, QUADSEG_INVALID_ARGUMENT);
    auto askew = view;
    askew.positions = reinterpret_cast<const double*>(reinterpret_cast<const char*>(view.positions) + 4);
    EXPECT_EQ(Job(askew).status, QUADSEG_INVALID_ARGUMENT);
}

TEST(CInterface, BadMeshesAreRefused) {
    Arrays mesh = can();
    mesh.triangles[4] = 1'000'000;
    EXPECT_EQ(Job(mesh.view()).status, QUADSEG_INVALID_MESH);
    EXPECT_NE(std::string(quadseg_last_error()).find("1000000"), std::string::npos) << quadseg_last_error();
    mesh = can();
    mesh.positions[7] = std::numeric_limits<double>::infinity();
    EXPECT_EQ(Job(mesh.view()).status, QUADSEG_INVALID_MESH);
    EXPECT_EQ(Job(Arrays{}.view()).status, QUADSEG_EMPTY_MESH);
}

TEST(CInterface, ErrorsBelongToTheirThread) {
    EXPECT_EQ(quadseg_context_create(nullptr), QUADSEG_INVALID_ARGUMENT);
    std::string of_other_thread = "unset";
    std::thread([&] { of_other_thread = quadseg_last_error(); }).join();
    EXPECT_EQ(of_other_thread, "");
    EXPECT_STREQ(quadseg_last_error(), "context: must not be null");
}

TEST(CInterface, LongTextsAreCutAtACharacter) {
    quadseg_mesh* mesh = nullptr;
    std::string path = "x";
    for (int i = 0; i < 2000; ++i) path += "é";
    EXPECT_EQ(quadseg_mesh_read(path.c_str(), nullptr, &mesh), QUADSEG_FILE_OPEN);
    const std::string text = quadseg_last_error();
    ASSERT_GT(text.size(), 1000U);
    const auto last = static_cast<unsigned char>(text.back());
    EXPECT_EQ(last, 0xA9) << "ends inside a character";
}

TEST(CInterface, CancelDeadlineAndLimits) {
    const Arrays mesh = can(200, 200);
    {
        const Context context;
        quadseg_context_cancel(context.handle);
        EXPECT_EQ(quadseg_context_cancelled(context.handle), 1);
        const Job job(mesh.view(), nullptr, context.handle);
        ASSERT_EQ(job.status, QUADSEG_OK) << quadseg_last_error();
        EXPECT_EQ(job.summary().partial, 1);
        EXPECT_EQ(job.summary().stop, QUADSEG_STOP_CANCELLED);
        EXPECT_EQ(job.summary().labels, mesh.triangles.size() / 3);
    }
    {
        const Context context;
        EXPECT_EQ(quadseg_context_set_time_limit(context.handle, -1), QUADSEG_INVALID_ARGUMENT);
        EXPECT_EQ(quadseg_context_set_time_limit(context.handle, 1e-6), QUADSEG_OK);
        const Job job(mesh.view(), nullptr, context.handle);
        ASSERT_EQ(job.status, QUADSEG_OK) << quadseg_last_error();
        EXPECT_EQ(job.summary().stop, QUADSEG_STOP_DEADLINE);
    }
    {
        const Context context;
        EXPECT_EQ(quadseg_context_set_memory_limit(context.handle, 1 << 20), QUADSEG_OK);
        EXPECT_EQ(Job(mesh.view(), nullptr, context.handle).status, QUADSEG_MEMORY_LIMIT);
    }
    {
        const Context context;
        EXPECT_EQ(quadseg_context_set_threads(context.handle, -2), QUADSEG_INVALID_ARGUMENT);
        EXPECT_EQ(quadseg_context_set_threads(context.handle, 1), QUADSEG_OK);
        const Job job(can().view(), nullptr, context.handle);
        EXPECT_EQ(job.summary().threads, 1);
    }
}

struct Watch {
    int calls = 0;
    double last = 0;
    bool falls = false;
    int stop_after = 1 << 30;
};

int32_t watch(const quadseg_progress* progress, void* user_data) {
    auto& seen = *static_cast<Watch*>(user_data);
    EXPECT_GE(progress->struct_size, 32U);
    seen.falls = seen.falls || progress->fraction < seen.last;
    seen.last = progress->fraction;
    return ++seen.calls < seen.stop_after ? 1 : 0;
}

TEST(CInterface, ProgressIsToldAndCancels) {
    const Arrays mesh = can(100, 100);
    const Context context;
    Watch all;
    ASSERT_EQ(quadseg_context_set_progress(context.handle, watch, &all), QUADSEG_OK);
    EXPECT_EQ(Job(mesh.view(), nullptr, context.handle).status, QUADSEG_OK);
    EXPECT_GT(all.calls, 0);
    EXPECT_FALSE(all.falls);
    Watch first;
    first.stop_after = 1;
    ASSERT_EQ(quadseg_context_set_progress(context.handle, watch, &first), QUADSEG_OK);
    const Job job(mesh.view(), nullptr, context.handle);
    ASSERT_EQ(job.status, QUADSEG_OK);
    EXPECT_EQ(job.summary().stop, QUADSEG_STOP_CANCELLED);
    EXPECT_EQ(first.calls, 1);
}

TEST(CInterface, ReadsAndWritesFiles) {
    const auto folder = std::filesystem::temp_directory_path() / ("quadseg-capi-" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    const std::string path = (folder / "can.ply").string();
    const Arrays mesh = can();
    const auto view = mesh.view();
    ASSERT_EQ(quadseg_write_mesh(path.c_str(), &view), QUADSEG_OK) << quadseg_last_error();
    quadseg_mesh* read = nullptr;
    ASSERT_EQ(quadseg_mesh_read(path.c_str(), nullptr, &read), QUADSEG_OK) << quadseg_last_error();
    auto back = sized<quadseg_mesh_view>();
    ASSERT_EQ(quadseg_mesh_get_view(read, &back), QUADSEG_OK);
    ASSERT_EQ(back.face_count, view.face_count);
    EXPECT_EQ(0, std::memcmp(back.triangles, view.triangles, view.face_count * 12));
    auto report = sized<quadseg_mesh_report>();
    EXPECT_EQ(quadseg_inspect(&back, 30, nullptr, &report), QUADSEG_OK);
    EXPECT_EQ(report.components, 1U);

    const std::vector<std::int32_t> labels(view.face_count, 5);
    const std::string label_path = (folder / "labels.txt").string();
    EXPECT_EQ(quadseg_write_labels(label_path.c_str(), &back, labels.data()), QUADSEG_OK);
    EXPECT_EQ(std::filesystem::file_size(label_path), 2 * view.face_count);
    const std::vector<std::uint8_t> rgb(3 * view.face_count, 9);
    EXPECT_EQ(quadseg_write_ply((folder / "c.ply").c_str(), &back, labels.data(), rgb.data()), QUADSEG_OK);
    EXPECT_EQ(quadseg_write_mesh((folder / "none" / "x.ply").c_str(), &back), QUADSEG_FILE_WRITE);
    quadseg_mesh_destroy(read);

    std::ofstream(folder / "bad.off") << "OFF\n3 1 0\n0 0 0\n";
    EXPECT_EQ(quadseg_mesh_read((folder / "bad.off").c_str(), nullptr, &read), QUADSEG_FILE_FORMAT);
    EXPECT_EQ(read, nullptr);
    std::filesystem::remove_all(folder);
}

TEST(CInterface, EveryNumberHasAName) {
    EXPECT_STREQ(quadseg_status_name(QUADSEG_OK), "ok");
    EXPECT_STREQ(quadseg_status_name(QUADSEG_INTERNAL), "internal");
    EXPECT_STREQ(quadseg_status_name(QUADSEG_CANCELLED), "cancelled");
    EXPECT_STREQ(quadseg_status_name(QUADSEG_MEMORY_LIMIT), "memory_limit");
    for (const int outside : {-1, 12, std::numeric_limits<int>::min(), std::numeric_limits<int>::max()}) {
        EXPECT_STREQ(quadseg_status_name(outside), "unknown");
    }
    EXPECT_STREQ(quadseg_surface_type_name(QUADSEG_TORUS), "torus");
    EXPECT_STREQ(quadseg_surface_type_name(QUADSEG_FREEFORM), "freeform");
    EXPECT_STREQ(quadseg_surface_type_name(17), "unknown");
    EXPECT_STREQ(quadseg_phase_name(QUADSEG_PHASE_FINE), "fine");
    EXPECT_STREQ(quadseg_regularity_name(QUADSEG_COAXIAL), "coaxial");
    EXPECT_GT(std::strlen(quadseg_version()), 0U);
}

}  // namespace
}  // namespace quadseg::capi_test
