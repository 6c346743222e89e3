#include "tools/cli/hausdorff.h"

#include <quadseg/error.h>

#include "math/vec3.h"
#include "runtime/parallel.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <embree3/rtcore.h>
#include <limits>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

namespace quadseg::cli {
namespace {

constexpr std::size_t block = 2048;

/// Coordinates as both meshes have them in common: about [−½, ½], where float32 boxes are good to 6e-8.
struct Frame {
    Vec3 centre;
    double size = 1;
    Vec3 to_unit(const double* p) const { return (Vec3{p[0], p[1], p[2]} - centre) / size; }
    Vec3 to_input(const Vec3& u) const { return u * size + centre; }
};

/// By how much a box or a query point may be off in float32, generously.
constexpr double float_error = 1e-6;

struct UnitMesh {
    std::vector<Vec3> points;
    std::vector<std::array<std::uint32_t, 3>> faces;
    Vec3 low, high;
};

void extend(const MeshView& mesh, Vec3& low, Vec3& high) {
    for (const std::uint32_t v : mesh.triangles) {
        for (int k = 0; k < 3; ++k) {
            const double x = mesh.positions[3 * std::size_t{v} + static_cast<std::size_t>(k)];
            low[k] = std::min(low[k], x);
            high[k] = std::max(high[k], x);
        }
    }
}

/// And the diagonal of A.
std::pair<Frame, double> common_frame(const MeshView& a, const MeshView& b) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Vec3 low{infinity, infinity, infinity}, high = -low;
    extend(a, low, high);
    const double diagonal = norm(high - low);
    extend(b, low, high);
    Frame frame;
    frame.centre = (low + high) / 2.0;
    frame.size = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
    if (!(frame.size > 0)) frame.size = 1;
    return {frame, diagonal};
}

UnitMesh to_unit(const MeshView& mesh, const Frame& frame) {
    UnitMesh unit;
    unit.points.resize(mesh.vertex_count());
    for (std::size_t v = 0; v < unit.points.size(); ++v) unit.points[v] = frame.to_unit(&mesh.positions[3 * v]);
    unit.faces.resize(mesh.face_count());
    for (std::size_t f = 0; f < unit.faces.size(); ++f) {
        for (std::size_t k = 0; k < 3; ++k) unit.faces[f][k] = mesh.triangles[3 * f + k];
    }
    return unit;
}

/// Christer Ericson's case distinction by Voronoi regions (Real-Time Collision Detection, 5.1.5).
Vec3 nearest(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 ab = b - a, ac = c - a, ap = p - a;
    const double d1 = dot(ab, ap), d2 = dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return a;
    const Vec3 bp = p - b;
    const double d3 = dot(ab, bp), d4 = dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) return b;
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + ab * (d1 > d3 ? d1 / (d1 - d3) : 0);
    const Vec3 cp = p - c;
    const double d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) return c;
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + ac * (d2 > d6 ? d2 / (d2 - d6) : 0);
    const double va = d3 * d6 - d5 * d4, along = d4 - d3, back = d5 - d6;
    if (va <= 0 && along >= 0 && back >= 0) return b + (c - b) * (along + back > 0 ? along / (along + back) : 0);
    const double sum = va + vb + vc;
    return a + ab * (vb / sum) + ac * (vc / sum);
}

