// Options checked, and the names of every enumeration of the public headers.
#include <quadseg/context.h>
#include <quadseg/error.h>
#include <quadseg/options.h>
#include <quadseg/segmentation.h>

#include <array>
#include <cmath>
#include <sstream>
#include <string_view>
#include <type_traits>
#include <utility>

namespace quadseg {

namespace {

template <class Enum>
using Name = std::pair<Enum, const char*>;

constexpr std::array<Name<Preset>, 2> preset_names{{{Preset::standard, "default"}, {Preset::paper, "paper"}}};

constexpr std::array<Name<Method>, 7> method_names{{{Method::quadric, "quadric"},
                                                    {Method::vsa_l21, "vsa_l21"},
                                                    {Method::vsa_l2, "vsa_l2"},
                                                    {Method::hybrid, "hybrid"},
                                                    {Method::quadric_l2, "quadric_l2"},
                                                    {Method::quadric_gradient, "quadric_gradient"},
                                                    {Method::hierarchical, "hierarchical"}}};

constexpr std::array<Name<Phase>, 6> phase_names{{{Phase::read, "read"},
                                                  {Phase::prepare, "prepare"},
                                                  {Phase::coarse, "coarse"},
                                                  {Phase::fine, "fine"},
                                                  {Phase::post, "post"},
                                                  {Phase::write, "write"}}};

constexpr std::array<Name<ErrorCode>, 9> error_names{{{ErrorCode::invalid_argument, "invalid_argument"},
                                                      {ErrorCode::invalid_mesh, "invalid_mesh"},
                                                      {ErrorCode::empty_mesh, "empty_mesh"},
                                                      {ErrorCode::file_open, "file_open"},
                                                      {ErrorCode::file_format, "file_format"},
                                                      {ErrorCode::file_write, "file_write"},
                                                      {ErrorCode::cancelled, "cancelled"},
                                                      {ErrorCode::memory_limit, "memory_limit"},
                                                      {ErrorCode::internal, "internal"}}};

constexpr std::array<Name<SurfaceType>, surface_type_count> surface_names{
    {{SurfaceType::plane, "plane"},
     {SurfaceType::sphere, "sphere"},
     {SurfaceType::cylinder, "cylinder"},
     {SurfaceType::cone, "cone"},
     {SurfaceType::torus, "torus"},
     {SurfaceType::ellipsoid, "ellipsoid"},
     {SurfaceType::elliptic_cylinder, "elliptic_cylinder"},
     {SurfaceType::elliptic_cone, "elliptic_cone"},
     {SurfaceType::elliptic_paraboloid, "elliptic_paraboloid"},
     {SurfaceType::hyperbolic_paraboloid, "hyperbolic_paraboloid"},
     {SurfaceType::hyperboloid_one_sheet, "hyperboloid_one_sheet"},
     {SurfaceType::hyperboloid_two_sheets, "hyperboloid_two_sheets"},
     {SurfaceType::parabolic_cylinder, "parabolic_cylinder"},
     {SurfaceType::hyperbolic_cylinder, "hyperbolic_cylinder"},
     {SurfaceType::quadric, "quadric"},
     {SurfaceType::blend, "blend"},
     {SurfaceType::freeform, "freeform"}}};

constexpr std::array<Name<StopReason>, 6> stop_names{{{StopReason::converged, "converged"},
                                                      {StopReason::regions, "regions"},
                                                      {StopReason::tolerance, "tolerance"},
                                                      {StopReason::maximum, "maximum"},
                                                      {StopReason::deadline, "deadline"},
                                                      {StopReason::cancelled, "cancelled"}}};

using Kind = Regularity::Kind;
constexpr std::array<Name<Kind>, 6> regularity_names{{{Kind::parallel, "parallel"},
                                                      {Kind::perpendicular, "perpendicular"},
                                                      {Kind::coaxial, "coaxial"},
                                                      {Kind::coplanar, "coplanar"},
                                                      {Kind::concentric, "concentric"},
                                                      {Kind::equal_radius, "equal_radius"}}};

template <class Names, class Enum>
const char* name_of(const Names& names, Enum value) noexcept {
    for (const auto& [known, name] : names) {
        if (known == value) return name;
    }
    return "unknown";  // a number that is no enumerator, cast by the caller
}

template <class Names, class Enum>
bool value_of(const Names& names, std::string_view wanted, Enum& value) noexcept {
    for (const auto& [known, name] : names) {
        if (wanted == name) {
            value = known;
            return true;
        }
    }
    return false;
}

template <class Names, class Enum>
bool is_known(const Names& names, Enum value) noexcept {
    for (const auto& entry : names) {
        if (entry.first == value) return true;
    }
    return false;
}

/// Collects the problems; every rule is a line of validate().
class Problems {
  public:
    template <class T>
    void require(bool fine, const char* option, const char* range, T value) {
        if (fine) return;
        std::ostringstream text;
        text.imbue(std::locale::classic());
        text << option << ": must be " << range << ", but is ";
        if constexpr (std::is_enum_v<T>) {
            text << static_cast<long long>(value);
        } else {
            text << value;
        }
        found_.push_back(text.str());
    }
    std::vector<std::string> take() { return std::move(found_); }

