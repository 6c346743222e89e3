#include "tools/cli/batch_manifest.h"

#include <quadseg/error.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <map>
#include <system_error>

namespace quadseg::cli {
namespace {

namespace fs = std::filesystem;

bool is_mesh(const fs::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension == ".ply" || extension == ".stl" || extension == ".obj" || extension == ".off";
}

std::uintmax_t size_of(const fs::path& path) {
    std::error_code ignored;
    const std::uintmax_t size = fs::file_size(path, ignored);
    return ignored ? 0 : size;
}

std::vector<BatchItem> meshes_of_folder(const fs::path& folder, const std::string& output) {
    std::vector<BatchItem> items;
    std::error_code error, ignored;
    auto it = fs::recursive_directory_iterator(folder, fs::directory_options::skip_permission_denied, error);
    for (; !error && it != fs::recursive_directory_iterator(); it.increment(error)) {
        const fs::path& path = it->path();
        const bool hidden = path.filename().string().starts_with('.');
        if (it->is_directory(ignored)) {
            if (hidden || fs::equivalent(path, output, ignored)) it.disable_recursion_pending();
        } else if (!hidden && is_mesh(path)) {
            items.push_back({path.string(), path.lexically_relative(folder).generic_string(), size_of(path)});
        }
    }
    if (error) throw Error(ErrorCode::file_open, folder.string() + ": can't list this folder: " + error.message());
    std::sort(items.begin(), items.end(), [](const BatchItem& a, const BatchItem& b) { return a.name < b.name; });
    return items;
}

/// The name of a mesh without one: its path, made to stay below the output folder.
std::string default_name(const fs::path& given) {
    const fs::path normal = given.lexically_normal();
    if (normal.is_relative() && *normal.begin() != "..") return normal.generic_string();
    return fs::absolute(normal).lexically_normal().relative_path().generic_string();
}

std::vector<BatchItem> meshes_of_manifest(const fs::path& manifest) {
    std::ifstream file(manifest, std::ios::binary);
    if (!file) throw Error(ErrorCode::file_open, manifest.string() + ": can't open this manifest");
    std::vector<BatchItem> items;
    std::string line;
    while (std::getline(file, line)) {
        if (!line.empty() && line.back() == '\r') line.pop_back();
        if (line.empty() || line.front() == '#') continue;
        const std::size_t tab = line.find('\t');
        const fs::path given = line.substr(0, tab);
        const fs::path path = given.is_absolute() ? given : manifest.parent_path() / given;
        items.push_back(
            {path.string(), tab == std::string::npos ? default_name(given) : line.substr(tab + 1), size_of(path)});
    }
    if (file.bad()) throw Error(ErrorCode::file_open, manifest.string() + ": can't read this manifest");
    return items;
}

/// Why a name can't be a folder below the output folder; empty if it can.
std::string problem_of(const std::string& name) {
    const fs::path path(name);
    if (name.empty() || path.is_absolute()) return "is no relative path";
    if (name.back() == '/') return "ends with a slash";
    for (const fs::path& part : path) {
        if (part == ".." || part == ".") return "leaves the output folder";
        if (part.string().starts_with('.')) return "begins with a dot, as only the program's own files may";
    }
    if (name == "batch.json" || (name.starts_with("results") && name.ends_with(".jsonl"))) {
        return "is that of a file of the program";
    }
    return {};
}

void check_names(const std::vector<BatchItem>& items) {
    const auto refuse = [](const BatchItem& item, const std::string& problem) {
        throw Error(ErrorCode::file_format, item.mesh + ": its name '" + item.name + "' " + problem +
                                                "; give another one after a tab in the manifest");
    };
    std::map<fs::path, const BatchItem*> by_name;
    for (const BatchItem& item : items) {
        const std::string problem = problem_of(item.name);
        if (!problem.empty()) refuse(item, problem);
        const auto [other, fresh] = by_name.emplace(fs::path(item.name).lexically_normal(), &item);
        if (!fresh) refuse(item, "is also that of " + other->second->mesh);
    }
    for (const BatchItem& item : items) {
        for (fs::path above = fs::path(item.name).parent_path(); !above.empty(); above = above.parent_path()) {
            const auto other = by_name.find(above);
            if (other != by_name.end()) refuse(item, "is inside the folder of " + other->second->mesh);
        }
    }
}

}  // namespace

std::vector<BatchItem> list_meshes(const std::string& folder_or_manifest, const std::string& output) {
    std::error_code ignored;
    const fs::path path(folder_or_manifest);
    auto items = fs::is_directory(path, ignored) ? meshes_of_folder(path, output) : meshes_of_manifest(path);
    check_names(items);
    return items;
}

Shard parse_shard(const std::string& text) {
    Shard shard;
    const char* const end = text.data() + text.size();
    const auto index = std::from_chars(text.data(), end, shard.index);
    if (index.ec == std::errc() && index.ptr != end && *index.ptr == '/') {
        const auto count = std::from_chars(index.ptr + 1, end, shard.count);
        if (count.ec == std::errc() && count.ptr == end && shard.index >= 1 && shard.index <= shard.count) return shard;
    }
    throw Error(ErrorCode::invalid_argument, "--shard: must be i/n with 1 <= i <= n, but is '" + text + "'");
}

std::vector<BatchItem> share_of(const std::vector<BatchItem>& items, const Shard& shard) {
    std::vector<BatchItem> share;
    for (std::size_t k = shard.index - 1; k < items.size(); k += shard.count) share.push_back(items[k]);
    return share;
}

}  // namespace quadseg::cli
