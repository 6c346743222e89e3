#include "mesh/build.h"
#include "mesh/connected.h"

namespace quadseg::mesh::build {

void find_components(WorkMesh& mesh, const runtime::RunControl& control) {
    mesh.component_count = connected_faces(
        mesh, [](std::size_t) { return true; }, [](std::size_t, std::size_t, std::size_t) { return true; },
        [&] { control.check(); }, mesh.components);
    mesh.report.components = mesh.component_count;
}

}  // namespace quadseg::mesh::build
