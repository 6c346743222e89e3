#include "flow/methods.h"

#include "quadric/fit.h"
#include "quadric/moments.h"

#include <algorithm>
#include <array>
#include <vector>

namespace quadseg::flow {

namespace {

using quadric::Coefficients;
using quadric::Proxy;
using quadric::RegionFit;
using quadric::TriangleSoup;

/// Centre and mean normal by area.
struct Mean {
    Vec3 centre, normal;
    double area = 0;
};

Mean mean_of(const TriangleSoup& region) {
    Mean mean;
    for (std::size_t i = 0; i < region.size(); ++i) {
        const Vec3 centroid = (region.corners[3 * i] + region.corners[3 * i + 1] + region.corners[3 * i + 2]) / 3.0;
        mean.centre += centroid * region.areas[i];
        mean.normal += region.normals[i] * region.areas[i];
        mean.area += region.areas[i];
    }
    if (mean.area > 0) {
        mean.centre = mean.centre / mean.area;
    } else if (!region.corners.empty()) {
        mean.centre = region.corners[0];
    }
    mean.normal = normalized(mean.normal);
    return mean;
}

/// Moments about the centroid in units of the RMS radius (MATH.md §3).
struct LocalMoments {
    quadric::Moments moments;
    Vec3 origin;
    double scale = 1;
};

LocalMoments rescaled(const quadric::Moments& centred, const Vec3& origin) {
    LocalMoments local;
    local.origin = origin;
    const double radius = quadric::spread(centred).radius;
    local.scale = radius > 0 ? 1 / radius : 1;
    local.moments = quadric::scaled(centred, local.scale);
    return local;
}

LocalMoments local_moments(const TriangleSoup& region) {
    const Vec3 centre = mean_of(region).centre;
    quadric::Moments moments;
    for (std::size_t i = 0; i < region.size(); ++i) {
        quadric::accumulate(moments, region.corners[3 * i] - centre, region.corners[3 * i + 1] - centre,
                            region.corners[3 * i + 2] - centre, region.normals[i], region.areas[i]);
    }
    return rescaled(moments, centre);
}

/// Coefficients in units scaled by `scale` brought back; gradients keep their length.
Proxy proxy_from_local(const Coefficients& c, const LocalMoments& local) {
    Proxy proxy;
    proxy.origin = local.origin;
    proxy.c = c;
    proxy.c[0] /= local.scale;
    for (std::size_t i = 4; i < 10; ++i) proxy.c[i] *= local.scale;
    return proxy;
}

/// MATH.md §3: 5 % of the median |∇f| over the faces.
void set_gradient_floor(Proxy& proxy, const TriangleSoup& region) {
    if (region.size() == 0) return;
    std::vector<double> lengths(region.size());
    for (std::size_t i = 0; i < region.size(); ++i) {
        const Vec3 centroid = (region.corners[3 * i] + region.corners[3 * i + 1] + region.corners[3 * i + 2]) / 3.0;
        lengths[i] = norm(quadric::gradient(proxy.c, centroid - proxy.origin));
    }
    const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
    std::nth_element(lengths.begin(), middle, lengths.end());
    proxy.gradient_floor = std::max(0.05 * *middle, 1e-6);
}

RegionFit measured(const Proxy& proxy, const TriangleSoup& region, const partition::FaceMetric& metric) {
    RegionFit fit;
    fit.proxy = proxy;
    for (std::size_t i = 0; i < region.size(); ++i) {
        const quadric::TriangleEnergy e =
            partition::corner_energy(proxy, region.corners[3 * i], region.corners[3 * i + 1], region.corners[3 * i + 2],
                                     region.normals[i], region.areas[i], metric.normalised);
        fit.energy.distance += e.distance;
        fit.energy.normal += e.normal;
    }
    fit.total = metric.distance * fit.energy.distance + metric.normal * fit.energy.normal;
    return fit;
}

RegionFit fit_mean_plane(const TriangleSoup& region, const partition::FaceMetric& metric) {
    const Mean mean = mean_of(region);
    return measured(quadric::plane_proxy(mean.centre, mean.normal), region, metric);
}

RegionFit fit_principal_plane(const TriangleSoup& region, const partition::FaceMetric& metric) {
    const LocalMoments local = local_moments(region);
    return measured(proxy_from_local(quadric::fit_plane(local.moments, 0).c, local), region, metric);
}

RegionFit fit_primitive(const TriangleSoup& region, const partition::FaceMetric& metric, double plane_tolerance) {
    const LocalMoments local = local_moments(region);
    const double weight = quadric::scaled_weight(metric.normal, local.scale);
    RegionFit best = measured(proxy_from_local(quadric::fit_plane(local.moments, weight).c, local), region, metric);
    if (best.total >= plane_tolerance) {
        for (const auto& curved :
             {quadric::fit_sphere_linear(local.moments, weight), quadric::fit_cylinder_linear(local.moments, weight)}) {
            Proxy proxy = proxy_from_local(curved.c, local);
            set_gradient_floor(proxy, region);
            const RegionFit fit = measured(proxy, region, metric);
            if (fit.total < best.total) best = fit;
        }
    }
    best.valid = quadric::is_valid(best.proxy, region);
    return best;
}

RegionFit fit_quadric_distance(const TriangleSoup& region, const partition::FaceMetric& metric,
                               double plane_tolerance) {
    const LocalMoments local = local_moments(region);
    RegionFit best = measured(proxy_from_local(quadric::fit_plane(local.moments, 0).c, local), region, metric);
    if (best.total >= plane_tolerance) {
        Proxy proxy = proxy_from_local(quadric::fit_taubin(local.moments).c, local);
        set_gradient_floor(proxy, region);
        const RegionFit fit = measured(proxy, region, metric);
        if (fit.total < best.total) best = fit;
    }
    best.valid = quadric::is_valid(best.proxy, region);
    return best;
}

RegionFit fit_quadric_gradient(const TriangleSoup& region, const partition::FaceMetric& metric) {
    const LocalMoments local = local_moments(region);
    const double weight = quadric::scaled_weight(metric.normal, local.scale);
    RegionFit fit =
        measured(proxy_from_local(quadric::fit_least_squares(local.moments, weight).c, local), region, metric);
    set_gradient_floor(fit.proxy, region);
    fit.valid = quadric::is_valid(fit.proxy, region);
    return fit;
}

/// The best plane, sphere or cylinder for moments about the region's centroid.
partition::RegionScore primitive_score(const quadric::Moments& moments, double weight) {
    partition::RegionScore score;
    if (!(moments.total_area > 0)) return score;
    const quadric::Spread spread = quadric::spread(moments);
    const LocalMoments local = rescaled(quadric::shifted(moments, spread.centroid), {});
    const double local_weight = quadric::scaled_weight(weight, local.scale);
    const std::array<std::pair<double, int>, 3> fits{
        {{quadric::fit_plane(local.moments, local_weight).energy, 3},
         {quadric::fit_sphere_linear(local.moments, local_weight).energy, 4},
         {quadric::fit_cylinder_linear(local.moments, local_weight).energy, 5}}};
    const auto best =
        std::min_element(fits.begin(), fits.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    const double squared = local.scale * local.scale;
    score.energy = std::max(0.0, best->first) / (squared * squared);
    score.cost = score.energy;
    score.dof = best->second;
    return score;
}

}  // namespace

MethodPolicy method_policy(const Options& options, std::function<void()> poll) {
    MethodPolicy policy;
    partition::FaceMetric& metric = policy.metric;
    metric.normal = options.weight;
    const double tolerance = options.paper.plane_tolerance;
    switch (options.method) {
        case Method::quadric: {
            quadric::RegionFitOptions fit_options;
            fit_options.weight = options.weight;
            fit_options.plane_tolerance = tolerance;
            fit_options.poll = std::move(poll);
            policy.fit = [fit_options](const TriangleSoup& r) { return quadric::fit_region(r, fit_options); };
            break;
        }
        case Method::vsa_l21:
            metric.distance = 0;
            metric.normal = 1;
            policy.fit = [metric](const TriangleSoup& r) { return fit_mean_plane(r, metric); };
            break;
        case Method::vsa_l2:
            metric.normal = 0;
            policy.fit = [metric](const TriangleSoup& r) { return fit_principal_plane(r, metric); };
            break;
        case Method::hybrid:
        case Method::hierarchical:
            policy.fit = [metric, tolerance](const TriangleSoup& r) { return fit_primitive(r, metric, tolerance); };
            break;
        case Method::quadric_l2:
            metric.normal = 0;
            policy.fit = [metric, tolerance](const TriangleSoup& r) {
                return fit_quadric_distance(r, metric, tolerance);
            };
            break;
        case Method::quadric_gradient:
            metric.normalised = false;
            policy.fit = [metric](const TriangleSoup& r) { return fit_quadric_gradient(r, metric); };
            break;
    }
    return policy;
}

/// A stop owes its result at once, and a surface for each of hundreds of thousands of regions takes its time: where
/// merging has hardly begun, nothing but the components has been found.
constexpr std::size_t most_regions_of_a_stop = 20000;

FlowResult run_hierarchical(const FlowInput& input) {
    const mesh::WorkMesh& mesh = input.mesh;
    const std::size_t faces = mesh.face_count();
    FlowResult result;
    partition::Labels single(faces);
    for (std::size_t f = 0; f < faces; ++f) single[f] = static_cast<std::int32_t>(f);
    const partition::Passage passage{&mesh, input.features, {}};
    const double weight = input.options.weight;
    const partition::Scorer scorer = [weight](const quadric::Moments& m) { return primitive_score(m, weight); };
    try {
        input.control.report(Phase::fine, 0.2, faces);
        const auto pairs = partition::region_pairs(passage, single, input.control);
        // Faces are measured for each merging anew: a stop would wait while a copy kept for the second, half a kilobyte
        // a face, is given back to the system.
        const auto merged = [&](const partition::MergeRules& rules) {
            return partition::merge_pairs(partition::measure_regions(mesh, single, faces, scorer, input.control), pairs,
                                          rules, scorer, input.control);
        };
        partition::MergeRules rules;
        rules.target = std::max<std::size_t>(input.options.regions, 1);
        rules.labels_only = true;
        partition::Merging merging = merged(rules);
        if (input.options.regions == 0 && !merging.stopped) {
            // The first merge sequence tells how far the threshold reaches; the second stops there.
            rules.target = faces;
            for (const MergeStep& step : merging.history) {
                if (!(step.energy <= input.options.paper.energy_threshold)) break;
                rules.target = step.regions;
            }
            std::vector<MergeStep> history = std::move(merging.history);
            merging = merged(rules);
            merging.history = std::move(history);
        }
        result.labels.resize(faces);
        for (std::size_t f = 0; f < faces; ++f) result.labels[f] = merging.region_of[f];
        result.regions = partition::compact(result.labels);
        result.history = std::move(merging.history);
        result.partial = merging.stopped;
    } catch (const runtime::Stopped&) {
        result.partial = true;
    }
    if (result.partial && (result.labels.empty() || result.regions > most_regions_of_a_stop)) {
        result.labels = mesh.components;
        result.regions = mesh.component_count;
    }
    if (result.partial) {
        result.stop = input.control.cancelled() ? StopReason::cancelled : StopReason::deadline;
    } else if (input.options.regions == 0) {
        result.stop = StopReason::tolerance;
    } else {
        result.stop = result.regions == input.options.regions ? StopReason::regions : StopReason::converged;
    }
    return result;
}

}  // namespace quadseg::flow
