// CGAL's Variational_shape_approximation (Cohen-Steiner, Alliez, Desbrun 2004) with its metrics and with the paper's,
// the nearest thing to the paper that a user of CGAL can put together.
#include "bench/rivals/adapter.h"
#include "bench/rivals/cgal_mesh.h"
#include "partition/face_metric.h"
#include "quadric/region_fit.h"

#include <CGAL/Surface_mesh_approximation/L21_metric_plane_proxy.h>
#include <CGAL/Surface_mesh_approximation/L2_metric_plane_proxy.h>
#include <CGAL/Variational_shape_approximation.h>
#include <CGAL/boost/graph/properties_Surface_mesh.h>
#include <algorithm>

namespace quadseg::bench {
namespace {

namespace approximation = CGAL::Surface_mesh_approximation;
namespace named = CGAL::parameters;
using Positions = boost::property_map<CgalMesh, boost::vertex_point_t>::type;
using Face = boost::graph_traits<CgalMesh>::face_descriptor;

/// Concept ErrorMetricProxy with the paper's proxy and hybrid energy (ω = .5), in the unit cube.
class QuadricMetric {
  public:
    using Proxy = quadric::Proxy;
    using FT = Kernel::FT;

    QuadricMetric(const CgalMesh& mesh, const Positions& positions) {
        const std::size_t count = mesh.number_of_faces();
        corners_.resize(3 * count);
        normals_.resize(count);
        areas_.resize(count);
        const CGAL::Bbox_3 box = CGAL::bbox_3(mesh.points().begin(), mesh.points().end());
        const Vec3 low{box.xmin(), box.ymin(), box.zmin()}, high{box.xmax(), box.ymax(), box.zmax()};
        const double scale = 1 / std::max({high.x - low.x, high.y - low.y, high.z - low.z});
        for (const Face face : mesh.faces()) {
            auto half = mesh.halfedge(face);
            const std::size_t f = face;
            for (std::size_t k = 0; k < 3; ++k, half = mesh.next(half)) {
                const Point& p = positions[mesh.target(half)];
                corners_[3 * f + k] = (Vec3{p.x(), p.y(), p.z()} - (low + high) / 2.0) * scale;
            }
            const Vec3 n = cross(corners_[3 * f + 1] - corners_[3 * f], corners_[3 * f + 2] - corners_[3 * f]);
            areas_[f] = norm(n) / 2;
            normals_[f] = areas_[f] > 0 ? n / (2 * areas_[f]) : Vec3{};
        }
    }

    FT compute_error(const Face face, const CgalMesh&, const Proxy& proxy) const {
        const std::size_t f = face;
        return partition::corner_energy(proxy, corners_[3 * f], corners_[3 * f + 1], corners_[3 * f + 2], normals_[f],
                                        areas_[f], true)
            .hybrid(0.5);
    }

    template <class Faces>
    Proxy fit_proxy(const Faces& faces, const CgalMesh&) const {
        std::vector<Vec3> corners, normals;
        std::vector<double> areas;
        for (const Face face : faces) {
            const std::size_t f = face;
            corners.insert(corners.end(), {corners_[3 * f], corners_[3 * f + 1], corners_[3 * f + 2]});
            normals.push_back(normals_[f]);
            areas.push_back(areas_[f]);
        }
        return quadric::fit_region({corners, normals, areas}, {}).proxy;
    }

  private:
    std::vector<Vec3> corners_, normals_;
    std::vector<double> areas_;
};

/// What approximate_triangle_mesh() of CGAL 5.5 really takes where nothing is asked for.
constexpr std::size_t default_iterations = 20;

template <class Metric>
class Vsa : public Adapter {
  public:
    /// Without a number: as many iterations as CGAL's manual says that approximate_triangle_mesh() takes by default.
    explicit Vsa(approximation::Seeding_method seeding, std::size_t iterations = 0)
        : seeding_(seeding), iterations_(iterations) {}

    void prepare(const Mesh& mesh, std::size_t regions) override {
        mesh_ = cgal_mesh(mesh);
        regions_ = regions;
        labels_ = mesh_.add_property_map<Face, std::size_t>("f:label").first;
    }
    /// With the number of relaxations that CGAL's own approximate_triangle_mesh() takes by default.
    void segment() override {
        const std::size_t iterations =
            iterations_ > 0
                ? iterations_
                : std::clamp<std::size_t>(mesh_.number_of_faces() / std::max<std::size_t>(regions_, 1), 20, 60);
        const Metric metric(mesh_, mesh_.points());
        CGAL::Variational_shape_approximation<CgalMesh, Positions, Metric> vsa(mesh_, mesh_.points(), metric);
        vsa.initialize_seeds(named::seeding_method(seeding_).max_number_of_proxies(regions_).number_of_relaxations(5));
        vsa.run(iterations);
        vsa.proxy_map(labels_);
    }
    std::vector<std::int32_t> labels() const override {
        std::vector<std::int32_t> result(mesh_.number_of_faces());
        for (const Face face : mesh_.faces()) result[face] = static_cast<std::int32_t>(labels_[face]);
        return result;
    }

  private:
    approximation::Seeding_method seeding_;
    std::size_t iterations_, regions_ = 0;
    CgalMesh mesh_;
    CgalMesh::Property_map<Face, std::size_t> labels_;
};

}  // namespace

std::unique_ptr<Adapter> make_vsa_l21() {
    using Metric = approximation::L21_metric_plane_proxy<CgalMesh>;
    return std::make_unique<Vsa<Metric>>(approximation::HIERARCHICAL, default_iterations);
}
std::unique_ptr<Adapter> make_vsa_l21_as_documented() {
    using Metric = approximation::L21_metric_plane_proxy<CgalMesh>;
    return std::make_unique<Vsa<Metric>>(approximation::HIERARCHICAL);
}
std::unique_ptr<Adapter> make_vsa_l2() {
    using Metric = approximation::L2_metric_plane_proxy<CgalMesh>;
    return std::make_unique<Vsa<Metric>>(approximation::HIERARCHICAL, default_iterations);
}
std::unique_ptr<Adapter> make_vsa_quadric() {
    return std::make_unique<Vsa<QuadricMetric>>(approximation::HIERARCHICAL, default_iterations);
}
std::unique_ptr<Adapter> make_vsa_quadric_incremental() {
    return std::make_unique<Vsa<QuadricMetric>>(approximation::INCREMENTAL, default_iterations);
}

}  // namespace quadseg::bench
