// The functions behind the package; quadseg/*.py is their public face.
#include <quadseg/error.h>
#include <quadseg/io.h>
#include <quadseg/segmentation.h>

#include "tools/python/native/arrays.h"
#include "tools/python/native/job.h"
#include "tools/python/native/options.h"
#include "tools/python/native/records.h"
#include "tools/python/native/segmenter.h"

#include <exception>
#include <new>
#include <optional>
#include <pybind11/stl.h>
#include <string>

namespace quadseg::python {
namespace {

namespace py = pybind11;

Limits limits_of(const py::object& progress, std::optional<double> timeout, int threads, std::size_t memory_limit) {
    return {progress, timeout, threads, memory_limit};
}

/// Work that neither calls Python nor can be stopped: without the GIL.
template <class Work>
auto without_gil(const Work& work) {
    const py::gil_scoped_release free;
    return work();
}

py::dict report_dict(const MeshReport& r) {
    using py::literals::operator""_a;
    return py::dict("faces"_a = r.faces, "vertices"_a = r.vertices, "components"_a = r.components,
                    "border_edges"_a = r.border_edges, "non_manifold_edges"_a = r.non_manifold_edges,
                    "non_manifold_vertices"_a = r.non_manifold_vertices, "isolated_vertices"_a = r.isolated_vertices,
                    "degenerate_faces"_a = r.degenerate_faces, "duplicate_faces"_a = r.duplicate_faces,
                    "flipped_faces"_a = r.flipped_faces, "unorientable_edges"_a = r.unorientable_edges,
                    "stitched_edges"_a = r.stitched_edges, "feature_edges"_a = r.feature_edges,
                    "diagonal"_a = r.diagonal, "area"_a = r.area, "offset"_a = r.offset,
                    "box_min"_a = py::tuple(py::cast(r.box_min)), "box_max"_a = py::tuple(py::cast(r.box_max)));
}

py::dict result_dict(Segmentation&& s) {
    py::dict d;
    d["labels"] = to_numpy(std::move(s.labels));
    d["unlabelled"] = to_numpy(std::move(s.unlabelled));
    d["table"] = to_numpy(to_records(s.regions));
    d["energy"] = py::make_tuple(s.energy.total, s.energy.distance, s.energy.normal);
    d["rms"] = s.rms;
    d["max"] = s.max;
    d["noise"] = s.noise;
    d["stop"] = to_string(s.stop);
    d["partial"] = s.partial;
    d["seconds"] = py::make_tuple(s.seconds.prepare, s.seconds.coarse, s.seconds.fine, s.seconds.post, s.seconds.total);
    d["threads"] = s.threads;
    d["peak_bytes"] = s.peak_bytes;
    d["report"] = report_dict(s.input);
    std::vector<std::uint32_t> merge_regions;
    std::vector<double> merge_energies;
    for (const MergeStep& step : s.history) {
        merge_regions.push_back(step.regions);
        merge_energies.push_back(step.energy);
    }
    d["merge_regions"] = to_numpy(std::move(merge_regions));
    d["merge_energies"] = to_numpy(std::move(merge_energies));
    d["energies"] = to_numpy(std::move(s.energies));
    py::list regularities;
    for (const Regularity& r : s.regularities) {
        regularities.append(py::make_tuple(to_string(r.kind), py::tuple(py::cast(r.regions)), r.snapped));
    }
    d["regularities"] = regularities;
    d["projected"] = s.projected.empty() ? py::object(py::none()) : py::object(to_numpy(std::move(s.projected), 3));
    return d;
}

MeshView mesh_of(const DoubleArray& vertices, const IndexArray& faces, const std::optional<IndexArray>& polygons) {
    MeshView mesh{view_of(vertices), view_of(faces), {}};
    if (polygons) mesh.polygons = view_of(*polygons);
    return mesh;
}

py::dict call_segment(const DoubleArray& vertices, const IndexArray& faces, const std::optional<IndexArray>& polygons,
                      const py::dict& options, const py::object& progress, std::optional<double> timeout, int threads,
                      std::size_t memory_limit) {
    const Options chosen = to_options(options);
    const MeshView mesh = mesh_of(vertices, faces, polygons);
    Segmentation result;
    Job job(limits_of(progress, timeout, threads, memory_limit));
    job.run([&](Context& context) { result = segment(mesh, chosen, &context); });
    return result_dict(std::move(result));
}

py::dict call_inspect(const DoubleArray& vertices, const IndexArray& faces, double feature_degrees,
                      std::optional<double> timeout, int threads) {
    const MeshView mesh = mesh_of(vertices, faces, std::nullopt);
    MeshReport report;
    Job job(limits_of(py::none(), timeout, threads, 0));
    job.run([&](Context& context) { report = inspect(mesh, feature_degrees, &context); });
    return report_dict(report);
}

py::dict call_read(const std::string& path, const py::object& progress, std::optional<double> timeout,
                   std::size_t memory_limit) {
    Mesh mesh;
    Job job(limits_of(progress, timeout, 0, memory_limit));
    job.run([&](Context& context) { mesh = read_mesh(path, &context); });
    py::dict d;
    d["vertices"] = to_numpy(std::move(mesh.positions), 3);
    d["faces"] = to_numpy(std::move(mesh.triangles), 3);
    d["polygons"] = mesh.polygons.empty() ? py::object(py::none()) : py::object(to_numpy(std::move(mesh.polygons)));
    d["file_faces"] = mesh.file_faces;
    d["welded_vertices"] = mesh.welded_vertices;
    return d;
}

void call_write(const std::string& path, const DoubleArray& vertices, const IndexArray& faces,
                const std::optional<LabelArray>& labels, const std::optional<ByteArray>& colors) {
    const MeshView mesh = mesh_of(vertices, faces, std::nullopt);
    FaceColors face_colors;
    if (labels) face_colors.labels = view_of(*labels);
    if (colors) face_colors.rgb = view_of(*colors);
    without_gil([&] {
        if (labels || colors) {
            write_ply(path, mesh, face_colors);
        } else {
            write_mesh(path, mesh);
        }
    });
}

void call_write_labels(const std::string& path, const LabelArray& labels, const std::optional<IndexArray>& polygons) {
    const auto numbers = view_of(labels);
    const auto of_polygons = polygons ? view_of(*polygons) : std::span<const std::uint32_t>{};
    without_gil([&] { write_labels(path, numbers, of_polygons); });
}

/// Exceptions of the package, by the kind of the library's error.
void raise(const char* kind, const char* text) {
    const py::object exception = py::module_::import("quadseg._errors").attr("make")(kind, text);
    PyErr_SetObject(py::type::handle_of(exception).ptr(), exception.ptr());
}

void translate(std::exception_ptr thrown) {  // NOLINT(performance-unnecessary-value-param): pybind11's signature
    try {
        if (thrown) std::rethrow_exception(thrown);
    } catch (const Error& error) {
        raise(to_string(error.code()), error.what());
    } catch (const std::bad_alloc&) {
        raise("out_of_memory", "out of memory");
    }
}

}  // namespace
}  // namespace quadseg::python

