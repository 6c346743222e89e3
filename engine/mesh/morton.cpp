// Order of faces along a space-filling curve: neighbours in space become neighbours in memory (shuffled faces cost the
// whole job up to 1.85 times its time).
#include "mesh/build.h"
#include "runtime/parallel.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <memory>
#include <utility>

namespace quadseg::mesh::build {

namespace {

constexpr int bits_per_axis = 21;
constexpr int key_bits = 3 * bits_per_axis;

/// The radix sort goes down to cells that hold about a face each (4^level cells of a surface); what shares such a cell
/// is sorted by comparison. The order is the same whatever the digits.
struct Digits {
    int passes, bits;

    explicit Digits(std::size_t faces) {
        constexpr int spare = 2, most_bits = 13;
        const int wanted = 3 * static_cast<int>(std::bit_width(faces)) / 2 + spare;
        passes = std::clamp((wanted + most_bits - 1) / most_bits, 1, 3);
        bits = std::min((wanted + passes - 1) / passes, most_bits);
    }
    std::size_t count() const noexcept { return std::size_t{1} << bits; }
    int low_bits() const noexcept { return key_bits - passes * bits; }
};

/// abc → a00b00c, for 21 bits.
std::uint64_t spread_bits(std::uint64_t x) noexcept {
    x = (x | x << 32) & 0x1f00000000ffff;
    x = (x | x << 16) & 0x1f0000ff0000ff;
    x = (x | x << 8) & 0x100f00f00f00f00f;
    x = (x | x << 4) & 0x10c30c30c30c30c3;
    x = (x | x << 2) & 0x1249249249249249;
    return x;
}

struct Keyed {
    std::uint64_t key;
    std::uint32_t face;
    std::uint8_t first_corner;  ///< in what would be padding
};

/// Not a vector: whoever fills a part touches its memory first, all threads at once.
class KeyedFaces {
  public:
    explicit KeyedFaces(std::size_t size) : keyed_(std::make_unique_for_overwrite<Keyed[]>(size)), size_(size) {}
    std::size_t size() const noexcept { return size_; }
    Keyed& operator[](std::size_t i) noexcept { return keyed_[i]; }
    const Keyed& operator[](std::size_t i) const noexcept { return keyed_[i]; }

