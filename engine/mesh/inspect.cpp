#include <quadseg/error.h>
#include <quadseg/mesh.h>

#include "mesh/features.h"
#include "mesh/work_mesh.h"
#include "runtime/parallel.h"

#include <string>

namespace quadseg {

MeshReport inspect(const MeshView& view, double feature_degrees, Context* context) {
    if (!(feature_degrees <= 180)) {
        throw Error(
            ErrorCode::invalid_argument,
            "feature_degrees: must be at most 180 (0 or less: not counted), but is " + std::to_string(feature_degrees));
    }
    const runtime::RunControl control(context);
    MeshReport report;
    try {
        runtime::in_arena(context ? context->threads() : 0, [&] {
            const mesh::WorkMesh work = mesh::build_work_mesh(view, control);
            report = work.report;
            report.feature_edges = mesh::count_feature_edges(mesh::find_feature_edges(work, feature_degrees, control));
        });
    } catch (const runtime::Stopped& stopped) {
        throw Error(ErrorCode::cancelled, stopped.deadline ? "out of time while the mesh was being checked"
                                                           : "cancelled while the mesh was being checked");
    }
    return report;
}

}  // namespace quadseg
