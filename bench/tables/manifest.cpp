#include "bench/tables/manifest.h"

#include <initializer_list>
#include <set>
#include <stdexcept>
#include <string_view>

namespace quadseg::bench {
namespace {

using nlohmann::json;

[[noreturn]] void refuse(std::initializer_list<std::string_view> words) {
    std::string text = "manifest: ";
    for (const std::string_view word : words) text += word;
    throw std::invalid_argument(text);
}

/// A misspelt key would silently change what is measured.
void only_known(const json& object, const std::set<std::string>& known, const std::string& where) {
    for (const auto& [key, value] : object.items()) {
        if (!known.contains(key)) refuse({"unknown key '", key, "' in ", where});
    }
}

std::string text_of(const json& value) {
    return value.is_string() ? value.get<std::string>() : value.dump();
}

/// One value or a list; `fallback` where the key is absent.
std::vector<std::string> list(const json& object, const char* key, const std::vector<std::string>& fallback) {
    if (!object.contains(key)) return fallback;
    const json& value = object.at(key);
    if (!value.is_array()) return {text_of(value)};
    std::vector<std::string> result;
    for (const json& item : value) result.push_back(text_of(item));
    return result;
}

MeshSource parse_mesh(const std::string& name, const json& object) {
    only_known(object, {"file", "generator", "faces", "noise", "seed", "stands_for"}, "mesh " + name);
    MeshSource mesh;
    mesh.name = name;
    mesh.file = object.value("file", "");
    mesh.generator = object.value("generator", "");
    mesh.faces = object.value("faces", std::size_t{0});
    mesh.noise = object.value("noise", 0.0);
    mesh.seed = object.value("seed", std::uint64_t{1});
    mesh.stands_for = object.value("stands_for", "");
    if (mesh.file.empty() == mesh.generator.empty()) refuse({"mesh ", name, " needs a file or a generator"});
    return mesh;
}

/// Meshes of a job: names, and one more for each size of a generated family.
std::vector<std::string> meshes_of(const json& object, Manifest& manifest, const std::string& where) {
    std::vector<std::string> result;
    for (const std::string& name : list(object, "mesh", {})) {
        if (!manifest.meshes.contains(name)) refuse({where, " names the unknown mesh ", name});
        const std::vector<std::string> sizes = list(object, "faces", {});
        if (sizes.empty()) result.push_back(name);
        for (const std::string& size : sizes) {
            MeshSource sized = manifest.meshes.at(name);
            if (sized.generator.empty()) refuse({where, ": sizes of the file mesh ", name});
            sized.faces = std::stoul(size);
            sized.name = name;
            sized.name.append("-").append(size);
            result.push_back(sized.name);
            manifest.meshes.emplace(sized.name, sized);
        }
    }
    if (result.empty()) refuse({where, " names no mesh"});
    return result;
}

void add_jobs(const json& object, Manifest& manifest, Table& table) {
    only_known(object, {"mesh", "faces", "preset", "regions", "threads", "arguments"}, "a job of " + table.name);
    for (const std::string& mesh : meshes_of(object, manifest, "table " + table.name)) {
        for (const std::string& preset : list(object, "preset", {"default"})) {
            for (const std::string& regions : list(object, "regions", {""})) {
                for (const std::string& threads : list(object, "threads", {"1"})) {
                    Job job;
                    job.mesh = mesh;
                    job.preset = preset;
                    job.regions = regions == "0" ? "" : regions;
                    job.threads = std::stoi(threads);
                    job.arguments = list(object, "arguments", {});
                    table.jobs.push_back(job);
                }
            }
        }
    }
}

void add_comparison(const json& object, const Manifest& manifest, Table& table) {
    only_known(object, {"model", "mesh", "regions", "preset", "threads", "paper", "arguments"},
               "a row of " + table.name);
    ComparisonRow row;
    row.model = object.at("model");
    row.mesh = object.at("mesh");
    if (!manifest.meshes.contains(row.mesh)) refuse({"table ", table.name, " names the unknown mesh ", row.mesh});
    const json& paper = object.at("paper");
    row.paper_regions = paper.at("regions");
    for (std::size_t v = 0; v < 2; ++v) {
        const std::string& variant = table.variants[v];
        row.paper_seconds[v] = paper.at(variant);
        for (const std::string& threads : list(object, "threads", {"1"})) {
            Job job;
            job.mesh = row.mesh;
            job.preset = object.value("preset", "paper");
            job.regions = object.contains("regions") ? text_of(object.at("regions")) : "";
            job.threads = std::stoi(threads);
            job.arguments = list(object.at("arguments"), variant.c_str(), {});
            job.variant = variant;
            job.row = table.comparison.size();
            table.jobs.push_back(job);
        }
    }
    table.comparison.push_back(row);
}

Table parse_table(const json& object, Manifest& manifest) {
    only_known(object, {"name", "caption", "runs", "time_limit", "scaling", "variants", "rows", "jobs"}, "a table");
    Table table;
    table.name = object.at("name");
    table.caption = object.value("caption", "");
    table.runs = object.value("runs", table.runs);
    table.time_limit = object.value("time_limit", table.time_limit);
    table.scaling = object.value("scaling", false);
    table.variants = list(object, "variants", {});
    if (!table.variants.empty() && table.variants.size() != 2) refuse({"table ", table.name, " needs two variants"});
    if (object.contains("rows") != (table.variants.size() == 2))
        refuse({table.name, ": rows and variants go together"});
    for (const json& row : object.value("rows", json::array())) add_comparison(row, manifest, table);
    for (const json& job : object.value("jobs", json::array())) add_jobs(job, manifest, table);
    return table;
}

}  // namespace

Manifest parse_manifest(const json& object) {
    try {
        only_known(object, {"title", "meshes", "tables"}, "the manifest");
        Manifest manifest;
        manifest.title = object.value("title", "");
        for (const auto& [name, mesh] : object.at("meshes").items()) manifest.meshes[name] = parse_mesh(name, mesh);
        for (const json& table : object.at("tables")) manifest.tables.push_back(parse_table(table, manifest));
        return manifest;
    } catch (const json::exception& error) {
        refuse({error.what()});
    }
}

}  // namespace quadseg::bench
