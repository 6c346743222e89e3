// The command line of `quadseg batch`: the options of `segment`, handed on to every mesh, and its own.
#pragma once

#include "tools/cli/batch_manifest.h"
#include "tools/cli/batch_worker.h"
#include "tools/cli/segment_options.h"

#include <CLI/CLI.hpp>
#include <cstddef>
#include <string>

namespace quadseg::cli {

struct BatchArguments {
    SegmentArguments segment;  ///< its mesh is the folder or manifest
    CLI::App* command = nullptr;

    int jobs = 0;  ///< 0: one a core
    bool resume = false, retry = false, list = false;
    std::string shard = "1/1";
    double grace = 10;
    std::string name;  ///< of the one mesh of `batch-item`
};

/// Adds what one mesh of a batch and a whole one have in common.
void add_item_options(CLI::App& command, BatchArguments& arguments);
/// Settings of the workers; checks the options of `segment`. Throws Error invalid_argument.
WorkerSettings worker_settings(BatchArguments& arguments);
int job_count(const BatchArguments& arguments);

}  // namespace quadseg::cli
