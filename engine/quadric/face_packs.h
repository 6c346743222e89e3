// A region's faces in packs, in the centred, scaled frame of the region, and the passes over them that a fit is made
// of.
#pragma once

#include "quadric/moments.h"
#include "quadric/monomials.h"
#include "quadric/pack_energy.h"
#include "quadric/region_fit.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace quadseg::quadric {

/// What the weights of the second step and the true energies need to know of a candidate.
struct Candidate {
    Coefficients c{};                 ///< local frame, oriented, mean |∇f(c_t)| 1
    double gradient_floor = 1e-6;     ///< 5 % of the region's median |∇f(c_t)|
    double distance = 0, normal = 0;  ///< true energies in the local frame
    double against = 0;               ///< area where n·∇f(c_t) ≤ 0
    bool usable = false;
};

class FacePacks {
  public:
    /// Finds the frame, fills the packs and the unit-weight moments. Faces of no (or no finite) area do not take part.
    /// with_moments = false leaves the moments' degrees above 0 and the normal moments out, where nothing is fitted.
    /// `poll` is called every few thousand faces of a pass and may throw.
    explicit FacePacks(const TriangleSoup& region, bool with_moments = true,
                       const std::function<void()>* poll = nullptr);

    double area() const noexcept { return area_; }  ///< in the unit frame
    const Vec3& centre() const noexcept { return centre_; }
    double scale() const noexcept { return scale_; }              ///< local = (x − centre) · scale
    const Moments& moments() const noexcept { return moments_; }  ///< local frame; normal2 is not filled

    /// Orients and scales c to mean |∇f(c_t)| 1 and finds the gradient floor. Not usable if not finite or zero.
    Candidate prepare(const Coefficients& c);
    /// Moments of the second step for two candidates in one pass: weights 1/|∇f⁰|² and 1/|∇f⁰| (appendix).
    void reweigh(const Candidate& first, const Candidate& second, Moments& out_first, Moments& out_second) const;
    /// Same for one.
    void reweigh(const Candidate& candidate, Moments& out) const;
    /// True energies with the one-point gradient of c itself, and the area against it.
    void evaluate(Candidate& candidate) const;
    /// Share of the area whose foot points lie on the smaller side of two-sheeted quadrics; 0 if on one connected
    /// sheet, 1 if there is no real surface.
    double share_on_other_sheet(const Coefficients& c) const;

  private:
    template <std::size_t count>
    void reweigh_all(const std::array<const Candidate*, count>& candidates,
                     const std::array<Moments*, count>& out) const;
    static constexpr std::size_t polled_packs = 1024;
    /// Those from `part` on that are passed over between two polls.
    std::span<const FacePack> packs(std::size_t part) const noexcept {
        return {packs_.get() + part, std::min(polled_packs, pack_count_ - part)};
    }
    void poll_packs() const {
        if (poll_ != nullptr && *poll_) (*poll_)();
    }

    const std::function<void()>* poll_;

    std::unique_ptr<FacePack[]> packs_;  // not a vector: written once, without being cleared first
    std::size_t pack_count_ = 0;
    std::vector<double> lengths_, sample_;
    Vec3 centre_;
    double area_ = 0, scale_ = 1;
    std::size_t faces_ = 0;
    Moments moments_;
};

}  // namespace quadseg::quadric
