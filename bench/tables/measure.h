// Jobs in fresh processes: reading, segmenting, writing.
#pragma once

#include "bench/tables/manifest.h"

#include <functional>
#include <string>
#include <vector>

namespace quadseg::bench {

struct Measured {
    Job job;
    std::vector<double> wall, cpu;  ///< seconds, a run each
    std::vector<double> peak;       ///< bytes
    std::size_t faces = 0, regions = 0;
    double energy = 0, rms = 0;
    std::string stop;
    int exit_code = 0;
    bool timed_out = false;
    nlohmann::ordered_json seconds;  ///< the program's own split, of the last run
};

struct Places {
    std::string program;  ///< quadseg
    std::string shared;   ///< of mesh files
    std::string meshes;   ///< where generated meshes are kept between runs
};

/// Path of a mesh, which is generated first if need be. Empty if it is a file that is not there.
std::string mesh_path(const MeshSource& mesh, const Places& places);

/// All jobs of a table, a round of all after the other, so that the machine's other work falls on all alike. A job that
/// failed or ran out of time is not run again. runs > 0 replaces the table's own.
std::vector<Measured> measure(const Manifest& manifest, const Table& table, const Places& places, int runs,
                              const std::function<void(const std::string&)>& say);

}  // namespace quadseg::bench
