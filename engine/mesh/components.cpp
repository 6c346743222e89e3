#include "mesh/build.h"
#include "runtime/parallel.h"

#include <atomic>

namespace quadseg::mesh::build {

namespace {

/// Union-find whose root is the smallest member: the result does not depend on the order of the unions, so they may run
/// at once (a root is only ever linked to a smaller face).
class SmallestRoot {
  public:
    explicit SmallestRoot(std::size_t size) : parent_(size) {
        runtime::parallel_for(size, block, [&](std::size_t i) { parent_[i] = static_cast<std::uint32_t>(i); });
    }

    std::uint32_t find(std::uint32_t i) noexcept {
        for (;;) {
            const std::uint32_t p = at(i).load(std::memory_order_relaxed);
            if (p == i) return i;
            const std::uint32_t grandparent = at(p).load(std::memory_order_relaxed);
            if (grandparent != p) at(i).store(grandparent, std::memory_order_relaxed);
            i = p;
        }
    }

    void join(std::uint32_t a, std::uint32_t b) noexcept {
        for (;;) {
            a = find(a);
            b = find(b);
            if (a == b) return;
            if (a < b) std::swap(a, b);
            std::uint32_t expected = a;
            if (at(a).compare_exchange_strong(expected, b, std::memory_order_relaxed)) return;
        }
    }

  private:
    std::atomic_ref<std::uint32_t> at(std::uint32_t i) noexcept { return std::atomic_ref<std::uint32_t>(parent_[i]); }
    std::vector<std::uint32_t> parent_;
};

}  // namespace

void find_components(WorkMesh& mesh, const runtime::RunControl& control) {
    SmallestRoot sets(mesh.face_count());
    runtime::parallel_blocks(mesh.face_count(), block, [&](std::size_t begin, std::size_t end) {
        control.check();
        for (std::size_t f = begin; f < end; ++f) {
            for (const std::int32_t g : mesh.neighbors[f]) {
                if (g >= 0 && static_cast<std::size_t>(g) < f) {
                    sets.join(static_cast<std::uint32_t>(f), static_cast<std::uint32_t>(g));
                }
            }
        }
    });
    // A root is the first face of its component: numbering the roots in order numbers the components by first face.
    const std::size_t faces = mesh.face_count();
    mesh.components.resize(faces);
    const auto is_root = [&](std::size_t f) { return sets.find(static_cast<std::uint32_t>(f)) == f; };
    std::vector<std::size_t> roots_before((faces + block - 1) / block, 0);
    runtime::parallel_blocks(faces, block, [&](std::size_t begin, std::size_t end) {
        for (std::size_t f = begin; f < end; ++f) roots_before[begin / block] += is_root(f) ? 1 : 0;
    });
    mesh.component_count = runtime::exclusive_scan(roots_before);
    control.check();
    runtime::parallel_blocks(faces, block, [&](std::size_t begin, std::size_t end) {
        std::size_t next = roots_before[begin / block];
        for (std::size_t f = begin; f < end; ++f) {
            if (is_root(f)) mesh.components[f] = static_cast<std::int32_t>(next++);
        }
    });
    control.check();
    runtime::parallel_for(faces, block, [&](std::size_t f) {
        const std::uint32_t root = sets.find(static_cast<std::uint32_t>(f));
        if (root != f) mesh.components[f] = mesh.components[root];
    });
    mesh.report.components = mesh.component_count;
}

}  // namespace quadseg::mesh::build
