#include "io/file_contents.h"

#include "io/file_descriptor.h"
#include "runtime/parallel.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <system_error>
#include <vector>

namespace quadseg::io {
namespace {

constexpr std::size_t block_bytes = std::size_t{4} << 20U;
constexpr int pipe_wait_milliseconds = 20;
/// File, arrays and welding table together, in multiples of the file's size (binary STL is the largest).
constexpr std::size_t memory_factor = 3;

std::string system_text(int number) {
    return std::generic_category().message(number);
}

[[noreturn]] void fail_to_read(const std::string& path, int number) {
    throw Error(ErrorCode::file_open, path + ": cannot be read: " + system_text(number));
}

}  // namespace

FileContents::FileContents(const std::string& path, const runtime::RunControl& control, std::size_t memory_limit)
    : path_(path) {
    // Non-blocking, so that a pipe without a writer cannot hang the call; regular files ignore it.
    const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (file.number() < 0) throw Error(ErrorCode::file_open, path + ": cannot be opened: " + system_text(errno));
    struct stat info {};
    if (::fstat(file.number(), &info) != 0) fail_to_read(path, errno);
    if (S_ISDIR(info.st_mode)) throw Error(ErrorCode::file_open, path + ": is a directory; name a mesh file");
    if (S_ISREG(info.st_mode)) {
        size_ = static_cast<std::size_t>(info.st_size);
        if (memory_limit > 0 && size_ > memory_limit / memory_factor) {
            throw Error(ErrorCode::memory_limit, path + ": reading needs about " +
                                                     std::to_string(memory_factor * size_) + " bytes, the limit is " +
                                                     std::to_string(memory_limit));
        }
        read_regular(file.number(), control);
    } else if (S_ISFIFO(info.st_mode)) {
        read_pipe(file.number(), control);
    } else {
        throw Error(ErrorCode::file_open, path + ": is neither a file nor a pipe; name a mesh file");
    }
    data_[size_] = '\n';
    if (size_ == 0) throw Error(ErrorCode::file_format, path + ": line 1: the file is empty");
}

FileContents::FileContents(std::string_view bytes, const std::string& name)
    : path_(name), data_(new char[bytes.size() + 1]), size_(bytes.size()) {
    std::copy(bytes.begin(), bytes.end(), data_.get());
    data_[size_] = '\n';
    if (size_ == 0) throw Error(ErrorCode::file_format, name + ": line 1: the file is empty");
}

void FileContents::read_regular(int descriptor, const runtime::RunControl& control) {
    data_.reset(new char[size_ + 1]);  // not initialised: the blocks below fill it
    runtime::parallel_blocks(size_, block_bytes, [&](std::size_t begin, std::size_t end) {
        control.check();
        while (begin < end) {
            const ssize_t got = ::pread(descriptor, data_.get() + begin, end - begin, static_cast<off_t>(begin));
            if (got < 0 && errno == EINTR) continue;
            if (got < 0) fail_to_read(path_, errno);
            if (got == 0) throw Error(ErrorCode::file_open, path_ + ": became shorter while it was read; try again");
            begin += static_cast<std::size_t>(got);
        }
    });
}

void FileContents::read_pipe(int descriptor, const runtime::RunControl& control) {
    std::size_t capacity = block_bytes;
    data_.reset(new char[capacity + 1]);
    for (;;) {
        control.check();
        if (size_ == capacity) {
            std::unique_ptr<char[]> larger(new char[2 * capacity + 1]);
            std::memcpy(larger.get(), data_.get(), size_);
            data_ = std::move(larger);
            capacity *= 2;
        }
        const ssize_t got = ::read(descriptor, data_.get() + size_, std::min(capacity - size_, block_bytes));
        if (got == 0) return;
        if (got > 0) {
            size_ += static_cast<std::size_t>(got);
        } else if (errno == EAGAIN) {
            pollfd waiting{descriptor, POLLIN, 0};
            ::poll(&waiting, 1, pipe_wait_milliseconds);
        } else if (errno != EINTR) {
            fail_to_read(path_, errno);
        }
    }
}

void FileContents::unify_text() noexcept {
    if (text().starts_with("\xEF\xBB\xBF")) std::fill_n(data_.get(), 3, ' ');
    if (std::memchr(data_.get(), '\n', size_) == nullptr) std::replace(data_.get(), data_.get() + size_, '\r', '\n');
}

void FileContents::fail_at_line(const Fault& fault) const {
    const auto line = 1 + std::count(begin(), std::min(fault.where, end()), '\n');
    throw Error(fault.code, path_ + ": line " + std::to_string(line) + ": " + fault.text);
}

void FileContents::fail_at_byte(const Fault& fault) const {
    throw Error(fault.code, path_ + ": byte " + std::to_string(fault.where - begin()) + ": " + fault.text);
}

void FileContents::fail(ErrorCode code, const std::string& text) const {
    throw Error(code, path_ + ": " + text);
}

}  // namespace quadseg::io
