// The results log of a batch: JSON Lines, one record a mesh, on disk before anything depends on it.
#pragma once

#include "tools/cli/report.h"

#include <map>
#include <string>

namespace quadseg::cli {

/// One process at a time holds a log. A record of a mesh says that it is done: its files, if any, are in place.
class ResultsLog {
  public:
    /// Opens or makes the log and locks it. A torn last line, which a killed process leaves, is cut off. Throws Error
    /// file_write; invalid_argument when another process has it.
    explicit ResultsLog(const std::string& path);
    ~ResultsLog();
    ResultsLog(const ResultsLog&) = delete;
    ResultsLog& operator=(const ResultsLog&) = delete;

    /// The last record of each mesh, by name.
    const std::map<std::string, Json>& records() const noexcept { return records_; }
    /// Returns when the record is on disk. Throws Error file_write; then the log is as it was before.
    void append(const Json& record);

  private:
    void load();

    std::string path_;
    int descriptor_ = -1;
    std::map<std::string, Json> records_;
};

/// One line of JSON, whatever bytes its texts have.
std::string to_line(const Json& json);
/// The key of records(): the name as it reads after being written.
std::string record_key(const std::string& name);
/// Makes sure that the entries of a folder are on disk.
void sync_folder(const std::string& path);

}  // namespace quadseg::cli
