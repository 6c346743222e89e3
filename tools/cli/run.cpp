#include <quadseg/error.h>

#include "tools/cli/commands.h"
#include "tools/cli/exit_code.h"

#include <exception>
#include <iostream>
#include <new>
#include <utility>
#include <vector>

namespace quadseg::cli {
namespace {

int exit_code_of(ErrorCode code) {
    switch (code) {
        case ErrorCode::invalid_argument:
            return exit_usage;
        case ErrorCode::invalid_mesh:
        case ErrorCode::empty_mesh:
        case ErrorCode::file_open:
        case ErrorCode::file_format:
        case ErrorCode::memory_limit:
            return exit_input;
        case ErrorCode::cancelled:
            return exit_stopped;
        case ErrorCode::file_write:
        case ErrorCode::internal:
            break;
    }
    return exit_defect;
}

int fail(int code, const char* text) {
    std::cerr << "quadseg: " << text << '\n';
    return code;
}

}  // namespace

int run(int argc, const char* const* argv) {
    try {
        CLI::App app("Segments triangle meshes into quadric surface regions.", "quadseg");
        app.set_version_flag("--version", "quadseg " QUADSEG_VERSION);
        app.require_subcommand(1);
        app.footer(
            "Exit codes: 0 done · 2 usage · 3 input can't be read or used · 4 stopped by time-out or signal, partial "
            "result\nwritten and marked · 1 a defect of ours, or the result can't be written");
        std::vector<std::pair<std::string, Command>> commands;
        commands.emplace_back("segment", add_segment(app));
        commands.emplace_back("info", add_info(app));
        commands.emplace_back("simplify", add_simplify(app));
        commands.emplace_back("compare", add_compare(app));
        commands.emplace_back("picture", add_picture(app));
        commands.emplace_back("generate", add_generate(app));
        commands.emplace_back("batch", add_batch(app));
        commands.emplace_back("batch-item", add_batch_item(app));
        try {
            app.parse(argc, argv);
        } catch (const CLI::ParseError& error) {
            return app.exit(error) == 0 ? exit_done : exit_usage;
        }
        for (const auto& [name, command] : commands) {
            if (app.got_subcommand(name)) return command();
        }
        return exit_usage;
    } catch (const Error& error) {
        return fail(exit_code_of(error.code()), error.what());
    } catch (const std::bad_alloc&) {
        return fail(exit_defect, "out of memory");
    } catch (const std::exception& error) {
        return fail(exit_defect, error.what());
    }
}

}  // namespace quadseg::cli