  private:
    std::unique_ptr<Keyed[]> keyed_;
    std::size_t size_;
};

const double* position(const MeshView& input, std::uint32_t v) noexcept {
    return &input.positions[3 * static_cast<std::size_t>(v)];
}

/// Faces with one key: by the positions of their corners from the first one on, so that an input that is numbered
/// differently gives the same order.
bool before_at_same_key(const MeshView& input, const Keyed& f, const Keyed& g) noexcept {
    for (std::size_t k = 0; k < 3; ++k) {
        const double* a = position(input, input.triangles[3 * std::size_t{f.face} + (f.first_corner + k) % 3]);
        const double* b = position(input, input.triangles[3 * std::size_t{g.face} + (g.first_corner + k) % 3]);
        for (int i = 0; i < 3; ++i) {
            if (a[i] != b[i]) return a[i] < b[i];
        }
    }
    return f.face < g.face;
}

std::array<std::uint32_t, 3> ascending(const std::uint32_t* t) noexcept {
    const auto [low, high] = std::minmax(t[0], t[1]);
    return {std::min(low, t[2]), std::max(low, std::min(high, t[2])), std::max(high, t[2])};
}

/// Of the three vertices in ascending order: faces with the same vertices have the same key to the last bit.
std::uint64_t key_of(const MeshView& input, const std::uint32_t* corners, const UnitFrame& frame) noexcept {
    constexpr double cells = 1 << bits_per_axis;
    const std::array<std::uint32_t, 3> t = ascending(corners);
    const double *a = position(input, t[0]), *b = position(input, t[1]), *c = position(input, t[2]);
    std::uint64_t key = 0;
    for (int i = 0; i < 3; ++i) {
        const double centre = frame.centre[i];
        const double sum = (a[i] - centre) + (b[i] - centre) + (c[i] - centre);
        const double x = sum * (frame.scale / 3) * cells + cells / 2;
        const auto cell = static_cast<std::int64_t>(std::min(std::max(x, 0.0), cells - 1));
        key = key << 1 | spread_bits(static_cast<std::uint64_t>(cell));
    }
    return key;
}

/// The corner that a face begins with, whichever the file names first: the one opposite its longest edge. Of two edges
/// of that length the later one counts, which is the same in every rotated copy of the mesh; of three equal ones the
/// corner that lies first by x, then y, then z.
std::uint8_t first_corner_of(const MeshView& input, const std::uint32_t* t) noexcept {
    constexpr double same_length = 1 - 1e-6;  // of squares: far above rounding, far below what a mesher varies
    const std::array<const double*, 3> p{position(input, t[0]), position(input, t[1]), position(input, t[2])};
    const auto squared_length = [&](std::size_t j, std::size_t k) {
        const double x = p[j][0] - p[k][0], y = p[j][1] - p[k][1], z = p[j][2] - p[k][2];
        return x * x + y * y + z * z;
    };
    const std::array<double, 3> length{squared_length(0, 1), squared_length(1, 2), squared_length(2, 0)};
    const double longest = same_length * std::max({length[0], length[1], length[2]});
    const std::array<bool, 3> is_longest{length[0] >= longest, length[1] >= longest, length[2] >= longest};
    for (std::uint8_t k = 0; k < 3; ++k) {
        if (is_longest[k] && !is_longest[k < 2 ? k + 1 : 0]) return k > 0 ? k - 1 : 2;
    }
    std::uint8_t first = 0;
    for (std::uint8_t k = 1; k < 3; ++k) {
        if (std::lexicographical_compare(p[k], p[k] + 3, p[first], p[first] + 3)) first = k;
    }
    return first;
}

/// Keys of the faces with three different vertices, in face order, and their first corners.
KeyedFaces face_keys(const MeshView& input, const UnitFrame& frame, const runtime::RunControl& control) {
    const auto collapsed = [&](std::size_t f) { return has_repeated_index(&input.triangles[3 * f]); };
    std::vector<std::size_t> block_begin((input.face_count() + block - 1) / block);
    runtime::parallel_blocks(input.face_count(), block, [&](std::size_t begin, std::size_t end) {
        control.check();
        std::size_t count = 0;
        for (std::size_t f = begin; f < end; ++f) count += collapsed(f) ? 0 : 1;
        block_begin[begin / block] = count;
    });
    KeyedFaces keyed(runtime::exclusive_scan(block_begin));
    runtime::parallel_blocks(input.face_count(), block, [&](std::size_t begin, std::size_t end) {
        control.check();
        std::size_t next = block_begin[begin / block];
        for (std::size_t f = begin; f < end; ++f) {
            if (collapsed(f)) continue;
            const std::uint32_t* t = &input.triangles[3 * f];
            keyed[next++] = {key_of(input, t, frame), static_cast<std::uint32_t>(f), first_corner_of(input, t)};
        }
    });
    return keyed;
}

/// One stable pass of the radix sort. The result of a stable sort is unique, whatever the parts.
void radix_pass(const KeyedFaces& from, KeyedFaces& to, int shift, std::size_t digits,
                const runtime::RunControl& control) {
    const auto threads = static_cast<std::size_t>(std::clamp(runtime::arena_threads(), 1, 64));
    const std::size_t part = std::max<std::size_t>((from.size() + threads - 1) / threads, block);
    const std::size_t parts = (from.size() + part - 1) / part;
    const auto digit = [=](const Keyed& k) { return static_cast<std::size_t>(k.key >> shift) & (digits - 1); };
    std::vector<std::uint32_t> next(parts * digits, 0);
    runtime::parallel_blocks(from.size(), part, [&](std::size_t begin, std::size_t end) {
        control.check();
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
        for (std::size_t i = begin; i < end; ++i) {
            if (i % block == 0) control.check();
            to[place[digit(from[i])]++] = from[i];
        }
    });
}

/// Sorts the runs of equal high bits in [begin, end), which holds whole runs.
void sort_runs(const MeshView& input, KeyedFaces& keyed, int low_bits, std::size_t begin, std::size_t end) {
    const auto less = [&](const Keyed& a, const Keyed& b) {
        return a.key != b.key ? a.key < b.key : before_at_same_key(input, a, b);
    };
    for (std::size_t i = begin, j = begin; i < end; i = j) {
        while (j < end && keyed[j].key >> low_bits == keyed[i].key >> low_bits) ++j;
        if (j - i > 1) {
            runtime::parallel_sort(&keyed[i], &keyed[i] + (j - i), less);
        }
    }
}

/// Begins of blocks of about `block` faces that cut no run of equal high bits; the end is the last entry.
std::vector<std::size_t> whole_run_blocks(const KeyedFaces& keyed, int low_bits) {
    std::vector<std::size_t> begins{0};
    while (begins.back() < keyed.size()) {
        std::size_t i = std::min(begins.back() + block, keyed.size());
        while (i < keyed.size() && keyed[i].key >> low_bits == keyed[i - 1].key >> low_bits) ++i;
        begins.push_back(i);
    }
    return begins;
}

/// Duplicates among the faces of [begin, end), which have one key.
void find_duplicates(const MeshView& input, const KeyedFaces& keyed, std::size_t begin, std::size_t end,
                     Duplicates& duplicates) {
    struct Face {
        std::array<std::uint32_t, 3> vertices;
        std::uint32_t face;
    };
    std::vector<Face> faces;
    for (std::size_t i = begin; i < end; ++i) {
        faces.push_back({ascending(&input.triangles[3 * std::size_t{keyed[i].face}]), keyed[i].face});
    }
    std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) {
        return a.vertices != b.vertices ? a.vertices < b.vertices : a.face < b.face;
    });
    for (std::size_t i = 1, first = 0; i < faces.size(); ++i) {
        if (faces[i].vertices != faces[first].vertices) {
            first = i;
        } else {
            duplicates.emplace_back(faces[i].face, faces[first].face);
        }
    }
}