class NearestPoints {
  public:
    explicit NearestPoints(const UnitMesh& mesh) : mesh_(mesh), device_(rtcNewDevice(nullptr)) {
        if (!device_) throw Error(ErrorCode::internal, "Embree can't be used on this machine");
        scene_.reset(rtcNewScene(device_.get()));
        const RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.points.size()));
        auto* faces = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), mesh.faces.size()));
        if (points == nullptr || faces == nullptr) {
            rtcReleaseGeometry(geometry);
            throw std::bad_alloc();
        }
        for (std::size_t v = 0; v < mesh.points.size(); ++v) {
            for (int k = 0; k < 3; ++k)
                points[3 * v + static_cast<std::size_t>(k)] = static_cast<float>(mesh.points[v][k]);
        }
        for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
            for (std::size_t k = 0; k < 3; ++k) faces[3 * f + k] = mesh.faces[f][k];
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_.get(), geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_.get());
    }

    double distance(const Vec3& p) const {
        Query query{&mesh_, p, std::numeric_limits<double>::infinity()};
        RTCPointQuery around{};
        around.x = static_cast<float>(p.x);
        around.y = static_cast<float>(p.y);
        around.z = static_cast<float>(p.z);
        around.radius = std::numeric_limits<float>::infinity();
        RTCPointQueryContext context;
        rtcInitPointQueryContext(&context);
        rtcPointQuery(scene_.get(), &around, &context, visit, &query);
        return std::sqrt(query.squared);
    }

  private:
    struct Query {
        const UnitMesh* mesh;
        Vec3 p;
        double squared;
    };
    struct Release {
        void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
        void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
    };

    static bool visit(RTCPointQueryFunctionArguments* arguments) {
        auto& query = *static_cast<Query*>(arguments->userPtr);
        const auto& face = query.mesh->faces[arguments->primID];
        const auto& x = query.mesh->points;
        const double d = squared_norm(query.p - nearest(query.p, x[face[0]], x[face[1]], x[face[2]]));
        if (!(d < query.squared)) return false;
        query.squared = d;
        // Boxes that float32 puts a little too far away are still opened.
        arguments->query->radius = static_cast<float>(std::sqrt(d) * (1 + float_error) + float_error);
        return true;
    }

    const UnitMesh& mesh_;
    std::unique_ptr<std::remove_pointer_t<RTCDevice>, Release> device_;
    std::unique_ptr<std::remove_pointer_t<RTCScene>, Release> scene_;
};

/// 64 well-mixed bits of a sample's number (splitmix64).
std::uint64_t mixed(std::uint64_t z) {
    z += 0x9E3779B97F4A7C15ULL;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31);
}

double unit_interval(std::uint64_t bits) {
    return static_cast<double>(bits >> 11) * 0x1p-53;
}

/// Every so much area along the faces a sample, somewhere in the face that it falls into.
struct Samples {
    std::vector<Vec3> points;
    double area = 0;
};

Samples surface_samples(const UnitMesh& mesh, std::size_t wanted) {
    Samples samples;
    const auto area_of = [&](const std::array<std::uint32_t, 3>& face) {
        const Vec3 &a = mesh.points[face[0]], &b = mesh.points[face[1]], &c = mesh.points[face[2]];
        return 0.5 * norm(cross(b - a, c - a));
    };
    for (const auto& face : mesh.faces) samples.area += area_of(face);
    if (!(samples.area > 0) || wanted == 0) return samples;
    const double step = samples.area / static_cast<double>(wanted);
    samples.points.reserve(wanted + 1);
    double covered = 0;
    for (const auto& face : mesh.faces) {
        covered += area_of(face);
        while (static_cast<double>(samples.points.size()) + 0.5 < covered / step) {
            const std::uint64_t number = 2 * samples.points.size();
            const double s = std::sqrt(unit_interval(mixed(number))), t = unit_interval(mixed(number + 1));
            samples.points.push_back(mesh.points[face[0]] * (1 - s) + mesh.points[face[1]] * (s * (1 - t)) +
                                     mesh.points[face[2]] * (s * t));
        }
    }
    return samples;
}

std::vector<Vec3> used_vertices(const UnitMesh& mesh) {
    std::vector<std::uint8_t> used(mesh.points.size(), 0);
    for (const auto& face : mesh.faces) {
        for (const std::uint32_t v : face) used[v] = 1;
    }
    std::vector<Vec3> points;
    for (std::size_t v = 0; v < used.size(); ++v) {
        if (used[v] != 0) points.push_back(mesh.points[v]);
    }
    return points;
}

