// Output folders and files of the program.
#pragma once

#include <quadseg/error.h>

#include <functional>
#include <string>
#include <vector>

namespace quadseg::cli {

/// Runs what works on the mesh of a file; its Errors name the file, unless they do already.
template <class Work>
auto on_file(const std::string& path, const Work& work) {
    try {
        return work();
    } catch (const Error& error) {
        const std::string text = error.what();
        const bool of_mesh = error.code() == ErrorCode::invalid_mesh || error.code() == ErrorCode::empty_mesh ||
                             error.code() == ErrorCode::memory_limit;
        if (!of_mesh || text.find(path) != std::string::npos) throw;
        throw Error(error.code(), path + ": " + text);
    }
}

/// Makes a folder and its parents. Throws Error file_write.
void make_folder(const std::string& path);

/// Runs independent jobs that write files, at once unless `threads` is 1; rethrows the first failure by order.
void write_all(const std::vector<std::function<void()>>& jobs, int threads);

}  // namespace quadseg::cli