Duplicates find_duplicates(const MeshView& input, const KeyedFaces& keyed, std::size_t begin, std::size_t end) {
    Duplicates duplicates;
    for (std::size_t i = begin, j = begin; i < end; i = j) {
        while (j < end && keyed[j].key == keyed[i].key) ++j;
        if (j - i > 1) find_duplicates(input, keyed, i, j, duplicates);
    }
    return duplicates;
}

void leave_out_duplicates(FaceOrder& order) {
    const auto is_duplicate = [&](std::uint32_t f) {
        const auto at = std::lower_bound(order.duplicates.begin(), order.duplicates.end(), std::pair{f, 0U});
        return at != order.duplicates.end() && at->first == f;
    };
    std::size_t kept = 0;
    for (std::size_t i = 0; i < order.faces.size(); ++i) {
        if (is_duplicate(order.faces[i])) continue;
        order.faces[kept] = order.faces[i];
        order.first_corner[kept++] = order.first_corner[i];
    }
    order.faces.resize(kept);
    order.first_corner.resize(kept);
}

}  // namespace

FaceOrder morton_order(const MeshView& input, const UnitFrame& frame, const runtime::RunControl& control) {
    KeyedFaces keyed = face_keys(input, frame, control);
    const Digits digits(keyed.size());
    {
        KeyedFaces other(keyed.size());
        for (int pass = 0; pass < digits.passes; ++pass) {
            radix_pass(keyed, other, digits.low_bits() + pass * digits.bits, digits.count(), control);
            std::swap(keyed, other);
        }
    }
    const std::vector<std::size_t> begins = whole_run_blocks(keyed, digits.low_bits());
    std::vector<Duplicates> found(begins.size() - 1);
    runtime::parallel_for(found.size(), 1, [&](std::size_t b) {
        control.check();
        sort_runs(input, keyed, digits.low_bits(), begins[b], begins[b + 1]);
        found[b] = find_duplicates(input, keyed, begins[b], begins[b + 1]);
    });
    FaceOrder order;
    for (const Duplicates& d : found) order.duplicates.insert(order.duplicates.end(), d.begin(), d.end());
    std::sort(order.duplicates.begin(), order.duplicates.end());
    order.faces.resize(keyed.size());
    order.first_corner.resize(keyed.size());
    runtime::parallel_for(keyed.size(), block, [&](std::size_t i) {
        order.faces[i] = keyed[i].face;
        order.first_corner[i] = keyed[i].first_corner;
    });
    if (!order.duplicates.empty()) leave_out_duplicates(order);
    return order;
}

}  // namespace quadseg::mesh::build
