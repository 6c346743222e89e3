// The subcommands. Each adds its options to the parser and returns what runs it.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace quadseg::cli {

/// Runs the parsed subcommand; returns an exit code, throws quadseg::Error.
using Command = std::function<int()>;

Command add_segment(CLI::App& app);
Command add_info(CLI::App& app);
Command add_simplify(CLI::App& app);
Command add_compare(CLI::App& app);
Command add_picture(CLI::App& app);
Command add_generate(CLI::App& app);
Command add_batch(CLI::App& app);
Command add_batch_item(CLI::App& app);

}  // namespace quadseg::cli
