#include "bench/tables/report.h"

#include "bench/support/statistics.h"

#include <cstdio>
#include <map>
#include <utility>

namespace quadseg::bench {
namespace {

using Json = nlohmann::ordered_json;

std::string format(const char* pattern, double value) {
    char text[64];
    std::snprintf(text, sizeof text, pattern, value);
    return text;
}

std::string joined(const std::vector<std::string>& words) {
    std::string result;
    for (const std::string& word : words) result += (result.empty() ? "" : " ") + word;
    return result;
}

std::string quoted(const std::string& text) {
    std::string result = "\"";
    for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
    return result + '"';
}

/// The mesh as a reader should know it: a stand-in is named as one.
std::string mesh_text(const MeshSource& mesh) {
    std::string text = mesh.file.empty() ? mesh.generator + " (generated)" : mesh.file;
    if (mesh.noise > 0) text += ", noise " + format("%g", mesh.noise);
    return mesh.stands_for.empty() ? text : text + ", **stand-in** for " + mesh.stands_for;
}

std::string failure(const Measured& m) {
    return m.timed_out ? "out of time" : "exit code " + std::to_string(m.exit_code);
}

std::string seconds_text(const std::vector<double>& values) {
    const Spread s = spread(values);
    return format("%.3g", s.median) + " (" + format("%.3g", s.min) + " … " + format("%.3g", s.max) + ")";
}

std::string plain_rows(const Manifest& manifest, const std::vector<Measured>& jobs) {
    std::string out =
        "| mesh | faces | options | threads | wall s: median (min … max) | CPU s | peak MB | bytes/face | regions | E "
        "| "
        "RMS |\n|---|---|---|---|---|---|---|---|---|---|---|\n";
    for (const Measured& m : jobs) {
        std::vector<std::string> options;
        if (m.job.preset != "default") options.push_back(m.job.preset);
        if (!m.job.regions.empty()) options.push_back("K " + m.job.regions);
        options.insert(options.end(), m.job.arguments.begin(), m.job.arguments.end());
        out += "| " + mesh_text(manifest.meshes.at(m.job.mesh)) + " | " + std::to_string(m.faces) + " | " +
               joined(options) + " | " + std::to_string(m.job.threads) + " | ";
        if (m.wall.empty()) {
            out += failure(m) + " | | | | | | |\n";
            continue;
        }
        const double peak = spread(m.peak).median;
        out += seconds_text(m.wall) + " | " + seconds_text(m.cpu) + " | " + format("%.0f", peak / 1e6) + " | " +
               format("%.0f", m.faces > 0 ? peak / static_cast<double>(m.faces) : 0) + " | " +
               std::to_string(m.regions) + " | " + format("%.3g", m.energy) + " | " + format("%.2e", m.rms) + " |\n";
    }
    return out;
}

const Measured* find(const std::vector<Measured>& jobs, std::size_t row, const std::string& variant, int threads) {
    for (const Measured& m : jobs) {
        if (m.job.row == row && m.job.variant == variant && m.job.threads == threads && !m.cpu.empty()) return &m;
    }
    return nullptr;
}

/// The paper's seconds and ours side by side. Its one core of 2007 and today's differ: the ratio of its two columns is
/// what can be compared, and how much sooner the user has a result.
std::string comparison_rows(const Manifest& manifest, const Table& table, const std::vector<Measured>& jobs) {
    const std::string &a = table.variants[0], &b = table.variants[1];
    std::string out = "| model | mesh | faces | regions: paper / ours | threads | paper s: " + a + " | paper s: " + b +
                      " | paper ratio | our CPU s: " + a + " | our CPU s: " + b + " | our ratio | paper / ours: " + a +
                      " | paper / ours: " + b + " | E: " + a + " | E: " + b +
                      " |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
    for (std::size_t r = 0; r < table.comparison.size(); ++r) {
        const ComparisonRow& row = table.comparison[r];
        std::vector<int> threads;
        for (const Measured& m : jobs) {
            if (m.job.row == r && (threads.empty() || m.job.threads > threads.back())) threads.push_back(m.job.threads);
        }
        for (const int n : threads) {
            const Measured *first = find(jobs, r, a, n), *second = find(jobs, r, b, n);
            const auto cpu = [](const Measured* m) { return m != nullptr ? spread(m->cpu).median : 0.0; };
            const auto number = [](const char* pattern, double value) {
                return value > 0 ? format(pattern, value) : std::string("failed");
            };
            const auto quotient = [&number](double x, double y) {
                return x > 0 && y > 0 ? number("%.3g", x / y) : std::string("–");
            };
            const Measured* any = first != nullptr ? first : second;
            out += "| " + row.model + " | " + mesh_text(manifest.meshes.at(row.mesh)) + " | " +
                   (any != nullptr ? std::to_string(any->faces) : "–") + " | " + format("%g", row.paper_regions) +
                   " / " + (first != nullptr ? std::to_string(first->regions) : "–") +
                   (first != nullptr && second != nullptr && first->regions != second->regions
                        ? ", " + std::to_string(second->regions)
                        : "") +
                   " | " + std::to_string(n) + " | " + format("%g", row.paper_seconds[0]) + " | " +
                   format("%g", row.paper_seconds[1]) + " | " + quotient(row.paper_seconds[0], row.paper_seconds[1]) +
                   " | " + number("%.3g", cpu(first)) + " | " + number("%.3g", cpu(second)) + " | " +
                   quotient(cpu(first), cpu(second)) + " | " + quotient(row.paper_seconds[0], cpu(first)) + " | " +
                   quotient(row.paper_seconds[1], cpu(second)) + " | " +
                   (first != nullptr ? format("%.3g", first->energy) : "–") + " | " +
                   (second != nullptr ? format("%.3g", second->energy) : "–") + " |\n";
        }
    }
    return out;
}

Json spread_json(const std::vector<double>& values) {
    const Spread s = spread(values);
    return {{"median", s.median}, {"min", s.min}, {"max", s.max}, {"runs", values.size()}};
}

}  // namespace

std::vector<Scaling> scalings(const std::vector<Measured>& jobs) {
    std::map<std::pair<std::string, int>, std::vector<const Measured*>> groups;
    for (const Measured& m : jobs) {
        if (!m.wall.empty() && m.faces > 0) groups[{m.job.preset, m.job.threads}].push_back(&m);
    }
    std::vector<Scaling> result;
    for (const auto& [key, group] : groups) {
        std::vector<double> faces, cpu, wall;
        const Measured* largest = group.front();
        for (const Measured* m : group) {
            faces.push_back(static_cast<double>(m->faces));
            cpu.push_back(spread(m->cpu).median);
            wall.push_back(spread(m->wall).median);
            if (m->faces > largest->faces) largest = m;
        }
        const PowerLaw law = power_law(faces, cpu);
        if (law.exponent == 0) continue;
        result.push_back({key.first, key.second, group.size(), law.exponent, power_law(faces, wall).exponent,
                          spread(largest->peak).median / static_cast<double>(largest->faces)});
    }
    return result;
}

std::string csv_header() {
    return "table,mesh,stands_for,faces,preset,regions_wanted,arguments,threads,variant,runs,wall_median,wall_min,"
           "wall_max,cpu_median,cpu_min,cpu_max,peak_bytes,regions,energy,rms,stop,exit_code\n";
}

std::string csv(const Manifest& manifest, const Table& table, const std::vector<Measured>& jobs) {
    std::string out;
    for (const Measured& m : jobs) {
        const Spread wall = spread(m.wall), cpu = spread(m.cpu);
        out += quoted(table.name) + ',' + quoted(m.job.mesh) + ',' + quoted(manifest.meshes.at(m.job.mesh).stands_for) +
               ',' + std::to_string(m.faces) + ',' + m.job.preset + ',' + m.job.regions + ',' +
               quoted(joined(m.job.arguments)) + ',' + std::to_string(m.job.threads) + ',' + quoted(m.job.variant) +
               ',' + std::to_string(m.wall.size());
        for (const double x : {wall.median, wall.min, wall.max, cpu.median, cpu.min, cpu.max}) {
            out += format(",%.6g", x);
        }
        out += format(",%.0f", spread(m.peak).median) + ',' + std::to_string(m.regions) + format(",%.6g", m.energy) +
               format(",%.6g,", m.rms) + m.stop + ',' + std::to_string(m.exit_code) + '\n';
    }
    return out;
}

Json json(const Manifest& manifest, const Table& table, const std::vector<Measured>& jobs) {
    Json rows = Json::array();
    for (const Measured& m : jobs) {
        Json row{{"mesh", m.job.mesh},
                 {"stands_for", manifest.meshes.at(m.job.mesh).stands_for},
                 {"faces", m.faces},
                 {"preset", m.job.preset},
                 {"regions_wanted", m.job.regions},
                 {"arguments", m.job.arguments},
                 {"threads", m.job.threads},
                 {"wall", spread_json(m.wall)},
                 {"cpu", spread_json(m.cpu)},
                 {"peak_bytes", spread_json(m.peak)},
                 {"regions", m.regions},
                 {"energy", m.energy},
                 {"rms", m.rms},
                 {"stop", m.stop},
                 {"seconds", m.seconds},
                 {"exit_code", m.exit_code}};
        if (!m.job.variant.empty()) row["variant"] = m.job.variant;
        rows.push_back(row);
    }
    Json result{{"name", table.name}, {"caption", table.caption}, {"jobs", rows}};
    for (std::size_t r = 0; r < table.comparison.size(); ++r) {
        const ComparisonRow& row = table.comparison[r];
        result["paper"].push_back({{"model", row.model},
                                   {"mesh", row.mesh},
                                   {"regions", row.paper_regions},
                                   {table.variants[0], row.paper_seconds[0]},
                                   {table.variants[1], row.paper_seconds[1]}});
    }
    if (table.scaling) {
        for (const Scaling& s : scalings(jobs)) {
            result["scaling"].push_back({{"preset", s.preset},
                                         {"threads", s.threads},
                                         {"sizes", s.sizes},
                                         {"cpu_exponent", s.cpu_exponent},
                                         {"wall_exponent", s.wall_exponent},
                                         {"bytes_a_face", s.bytes_a_face}});
        }
    }
    return result;
}

std::string markdown(const Manifest& manifest, const Table& table, const std::vector<Measured>& jobs) {
    std::string out = "### " + table.name + "\n\n" + (table.caption.empty() ? "" : table.caption + "\n\n");
    out += table.variants.empty() ? plain_rows(manifest, jobs) : comparison_rows(manifest, table, jobs);
    if (table.scaling) {
        out +=
            "\n| preset | threads | sizes | exponent, CPU | exponent, wall | bytes/face at the largest |\n"
            "|---|---|---|---|---|---|\n";
        for (const Scaling& s : scalings(jobs)) {
            out += "| " + s.preset + " | " + std::to_string(s.threads) + " | " + std::to_string(s.sizes) + " | " +
                   format("%.3f", s.cpu_exponent) + " | " + format("%.3f", s.wall_exponent) + " | " +
                   format("%.0f", s.bytes_a_face) + " |\n";
        }
    }
    return out + "\n";
}

}  // namespace quadseg::bench
