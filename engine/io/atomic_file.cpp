#include "io/atomic_file.h"

#include <quadseg/error.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <memory>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

namespace quadseg::io {
namespace {

constexpr int attempts = 100;
constexpr mode_t mode = 0666;  // less the caller's umask

/// Different for each file that this process, or another one at the same time, writes.
std::string unique_suffix(const void* object) {
    const auto ticks = static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count());
    const std::uint64_t number = (ticks * 0x9E3779B97F4A7C15U) ^ reinterpret_cast<std::uintptr_t>(object);
    return ".tmp-" + std::to_string(::getpid()) + "-" + std::to_string(number % 1000000000U);
}

/// A link is followed, so that the file it points to is replaced and not the link.
std::string resolve_links(const std::string& path) {
    const std::unique_ptr<char, void (*)(void*)> real(::realpath(path.c_str(), nullptr), &std::free);
    return real ? std::string(real.get()) : path;
}

}  // namespace

AtomicFile::AtomicFile(const std::string& path) : path_(path), target_(resolve_links(path)) {
    struct stat info {};
    const bool exists = ::stat(target_.c_str(), &info) == 0;
    if (exists && S_ISDIR(info.st_mode)) fail("is a directory, not a file", 0);
    if (exists && !S_ISREG(info.st_mode)) {
        // Renaming onto a device would replace the device.
        descriptor_ = ::open(target_.c_str(), O_WRONLY | O_CLOEXEC);
        if (descriptor_ < 0) fail("cannot be opened for writing", errno);
        return;
    }
    if (exists && ::access(target_.c_str(), W_OK) != 0) fail("cannot be written", errno);
    open_temporary();
    if (exists) {
        // The new file keeps the permissions of the one it replaces; where that is refused, the usual ones do.
        [[maybe_unused]] const int ignored = ::fchmod(descriptor_, info.st_mode & 07777U);
    }
}

AtomicFile::~AtomicFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::open_temporary() {
    for (int k = 0; k < attempts; ++k) {
        const std::string name = target_ + unique_suffix(this);
        descriptor_ = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
        if (descriptor_ >= 0) {
            temporary_ = name;
            return;
        }
        if (errno != EEXIST) break;
    }
    fail("cannot be created", errno);
}

void AtomicFile::write(std::string_view bytes) {
    // Linux writes at most 2 GiB at once; smaller pieces cost nothing.
    constexpr std::size_t largest_piece = std::size_t{1} << 26U;
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor_, bytes.data(), std::min(bytes.size(), largest_piece));
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail("cannot be written", errno);
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
}

void AtomicFile::commit() {
    // Devices and pipes have nothing to flush and say EINVAL.
    if (!temporary_.empty() && ::fsync(descriptor_) != 0) fail("cannot be flushed to disk", errno);
    const int closed = ::close(descriptor_);
    descriptor_ = -1;
    if (closed != 0) fail("cannot be closed", errno);
    if (temporary_.empty()) return;
    if (std::rename(temporary_.c_str(), target_.c_str()) != 0) fail("cannot be renamed into place", errno);
    temporary_.clear();
}

void AtomicFile::fail(const std::string& what, int number) const {
    std::string text = path_ + ": " + what;
    if (number != 0) text += ": " + std::generic_category().message(number);
    throw Error(ErrorCode::file_write, text);
}

}  // namespace quadseg::io