struct Sums {
    double sum = 0, squares = 0, max = -1;
    Vec3 farthest;
};

Sums distances(const std::vector<Vec3>& points, const NearestPoints& target, const Context& context) {
    return runtime::reduce_blocks(
        points.size(), block, Sums{},
        [&](std::size_t begin, std::size_t end) {
            if (context.cancelled() || context.past_deadline())
                throw Error(ErrorCode::cancelled, "stopped before the end");
            Sums part;
            for (std::size_t i = begin; i < end; ++i) {
                const double d = target.distance(points[i]);
                part.sum += d;
                part.squares += d * d;
                if (d > part.max) {
                    part.max = d;
                    part.farthest = points[i];
                }
            }
            return part;
        },
        [](Sums a, const Sums& b) {
            a.sum += b.sum;
            a.squares += b.squares;
            if (b.max > a.max) {
                a.max = b.max;
                a.farthest = b.farthest;
            }
            return a;
        });
}

OneSidedDistance one_sided(const UnitMesh& from, const NearestPoints& to, std::size_t wanted, const Frame& frame,
                           const Context& context) {
    const Samples samples = surface_samples(from, wanted);
    const std::vector<Vec3> vertices = used_vertices(from);
    const Sums surface = distances(samples.points, to, context), corners = distances(vertices, to, context);
    OneSidedDistance result;
    result.area = samples.area * frame.size * frame.size;
    result.surface_samples = samples.points.size();
    result.vertex_samples = vertices.size();
    const Sums& worst = corners.max >= surface.max ? corners : surface;
    result.max = std::max(worst.max, 0.0) * frame.size;
    result.farthest = to_array(frame.to_input(worst.farthest));
    // A mesh without area has only its vertices.
    const Sums& all = samples.points.empty() ? corners : surface;
    const auto count =
        static_cast<double>(std::max<std::size_t>(samples.points.empty() ? vertices.size() : samples.points.size(), 1));
    result.mean = all.sum / count * frame.size;
    result.rms = std::sqrt(all.squares / count) * frame.size;
    return result;
}

}  // namespace

std::array<double, 3> nearest_on_triangle(const std::array<double, 3>& p, const std::array<double, 3>& a,
                                          const std::array<double, 3>& b, const std::array<double, 3>& c) {
    return to_array(nearest(to_vec3(p), to_vec3(a), to_vec3(b), to_vec3(c)));
}

std::vector<double> vertex_distances(const MeshView& a, const MeshView& b, const Context& context) {
    const Frame frame = common_frame(a, b).first;
    const UnitMesh from = to_unit(a, frame), to = to_unit(b, frame);
    const NearestPoints target(to);
    std::vector<double> distance(from.points.size());
    runtime::parallel_for(distance.size(), block, [&](std::size_t v) {
        if (v % 64 == 0 && (context.cancelled() || context.past_deadline()))
            throw Error(ErrorCode::cancelled, "stopped before the end");
        distance[v] = target.distance(from.points[v]) * frame.size;
    });
    return distance;
}

MeshDistance measure_mesh_distance(const MeshView& a, const MeshView& b, std::size_t samples, const Context& context) {
    MeshDistance result;
    Frame frame;
    std::tie(frame, result.diagonal) = common_frame(a, b);
    const UnitMesh first = to_unit(a, frame), second = to_unit(b, frame);
    result.forward = one_sided(first, NearestPoints(second), samples, frame, context);
    result.backward = one_sided(second, NearestPoints(first), samples, frame, context);
    result.max = std::max(result.forward.max, result.backward.max);
    const double total = result.forward.area + result.backward.area;
    const double share = total > 0 ? result.forward.area / total : 0.5;
    result.mean = share * result.forward.mean + (1 - share) * result.backward.mean;
    result.rms = std::sqrt(share * result.forward.rms * result.forward.rms +
                           (1 - share) * result.backward.rms * result.backward.rms);
    return result;
}

}  // namespace quadseg::cli
