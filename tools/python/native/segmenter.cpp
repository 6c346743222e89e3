#include "tools/python/native/segmenter.h"

#include <quadseg/error.h>
#include <quadseg/segmenter.h>

#include "tools/python/native/arrays.h"
#include "tools/python/native/job.h"
#include "tools/python/native/options.h"

#include <atomic>
#include <functional>
#include <optional>
#include <pybind11/stl.h>
#include <utility>
#include <vector>

namespace quadseg::python {

namespace py = pybind11;

namespace {

/// A segmenter for one Python thread at a time: the GIL is free while it works, so a second one is turned away.
class Guarded {
  public:
    Guarded(const DoubleArray& vertices, const IndexArray& faces, const std::optional<IndexArray>& polygons,
            const py::dict& options, const Limits& limits) {
        MeshView mesh{view_of(vertices), view_of(faces), {}};
        if (polygons) mesh.polygons = view_of(*polygons);
        const Options chosen = to_options(options);
        Job job(limits);
        job.run([&](Context& context) { segmenter_.emplace(mesh, chosen, &context); });
        segmenter_->set_context(nullptr);  // the job's ends with it
    }

    /// work(segmenter), watched as `limits` say.
    void run(const Limits& limits, const std::function<void(Segmenter&)>& work) {
        const Turn turn(busy_);
        Job job(limits);
        const Release release{*segmenter_};
        job.run([&](Context& context) {
            segmenter_->set_context(&context);
            work(*segmenter_);
        });
    }

    /// For what takes no time.
    Segmenter& look() {
        const Turn turn(busy_);
        return *segmenter_;
    }

  private:
    struct Release {
        Segmenter& segmenter;
        ~Release() { segmenter.set_context(nullptr); }
    };
    class Turn {
      public:
        explicit Turn(std::atomic<bool>& busy) : busy_(busy) {
            if (busy_.exchange(true)) {
                throw Error(ErrorCode::invalid_argument, "this Segmenter is at work in another thread");
            }
        }
        ~Turn() { busy_ = false; }
        Turn(const Turn&) = delete;
        Turn& operator=(const Turn&) = delete;

      private:
        std::atomic<bool>& busy_;
    };

    std::optional<Segmenter> segmenter_;
    std::atomic<bool> busy_{false};
};

}  // namespace

void register_segmenter(py::module_& module, py::dict (*to_python)(Segmentation&&)) {
    using py::literals::operator""_a;
    const auto limits = [](const py::object& progress, std::optional<double> timeout, int threads) {
        return Limits{progress, timeout, threads, 0};
    };
    py::class_<Guarded>(module, "Segmenter")
        .def(py::init([=](const DoubleArray& vertices, const IndexArray& faces,
                          const std::optional<IndexArray>& polygons, const py::dict& options,
                          const py::object& progress, std::optional<double> timeout, int threads) {
                 return std::make_unique<Guarded>(vertices, faces, polygons, options,
                                                  limits(progress, timeout, threads));
             }),
             py::arg("vertices").noconvert(), py::arg("faces").noconvert(), py::arg("polygons").noconvert(),
             "options"_a, "progress"_a, "timeout"_a, "threads"_a)
        .def("regions", [](Guarded& s) { return s.look().region_count(); })
        .def("labels",
             [](Guarded& s) {
                 const auto labels = s.look().labels();
                 return to_numpy(std::vector<std::int32_t>(labels.begin(), labels.end()));
             })
        .def("set_options",
             [=](Guarded& s, const py::dict& options, int threads) {
                 const Options chosen = to_options(options);
                 s.run(limits(py::none(), {}, threads), [&](Segmenter& it) { it.set_options(chosen); });
             })
        .def("run",
             [=](Guarded& s, const py::object& progress, std::optional<double> timeout, int threads) {
                 StopReason stop{};
                 s.run(limits(progress, timeout, threads), [&](Segmenter& it) { stop = it.run(); });
                 return to_string(stop);
             })
        .def("set_labels",
             [=](Guarded& s, const LabelArray& labels) {
                 const auto numbers = view_of(labels);
                 s.run(limits(py::none(), {}, 0), [&](Segmenter& it) { it.set_labels(numbers); });
             })
        .def("insert",
             [=](Guarded& s, std::optional<std::size_t> face) {
                 std::int32_t label = 0;
                 s.run(limits(py::none(), {}, 0),
                       [&](Segmenter& it) { label = face ? it.insert(*face) : it.insert(); });
                 return label;
             })
        .def("merge", [=](Guarded& s, std::int32_t a,
                          std::int32_t b) { s.run(limits(py::none(), {}, 0), [&](Segmenter& it) { it.merge(a, b); }); })
        .def("merge_candidate",
             [=](Guarded& s, std::int32_t a, std::int32_t b) {
                 Segmenter::MergeCandidate candidate{};
                 s.run(limits(py::none(), {}, 0), [&](Segmenter& it) { candidate = it.merge_candidate(a, b); });
                 return py::make_tuple(candidate.increase, candidate.valid);
             })
        .def("relax",
             [=](Guarded& s, int iterations, const py::object& progress, std::optional<double> timeout, int threads) {
                 double energy = 0;
                 s.run(limits(progress, timeout, threads), [&](Segmenter& it) { energy = it.relax(iterations); });
                 return energy;
             })
        .def("smooth", [=](Guarded& s) { s.run(limits(py::none(), {}, 0), [](Segmenter& it) { it.smooth(); }); })
        .def("undo", [](Guarded& s) { return s.look().undo(); })
        .def("result", [=](Guarded& s, int threads) {
            Segmentation result;
            s.run(limits(py::none(), {}, threads), [&](Segmenter& it) { result = it.result(); });
            return to_python(std::move(result));
        });
}

}  // namespace quadseg::python
