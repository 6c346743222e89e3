// What a job will take, told before it begins.
#pragma once

#include <quadseg/mesh.h>
#include <quadseg/options.h>

#include <cstddef>

namespace quadseg::flow {

/// What is known of a mesh by its numbers, and what only a look at it tells.
enum class Surfaces { clean, noisy };

/// Bytes that the caller's arrays and segment() take together at the peak: above what was measured, by the kind of job
/// (tests/pipeline/memory_test.cpp). `threads` may take part.
std::size_t estimated_bytes(const MeshView& mesh, const Options& options, int threads, Surfaces surfaces);

/// Whether noise decides what is done, and with it how much is needed.
bool noise_matters(const Options& options) noexcept;

}  // namespace quadseg::flow
