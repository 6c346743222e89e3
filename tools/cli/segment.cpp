#include <quadseg/error.h>
#include <quadseg/io.h>

#include "runtime/resources.h"
#include "tools/cli/colors.h"
#include "tools/cli/commands.h"
#include "tools/cli/exit_code.h"
#include "tools/cli/files.h"
#include "tools/cli/picture.h"
#include "tools/cli/report.h"
#include "tools/cli/segment_options.h"
#include "tools/cli/stop_signals.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <memory>

namespace quadseg::cli {
namespace {

using Clock = std::chrono::steady_clock;
using runtime::seconds_since;

void write_files(const SegmentArguments& a, const Mesh& mesh, const Segmentation& s) {
    const std::string base = a.folder + "/";
    std::vector<Rgb> by_region;
    std::vector<Rgb> by_type;
    for (const Region& region : s.regions) {
        by_region.push_back(region_color(region.id));
        by_type.push_back(type_color(region.surface.type));
    }
    const auto write_colored = [&](const char* name, const std::vector<Rgb>& colors) {
        const auto rgb = face_colors(s.labels, colors);
        write_ply(base + name, mesh.view(), {s.labels, rgb});
    };
    std::vector<std::function<void()>> jobs;
    jobs.emplace_back([&] { write_labels(base + "labels.txt", s.labels, mesh.polygons); });
    if (a.write_regions) jobs.emplace_back([&] { write_colored("regions.ply", by_region); });
    if (a.write_types) jobs.emplace_back([&] { write_colored("types.ply", by_type); });
    if (!s.projected.empty()) {
        jobs.emplace_back([&] {
            const auto rgb = face_colors(s.labels, by_region);
            write_ply(base + "projected.ply", {s.projected, mesh.triangles, {}}, {s.labels, rgb});
        });
    }
    if (a.pictures) {
        jobs.emplace_back([&] { write_region_picture(base + "regions.png", mesh, s); });
        jobs.emplace_back([&] { write_type_picture(base + "types.png", mesh, s); });
    }
    write_all(jobs, a.threads);
}

void print_summary(const SegmentArguments& a, const Segmentation& s) {
    std::array<std::size_t, surface_type_count> count{};
    for (const Region& region : s.regions) ++count[static_cast<std::size_t>(region.surface.type)];
    std::string types;
    for (std::size_t t = 0; t < count.size(); ++t) {
        if (count[t] == 0) continue;
        types += (types.empty() ? "" : ", ") + std::to_string(count[t]) + ' ' + to_string(static_cast<SurfaceType>(t));
    }
    std::printf("%zu faces in %zu regions: %s\n", s.labels.size(), s.regions.size(), types.c_str());
    std::printf("RMS distance %.3g, largest %.3g of the diagonal; energy %.4g\n", s.rms, s.max, s.energy.total);
    std::printf("%.2f s with %d threads, %.0f MB; stopped: %s%s\n", s.seconds.total, s.threads,
                static_cast<double>(s.peak_bytes) / 1e6, to_string(s.stop), s.partial ? " (partial result)" : "");
    std::printf("written to %s\n", a.folder.c_str());
}

int run_segment(SegmentArguments& a) {
    const auto start = Clock::now();
    resolve(a);
    Context context;
    context.set_threads(a.threads);
    if (a.timeout > 0) context.set_time_limit(a.timeout);
    context.set_memory_limit(a.memory_limit);
    const StopSignals signals(context);
    ProgressDisplay progress(a.progress_mode());

    progress.attach(context, 0, 0.1);
    const Mesh mesh = read_mesh(a.mesh, &context);
    const double read = seconds_since(start);
    make_folder(a.folder);

    progress.attach(context, 0.1, 0.9);
    Segmentation result = on_file(a.mesh, [&] { return segment(mesh.view(), a.options, &context); });

    context.on_progress(nullptr);
    progress.show({Phase::write, 0.9, result.regions.size(), result.energy.total});
    const auto write_start = Clock::now();
    write_files(a, mesh, result);
    result.seconds.read = read;
    result.seconds.write = seconds_since(write_start);
    result.seconds.total = seconds_since(start);
    result.peak_bytes = std::max(result.peak_bytes, runtime::peak_resident_bytes());
    // Last, so that a folder with a result.json is complete.
    const std::string json = indented(result_json(a.mesh, mesh, a.options, result));
    write_text(a.folder + "/result.json", json);
    progress.finish();
    if (a.json) {
        std::cout << json << std::flush;
    } else if (!a.quiet) {
        print_summary(a, result);
    }
    return result.partial ? exit_stopped : exit_done;
}

}  // namespace

Command add_segment(CLI::App& app) {
    const auto arguments = std::make_shared<SegmentArguments>();
    CLI::App* command = app.add_subcommand("segment", "Segments a mesh into quadric surface regions");
    add_options(*command, *arguments);
    return [arguments] { return run_segment(*arguments); };
}

}  // namespace quadseg::cli
