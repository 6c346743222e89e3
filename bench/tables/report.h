// Measured jobs as CSV, JSON and Markdown.
#pragma once

#include "bench/tables/measure.h"

#include <string>
#include <vector>

namespace quadseg::bench {

struct Scaling {
    std::string preset;
    int threads = 0;
    std::size_t sizes = 0;
    double cpu_exponent = 0, wall_exponent = 0;
    double bytes_a_face = 0;  ///< peak at the largest size over its faces
};

/// One a pair of preset and number of threads that ran at two sizes or more.
std::vector<Scaling> scalings(const std::vector<Measured>& jobs);

std::string csv_header();
std::string csv(const Manifest& manifest, const Table& table, const std::vector<Measured>& jobs);
nlohmann::ordered_json json(const Manifest& manifest, const Table& table, const std::vector<Measured>& jobs);
std::string markdown(const Manifest& manifest, const Table& table, const std::vector<Measured>& jobs);

}  // namespace quadseg::bench
