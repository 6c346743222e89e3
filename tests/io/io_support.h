// What the tests of reading and writing share.
#pragma once

#include <quadseg/error.h>
#include <quadseg/io.h>

#include "io/file_contents.h"
#include "io/formats.h"
#include "runtime/run_control.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <string>
#include <string_view>
#include <unistd.h>
#include <vector>

namespace quadseg::test {

/// Reads bytes as if they lay in a file of that name.
inline Mesh parse(std::string_view bytes, const std::string& name) {
    const runtime::RunControl control(nullptr);
    io::FileContents file(bytes, name);
    return io::read_contents(file, control);
}

/// The Error that body throws.
template <class Body>
Error error_of(const Body& body) {
    try {
        body();
    } catch (const Error& error) {
        return error;
    }
    ADD_FAILURE() << "no Error was thrown";
    return {ErrorCode::internal, "none"};
}

/// Reading the bytes must fail with that code and all of those words in the text.
inline void expect_error(std::string_view bytes, const std::string& name, ErrorCode code,
                         const std::vector<std::string>& words) {
    const Error error = error_of([&] { parse(bytes, name); });
    EXPECT_EQ(error.code(), code) << error.what();
    for (const std::string& word : words) {
        EXPECT_NE(std::string(error.what()).find(word), std::string::npos)
            << "'" << word << "' is not in: " << error.what();
    }
}

/// A folder of its own, gone with its contents at the end.
class TemporaryFolder {
  public:
    TemporaryFolder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "quadseg-io-XXXXXX").string();
        if (::mkdtemp(pattern.data()) == nullptr) ADD_FAILURE() << "no temporary folder";
        path_ = pattern;
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    std::string file(const std::string& name) const { return (path_ / name).string(); }
    std::string put(const std::string& name, std::string_view bytes) const {
        std::ofstream(file(name), std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        return file(name);
    }
    std::string get(const std::string& name) const {
        std::ifstream in(file(name), std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    std::size_t files() const {
        return static_cast<std::size_t>(
            std::distance(std::filesystem::directory_iterator(path_), std::filesystem::directory_iterator()));
    }

  private:
    std::filesystem::path path_;
};

/// n × n vertices, 2(n−1)² triangles; coordinates have a few digits, so that they are exact floats.
inline Mesh grid(std::uint32_t n) {
    Mesh mesh;
    for (std::uint32_t j = 0; j < n; ++j) {
        for (std::uint32_t i = 0; i < n; ++i) {
            mesh.positions.insert(mesh.positions.end(), {i * 0.25, j * 0.5, ((i * 7 + j * 13) % 17) * -0.125});
        }
    }
    for (std::uint32_t j = 0; j + 1 < n; ++j) {
        for (std::uint32_t i = 0; i + 1 < n; ++i) {
            const std::uint32_t v = j * n + i;
            mesh.triangles.insert(mesh.triangles.end(), {v, v + 1, v + n + 1, v, v + n + 1, v + n});
        }
    }
    mesh.file_faces = mesh.triangles.size() / 3;
    return mesh;
}

/// Bytes of numbers, most or least significant first.
template <class T>
void append_bytes(std::string& out, T value, bool big_endian = false) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    if (big_endian) std::reverse(bytes, bytes + sizeof(T));
    out.append(bytes, sizeof(T));
}

}  // namespace quadseg::test