  private:
    std::vector<std::string> found_;
};

/// False for NaN and infinities.
bool within(double value, double low, double high) noexcept {
    return std::isfinite(value) && value >= low && value <= high;
}

constexpr double unbounded = 1e300;

}  // namespace

std::vector<std::string> validate(const Options& o) {
    Problems problems;
    problems.require(is_known(preset_names, o.preset), "preset", "default or paper", o.preset);
    problems.require(is_known(method_names, o.method), "method", "one of the listed methods", o.method);
    problems.require(within(o.tolerance, 0, 1), "tolerance", "0 (from the data) to 1 diagonal", o.tolerance);
    problems.require(within(o.detail, 1e-6, 1e6), "detail", "1e-6 to 1e6", o.detail);
    problems.require(within(o.feature_angle, -unbounded, 180), "feature_angle",
                     "0 (none) to 180 degrees, or negative (as the preset sees fit)", o.feature_angle);
    problems.require(within(o.weight, 0, unbounded), "weight", "0 or more", o.weight);
    problems.require(o.coarse >= -1, "coarse", "0 (none), -1 (automatic) or a number of faces", o.coarse);

    const PaperOptions& p = o.paper;
    problems.require(p.lloyd_iterations >= 1, "paper.lloyd_iterations", "1 or more", p.lloyd_iterations);
    problems.require(within(p.convergence, 0, unbounded), "paper.convergence", "0 or more", p.convergence);
    problems.require(within(p.plane_tolerance, 0, unbounded), "paper.plane_tolerance", "0 or more", p.plane_tolerance);
    problems.require(within(p.merge_tolerance, 0, unbounded), "paper.merge_tolerance", "0 or more", p.merge_tolerance);
    problems.require(p.teleportations >= 0, "paper.teleportations", "0 or more", p.teleportations);
    problems.require(within(p.energy_threshold, 0, unbounded) && p.energy_threshold > 0, "paper.energy_threshold",
                     "above 0", p.energy_threshold);
    problems.require(p.maximum_regions >= 1, "paper.maximum_regions", "1 or more", p.maximum_regions);

    problems.require(o.smoothing.band >= 1, "smoothing.band", "1 or more", o.smoothing.band);
    problems.require(within(o.smoothing.lambda, 0, unbounded), "smoothing.lambda", "0 or more", o.smoothing.lambda);
    return problems.take();
}

const char* to_string(Preset preset) noexcept {
    return name_of(preset_names, preset);
}
const char* to_string(Method method) noexcept {
    return name_of(method_names, method);
}
const char* to_string(Phase phase) noexcept {
    return name_of(phase_names, phase);
}
const char* to_string(ErrorCode code) noexcept {
    return name_of(error_names, code);
}
const char* to_string(SurfaceType type) noexcept {
    return name_of(surface_names, type);
}
const char* to_string(StopReason reason) noexcept {
    return name_of(stop_names, reason);
}
const char* to_string(Regularity::Kind kind) noexcept {
    return name_of(regularity_names, kind);
}

bool from_string(const std::string& name, Preset& preset) noexcept {
    return value_of(preset_names, name, preset);
}
bool from_string(const std::string& name, Method& method) noexcept {
    return value_of(method_names, name, method);
}

}  // namespace quadseg