PYBIND11_MODULE(_native, module) {
    namespace py = pybind11;
    using namespace quadseg;
    using namespace quadseg::python;
    using py::literals::operator""_a;
    register_records();
    py::register_local_exception_translator(translate);
    module.attr("version") = QUADSEG_VERSION;
    py::list types;
    for (std::size_t i = 0; i < surface_type_count; ++i) types.append(to_string(static_cast<SurfaceType>(i)));
    module.attr("surface_types") = py::tuple(types);
    // noconvert: an array of another type here is a mistake of ours, not a reason to copy.
    module.def("segment", call_segment, py::arg("vertices").noconvert(), py::arg("faces").noconvert(),
               py::arg("polygons").noconvert(), "options"_a, "progress"_a, "timeout"_a, "threads"_a, "memory_limit"_a);
    register_segmenter(module, result_dict);
    module.def("inspect", call_inspect, py::arg("vertices").noconvert(), py::arg("faces").noconvert(),
               "feature_degrees"_a, "timeout"_a, "threads"_a);
    module.def("read", call_read, "path"_a, "progress"_a, "timeout"_a, "memory_limit"_a);
    module.def("write", call_write, "path"_a, py::arg("vertices").noconvert(), py::arg("faces").noconvert(),
               py::arg("labels").noconvert(), py::arg("colors").noconvert());
    module.def("write_labels", call_write_labels, "path"_a, py::arg("labels").noconvert(),
               py::arg("polygons").noconvert());
}
