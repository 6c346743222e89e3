#include "simplify/pieces.h"

#include "runtime/parallel.h"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace quadseg::simplify {
namespace {

constexpr int digit_bits = 10, passes = 3;
constexpr std::size_t digits = std::size_t{1} << digit_bits;
constexpr std::size_t part = 16384;

/// abc → a00b00c, for 10 bits.
std::uint32_t spread_bits(std::uint32_t x) noexcept {
    x = (x | x << 16) & 0x030000ff;
    x = (x | x << 8) & 0x0300f00f;
    x = (x | x << 4) & 0x030c30c3;
    x = (x | x << 2) & 0x09249249;
    return x;
}

/// In the frame the mesh lies in [-.5, .5]³; a cube of edge 2 leaves room to shift it.
std::uint32_t morton_key(const Vec3& p, const Vec3& shift) noexcept {
    constexpr double cells = digits;
    std::uint32_t key = 0;
    for (int i = 0; i < 3; ++i) {
        const double x = (p[i] + 0.5 + shift[i]) * (cells / 2);
        key = key << 1 | spread_bits(static_cast<std::uint32_t>(std::min(std::max(x, 0.0), cells - 1)));
    }
    return key;
}

struct Keyed {
    std::uint32_t key, face;
};

/// One stable pass of a radix sort; the result does not depend on the parts.
void radix_pass(const std::vector<Keyed>& from, std::vector<Keyed>& to, int shift) {
    const auto digit = [shift](const Keyed& k) { return static_cast<std::size_t>(k.key >> shift) & (digits - 1); };
    const std::size_t parts = (from.size() + part - 1) / part;
    std::vector<std::uint32_t> next(parts * digits, 0);
    runtime::parallel_blocks(from.size(), part, [&](std::size_t begin, std::size_t end) {
        std::uint32_t* count = &next[begin / part * digits];
        for (std::size_t i = begin; i < end; ++i) ++count[digit(from[i])];
    });
    std::uint32_t sum = 0;
    for (std::size_t d = 0; d < digits; ++d) {
        for (std::size_t p = 0; p < parts; ++p) {
            const std::uint32_t count = next[p * digits + d];
            next[p * digits + d] = sum;
            sum += count;
        }
    }
    runtime::parallel_blocks(from.size(), part, [&](std::size_t begin, std::size_t end) {
        std::uint32_t* place = &next[begin / part * digits];
        for (std::size_t i = begin; i < end; ++i) to[place[digit(from[i])]++] = from[i];
    });
}

bool sort_along_curve(const CollapseMesh& mesh, std::size_t phase, const std::function<bool()>& stopped,
                      std::vector<std::uint32_t>& alive) {
    // Multiples of three numbers that no small integers relate.
    const auto turn = static_cast<double>(phase);
    const auto fraction = [&](double step) { return turn * step - std::floor(turn * step); };
    const Vec3 shift{fraction(0.8191725134), fraction(0.6710436067), fraction(0.5497004779)};
    std::vector<Keyed> keyed(alive.size()), other(alive.size());
    runtime::parallel_for(alive.size(), part, [&](std::size_t i) {
        const std::uint32_t f = alive[i];
        keyed[i] = {morton_key(mesh.vertices[mesh.faces[f][0]].position, shift), f};  // any point of it will do
    });
    for (int pass = 0; pass < passes; ++pass) {
        if (stopped()) return false;
        radix_pass(keyed, other, pass * digit_bits);
        keyed.swap(other);
    }
    runtime::parallel_for(alive.size(), part, [&](std::size_t i) { alive[i] = keyed[i].face; });
    return !stopped();
}

void find_owners(const CollapseMesh& mesh, Pieces& pieces) {
    pieces.owner.assign(mesh.vertices.size(), none);
    runtime::parallel_for(pieces.faces.size(), 1, [&](std::size_t piece) {
        const auto number = static_cast<std::uint32_t>(piece);
        for (const std::uint32_t f : pieces.faces[piece]) {
            for (const std::uint32_t v : mesh.faces[f]) {
                // Whoever comes second finds another owner: the outcome is the same in any order.
                std::atomic_ref<std::uint32_t> owner(pieces.owner[v]);
                std::uint32_t seen = owner.load(std::memory_order_relaxed);
                if (seen == none && owner.compare_exchange_strong(seen, number, std::memory_order_relaxed)) continue;
                if (seen != number) owner.store(shared_vertex, std::memory_order_relaxed);
            }
        }
    });
}

}  // namespace

bool cut_into_pieces(const CollapseMesh& mesh, std::size_t phase, std::size_t piece_faces,
                     const std::function<bool()>& stopped, std::vector<std::uint32_t>& alive, Pieces& pieces) {
    pieces.faces.clear();
    if (!sort_along_curve(mesh, phase, stopped, alive)) return false;
    const std::size_t count = (alive.size() + piece_faces - 1) / piece_faces;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t begin = i * alive.size() / count, end = (i + 1) * alive.size() / count;
        pieces.faces.emplace_back(alive.data() + begin, end - begin);
    }
    find_owners(mesh, pieces);
    return true;
}

void keep_in_one_piece(const CollapseMesh& mesh, const std::vector<std::uint32_t>& alive, Pieces& pieces) {
    pieces.faces.assign(1, alive);
    find_owners(mesh, pieces);
}

}  // namespace quadseg::simplify
