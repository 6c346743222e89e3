// Everything that can be asked of a segmentation. Every field has a default; lengths are relative to the diagonal of
// the bounding box, angles in degrees, unless the name says otherwise.
#pragma once

#include <quadseg/export.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace quadseg {

enum class Preset {
    standard,  ///< "default": bottom-up, finds the surfaces and their number by itself
    paper      ///< the variational loop of the paper, faithfully
};

/// The proxies and the metric of the variational loop (preset paper), for comparisons.
enum class Method {
    quadric,           ///< the paper: plane first, else general quadric, hybrid metric
    vsa_l21,           ///< planes, normal metric: Cohen-Steiner, Alliez, Desbrun 2004
    vsa_l2,            ///< planes, distance metric: the same paper
    hybrid,            ///< plane, sphere, cylinder: Wu and Kobbelt 2005, without rolling-ball blends
    quadric_l2,        ///< general quadrics, distance only: Yan, Liu, Wang 2006
    quadric_gradient,  ///< general quadrics, algebraic distance and unnormalised gradient: Kanai, Ohtake, Kase 2006
    hierarchical       ///< merging of planes, spheres, cylinders: Attene, Falcidieno, Spagnuolo 2006
};

/// The paper's section 4, parameter by parameter, with its values.
struct PaperOptions {
    int lloyd_iterations = 30;      ///< at most, a Lloyd run (≥ 1)
    double convergence = 1e-4;      ///< a Lloyd run stops when the energy falls by less than this share (≥ 0)
    double plane_tolerance = 1e-6;  ///< a region is a plane when its plane energy (unit cube) is below (≥ 0)
    double merge_tolerance =
        1e-4;  ///< ε of section 4.3.3: energy increase (unit cube) below which a pair may merge (≥ 0)
    std::size_t initial_regions =
        1;  ///< random seeds to begin with; 1: one seed, then progressive insertion; 0: as many as --regions
    bool merging = true;        ///< merge redundant regions after each Lloyd run
    bool teleportation = true;  ///< with a fixed number of regions: each merge is followed by an insertion
    int teleportations = 20;    ///< at most (≥ 0)
    double energy_threshold =
        1e-3;  ///< without a number of regions: insertion goes on until the total energy is below (> 0)
    std::size_t maximum_regions = 10000;  ///< bound of the progressive insertion (≥ 1)
};

struct SmoothOptions {
    int band = 2;         ///< faces on each side of a border that may change their label (≥ 1)
    double lambda = 1.0;  ///< weight of the border length, section 4.4.1 (≥ 0)
};

struct Options {
    Preset preset = Preset::standard;
    Method method = Method::quadric;

    std::size_t regions = 0;  ///< number of regions wanted; 0: found by the method itself. Components set a floor.
    /// Largest RMS distance of a region from its surface, relative to the diagonal; 0: from the data. Preset standard.
    double tolerance = 0;
    /// > 0. Above 1 small features survive more easily, below 1 less: divides what a region must be worth to stand
    /// alone.
    double detail = 1;
    /// Edges sharper than this (degrees, 0 to 180) bound regions, unless they belong to a tessellated smooth surface;
    /// 0: no features. Preset standard ignores creases unless this is set explicitly (< 0: as the preset sees fit).
    double feature_angle = -1;
    /// ω of eq. (3), weight of the normal term in the unit cube (≥ 0).
    double weight = 0.5;
    std::uint64_t seed = 1;  ///< of every random choice
    /// Faces of the simplified mesh that is segmented first (section 5.2); 0: none, −1: automatic where it pays (preset
    /// paper, from 10,000 faces on). Preset standard then groups faces by energy only; with 0 too it segments scans of
    /// 250,000 faces and more through a simplified mesh, by likelihood.
    std::int64_t coarse = 0;

    bool smooth = false;   ///< graph-cut smoothing of region borders, section 4.4.1
    bool project = false;  ///< project the vertices onto the surfaces, section 4.4.3; fills Segmentation::projected
    bool project_joint = false;  ///< border vertices onto all incident surfaces at once instead of the paper's average
    bool regularities =
        true;  ///< find parallel, coaxial, equal … groups and snap where the data allow (preset standard)

    PaperOptions paper;
    SmoothOptions smoothing;
};

/// All problems of a set of options, one sentence each; empty when they are fine. segment() throws Error
/// invalid_argument with them.
QUADSEG_API std::vector<std::string> validate(const Options& options);

/// "default"/"paper"; "quadric", "vsa_l21" … Never null.
QUADSEG_API const char* to_string(Preset preset) noexcept;
QUADSEG_API const char* to_string(Method method) noexcept;
/// The reverse; false if there is no such name.
QUADSEG_API bool from_string(const std::string& name, Preset& preset) noexcept;
QUADSEG_API bool from_string(const std::string& name, Method& method) noexcept;

}  // namespace quadseg
