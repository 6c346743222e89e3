// CGAL's region growing of least-squares planes over the mesh.
#include "bench/rivals/adapter.h"
#include "bench/rivals/cgal_mesh.h"

#include <CGAL/Shape_detection/Region_growing/Region_growing.h>
#include <CGAL/Shape_detection/Region_growing/Region_growing_on_polygon_mesh.h>
#include <CGAL/boost/graph/properties_Surface_mesh.h>
#include <algorithm>
#include <cmath>
#include <iterator>

namespace quadseg::bench {
namespace {

using Faces = CgalMesh::Face_range;
using Neighbors = CGAL::Shape_detection::Polygon_mesh::One_ring_neighbor_query<CgalMesh>;
using Planes = CGAL::Shape_detection::Polygon_mesh::Least_squares_plane_fit_region<Kernel, CgalMesh>;
using Sorting = CGAL::Shape_detection::Polygon_mesh::Least_squares_plane_fit_sorting<Kernel, CgalMesh, Neighbors>;
using Growing = CGAL::Shape_detection::Region_growing<Faces, Neighbors, Planes, Sorting::Seed_map>;

class RegionGrowing : public Adapter {
  public:
    void prepare(const Mesh& mesh, std::size_t) override { mesh_ = cgal_mesh(mesh); }

    /// Planes within .05 % of the diagonal and 5 degrees, of at least .05 % of the faces (at least 10), best seeds
    /// first.
    void segment() override {
        const CGAL::Bbox_3 box = CGAL::bbox_3(mesh_.points().begin(), mesh_.points().end());
        const double diagonal = std::hypot(box.xmax() - box.xmin(), box.ymax() - box.ymin(), box.zmax() - box.zmin());
        const Faces faces = mesh_.faces();
        Neighbors neighbors(mesh_);
        const std::size_t smallest = std::max<std::size_t>(10, mesh_.number_of_faces() / 2000);
        Planes planes(mesh_, 5e-4 * diagonal, 5, smallest, mesh_.points());
        Sorting sorting(mesh_, neighbors, mesh_.points());
        sorting.sort();
        Growing growing(faces, neighbors, planes, sorting.seed_map());
        growing.detect(std::back_inserter(regions_));
    }

    std::vector<std::int32_t> labels() const override {
        std::vector<std::int32_t> result(mesh_.number_of_faces(), -1);
        for (std::size_t r = 0; r < regions_.size(); ++r) {
            for (const std::size_t f : regions_[r]) result[f] = static_cast<std::int32_t>(r);
        }
        return result;
    }

  private:
    CgalMesh mesh_;
    std::vector<std::vector<std::size_t>> regions_;
};

}  // namespace

std::unique_ptr<Adapter> make_region_growing() {
    return std::make_unique<RegionGrowing>();
}

}  // namespace quadseg::bench
