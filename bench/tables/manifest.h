// What to run: a JSON file of meshes and tables, every list of a job multiplied out. bench/README.md describes it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace quadseg::bench {

/// A file below the folder of shared meshes, or a recipe for the program's generator.
struct MeshSource {
    std::string name;
    std::string file;       ///< relative to --shared; empty: generated
    std::string generator;  ///< plate, shaft …
    std::size_t faces = 0;
    double noise = 0;
    std::uint64_t seed = 1;
    std::string stands_for;  ///< the paper's model that it replaces; empty: the model itself
};

struct Job {
    std::string mesh;  ///< key of Manifest::meshes
    std::vector<std::string> arguments;
    int threads = 0;
    std::string variant;  ///< the two columns of a comparison; empty otherwise
    std::size_t row = 0;  ///< of a comparison
    std::string preset = "default";
    std::string regions;  ///< asked for; empty: found by itself
};

/// Two ways of running the same mesh beside what the paper says of them.
struct ComparisonRow {
    std::string model, mesh;
    double paper_regions = 0, paper_seconds[2] = {0, 0};
};

struct Table {
    std::string name, caption;
    std::vector<Job> jobs;
    int runs = 3;
    double time_limit = 600;
    bool scaling = false;                   ///< fit time ≈ a·F^b over the jobs of one preset and number of threads
    std::vector<std::string> variants;      ///< two names: a comparison
    std::vector<ComparisonRow> comparison;  ///< by Job::row
};

struct Manifest {
    std::string title;
    std::map<std::string, MeshSource> meshes;
    std::vector<Table> tables;
};

/// Throws std::invalid_argument naming what is missing or unknown.
Manifest parse_manifest(const nlohmann::json& json);

}  // namespace quadseg::bench
