// What a batch is to do: meshes, and where each one's files go.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace quadseg::cli {

struct BatchItem {
    std::string mesh;          ///< path of the file
    std::string name;          ///< its folder below the output folder; unique
    std::uintmax_t bytes = 0;  ///< of the file, for the estimate of the time left; 0 if it can't be read
};

/// All meshes of a folder and those below it (by extension, hidden ones and the output folder left out), sorted by
/// name; or the lines of a manifest: PATH or PATH<TAB>NAME, relative to the manifest's folder, '#' begins a comment.
/// Throws Error file_open, file_format (names that are not unique or leave the output folder).
std::vector<BatchItem> list_meshes(const std::string& folder_or_manifest, const std::string& output);

/// Every n-th mesh, beginning with the i-th: the share of one job of an array.
struct Shard {
    std::size_t index = 1, count = 1;
    bool whole() const noexcept { return count == 1; }
};
/// "i/n" with 1 ≤ i ≤ n. Throws Error invalid_argument.
Shard parse_shard(const std::string& text);
std::vector<BatchItem> share_of(const std::vector<BatchItem>& items, const Shard& shard);

}  // namespace quadseg::cli
