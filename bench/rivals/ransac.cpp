// CGAL's Efficient_RANSAC (Schnabel, Wahl, Klein 2007) with all five shapes, on one oriented point a face.
#include "bench/rivals/adapter.h"
#include "bench/rivals/cgal_mesh.h"

#include <CGAL/Random.h>
#include <CGAL/Shape_detection/Efficient_RANSAC.h>
#include <CGAL/property_map.h>
#include <cmath>
#include <tuple>

namespace quadseg::bench {
namespace {

/// With its face: detect() reorders its input.
using FacePoint = std::tuple<Point, Vector, std::size_t>;
using RansacTraits = CGAL::Shape_detection::Efficient_RANSAC_traits<Kernel, std::vector<FacePoint>,
                                                                    CGAL::Nth_of_tuple_property_map<0, FacePoint>,
                                                                    CGAL::Nth_of_tuple_property_map<1, FacePoint>>;
using Engine = CGAL::Shape_detection::Efficient_RANSAC<RansacTraits>;

class Ransac : public Adapter {
  public:
    explicit Ransac(bool tight) : tight_(tight) {}

    void prepare(const Mesh& mesh, std::size_t) override {
        const auto corner = [&mesh](std::size_t c) {
            const double* p = &mesh.positions[3 * std::size_t{mesh.triangles[c]}];
            return Point(p[0], p[1], p[2]);
        };
        points_.reserve(mesh.triangles.size() / 3);
        for (std::size_t c = 0; c < mesh.triangles.size(); c += 3) {
            const Point p = corner(c), q = corner(c + 1), r = corner(c + 2);
            const Vector n = CGAL::cross_product(q - p, r - p);
            const double length = std::sqrt(n.squared_length());
            points_.emplace_back(CGAL::centroid(p, q, r), length > 0 ? n / length : Vector(0, 0, 1), c / 3);
        }
        CGAL::Bbox_3 box;
        for (std::size_t c = 0; c < mesh.triangles.size(); ++c) box += corner(c).bbox();
        diagonal_ = std::hypot(box.xmax() - box.xmin(), box.ymax() - box.ymin(), box.zmax() - box.zmin());
    }

    void segment() override {
        CGAL::get_default_random() = CGAL::Random(1);
        engine_.set_input(points_);
        namespace shapes = CGAL::Shape_detection;
        engine_.add_shape_factory<shapes::Plane<RansacTraits>>();
        engine_.add_shape_factory<shapes::Sphere<RansacTraits>>();
        engine_.add_shape_factory<shapes::Cylinder<RansacTraits>>();
        engine_.add_shape_factory<shapes::Cone<RansacTraits>>();
        engine_.add_shape_factory<shapes::Torus<RansacTraits>>();
        // The library's defaults (1 % of the diagonal, .9, .05) but for the smallest shape: 1 % of all faces leaves
        // half of a part of hundreds of surfaces without a label.
        Engine::Parameters parameters;
        parameters.min_points = std::max<std::size_t>(20, points_.size() / 1000);
        if (tight_) {
            parameters.epsilon = 0.001 * diagonal_;
            parameters.cluster_epsilon = 0.01 * diagonal_;
            parameters.normal_threshold = 0.95;
            parameters.probability = 0.05;
        }
        engine_.detect(parameters);
    }

    std::vector<std::int32_t> labels() const override {
        std::vector<std::int32_t> result(points_.size(), -1);
        std::int32_t label = 0;
        for (const auto& shape : engine_.shapes()) {
            for (const std::size_t i : shape->indices_of_assigned_points()) result[std::get<2>(points_[i])] = label;
            ++label;
        }
        return result;
    }

  private:
    bool tight_;
    double diagonal_ = 0;
    std::vector<FacePoint> points_;
    Engine engine_;
};

}  // namespace

std::unique_ptr<Adapter> make_ransac() {
    return std::make_unique<Ransac>(false);
}
std::unique_ptr<Adapter> make_ransac_tight() {
    return std::make_unique<Ransac>(true);
}

}  // namespace quadseg::bench
