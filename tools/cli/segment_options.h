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
    std::size_t memory_limit = 0;  ///< bytes, 0: none
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
    std::string memory;

    ProgressMode progress_mode() const;
};

void add_options(CLI::App& command, SegmentArguments& arguments);
/// Bytes: a number with or without K, M, G, T (powers of 1024). Throws Error invalid_argument.
std::size_t parse_bytes(const std::string& option, const std::string& text);
/// Translates words into options. Throws Error invalid_argument.
void resolve(SegmentArguments& arguments);

}  // namespace quadseg::cli
