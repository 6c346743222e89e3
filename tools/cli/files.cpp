#include "tools/cli/files.h"

#include <quadseg/error.h>

#include "runtime/parallel.h"

#include <exception>
#include <filesystem>
#include <system_error>

namespace quadseg::cli {

void make_folder(const std::string& path) {
    std::error_code error;
    std::filesystem::create_directories(path, error);
    if (!error && !std::filesystem::is_directory(path, error) && !error) {
        error = std::make_error_code(std::errc::not_a_directory);
    }
    if (error) throw Error(ErrorCode::file_write, path + ": can't make this folder: " + error.message());
}

void write_all(const std::vector<std::function<void()>>& jobs, int threads) {
    std::vector<std::exception_ptr> failures(jobs.size());
    runtime::in_arena(threads, [&] {
        runtime::parallel_for(jobs.size(), 1, [&](std::size_t k) {
            try {
                jobs[k]();
            } catch (...) {
                failures[k] = std::current_exception();
            }
        });
    });
    for (const auto& failure : failures) {
        if (failure) std::rethrow_exception(failure);
    }
}

}  // namespace quadseg::cli
