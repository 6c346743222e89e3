// The command line of `quadseg segment`.
#pragma once

#include <quadseg/options.h>

#include "tools/cli/progress.h"

#include <CLI/CLI.hpp>
#include <string>

namespace quadseg::cli {

struct SegmentArguments {
    std::string mesh;
    std::string folder;
    Options options;
    int threads = 0;
    double timeout = 0;
    bool quiet = false;
    bool json = false;
    bool pictures = false;
    bool write_regions = true;
    bool write_types = true;

    // As typed; resolve() translates them.
    std::string preset = "default";
    std::string method = "quadric";
    std::string features;
    std::string coarse = "none";
    std::string progress = "auto";

    ProgressMode progress_mode() const;
};

void add_options(CLI::App& command, SegmentArguments& arguments);
/// Translates words into options. Throws Error invalid_argument.
void resolve(SegmentArguments& arguments);

}  // namespace quadseg::cli
