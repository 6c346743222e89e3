// Output folders and files of the program.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace quadseg::cli {

/// Makes a folder and its parents. Throws Error file_write.
void make_folder(const std::string& path);

/// Runs independent jobs that write files, at once unless `threads` is 1; rethrows the first failure by order.
void write_all(const std::vector<std::function<void()>>& jobs, int threads);

}  // namespace quadseg::cli
