#include "simplify/decimate.h"

#include "runtime/parallel.h"
#include "runtime/per_thread.h"
#include "simplify/collapse_mesh.h"
#include "simplify/face_map.h"
#include "simplify/piece.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace quadseg::simplify {
namespace {

/// Faces of a piece: with its vertices 400 kB, what a core keeps in its own cache. A tenth of them touch its border.
constexpr std::size_t piece_faces = 4096;
/// So few are not cut: without borders between pieces the order of the collapses is the best.
constexpr std::size_t one_piece_faces = 16384;
/// A phase leaves half of the faces; a quarter while that is more than `far` times the target, where what it does too
/// much in one place or another comes to nothing.
constexpr double phase_share = 0.5, far_phase_share = 0.25, far = 3;
/// Pieces stop that much above the target: the rest, over the whole mesh, has the last word on where faces go.
constexpr double reserve = 1.05;
constexpr std::size_t most_phases = 16;
/// A phase that removes less than this share of the faces has done what it could.
constexpr double least_progress = 0.02;
constexpr std::size_t cost_samples = 4096;
constexpr float any_cost = std::numeric_limits<float>::max();

/// Phases: the mesh is cut into pieces, which collapse their cheapest edges at once, up to a cost that is the same for
/// all; the next phase cuts elsewhere. When little is left to do, or the mesh is small, it is done in one piece.
class Decimator {
  public:
    Decimator(CollapseMesh& mesh, std::size_t target, const std::function<bool()>& stopped)
        : mesh_(mesh), target_(target), stopped_(stopped) {
        alive_.reserve(mesh.face_count);
        for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
            if (mesh.alive(static_cast<std::uint32_t>(i))) alive_.push_back(static_cast<std::uint32_t>(i));
        }
    }

    void run() {
        for (std::size_t phase = 0; phase < most_phases && !stopped_(); ++phase) {
            const auto count = static_cast<double>(alive_.size());
            if (alive_.size() <= one_piece_faces || count <= reserve * static_cast<double>(target_)) break;
            if (!collapse_pieces(phase)) break;
            if (static_cast<double>(alive_.size()) > (1 - least_progress) * count) break;
        }
        if (!stopped_()) collapse_whole();
        mesh_.face_count = alive_.size();
    }

    double max_error() const noexcept { return max_error_; }

  private:
    bool collapse_pieces(std::size_t phase) {
        if (!cut_into_pieces(mesh_, phase, piece_faces, stopped_, alive_, pieces_)) return false;
        const auto count = static_cast<double>(alive_.size());
        const auto target = static_cast<double>(target_);
        PieceLimits limits;
        const double share = far_phase_share * count > far * target ? far_phase_share : phase_share;
        limits.largest_cost = cost_that_leaves(std::max(share, (1 + 0.4 * (reserve - 1)) * target / count));
        std::vector<std::vector<std::uint32_t>> survivors(pieces_.faces.size());
        std::vector<double> errors(pieces_.faces.size(), 0);
        runtime::parallel_for(pieces_.faces.size(), 1, [&](std::size_t i) {
            Piece& piece = workspace_.local();
            piece.load(mesh_, pieces_, static_cast<std::uint32_t>(i));
            PieceLimits own = limits;
            // Whatever the costs, all together stay above the target. (A collapse removes two faces.)
            const double own_count = static_cast<double>(piece.face_count());
            own.fewest_faces = static_cast<std::size_t>(std::ceil(target / count * own_count)) + 1;
            if (!stopped_()) piece.collapse(own, stopped_);
            piece.store(mesh_, survivors[i]);
            errors[i] = piece.max_error();
        });
        alive_.clear();
        for (const auto& part : survivors) alive_.insert(alive_.end(), part.begin(), part.end());
        for (const double error : errors) max_error_ = std::max(max_error_, error);
        return true;
    }

    void collapse_whole() {
        keep_in_one_piece(mesh_, alive_, pieces_);
        Piece piece;
        piece.load(mesh_, pieces_, 0);
        for (const bool keep_shape : {true, false}) {
            // Refused edges get another chance as long as anything around them may have changed.
            for (std::size_t collapses = 1; collapses > 0 && piece.face_count() > target_ && !stopped_();) {
                const std::size_t wanted = (piece.face_count() - target_ + 1) / 2;
                const float cost = piece.cost_of_rank(8 * wanted);
                collapses = piece.collapse({cost, target_, keep_shape}, stopped_);
                if (collapses == 0 && cost < any_cost)
                    collapses = piece.collapse({any_cost, target_, keep_shape}, stopped_);
            }
        }
        std::vector<std::uint32_t> left;
        piece.store(mesh_, left);
        alive_ = std::move(left);
        max_error_ = std::max(max_error_, piece.max_error());
    }

