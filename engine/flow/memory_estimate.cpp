#include "flow/memory_estimate.h"

#include "flow/coarse.h"

#include <algorithm>

namespace quadseg::flow {
namespace {

// Bytes, above what was measured: by a tenth to a third, of jobs that turn out well by more.
constexpr std::size_t a_job = std::size_t{8} << 20;
constexpr std::size_t a_vertex = 250;  ///< a soup has six times as many of them as a closed mesh
constexpr std::size_t a_clean_face = 165, a_noisy_face = 430;
/// And for each thread beyond two, as measured up to 16: what every thread has in hand at once.
constexpr std::size_t a_clean_face_of_a_thread = 8, a_noisy_face_of_a_thread = 35;
constexpr std::size_t a_paper_face = 230, a_hierarchical_face = 1950;
/// Unions of two regions that are fitted at once, one a thread: each may be the whole mesh while there are few regions.
constexpr std::size_t a_fitted_face = 300;
constexpr int most_fits_at_once = 6;  // so many neighbours has a region
/// Of the fine mesh: while it is simplified, and when the regions found on the simplified one are fitted to it.
constexpr std::size_t a_simplified_face = 280, a_refitted_face = 100;

std::size_t paper_bytes(std::size_t faces, std::size_t coarse, int threads) {
    const auto at_once = static_cast<std::size_t>(std::clamp(threads, 1, most_fits_at_once));
    const std::size_t fits = at_once * a_fitted_face;
    return faces * a_paper_face + (coarse > 0 ? coarse * fits + faces * a_refitted_face : faces * fits);
}

}  // namespace

bool noise_matters(const Options& options) noexcept {
    return options.preset == Preset::standard && options.regions == 0 && !(options.tolerance > 0) &&
           options.coarse == 0;
}

std::size_t estimated_bytes(const MeshView& mesh, const Options& options, int threads, Surfaces surfaces) {
    const std::size_t faces = mesh.face_count(), coarse = coarse_face_count(options, faces);
    std::size_t bytes = a_job + mesh.vertex_count() * a_vertex + (coarse > 0 ? faces * a_simplified_face : 0);
    if (options.preset != Preset::paper) {
        const bool noisy = surfaces == Surfaces::noisy && noise_matters(options);
        const auto more_threads = static_cast<std::size_t>(std::max(0, threads - 2));
        bytes += faces * (noisy ? a_noisy_face + more_threads * a_noisy_face_of_a_thread
                                : a_clean_face + more_threads * a_clean_face_of_a_thread);
    } else if (options.method == Method::hierarchical) {
        bytes += faces * a_hierarchical_face;
    } else {
        bytes += paper_bytes(faces, coarse, threads);
    }
    return bytes;
}

}  // namespace quadseg::flow
