#include "tools/cli/batch_log.h"

#include <quadseg/error.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <sys/file.h>
#include <unistd.h>

namespace quadseg::cli {
namespace {

[[noreturn]] void failed(const std::string& path, const char* what) {
    throw Error(ErrorCode::file_write, path + ": can't " + what + ": " + std::strerror(errno));
}

}  // namespace

std::string to_line(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string record_key(const std::string& name) {
    return Json::parse(to_line(name)).get<std::string>();
}

void sync_folder(const std::string& path) {
    const int folder = open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder < 0) failed(path, "open this folder");
    // Some file systems can't sync folders (EINVAL): nothing more can be done there.
    const bool synced = fsync(folder) == 0 || errno == EINVAL;
    close(folder);
    if (!synced) failed(path, "flush this folder to disk");
}

ResultsLog::ResultsLog(const std::string& path) : path_(path) {
    descriptor_ = open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (descriptor_ < 0) failed(path, "open the results log");
    if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
        const bool taken = errno == EWOULDBLOCK;
        close(descriptor_);
        if (taken) throw Error(ErrorCode::invalid_argument, path + ": another batch is at work on this log");
        failed(path, "lock the results log");
    }
    try {
        load();
        sync_folder(std::filesystem::path(path).parent_path().string());
    } catch (...) {
        close(descriptor_);
        throw;
    }
}

ResultsLog::~ResultsLog() {
    close(descriptor_);  // and unlocks
}

void ResultsLog::load() {
    std::string text;
    std::array<char, 65536> buffer{};
    while (true) {
        const ssize_t count = read(descriptor_, buffer.data(), buffer.size());
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) failed(path_, "read the results log");
        if (count == 0) break;
        text.append(buffer.data(), static_cast<std::size_t>(count));
    }
    std::size_t good = 0;  // end of the last line that is a record
    std::size_t begin = 0;
    for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n', begin)) {
        Json record = Json::parse(text.begin() + static_cast<std::ptrdiff_t>(begin),
                                  text.begin() + static_cast<std::ptrdiff_t>(end), nullptr, false);
        begin = end + 1;
        if (!record.is_object() || !record.contains("name") || !record["name"].is_string()) continue;
        std::string name = record["name"].get<std::string>();
        records_[std::move(name)] = std::move(record);
        good = begin;
    }
    // What follows the last record was being written when its process died.
    if (good < text.size() && ftruncate(descriptor_, static_cast<off_t>(good)) != 0) {
        failed(path_, "repair the results log");
    }
}

void ResultsLog::append(const Json& record) {
    const off_t before = lseek(descriptor_, 0, SEEK_END);
    const std::string line = to_line(record);
    std::size_t written = 0;
    while (written < line.size()) {
        const ssize_t count = write(descriptor_, line.data() + written, line.size() - written);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) break;
        written += static_cast<std::size_t>(count);
    }
    if (written < line.size() || fsync(descriptor_) != 0) {
        const int error = errno;
        [[maybe_unused]] const int ignored = ftruncate(descriptor_, before);
        errno = error;
        failed(path_, "write to the results log");
    }
    records_[record_key(record.at("name").get<std::string>())] = record;
}

}  // namespace quadseg::cli