    /// The cost of collapses that leaves about this share of the faces, from the cheapest edges of a sample of them. On
    /// a curved surface costs grow with the cube of the area that a face stands for.
    float cost_that_leaves(double share) const {
        const std::size_t samples = std::min(cost_samples, alive_.size());
        std::vector<double> roots(samples);
        runtime::parallel_for(samples, 256, [&](std::size_t i) {
            const Face& f = mesh_.faces[alive_[i * alive_.size() / samples]];
            double least = std::numeric_limits<double>::max();
            for (std::size_t k = 0; k < 3; ++k)
                least = std::min(least, place_collapsed(mesh_, f[k], f[(k + 1) % 3]).cost);
            roots[i] = std::cbrt(std::max(least, 0.0));
        });
        const auto share_left = [&](double root) {
            double sum = 0;
            for (const double r : roots) sum += r < root ? r / root : 1;
            return sum / static_cast<double>(samples);
        };
        double low = 0, high = std::cbrt(static_cast<double>(any_cost));
        for (int step = 0; step < 200 && high > low * 1.001; ++step) {
            // In steps of the exponent: costs range over dozens of powers of ten.
            const double middle = low > 0 ? std::sqrt(low * high) : high * 1e-3;
            if (share_left(middle) > share) {
                low = middle;
            } else {
                high = middle;
            }
            if (high < 1e-15) break;
        }
        return static_cast<float>(std::min(high * high * high, static_cast<double>(any_cost)));
    }

    CollapseMesh& mesh_;
    std::size_t target_;
    const std::function<bool()>& stopped_;
    std::vector<std::uint32_t> alive_;
    Pieces pieces_;
    runtime::PerThread<Piece> workspace_;
    double max_error_ = 0;
};

Decimated identity(std::span<const Vec3> positions, std::span<const Face> faces) {
    Decimated result;
    result.positions.assign(positions.begin(), positions.end());
    result.faces.assign(faces.begin(), faces.end());
    result.face_map.resize(faces.size());
    for (std::size_t i = 0; i < faces.size(); ++i) result.face_map[i] = static_cast<std::uint32_t>(i);
    return result;
}

/// The live part of the mesh in its old order, and the number of every live face in it.
std::vector<std::uint32_t> extract(const CollapseMesh& mesh, std::span<const Vec3> input, const Frame& frame,
                                   Decimated& result) {
    std::vector<std::uint32_t> face_number(mesh.faces.size(), none), vertex_number(mesh.vertices.size(), none);
    for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
        if (!mesh.alive(static_cast<std::uint32_t>(i))) continue;
        for (const std::uint32_t v : mesh.faces[i]) vertex_number[v] = 0;
    }
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        if (vertex_number[v] == none) continue;
        vertex_number[v] = static_cast<std::uint32_t>(result.positions.size());
        const std::uint32_t source = mesh.vertices[v].source;
        result.positions.push_back(source != none ? input[source] : frame.to_input(mesh.vertices[v].position));
    }
    for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
        if (!mesh.alive(static_cast<std::uint32_t>(i))) continue;
        face_number[i] = static_cast<std::uint32_t>(result.faces.size());
        const Face& f = mesh.faces[i];
        result.faces.push_back({vertex_number[f[0]], vertex_number[f[1]], vertex_number[f[2]]});
    }
    return face_number;
}

/// A face with a repeated vertex lives nowhere: it takes the place of a face at one of its vertices.
void adopt_degenerate_faces(std::span<const Face> faces, std::size_t vertices, std::vector<std::uint32_t>& face_map) {
    std::vector<std::uint32_t> at_vertex;
    for (std::size_t i = 0; i < faces.size(); ++i) {
        if (face_map[i] != none) continue;
        if (at_vertex.empty()) {
            at_vertex.assign(vertices, none);
            for (std::size_t j = faces.size(); j-- > 0;) {
                if (face_map[j] == none) continue;
                for (const std::uint32_t v : faces[j]) at_vertex[v] = face_map[j];
            }
        }
        for (const std::uint32_t v : faces[i]) {
            if (face_map[i] == none) face_map[i] = at_vertex[v];
        }
        if (face_map[i] == none && i > 0) face_map[i] = face_map[i - 1];
    }
    for (std::size_t i = faces.size(); i-- > 1;) {
        if (face_map[i - 1] == none) face_map[i - 1] = face_map[i];
    }
}

}  // namespace

Decimated decimate(std::span<const Vec3> positions, std::span<const Face> faces, const DecimateOptions& options) {
    const std::function<bool()> stopped = [&] { return options.should_stop && options.should_stop(); };
    if (faces.size() <= options.target_faces) return identity(positions, faces);
    CollapseMesh mesh;
    if (!build_collapse_mesh(positions, faces, options.feature_degrees, stopped, mesh)) {
        return identity(positions, faces);
    }
    Decimator decimator(mesh, options.target_faces, stopped);
    decimator.run();

    Decimated result;
    result.max_error = decimator.max_error() / mesh.frame.scale;
    const std::vector<std::uint32_t> face_number = extract(mesh, positions, mesh.frame, result);
    result.face_map = last_heirs(mesh);
    for (std::uint32_t& f : result.face_map) f = f == none ? none : face_number[f];
    if (result.faces.empty()) return identity(positions, faces);
    refine_face_map(positions, faces, result.positions, result.faces, stopped, result.face_map);
    adopt_degenerate_faces(faces, positions.size(), result.face_map);
    return result;
}

}  // namespace quadseg::simplify
