// An OpenMesh mesh gets the labels of its faces as a face property.
#include <quadseg/adapters/openmesh.h>

#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <array>
#include <cstdio>
#include <set>
#include <vector>

using PolyMesh = OpenMesh::PolyMesh_ArrayKernelT<>;

int main() {
    // A box of squares, 8 × 8 on each side: six planes.
    constexpr int n = 8;
    PolyMesh mesh;
    auto vertex = [&mesh, seen = std::vector<PolyMesh::VertexHandle>((n + 1) * (n + 1) * (n + 1))](
                      const std::array<int, 3>& p) mutable {
        auto& handle = seen[static_cast<std::size_t>((p[0] * (n + 1) + p[1]) * (n + 1) + p[2])];
        if (!handle.is_valid()) {
            handle = mesh.add_vertex(
                PolyMesh::Point(static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])));
        }
        return handle;
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const int level : {0, n}) {
            for (int i = 0; i < n; ++i) {
                for (int j = 0; j < n; ++j) {
                    const auto corner = [&](int u, int v) {
                        std::array<int, 3> p{};
                        p[axis] = level;
                        p[(axis + 1) % 3] = u;
                        p[(axis + 2) % 3] = v;
                        return vertex(p);
                    };
                    std::vector<PolyMesh::VertexHandle> square{corner(i, j), corner(i + 1, j), corner(i + 1, j + 1),
                                                               corner(i, j + 1)};
                    if (level == 0) std::swap(square[1], square[3]);
                    mesh.add_face(square);
                }
            }
        }
    }

    OpenMesh::FPropHandleT<int> labels;
    mesh.add_property(labels, "region");
    const quadseg::Segmentation result = quadseg::adapters::segment(mesh, labels);

    std::set<int> used;
    for (const auto face : mesh.faces()) used.insert(mesh.property(labels, face));
    std::printf("%zu faces, %zu regions\n", mesh.n_faces(), used.size());
    return used.size() == 6 && result.regions.size() == 6 ? 0 : 1;
}
